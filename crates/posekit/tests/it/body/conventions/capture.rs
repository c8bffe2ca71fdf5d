//! Skeletons of published sets of captured motion.

use super::{Convention, PLAIN, SMALL, WORDS};

pub(super) fn capture() -> Vec<Convention> {
    vec![
        Convention {
            label: "CMU",
            sides: WORDS,
            above: &[],
            trunk: &[
                ("Hips", [0.0, 17.0, 0.0]),
                ("LowerBack", [0.0, 0.0, 0.0]),
                ("Spine", [0.03, 2.04, -0.19]),
                ("Spine1", [0.06, 2.05, -0.04]),
                ("Neck", [0.0, 0.0, 0.0]),
                ("Neck1", [-0.05, 1.75, 0.17]),
                ("Head", [0.1, 1.76, -0.12]),
                ("Head_end", [0.04, 1.77, -0.06]),
            ],
            head: "Head",
            chest: "Spine1",
            leg: &[
                ("#HipJoint", [0.0, 0.0, 0.0]),
                ("%UpLeg", [1.36, -1.79, 0.84]),
                ("%Leg", [2.45, -6.73, 0.0]),
                ("%Foot", [2.56, -7.04, 0.0]),
                ("%ToeBase", [0.16, -0.43, 2.32]),
                ("%Toe_end", [0.0, 0.0, 1.19]),
            ],
            arm: &[
                ("%Shoulder", [0.0, 0.0, 0.0]),
                ("%Arm", [3.36, 1.2, -0.31]),
                ("%ForeArm", [4.98, 0.0, 0.0]),
                ("%Hand", [3.48, 0.0, 0.0]),
                ("%FingerBase", [0.0, 0.0, 0.0]),
                ("%HandIndex1", [0.72, 0.0, 0.0]),
                ("%Hand_end", [0.58, 0.0, 0.0]),
            ],
            landmarks: ["%UpLeg", "%Leg", "%Foot", "%Arm", "%ForeArm", "%Hand"],
            ..PLAIN
        },
        Convention {
            label: "Bandai",
            sides: WORDS,
            above: &[("joint_Root", [0.0, 0.0, 0.0])],
            trunk: &[
                ("Hips", [0.0, 94.0, 0.0]),
                ("Spine", [0.0, 15.7, 0.0]),
                ("Chest", [0.0, 9.0, 0.4]),
                ("Neck", [0.0, 16.4, 0.0]),
                ("Head", [0.0, 6.5, 0.0]),
                ("Head_end", [0.0, 10.0, 0.0]),
            ],
            head: "Head",
            chest: "Chest",
            leg: &[
                ("UpperLeg_#", [6.5, -2.2, 0.0]),
                ("LowerLeg_#", [0.0, -39.1, 0.0]),
                ("Foot_#", [0.0, -41.0, 0.0]),
                ("Toes_#", [0.0, -9.0, 7.5]),
                ("Toes_#_end", [0.0, 0.0, 5.0]),
            ],
            arm: &[
                ("Shoulder_#", [5.0, 13.0, 0.2]),
                ("UpperArm_#", [5.3, 0.0, 0.0]),
                ("LowerArm_#", [24.3, 0.0, 0.0]),
                ("Hand_#", [22.3, 0.0, 0.0]),
                ("Hand_#_end", [5.0, 0.0, 0.0]),
            ],
            landmarks: [
                "UpperLeg_#",
                "LowerLeg_#",
                "Foot_#",
                "UpperArm_#",
                "LowerArm_#",
                "Hand_#",
            ],
            is_flat: true,
            ..PLAIN
        },
        Convention {
            label: "course",
            sides: SMALL,
            above: &[],
            trunk: &[
                ("RootJoint", [0.0, 0.9, 0.0]),
                ("pelvis_lowerback", [0.0, 0.094, 0.0]),
                ("lowerback_torso", [0.0, 0.1, 0.0]),
                ("torso_head", [0.0, 0.282, 0.0]),
                ("torso_head_end", [0.0, 0.193, 0.0]),
            ],
            head: "torso_head",
            chest: "lowerback_torso",
            leg: &[
                ("#Hip", [0.1, -0.051, 0.0]),
                ("#Knee", [0.0, -0.41, 0.0]),
                ("#Ankle", [0.0, -0.39, 0.0]),
                ("#ToeJoint", [0.0, -0.05, 0.13]),
                ("#ToeJoint_end", [0.01, 0.002, 0.06]),
            ],
            arm: &[
                ("#Torso_Clavicle", [0.001, 0.158, 0.0]),
                ("#Shoulder", [0.118, 0.0, 0.0]),
                ("#Elbow", [0.245, 0.0, 0.0]),
                ("#Wrist", [0.24, 0.0, 0.0]),
                ("#Wrist_end", [0.116, -0.003, 0.0]),
            ],
            landmarks: ["#Hip", "#Knee", "#Ankle", "#Shoulder", "#Elbow", "#Wrist"],
            ..PLAIN
        },
        Convention {
            label: "LAFAN1",
            sides: WORDS,
            above: &[],
            trunk: &[
                ("Hips", [0.0, 92.0, 0.0]),
                ("Spine", [0.0, 6.9, -2.6]),
                ("Spine1", [0.0, 12.6, 0.0]),
                ("Spine2", [0.0, 12.6, 0.0]),
                ("Neck", [0.0, 25.7, 0.5]),
                ("Head", [0.0, 11.6, 2.0]),
                ("Head_end", [0.0, 16.4, 0.0]),
            ],
            head: "Head",
            chest: "Spine2",
            leg: &[
                ("%UpLeg", [10.4, 0.1, 1.9]),
                ("%Leg", [0.0, -43.5, 0.0]),
                ("%Foot", [0.0, -42.4, 0.0]),
                ("%Toe", [0.0, -6.0, 16.3]),
                ("%Toe_end", [0.0, 0.0, 5.8]),
            ],
            arm: &[
                ("%Shoulder", [6.1, 11.3, 1.7]),
                ("%Arm", [11.5, 0.0, 0.0]),
                ("%ForeArm", [30.0, 0.0, 0.0]),
                ("%Hand", [24.5, 0.0, 0.0]),
                ("%Hand_end", [16.5, 0.0, 0.0]),
            ],
            landmarks: ["%UpLeg", "%Leg", "%Foot", "%Arm", "%ForeArm", "%Hand"],
            is_flat: true,
            ..PLAIN
        },
    ]
}
