//! Skeletons that motion capture suits write.

use super::{Convention, PLAIN, WORDS};

pub(super) fn suits() -> Vec<Convention> {
    vec![
        Convention {
            label: "Rokoko",
            sides: WORDS,
            above: &[("Root", [0.0, 0.0, 0.0])],
            trunk: &[
                ("Hips", [0.0, 97.0, 0.0]),
                ("Spine1", [0.0, 7.5, 0.0]),
                ("Spine2", [0.0, 9.5, 0.0]),
                ("Spine3", [0.0, 9.5, 0.0]),
                ("Spine4", [0.0, 10.0, 0.0]),
                ("Neck", [0.0, 16.0, -1.0]),
                ("Head", [0.0, 11.0, 2.0]),
                ("HeadEnd", [0.0, 19.0, 0.0]),
            ],
            head: "Head",
            chest: "Spine4",
            leg: &[
                ("%Thigh", [9.5, -2.0, 0.0]),
                ("%Shin", [0.0, -44.0, 0.0]),
                ("%Foot", [0.0, -43.0, -1.0]),
                ("%Toe", [0.0, -8.0, 15.0]),
                ("%ToeEnd", [0.0, 0.0, 6.0]),
            ],
            arm: &[
                ("%Shoulder", [3.5, 11.0, 0.0]),
                ("%Arm", [14.0, 0.0, 0.0]),
                ("%ForeArm", [28.0, 0.0, 0.0]),
                ("%Hand", [26.0, 0.0, 0.0]),
            ],
            landmarks: ["%Thigh", "%Shin", "%Foot", "%Arm", "%ForeArm", "%Hand"],
            fingers: (5, 4, "%Digit"),
            is_flat: true,
            ..PLAIN
        },
        Convention {
            label: "Xsens",
            sides: WORDS,
            above: &[],
            trunk: &[
                ("Hips", [0.0, 92.0, 0.0]),
                ("Chest", [0.0, 9.6, 0.0]),
                ("Chest2", [0.0, 10.4, 0.0]),
                ("Chest3", [0.0, 9.4, 0.0]),
                ("Chest4", [0.0, 9.4, 0.0]),
                ("Neck", [0.0, 12.1, 0.0]),
                ("Head", [0.0, 9.3, 0.0]),
                ("Head_end", [0.0, 17.9, 0.0]),
            ],
            head: "Head",
            chest: "Chest4",
            leg: &[
                ("%Hip", [8.2, 0.0, 0.0]),
                ("%Knee", [0.0, -42.5, 0.0]),
                ("%Ankle", [0.0, -41.4, 0.0]),
                ("%Toe", [0.0, -8.1, 14.0]),
                ("%Toe_end", [0.0, 0.0, 6.0]),
            ],
            arm: &[
                ("%Collar", [3.1, 7.9, 0.0]),
                ("%Shoulder", [14.4, 0.0, 0.0]),
                ("%Elbow", [30.8, 0.0, 0.0]),
                ("%Wrist", [25.2, 0.0, 0.0]),
                ("%Wrist_end", [18.8, 0.0, 0.0]),
            ],
            landmarks: ["%Hip", "%Knee", "%Ankle", "%Shoulder", "%Elbow", "%Wrist"],
            ..PLAIN
        },
        Convention {
            label: "Perception Neuron",
            sides: WORDS,
            above: &[],
            trunk: &[
                ("Hips", [0.0, 98.0, 0.0]),
                ("Spine", [0.0, 10.7, 0.0]),
                ("Spine1", [0.0, 18.0, 0.0]),
                ("Spine2", [0.0, 11.9, 0.0]),
                ("Neck", [0.0, 17.0, 0.0]),
                ("Head", [0.0, 8.2, 1.5]),
                ("Head_end", [0.0, 17.9, 0.0]),
            ],
            head: "Head",
            chest: "Spine2",
            leg: &[
                ("%UpLeg", [11.5, 0.0, 0.0]),
                ("%Leg", [0.0, -48.0, 0.0]),
                ("%Foot", [0.0, -48.0, 0.0]),
                ("%Foot_end", [0.0, -7.8, 18.0]),
            ],
            arm: &[
                ("%Shoulder", [3.9, 16.0, -0.1]),
                ("%Arm", [17.7, 0.0, 0.0]),
                ("%ForeArm", [27.8, 0.0, 0.0]),
                ("%Hand", [27.0, 0.0, 0.0]),
            ],
            landmarks: ["%UpLeg", "%Leg", "%Foot", "%Arm", "%ForeArm", "%Hand"],
            fingers: (5, 3, "%Hand"),
            ..PLAIN
        },
    ]
}
