//! Skeletons of figure posing programs and of other motion capture systems.

use super::{Convention, PLAIN, SMALL};

const LETTERS: [[&str; 2]; 2] = [["L", "R"], ["l", "r"]];

pub(super) fn posers() -> Vec<Convention> {
    vec![
        Convention {
            label: "Poser",
            sides: LETTERS,
            trunk: &[
                ("hip", [0.0, 92.0, 0.0]),
                ("abdomen", [0.0, 12.7, -0.7]),
                ("chest", [0.0, 14.7, -0.5]),
                ("neck", [0.0, 22.2, -2.2]),
                ("head", [0.0, 8.0, 1.0]),
                ("head_end", [0.0, 18.0, 0.0]),
            ],
            head: "head",
            chest: "chest",
            leg: &[
                ("#buttock", [8.8, 4.4, 1.2]),
                ("#thigh", [0.0, -8.7, -2.2]),
                ("#shin", [0.0, -39.8, 0.7]),
                ("#foot", [-0.7, -41.1, -5.1]),
                ("#foot_end", [1.1, -3.7, 12.1]),
            ],
            arm: &[
                ("#collar", [2.7, 19.3, -4.9]),
                ("#shldr", [8.8, -2.0, 1.5]),
                ("#forearm", [28.2, -1.7, 0.5]),
                ("#hand", [22.6, 0.8, 7.1]),
                ("#hand_end", [11.2, 1.2, 3.4]),
            ],
            landmarks: ["#thigh", "#shin", "#foot", "#shldr", "#forearm", "#hand"],
            ..PLAIN
        },
        // Daz: bones cut in two for their twist.
        Convention {
            label: "Genesis",
            sides: LETTERS,
            above: &[("hip", [0.0, 103.0, 1.0])],
            trunk: &[
                ("pelvis", [0.0, 1.8, -0.6]),
                ("abdomenLower", [0.0, 1.7, 0.0]),
                ("abdomenUpper", [0.0, 8.3, 0.3]),
                ("chestLower", [0.0, 8.0, -1.3]),
                ("chestUpper", [0.0, 13.3, -2.7]),
                ("neckLower", [0.0, 17.8, -1.5]),
                ("neckUpper", [0.0, 3.5, 1.0]),
                ("head", [0.0, 5.0, 1.2]),
            ],
            head: "head",
            chest: "chestUpper",
            leg: &[
                ("#ThighBend", [7.9, -10.3, -0.8]),
                ("#ThighTwist", [0.7, -21.0, 0.2]),
                ("#Shin", [0.7, -25.5, 0.2]),
                ("#Foot", [0.5, -42.0, -3.5]),
                ("#Metatarsals", [0.4, -4.2, 3.5]),
                ("#Toe", [0.9, -2.8, 8.5]),
                ("#BigToe", [-1.2, -0.5, 2.0]),
            ],
            arm: &[
                ("#Collar", [3.2, 11.0, -1.0]),
                ("#ShldrBend", [11.9, -1.5, -1.8]),
                ("#ShldrTwist", [11.3, 0.0, 0.0]),
                ("#ForearmBend", [14.4, 0.0, 0.0]),
                ("#ForearmTwist", [12.1, 0.0, 0.0]),
                ("#Hand", [13.1, 0.0, 0.0]),
                ("#Mid1", [8.8, 0.0, 0.0]),
                ("#Mid2", [4.5, 0.0, 0.0]),
            ],
            landmarks: [
                "#ThighBend",
                "#Shin",
                "#Foot",
                "#ShldrBend",
                "#ForearmBend",
                "#Hand",
            ],
            beside_limbs: &[
                ("chestUpper", ("#Pectoral", [7.0, -1.0, 9.0])),
                ("head", ("#Eye", [3.2, 6.5, 6.5])),
                ("head", ("#Ear", [7.0, 5.0, -1.0])),
            ],
            ..PLAIN
        },
        Convention {
            label: "OptiTrack",
            trunk: &[
                ("Hip", [0.0, 0.93, 0.0]),
                ("Ab", [0.0, 0.082, 0.0]),
                ("Chest", [0.0, 0.19, 0.0]),
                ("Neck", [0.0, 0.25, 0.01]),
                ("Head", [0.0, 0.13, 0.02]),
                ("Head_end", [0.0, 0.14, 0.0]),
            ],
            head: "Head",
            chest: "Chest",
            leg: &[
                ("#Thigh", [0.085, 0.0, 0.0]),
                ("#Shin", [0.0, -0.42, 0.0]),
                ("#Foot", [0.0, -0.41, 0.0]),
                ("#Toe", [0.0, -0.055, 0.13]),
                ("#Toe_end", [0.0, -0.03, 0.06]),
            ],
            arm: &[
                ("#Shoulder", [0.04, 0.19, 0.0]),
                ("#UArm", [0.13, 0.0, 0.0]),
                ("#FArm", [0.29, 0.0, 0.0]),
                ("#Hand", [0.24, 0.0, 0.0]),
                ("#Hand_end", [0.18, 0.0, 0.0]),
            ],
            landmarks: ["#Thigh", "#Shin", "#Foot", "#UArm", "#FArm", "#Hand"],
            ..PLAIN
        },
        Convention {
            label: "Kinect",
            trunk: &[
                ("SpineBase", [0.0, 0.93, 0.0]),
                ("SpineMid", [0.0, 0.3, 0.0]),
                ("SpineShoulder", [0.0, 0.22, -0.02]),
                ("Neck", [0.0, 0.07, 0.0]),
                ("Head", [0.0, 0.15, 0.03]),
            ],
            head: "Head",
            chest: "SpineShoulder",
            leg: &[
                ("Hip%", [0.08, -0.03, 0.0]),
                ("Knee%", [0.03, -0.4, 0.0]),
                ("Ankle%", [0.01, -0.41, 0.0]),
                ("Foot%", [0.02, -0.06, 0.12]),
            ],
            arm: &[
                ("Shoulder%", [0.17, -0.05, 0.0]),
                ("Elbow%", [0.27, 0.0, 0.0]),
                ("Wrist%", [0.24, 0.0, 0.0]),
                ("Hand%", [0.08, 0.0, 0.0]),
                ("HandTip%", [0.08, 0.0, 0.0]),
            ],
            landmarks: ["Hip%", "Knee%", "Ankle%", "Shoulder%", "Elbow%", "Wrist%"],
            ..PLAIN
        },
        Convention {
            label: "Acclaim",
            sides: LETTERS,
            trunk: &[
                ("root", [0.0, 17.0, 0.0]),
                ("lowerback", [0.0, 0.2, 0.0]),
                ("upperback", [0.0, 2.0, -0.2]),
                ("thorax", [0.0, 2.0, 0.0]),
                ("lowerneck", [0.0, 2.1, 0.1]),
                ("upperneck", [0.0, 1.6, 0.2]),
                ("head", [0.0, 1.6, 0.0]),
                ("head_end", [0.0, 1.7, 0.0]),
            ],
            head: "head",
            chest: "thorax",
            leg: &[
                ("#hipjoint", [0.0, 0.0, 0.0]),
                ("#femur", [1.4, -1.8, 0.8]),
                ("#tibia", [2.4, -6.7, 0.0]),
                ("#foot", [2.5, -7.0, 0.0]),
                ("#toes", [0.2, -0.4, 2.3]),
                ("#toes_end", [0.0, 0.0, 1.2]),
            ],
            arm: &[
                ("#clavicle", [0.0, 2.1, 0.0]),
                ("#humerus", [3.4, 0.6, -0.3]),
                ("#radius", [5.0, 0.0, 0.0]),
                ("#wrist", [3.4, 0.0, 0.0]),
                ("#hand", [0.0, 0.0, 0.0]),
                ("#fingers", [0.7, 0.0, 0.0]),
                ("#fingers_end", [0.6, 0.0, 0.0]),
            ],
            landmarks: ["#femur", "#tibia", "#foot", "#humerus", "#radius", "#wrist"],
            ..PLAIN
        },
        // Vertebrae are named by letter and number: `L5` is no joint of the left side.
        Convention {
            label: "MVN",
            trunk: &[
                ("Pelvis", [0.0, 0.93, 0.0]),
                ("L5", [0.0, 0.1, 0.0]),
                ("L3", [0.0, 0.1, 0.0]),
                ("T12", [0.0, 0.095, 0.0]),
                ("T8", [0.0, 0.095, 0.0]),
                ("Neck", [0.0, 0.13, 0.0]),
                ("Head", [0.0, 0.09, 0.0]),
                ("Head_end", [0.0, 0.18, 0.0]),
            ],
            head: "Head",
            chest: "T8",
            leg: &[
                ("%UpperLeg", [0.08, 0.0, 0.0]),
                ("%LowerLeg", [0.0, -0.43, 0.0]),
                ("%Foot", [0.0, -0.41, 0.0]),
                ("%Toe", [0.0, -0.08, 0.14]),
                ("%Toe_end", [0.0, 0.0, 0.06]),
            ],
            arm: &[
                ("%Shoulder", [0.03, 0.08, 0.0]),
                ("%UpperArm", [0.14, 0.0, 0.0]),
                ("%ForeArm", [0.3, 0.0, 0.0]),
                ("%Hand", [0.25, 0.0, 0.0]),
                ("%Hand_end", [0.18, 0.0, 0.0]),
            ],
            landmarks: [
                "%UpperLeg",
                "%LowerLeg",
                "%Foot",
                "%UpperArm",
                "%ForeArm",
                "%Hand",
            ],
            ..PLAIN
        },
        // MakeHuman with its face: the jaw's and the lips' chains hang from the head.
        Convention {
            label: "MakeHuman",
            sides: SMALL,
            above: &[],
            trunk: &[
                ("hip", [0.0, 9.2, 0.0]),
                ("abdomen", [0.0, 1.6, 0.2]),
                ("chest", [0.0, 2.2, -0.3]),
                ("neck", [0.0, 2.1, -0.4]),
                ("neck1", [0.0, 0.4, 0.1]),
                ("head", [0.0, 0.4, 0.1]),
                ("__jaw", [0.0, 0.1, 0.3]),
                ("jaw", [0.0, 0.0, 0.0]),
                ("special04", [0.0, 0.0, 0.6]),
                ("oris02", [0.0, 0.0, 0.2]),
                ("oris01", [0.0, 0.1, 0.1]),
            ],
            head: "head",
            chest: "chest",
            leg: &[
                ("#Buttock", [0.5, -0.1, 0.2]),
                ("#Thigh", [0.5, -0.7, 0.0]),
                ("#Shin", [0.2, -4.1, 0.2]),
                ("#Foot", [0.0, -4.0, -0.3]),
                ("toe1-1.#", [0.2, -0.5, 1.2]),
                ("toe1-2.#", [0.0, 0.0, 0.3]),
            ],
            arm: &[
                ("#Collar", [0.2, 1.5, 0.1]),
                ("#Shldr", [1.2, 0.0, -0.3]),
                ("#ForeArm", [2.6, 0.0, 0.0]),
                ("#Hand", [2.3, 0.0, 0.0]),
                ("metacarpal1.#", [0.2, 0.0, 0.1]),
                ("finger2-1.#", [0.8, 0.0, 0.1]),
                ("finger2-2.#", [0.4, 0.0, 0.0]),
            ],
            landmarks: ["#Thigh", "#Shin", "#Foot", "#Shldr", "#ForeArm", "#Hand"],
            beside: &[
                ("head", ("tongue00", [0.0, 0.1, 0.4])),
                ("tongue00", ("tongue01", [0.0, 0.0, 0.2])),
            ],
            beside_limbs: &[
                ("head", ("eye.#", [0.3, 0.7, 0.8])),
                ("head", ("levator02.#", [0.2, 0.4, 0.9])),
            ],
            ..PLAIN
        },
    ]
}
