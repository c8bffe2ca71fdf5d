//! Figures as many programs lay them out: their joints' names, their proportions, their rest poses.
//!
//! Names and lengths are those of published skeletons (CMU `01_01`, Mixamo, Bandai-Namco, LAFAN1, suits of
//! Rokoko, Xsens, Perception Neuron, SMPL's mean shape, the VRM humanoid) to a centimetre or so; the child
//! has the proportions of a four-year-old, the ape long arms on high shoulders. Every figure is described
//! as it stands with its arms out, Y up, facing +Z; `is_flat` then lays each bone along its parent's X at
//! rest, as files do that keep the posture in their motion.

use std::sync::Arc;

use glam::{Quat, Vec3};
use posekit::motion::{FrameTime, Motion};
use posekit::skeleton::{JointId, Skeleton, SkeletonBuilder};

type Joint = (&'static str, [f32; 3]);

/// A way to lay out a figure. In names `%` stands for the side as a word and `#` for its letter.
pub(crate) struct Convention {
    pub(crate) label: &'static str,
    /// The words for left and right, then the letters.
    sides: [[&'static str; 2]; 2],
    /// Joints above the pelvis.
    above: &'static [Joint],
    /// From the pelvis to the crown; a name ending in `_end` is an End Site.
    trunk: &'static [Joint],
    head: &'static str,
    /// The joint of the trunk that the collar bones hang from.
    chest: &'static str,
    leg: &'static [Joint],
    arm: &'static [Joint],
    /// Hip, knee, ankle, shoulder, elbow, wrist.
    landmarks: [&'static str; 6],
    /// Chains of so many joints on the hand.
    fingers: (usize, usize, &'static str),
    is_flat: bool,
}

const WORDS: [[&str; 2]; 2] = [["Left", "Right"], ["L", "R"]];
const SMALL: [[&str; 2]; 2] = [["left", "right"], ["l", "r"]];

pub(crate) fn conventions() -> Vec<Convention> {
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
            fingers: (0, 0, ""),
            is_flat: false,
        },
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
            is_flat: false,
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
            fingers: (0, 0, ""),
            is_flat: true,
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
            fingers: (0, 0, ""),
            is_flat: false,
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
            fingers: (0, 0, ""),
            is_flat: true,
        },
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
            fingers: (0, 0, ""),
            is_flat: false,
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
            is_flat: false,
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
            fingers: (0, 0, ""),
            is_flat: false,
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
            is_flat: false,
        },
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
            fingers: (0, 0, ""),
            is_flat: false,
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
            fingers: (0, 0, ""),
            is_flat: false,
        },
    ]
}

/// A joint of a figure that stands.
struct Built {
    name: String,
    parent: Option<usize>,
    offset: Vec3,
    is_end: bool,
}

impl Convention {
    /// The name of a joint on a side, 0 left and 1 right.
    pub(crate) fn name(&self, pattern: &str, side: usize) -> String {
        pattern
            .replace('%', self.sides[0][side])
            .replace('#', self.sides[1][side])
    }

    /// Names of hip, knee, ankle, shoulder, elbow, wrist on a side.
    pub(crate) fn landmarks(&self, side: usize) -> [String; 6] {
        self.landmarks.map(|pattern| self.name(pattern, side))
    }

    /// The names of pelvis, chest and head.
    pub(crate) fn trunk(&self) -> [&'static str; 3] {
        [self.trunk[0].0, self.chest, self.head]
    }

