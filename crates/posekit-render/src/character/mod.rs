//! From a skeleton to something to look at: a body, bones, axes.

mod body;
mod bones;
mod fitter;
mod hinges;
mod limbs;
mod links;
mod proportions;
mod reference;
mod trunk;

pub use body::body_mesh;
pub use bones::{MOST_BODY_JOINTS, axes_mesh, bone_mesh, octahedron_mesh};
pub use proportions::Proportions;
