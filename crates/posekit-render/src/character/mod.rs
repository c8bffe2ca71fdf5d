//! From a skeleton to something to look at: a body, bones, axes.

mod anatomy;
mod body;
mod bones;
mod fitter;
mod hinges;
mod limbs;
mod links;
mod proportions;
mod reference;
mod trunk;

pub(crate) use anatomy::side_of_joint;
pub use anatomy::{Anatomy, Limb, Side};
pub use body::body_mesh;
pub use bones::{axes_mesh, bone_mesh, octahedron_mesh};
pub use proportions::Proportions;
