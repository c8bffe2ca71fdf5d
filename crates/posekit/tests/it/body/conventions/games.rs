//! Skeletons of game engines, games and avatars.

use super::{Convention, PLAIN, SMALL};

pub(super) fn games() -> Vec<Convention> {
    vec![
        Convention {
            label: "Unreal",
            sides: SMALL,
            above: &[("root", [0.0, 0.0, 0.0])],
            trunk: &[
                ("pelvis", [0.0, 96.8, 1.1]),
                ("spine_01", [0.0, 10.8, -0.9]),
                ("spine_02", [0.0, 18.9, 0.2]),
                ("spine_03", [0.0, 13.4, -1.0]),
                ("neck_01", [0.0, 16.6, -3.0]),
                ("head", [0.0, 9.3, 0.9]),
            ],
            head: "head",
            chest: "spine_03",
            leg: &[
                ("thigh_#", [9.0, -1.4, 0.6]),
                ("calf_#", [2.5, -42.4, 1.6]),
                ("foot_#", [2.3, -40.0, -4.7]),
                ("ball_#", [0.5, -10.4, 15.5]),
            ],
            arm: &[
                ("clavicle_#", [3.8, 11.9, -2.8]),
                ("upperarm_#", [15.0, -3.0, -3.5]),
                ("lowerarm_#", [30.3, 0.0, 0.0]),
                ("hand_#", [26.9, 0.0, 0.0]),
            ],
            landmarks: [
                "thigh_#",
                "calf_#",
                "foot_#",
                "upperarm_#",
                "lowerarm_#",
                "hand_#",
            ],
            fingers: (5, 3, "#_"),
            beside: &[
                ("root", ("ik_foot_root", [0.0, 0.0, 0.0])),
                ("ik_foot_root", ("ik_foot_l", [13.8, 13.0, -1.4])),
                ("ik_foot_root", ("ik_foot_r", [-13.8, 13.0, -1.4])),
                ("root", ("ik_hand_root", [0.0, 0.0, 0.0])),
                ("ik_hand_root", ("ik_hand_gun", [-76.0, 146.0, -8.0])),
                ("ik_hand_gun", ("ik_hand_r", [0.0, 0.0, 0.0])),
                ("ik_hand_gun", ("ik_hand_l", [152.0, 0.0, 0.0])),
            ],
            beside_limbs: &[
                ("thigh_#", ("thigh_twist_01_#", [1.2, -22.0, 0.8])),
                ("calf_#", ("calf_twist_01_#", [1.1, -20.0, -2.4])),
                ("upperarm_#", ("upperarm_twist_01_#", [0.5, 0.0, 0.0])),
                ("lowerarm_#", ("lowerarm_twist_01_#", [14.0, 0.0, 0.0])),
            ],
            ..PLAIN
        },
        // 3ds Max: the legs hang from the spine, the collar bones from the neck.
        Convention {
            label: "Biped",
            sides: [["L", "R"], ["L", "R"]],
            above: &[("Bip01", [0.0, 94.0, 0.0])],
            trunk: &[
                ("Bip01 Pelvis", [0.0, 0.0, 0.0]),
                ("Bip01 Spine", [0.0, 9.0, -1.0]),
                ("Bip01 Spine1", [0.0, 14.0, 0.0]),
                ("Bip01 Spine2", [0.0, 14.0, 0.0]),
                ("Bip01 Neck", [0.0, 14.0, 0.0]),
                ("Bip01 Head", [0.0, 9.0, 2.0]),
                ("Bip01 HeadNub", [0.0, 22.0, 0.0]),
            ],
            head: "Bip01 Head",
            chest: "Bip01 Neck",
            legs_on: "Bip01 Spine",
            leg: &[
                ("Bip01 # Thigh", [9.5, -9.0, 1.0]),
                ("Bip01 # Calf", [0.0, -43.0, 0.0]),
                ("Bip01 # Foot", [0.0, -42.0, -2.0]),
                ("Bip01 # Toe0", [0.0, -9.0, 13.0]),
                ("Bip01 # Toe0Nub", [0.0, 0.0, 7.0]),
            ],
            arm: &[
                ("Bip01 # Clavicle", [3.0, -3.0, 0.0]),
                ("Bip01 # UpperArm", [14.0, 0.0, -1.0]),
                ("Bip01 # Forearm", [28.0, 0.0, 0.0]),
                ("Bip01 # Hand", [25.0, 0.0, 0.0]),
                ("Bip01 # Finger1", [9.0, 0.0, 1.0]),
                ("Bip01 # Finger1Nub", [7.0, 0.0, 0.0]),
            ],
            landmarks: [
                "Bip01 # Thigh",
                "Bip01 # Calf",
                "Bip01 # Foot",
                "Bip01 # UpperArm",
                "Bip01 # Forearm",
                "Bip01 # Hand",
            ],
            ..PLAIN
        },
        Convention {
            label: "MikuMikuDance",
            sides: [["左", "右"], ["左", "右"]],
            above: &[("全ての親", [0.0, 0.0, 0.0]), ("センター", [0.0, 8.0, 0.0])],
            trunk: &[
                ("上半身", [0.0, 4.5, -0.1]),
                ("上半身2", [0.0, 1.2, 0.1]),
                ("首", [0.0, 3.1, -0.2]),
                ("頭", [0.0, 0.9, 0.1]),
                ("頭先_end", [0.0, 1.6, 0.0]),
            ],
            head: "頭",
            chest: "上半身2",
            beside: &[("センター", ("下半身", [0.0, 4.5, -0.1]))],
            legs_on: "下半身",
            leg: &[
                ("%足", [0.9, -1.2, 0.1]),
                ("%ひざ", [0.1, -4.6, 0.1]),
                ("%足首", [0.1, -5.0, -0.2]),
                ("%つま先", [0.0, -1.4, 1.4]),
            ],
            arm: &[
                ("%肩", [0.3, 2.6, 0.0]),
                ("%腕", [1.0, -0.1, 0.0]),
                ("%ひじ", [2.8, 0.0, 0.0]),
                ("%手首", [2.4, 0.0, 0.0]),
                ("%手先_end", [0.8, 0.0, 0.0]),
            ],
            landmarks: ["%足", "%ひざ", "%足首", "%腕", "%ひじ", "%手首"],
            ..PLAIN
        },
        // VRoid: hair, skirt and bust swing on chains of their own.
        Convention {
            label: "VRoid",
            above: &[("Root", [0.0, 0.0, 0.0])],
            trunk: &[
                ("J_Bip_C_Hips", [0.0, 0.93, 0.0]),
                ("J_Bip_C_Spine", [0.0, 0.06, 0.01]),
                ("J_Bip_C_Chest", [0.0, 0.12, 0.0]),
                ("J_Bip_C_UpperChest", [0.0, 0.12, -0.02]),
                ("J_Bip_C_Neck", [0.0, 0.14, -0.03]),
                ("J_Bip_C_Head", [0.0, 0.08, 0.02]),
                ("J_Sec_Hair1_01", [0.0, 0.16, -0.08]),
                ("J_Sec_Hair2_01", [0.0, -0.2, -0.05]),
                ("J_Sec_Hair3_01", [0.0, -0.3, 0.0]),
            ],
            head: "J_Bip_C_Head",
            chest: "J_Bip_C_UpperChest",
            leg: &[
                ("J_Bip_#_UpperLeg", [0.08, -0.04, 0.0]),
                ("J_Bip_#_LowerLeg", [0.0, -0.39, 0.0]),
                ("J_Bip_#_Foot", [0.0, -0.42, -0.03]),
                ("J_Bip_#_ToeBase", [0.0, -0.07, 0.11]),
            ],
            arm: &[
                ("J_Bip_#_Shoulder", [0.03, 0.1, -0.01]),
                ("J_Bip_#_UpperArm", [0.09, -0.01, 0.0]),
                ("J_Bip_#_LowerArm", [0.23, 0.0, 0.0]),
                ("J_Bip_#_Hand", [0.22, 0.0, 0.0]),
            ],
            landmarks: [
                "J_Bip_#_UpperLeg",
                "J_Bip_#_LowerLeg",
                "J_Bip_#_Foot",
                "J_Bip_#_UpperArm",
                "J_Bip_#_LowerArm",
                "J_Bip_#_Hand",
            ],
            fingers: (5, 3, "J_Bip_#_"),
            beside: &[
                ("J_Bip_C_Head", ("J_Adj_L_FaceEye", [0.02, 0.06, 0.04])),
                ("J_Bip_C_Head", ("J_Adj_R_FaceEye", [-0.02, 0.06, 0.04])),
            ],
            beside_limbs: &[
                ("J_Bip_C_UpperChest", ("J_Sec_#_Bust1", [0.04, 0.0, 0.06])),
                ("J_Sec_#_Bust1", ("J_Sec_#_Bust2", [0.01, -0.01, 0.05])),
                (
                    "J_Bip_C_Hips",
                    ("J_Sec_#_SkirtSide1_01", [0.12, -0.05, 0.0]),
                ),
                (
                    "J_Sec_#_SkirtSide1_01",
                    ("J_Sec_#_SkirtSide2_01", [0.05, -0.18, 0.0]),
                ),
                (
                    "J_Sec_#_SkirtSide2_01",
                    ("J_Sec_#_SkirtSide3_01", [0.05, -0.18, 0.0]),
                ),
            ],
            ..PLAIN
        },
        Convention {
            label: "Second Life",
            trunk: &[
                ("mPelvis", [0.0, 1.07, 0.0]),
                ("mTorso", [0.0, 0.084, 0.0]),
                ("mChest", [0.0, 0.205, -0.015]),
                ("mNeck", [0.0, 0.251, -0.01]),
                ("mHead", [0.0, 0.076, 0.0]),
                ("mSkull_end", [0.0, 0.079, 0.0]),
            ],
            head: "mHead",
            chest: "mChest",
            leg: &[
                ("mHip%", [0.127, -0.041, 0.034]),
                ("mKnee%", [-0.046, -0.491, -0.001]),
                ("mAnkle%", [0.001, -0.468, -0.029]),
                ("mFoot%", [0.0, -0.061, 0.112]),
                ("mToe%_end", [0.0, 0.0, 0.109]),
            ],
            arm: &[
                ("mCollar%", [0.085, 0.165, -0.021]),
                ("mShoulder%", [0.079, 0.0, 0.0]),
                ("mElbow%", [0.248, 0.0, 0.0]),
                ("mWrist%", [0.205, 0.0, 0.0]),
                ("mHand%_end", [0.16, 0.0, 0.0]),
            ],
            landmarks: [
                "mHip%",
                "mKnee%",
                "mAnkle%",
                "mShoulder%",
                "mElbow%",
                "mWrist%",
            ],
            ..PLAIN
        },
    ]
}
