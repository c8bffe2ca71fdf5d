//! The program's state, apart from any widget: testable without a window.

pub mod animate;
pub mod arm;
pub mod camera;
#[cfg(not(target_arch = "wasm32"))]
pub mod chooser;
pub mod clip;
pub mod curves;
pub mod display;
pub mod edit;
pub mod ik;
pub mod interpolation;
pub mod library;
pub mod mode;
pub mod names;
pub mod notices;
pub mod pick;
pub mod readout;
pub mod session;
pub mod settings;
pub mod text;
pub mod things;
pub mod transport;
