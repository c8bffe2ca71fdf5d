//! The commands, a module each: its arguments and what it does with them.

pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod convert;
pub(crate) mod fix;
pub(crate) mod fk;
pub(crate) mod ik;
pub(crate) mod ik_study;
pub(crate) mod inbetween;
pub(crate) mod info;
pub(crate) mod keys;
pub(crate) mod man;
pub(crate) mod render;
pub(crate) mod sample;
pub(crate) mod serve;
pub(crate) mod slerp;
pub(crate) mod start;
#[cfg(feature = "window")]
pub(crate) mod view;
