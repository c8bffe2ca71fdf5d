//! The comparison on a clip: what is compared at the left, figures in the middle, errors at the right.

pub(super) mod choices;
pub(super) mod errors;
pub(super) mod plot;
pub(super) mod view;
