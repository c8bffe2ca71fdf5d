//! Authored motion.

pub mod channel;
