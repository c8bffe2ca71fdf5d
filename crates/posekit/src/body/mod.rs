//! What a skeleton is as a body: which joint is the knee, which side it is on, and how sure that is.
//!
//! Everybody who asks such a thing asks here: the renderer that hangs a body on the joints, inverse
//! kinematics for its limbs, the checks for feet, `posekit info`.
//!
//! Landmarks are found from three kinds of evidence together. *Names*, in the vocabularies of many
//! programs; a word may mean two things (`Hip`, `Leg`, `Shoulder`), so names are weighed, not looked up.
//! *Lengths*, which no pose changes: limbs come in pairs that are as long bone by bone, the two long bones
//! of a limb are about as long as each other, and hands, feet, collar bones are shorter. *Angles* of the
//! pose given: what skips a joint bends aside there; an animal's limbs stand across its trunk. Names that
//! say nothing are no hindrance, and neither is a rest pose that is no posture.
//!
//! Y is up where a pose has to say what is below; left is +X where nothing else tells sides apart.
//! Lengths are in the file's unit. Any skeleton is answered without panic, in n log n of its joints.

mod anatomy;
mod feet;
mod find;
mod limb;
mod name;
mod shape;
mod side;
mod tree;
mod twins;

pub use anatomy::{Anatomy, BodyAxes, Certainty, Limb, NoAnatomy};
pub use feet::{Foot, feet};
pub use side::{Side, side_of_joint, side_of_name, sides};
