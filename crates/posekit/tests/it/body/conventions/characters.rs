//! Skeletons of characters and body models.

use super::{Convention, PLAIN, SMALL, WORDS};

pub(super) fn characters() -> Vec<Convention> {
    vec![
        Convention {
            label: "Mixamo",
            sides: WORDS,
            above: &[],
            trunk: &[
                ("mixamorig:Hips", [0.0, 102.6, -0.5]),
                ("mixamorig:Spine", [0.0, 5.6, 0.0]),
                ("mixamorig:Spine1", [0.0, 6.6, 0.0]),
                ("mixamorig:Spine2", [0.0, 7.5, 0.0]),
                ("mixamorig:Neck", [0.0, 8.5, 0.0]),
                ("mixamorig:Head", [0.0, 6.0, -1.2]),
                ("mixamorig:HeadTop_End", [0.0, 21.7, -4.2]),
                ("HeadTop_End_end", [0.0, 22.2, 0.0]),
            ],
            head: "mixamorig:Head",
            chest: "mixamorig:Spine2",
            leg: &[
                ("mixamorig:%UpLeg", [6.6, -8.8, -0.4]),
                ("mixamorig:%Leg", [2.7, -36.1, 0.7]),
                ("mixamorig:%Foot", [1.1, -46.2, 1.0]),
                ("mixamorig:%ToeBase", [-0.4, -10.4, 12.7]),
                ("mixamorig:%Toe_End", [-0.1, -0.1, 6.7]),
                ("%Toe_End_end", [-0.1, -0.1, 6.7]),
            ],
            arm: &[
                ("mixamorig:%Shoulder", [3.4, 7.3, -0.1]),
                ("mixamorig:%Arm", [6.8, -2.2, 0.0]),
                ("mixamorig:%ForeArm", [24.2, -0.4, 0.3]),
                ("mixamorig:%Hand", [21.6, 0.0, 0.7]),
            ],
            landmarks: [
                "mixamorig:%UpLeg",
                "mixamorig:%Leg",
                "mixamorig:%Foot",
                "mixamorig:%Arm",
                "mixamorig:%ForeArm",
                "mixamorig:%Hand",
            ],
            fingers: (5, 4, "mixamorig:%Hand"),
            ..PLAIN
        },
        Convention {
            label: "SMPL",
            sides: WORDS,
            above: &[],
            trunk: &[
                ("m_avg_Pelvis", [0.0, 0.93, 0.0]),
                ("m_avg_Spine1", [0.004, 0.124, -0.038]),
                ("m_avg_Spine2", [0.004, 0.138, 0.027]),
                ("m_avg_Spine3", [-0.002, 0.056, 0.003]),
                ("m_avg_Neck", [-0.013, 0.212, -0.033]),
                ("m_avg_Head", [0.01, 0.089, 0.05]),
            ],
            head: "m_avg_Head",
            chest: "m_avg_Spine3",
            leg: &[
                ("m_avg_#_Hip", [0.059, -0.082, -0.018]),
                ("m_avg_#_Knee", [0.043, -0.386, 0.008]),
                ("m_avg_#_Ankle", [-0.015, -0.427, -0.037]),
                ("m_avg_#_Foot", [0.041, -0.06, 0.122]),
            ],
            arm: &[
                ("m_avg_#_Collar", [0.072, 0.114, -0.019]),
                ("m_avg_#_Shoulder", [0.123, 0.045, -0.019]),
                ("m_avg_#_Elbow", [0.255, -0.016, -0.023]),
                ("m_avg_#_Wrist", [0.266, 0.013, -0.007]),
                ("m_avg_#_Hand", [0.087, -0.011, -0.016]),
            ],
            landmarks: [
                "m_avg_#_Hip",
                "m_avg_#_Knee",
                "m_avg_#_Ankle",
                "m_avg_#_Shoulder",
                "m_avg_#_Elbow",
                "m_avg_#_Wrist",
            ],
            ..PLAIN
        },
        Convention {
            label: "VRM",
            sides: SMALL,
            above: &[("root", [0.0, 0.0, 0.0])],
            trunk: &[
                ("hips", [0.0, 0.86, 0.0]),
                ("spine", [0.0, 0.06, 0.01]),
                ("chest", [0.0, 0.11, -0.005]),
                ("upperChest", [0.0, 0.11, -0.01]),
                ("neck", [0.0, 0.13, -0.02]),
                ("head", [0.0, 0.08, 0.015]),
            ],
            head: "head",
            chest: "upperChest",
            leg: &[
                ("%UpperLeg", [0.075, -0.04, 0.0]),
                ("%LowerLeg", [0.0, -0.36, 0.0]),
                ("%Foot", [0.0, -0.39, -0.02]),
                ("%Toes", [0.0, -0.06, 0.1]),
            ],
            arm: &[
                ("%Shoulder", [0.02, 0.1, -0.01]),
                ("%UpperArm", [0.08, -0.01, 0.0]),
                ("%LowerArm", [0.21, 0.0, 0.0]),
                ("%Hand", [0.21, 0.0, 0.0]),
            ],
            landmarks: [
                "%UpperLeg",
                "%LowerLeg",
                "%Foot",
                "%UpperArm",
                "%LowerArm",
                "%Hand",
            ],
            fingers: (5, 3, "%"),
            ..PLAIN
        },
    ]
}
