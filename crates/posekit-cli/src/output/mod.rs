//! Where results go: which file each input's result is written to, and how it gets there whole.

mod plan;
mod whole;

pub(crate) use plan::{Destination, Plan};
pub(crate) use whole::{interrupt_is_no_failure, remove_unfinished_on_interrupt, write_whole};
