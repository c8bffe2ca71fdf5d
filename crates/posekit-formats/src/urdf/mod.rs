//! URDF (Unified Robot Description Format): links and joints of a robot, as XML.
//!
//! [`read()`] turns bytes into a [`Urdf`], the document, in the file's axes (Z up, X forward; ROS REP 103)
//! and units (metres, radians). [`Urdf::to_robot`] makes a skeleton of it and says how each joint moves, so
//! that it goes the same way as every figure: values to a [`LocalPose`](posekit::pose::LocalPose), forward
//! kinematics, solvers. [`UpAxis`] says whether the robot is stood upright in a world with Y up on the way.
//!
//! The format is that of <http://wiki.ros.org/urdf/XML>. Read are links with their visuals, joints of all
//! six kinds with origin, axis, limits and mimic, and materials. What makes sense is read and every liberty
//! is a warning in the report, a `<mimic>` that makes no sense too; what leaves no tree (a cycle, several roots, a link that
//! is not there, a name twice) is one [`ReadError`](crate::report::ReadError) with a line and a column.
//!
//! Limits: [`MAX_DEPTH`], [`MAX_ELEMENTS`], [`MAX_ATTRIBUTES`]. The reader does not recurse, resolves no
//! entities but those of XML itself, opens no other file, and takes memory in proportion to the bytes.
//!
//! ```
//! use posekit_formats::urdf::{self, UpAxis};
//!
//! let text = br#"<robot name="door">
//!   <link name="frame"/> <link name="leaf"/>
//!   <joint name="hinge" type="revolute">
//!     <parent link="frame"/> <child link="leaf"/>
//!     <origin xyz="0.4 0 0"/> <axis xyz="0 0 1"/>
//!     <limit lower="0" upper="1.6" effort="9" velocity="1"/>
//!   </joint>
//! </robot>"#;
//! let door = urdf::read(text)?.document;
//! assert_eq!(door.links[door.root].name, "frame");
//! let robot = door.to_robot(UpAxis::Y)?;
//! let hinge = robot.skeleton().find("hinge").unwrap();
//! assert_eq!(robot.value_count(), 1);
//! let open = robot.local_pose(&[1.5]).to_global(robot.skeleton());
//! // X forward became Z forward.
//! assert!((open.positions[hinge.index()].z - 0.4).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod check;
mod document;
mod read;
mod robot;
pub mod sample;

pub use check::check;
pub use document::{
    Urdf, UrdfJoint, UrdfJointKind, UrdfLimit, UrdfLink, UrdfMimic, UrdfOrigin, UrdfShape,
    UrdfVisual,
};
pub use read::{MAX_ATTRIBUTES, MAX_DEPTH, MAX_ELEMENTS, read};
pub use robot::{RobotError, UpAxis};
