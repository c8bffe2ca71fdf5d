//! The integration tests of posekit-formats, in one binary.
#![allow(
    clippy::unwrap_used,
    reason = "a test that fails panics where it fails"
)]
#![allow(clippy::print_stderr, reason = "a test that is skipped says so")]

mod bvh_fix;
mod bvh_parsers_agree;
mod bvh_real_files;
mod bvh_refusals;
mod bvh_text;
mod bvh_wild_hierarchy;
mod bvh_wild_motion;
mod cases;
mod check_clip;
mod check_corruptions;
mod check_damage;
mod check_recall;
mod gltf_poses;
mod gltf_wild;
mod guide_pages;
mod ik_course;
mod ik_course_jacobian;
mod in_pieces;
mod poses;
mod robot_arms;
mod robot_ways;
mod scene;
mod urdf_damage;
mod urdf_kinematics;
mod urdf_reading;
mod urdf_refusals;
mod walker;
