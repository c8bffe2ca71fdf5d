//! Forward kinematics: of a pose, of a motion, from channel rows, and between frames.

mod channel_rows;
mod motions;
mod poses;
mod sampling;
