//! Inverse kinematics: every solver through one suite, and what each does alone.

mod anywhere;
mod conformance;
mod figures;
mod iterations;
mod limits;
mod long_runs;
mod single;
mod suite;