    fn joints(&self) -> Vec<Built> {
        let mut joints: Vec<Built> = Vec::new();
        let mut add = |name: String, parent: Option<usize>, offset: [f32; 3]| {
            let is_end = name.ends_with("_end");
            joints.push(Built {
                name,
                parent,
                offset: Vec3::from(offset),
                is_end,
            });
            joints.len() - 1
        };
        let mut last = None;
        let (mut pelvis, mut chest) = (0, 0);
        for &(name, offset) in self.above.iter().chain(self.trunk) {
            let at = add(name.to_owned(), last, offset);
            last = Some(at);
            if name == self.trunk[0].0 {
                pelvis = at;
            }
            if name == self.chest {
                chest = at;
            }
        }
        for (side, mirror) in [(0, 1.0), (1, -1.0)] {
            let mirrored = |[x, y, z]: [f32; 3]| [x * mirror, y, z];
            for (from, limb) in [(pelvis, self.leg), (chest, self.arm)] {
                let mut last = from;
                for &(pattern, offset) in limb {
                    last = add(self.name(pattern, side), Some(last), mirrored(offset));
                }
                if from == chest {
                    let (count, length, pattern) = self.fingers;
                    let forearm = limb[3].1[0];
                    let kinds = ["Thumb", "Index", "Middle", "Ring", "Pinky"];
                    for (finger, kind) in kinds.iter().enumerate().take(count) {
                        let apart = 0.08 * forearm * (2.0 - finger as f32);
                        let mut parent = last;
                        for bone in 0..length {
                            let long = if bone == 0 { 0.33 } else { 0.12 } * forearm;
                            let offset = [long, 0.0, if bone == 0 { apart } else { 0.0 }];
                            let name = self.name(pattern, side);
                            let name = format!("{name}{kind}{}", bone + 1);
                            parent = add(name, Some(parent), mirrored(offset));
                        }
                    }
                }
            }
        }
        joints
    }

    /// The figure in a motion of eight frames: it stands, then strides with its arms down, knees and
    /// elbows bent, its trunk turned.
    pub(crate) fn motion(&self) -> Motion {
        self.motion_named(|joint| joint.to_owned())
    }

    /// The same with every joint's name replaced.
    pub(crate) fn motion_named(&self, rename: impl Fn(&str) -> String) -> Motion {
        let joints = self.joints();
        let standing = self.orientations(&joints);
        let mut builder = SkeletonBuilder::new();
        for joint in &joints {
            let parent_turn = joint.parent.map_or(Quat::IDENTITY, |p| standing[p]);
            let offset = parent_turn.conjugate() * joint.offset;
            let parent = joint.parent.map(JointId::new);
            match parent {
                Some(parent) if joint.is_end => {
                    builder.end_site(rename(&joint.name), parent, offset)
                }
                parent => builder.joint(rename(&joint.name), parent, offset),
            };
        }
        let skeleton: Arc<Skeleton> = Arc::new(builder.build().unwrap());
        let mut motion = Motion::at_rest(skeleton, 8, FrameTime::of_fps(10), [JointId::new(0)]);
        for frame in 0..8 {
            motion.set_translation(frame, JointId::new(0), joints[0].offset);
            for (index, joint) in joints.iter().enumerate().filter(|(_, j)| !j.is_end) {
                let parent_turn = joint.parent.map_or(Quat::IDENTITY, |p| standing[p]);
                let turn = self.turn(&joint.name, frame);
                let local = parent_turn.conjugate() * turn * standing[index];
                motion.set_rotation(frame, JointId::new(index), local);
            }
        }
        motion
    }

    /// World orientation of every joint in the standing posture: none, or X along the bone.
    fn orientations(&self, joints: &[Built]) -> Vec<Quat> {
        let along = |index: usize| {
            let child = joints.iter().find(|j| j.parent == Some(index));
            let bone = child.map_or(joints[index].offset, |child| child.offset);
            bone.try_normalize()
        };
        let turn = |index: usize| match along(index) {
            Some(bone) if self.is_flat => Quat::from_rotation_arc(Vec3::X, bone),
            _ => Quat::IDENTITY,
        };
        (0..joints.len()).map(turn).collect()
    }

    /// How a joint turns in a frame, in the world's axes of the standing posture.
    fn turn(&self, name: &str, frame: usize) -> Quat {
        let share = frame as f32 / 7.0;
        if name == self.chest {
            return Quat::from_rotation_y(0.3 * share);
        }
        for (side, sign) in [(0, 1.0), (1, -1.0)] {
            let [hip, knee, _, shoulder, elbow, _] = self.landmarks(side);
            let turn = match name {
                _ if name == hip => Quat::from_rotation_x(-0.6 * sign * share),
                _ if name == knee => Quat::from_rotation_x(0.7 * share),
                _ if name == shoulder => {
                    Quat::from_rotation_x(0.5 * sign * share)
                        * Quat::from_rotation_z(-1.2 * sign * share)
                }
                _ if name == elbow => Quat::from_rotation_y(-0.6 * sign * share),
                _ => continue,
            };
            return turn;
        }
        Quat::IDENTITY
    }
}
