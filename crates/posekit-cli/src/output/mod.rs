//! Where results go: which file each input's result is written to, that this is nobody's else, and how it gets
//! there whole.

mod guard;
mod plan;
mod whole;

pub(crate) use guard::{Guard, Target};
pub(crate) use plan::{Destination, Plan};
pub(crate) use whole::{interrupt_is_no_failure, remove_unfinished_on_interrupt, write_whole};
