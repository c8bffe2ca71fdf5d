//! Figures of other proportions than an adult's.

use super::{Convention, PLAIN, WORDS};

pub(super) fn proportions() -> Vec<Convention> {
    vec![
        Convention {
            label: "child",
            sides: WORDS,
            above: &[],
            trunk: &[
                ("DEF-spine", [0.0, 0.48, 0.0]),
                ("DEF-spine.001", [0.0, 0.08, 0.0]),
                ("DEF-spine.002", [0.0, 0.07, 0.0]),
                ("DEF-spine.003", [0.0, 0.07, 0.0]),
                ("DEF-neck", [0.0, 0.09, -0.01]),
                ("DEF-head", [0.0, 0.045, 0.01]),
                ("DEF-head_end", [0.0, 0.19, 0.0]),
            ],
            head: "DEF-head",
            chest: "DEF-spine.003",
            leg: &[
                ("DEF-thigh.#", [0.055, -0.02, 0.0]),
                ("DEF-thigh.#.001", [0.0, -0.1, 0.0]),
                ("DEF-shin.#", [0.0, -0.1, 0.0]),
                ("DEF-shin.#.001", [0.0, -0.1, 0.0]),
                ("DEF-foot.#", [0.0, -0.1, 0.0]),
                ("DEF-toe.#", [0.0, -0.04, 0.08]),
                ("DEF-toe.#_end", [0.0, 0.0, 0.04]),
            ],
            arm: &[
                ("DEF-shoulder.#", [0.015, 0.07, 0.0]),
                ("DEF-upper_arm.#", [0.075, -0.01, 0.0]),
                ("DEF-upper_arm.#.001", [0.08, 0.0, 0.0]),
                ("DEF-forearm.#", [0.08, 0.0, 0.0]),
                ("DEF-forearm.#.001", [0.065, 0.0, 0.0]),
                ("DEF-hand.#", [0.065, 0.0, 0.0]),
                ("DEF-hand.#_end", [0.09, 0.0, 0.0]),
            ],
            landmarks: [
                "DEF-thigh.#",
                "DEF-shin.#",
                "DEF-foot.#",
                "DEF-upper_arm.#",
                "DEF-forearm.#",
                "DEF-hand.#",
            ],
            ..PLAIN
        },
        Convention {
            label: "ape",
            sides: WORDS,
            above: &[],
            trunk: &[
                ("Hips", [0.0, 86.0, 0.0]),
                ("Spine", [0.0, 19.0, 0.0]),
                ("Chest", [0.0, 27.0, 0.0]),
                ("Neck", [0.0, 24.0, 13.0]),
                ("Neck_end", [0.0, 13.0, 8.0]),
            ],
            head: "Neck",
            chest: "Chest",
            leg: &[
                ("%UpLeg", [14.0, 0.0, 0.0]),
                ("%Leg", [1.0, -38.0, 4.0]),
                ("%Foot", [1.0, -31.0, -5.0]),
                ("%Foot_end", [0.0, -16.0, 21.0]),
            ],
            arm: &[
                ("%Shoulder", [6.0, 53.0, -9.0]),
                ("%Arm", [39.0, 0.0, 0.0]),
                ("%ForeArm", [54.0, 0.0, 0.0]),
                ("%Hand", [50.0, 0.0, 0.0]),
                ("%Hand_end", [21.0, 0.0, 0.0]),
            ],
            landmarks: ["%UpLeg", "%Leg", "%Foot", "%Arm", "%ForeArm", "%Hand"],
            ..PLAIN
        },
    ]
}
