//! The hierarchy: what can be built, and what is found in it.

mod building;
mod walks;
