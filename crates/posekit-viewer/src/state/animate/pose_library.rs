//! The pose library: poses under names, kept from project to project.
//!
//! A saved pose is about joints by their names, and fits every skeleton that has such joints. Of where a
//! figure stands only the height of its root is applied, scaled to the skeleton's own: a pose taken in one
//! place is put on where the figure is.

use std::collections::BTreeSet;

use posekit::keyframe::edit::{mirror_axis, mirror_pose};
use posekit::pose::LocalPose;
use posekit::skeleton::{JointId, Skeleton};
use posekit_formats::poses::{self, SavedJoint, SavedPose};
use posekit_formats::scene::SceneReadError;

/// A pose of the library: it stays the same however the list changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PoseId(u64);

/// A pose in the library.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Which one it is.
    pub id: PoseId,
    /// The pose.
    pub pose: SavedPose,
}

/// Saved poses in the order in which they were saved.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseLibrary {
    entries: Vec<Entry>,
    next_id: u64,
}

/// Whether left and right change places when a pose is applied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// They stay.
    #[default]
    AsSaved,
    /// They change.
    Mirrored,
}

/// A saved pose on a certain skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct Applied {
    /// The whole pose: that of before, with what was saved in its place.
    pub pose: LocalPose,
    /// The joints that the saved pose says something about.
    pub joints: Vec<JointId>,
}

impl PoseLibrary {
    /// The library of a file.
    ///
    /// # Errors
    /// [`SceneReadError`] with everything that is wrong with it.
    pub fn read(bytes: &[u8]) -> Result<Self, SceneReadError> {
        let mut library = Self::default();
        library.merge(poses::read(bytes)?);
        Ok(library)
    }

    /// The bytes of its file.
    #[must_use]
    pub fn write(&self) -> Vec<u8> {
        let poses: Vec<SavedPose> = self.entries.iter().map(|e| e.pose.clone()).collect();
        poses::write(&poses)
    }

    /// The poses, in the order in which they were saved.
    #[must_use]
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// A pose.
    #[must_use]
    pub fn get(&self, id: PoseId) -> Option<&SavedPose> {
        let entry = self.entries.iter().find(|entry| entry.id == id)?;
        Some(&entry.pose)
    }

    /// Adds a pose. If its name is taken it gets a number.
    pub fn add(&mut self, mut pose: SavedPose) -> PoseId {
        pose.name = self.free_name(&pose.name, None);
        let id = PoseId(self.next_id);
        self.next_id += 1;
        self.entries.push(Entry { id, pose });
        id
    }

    /// Adds poses that are not there yet, name, joints and all. How many those were.
    pub fn merge(&mut self, poses: Vec<SavedPose>) -> usize {
        let before = self.entries.len();
        for pose in poses {
            if self.entries.iter().all(|entry| entry.pose != pose) {
                self.add(pose);
            }
        }
        self.entries.len() - before
    }

    /// Renames a pose. If the name is taken it gets a number; an empty name changes nothing.
    pub fn rename(&mut self, id: PoseId, name: &str) {
        let name = name.trim();
        if name.is_empty() {
            return;
        }
        let name = self.free_name(name, Some(id));
        if let Some(entry) = self.entries.iter_mut().find(|entry| entry.id == id) {
            entry.pose.name = name;
        }
    }

    /// Takes a pose out: what it was.
    pub fn remove(&mut self, id: PoseId) -> Option<SavedPose> {
        let index = self.entries.iter().position(|entry| entry.id == id)?;
        Some(self.entries.remove(index).pose)
    }

    /// A name that no other pose has.
    fn free_name(&self, wanted: &str, own: Option<PoseId>) -> String {
        let taken: BTreeSet<&str> = self
            .entries
            .iter()
            .filter(|entry| Some(entry.id) != own)
            .map(|entry| entry.pose.name.as_str())
            .collect();
        if !taken.contains(wanted) {
            return wanted.to_owned();
        }
        let numbered = (2..).map(|number: u32| format!("{wanted} {number}"));
        let mut free = numbered.filter(|name| !taken.contains(name.as_str()));
        free.next().unwrap_or_else(|| wanted.to_owned())
    }
}

/// A pose as it is saved: of `joints`, or of all that can turn where there is none. Roots, and joints
/// that stand elsewhere than at rest, bring their place.
#[must_use]
pub fn saved(
    name: &str,
    skeleton: &Skeleton,
    pose: &LocalPose,
    joints: &[JointId],
) -> Option<SavedPose> {
    let is_meant = |joint: &JointId| joints.is_empty() || joints.contains(joint);
    let turns = |joint: &JointId| !skeleton.is_end_site(*joint);
    let joint = |joint: JointId| {
        let place = pose.translations[joint.index()];
        let moves = skeleton.parent(joint).is_none() || place != skeleton.rest_translation(joint);
        SavedJoint {
            name: skeleton.unique_name(joint).to_owned(),
            rotation: pose.rotations[joint.index()].as_dquat().normalize(),
            translation: moves.then(|| place.as_dvec3()),
        }
    };
    let chosen = skeleton.joints().filter(turns).filter(is_meant);
    let joints: Vec<SavedJoint> = chosen.map(joint).collect();
    let is_finite = joints.iter().all(|joint| joint.rotation.is_finite());
    let height = f64::from(skeleton.height());
    (!joints.is_empty() && is_finite).then(|| SavedPose {
        name: name.to_owned(),
        height: if height > 0.0 { height } else { 1.0 },
        joints,
    })
}

/// A saved pose put onto another one. `None` when the skeleton has none of its joints.
#[must_use]
pub fn applied(
    skeleton: &Skeleton,
    base: &LocalPose,
    saved: &SavedPose,
    sides: Sides,
) -> Option<Applied> {
    let matched = |joint: &SavedJoint| {
        let found = skeleton.find(&joint.name);
        found.filter(|found| !skeleton.is_end_site(*found))
    };
    let mut pose = base.clone();
    let mut joints = Vec::new();
    let height = f64::from(skeleton.height());
    let scale = if height > 0.0 {
        height / saved.height
    } else {
        1.0
    };
    for joint in &saved.joints {
        let Some(id) = matched(joint) else {
            continue;
        };
        joints.push(id);
        pose.rotations[id.index()] = joint.rotation.as_quat().normalize();
        if let Some(place) = joint.translation {
            let place = (place * scale).as_vec3();
            if skeleton.parent(id).is_none() {
                pose.translations[id.index()].y = place.y;
            } else {
                pose.translations[id.index()] = place;
            }
        }
    }
    if joints.is_empty() {
        return None;
    }
    if sides == Sides::Mirrored {
        return Some(mirrored(skeleton, base, &Applied { pose, joints }));
    }
    Some(Applied { pose, joints })
}

/// The same with left and right exchanged: of the joints on the other side, on `base`.
fn mirrored(skeleton: &Skeleton, base: &LocalPose, applied: &Applied) -> Applied {
    let image = mirror_pose(skeleton, mirror_axis(skeleton), &applied.pose);
    let pairs = skeleton.symmetric_pairs();
    let other = |joint: JointId| {
        let pair = pairs
            .iter()
            .find(|pair| pair.left == joint || pair.right == joint);
        match pair {
            Some(pair) if pair.left == joint => pair.right,
            Some(pair) => pair.left,
            None => joint,
        }
    };
    let joints: Vec<JointId> = applied.joints.iter().map(|&joint| other(joint)).collect();
    let mut pose = base.clone();
    for &joint in &joints {
        let index = joint.index();
        pose.rotations[index] = image.rotations[index];
        if skeleton.parent(joint).is_none() {
            pose.translations[index].y = image.translations[index].y;
        } else {
            pose.translations[index] = image.translations[index];
        }
    }
    Applied { pose, joints }
}

#[cfg(test)]
mod tests {
    use glam::Quat;
    use posekit::sample::by_name;

    use super::*;

    fn walking() -> (std::sync::Arc<Skeleton>, LocalPose, LocalPose) {
        let motion = by_name("walk").expect("a sample");
        let skeleton = std::sync::Arc::clone(motion.skeleton());
        (skeleton, motion.pose(3), motion.pose(20))
    }

    #[test]
    fn a_saved_pose_goes_through_its_file_onto_the_figure() {
        let (skeleton, pose, other) = walking();
        let mut library = PoseLibrary::default();
        let id = library.add(saved("Contact", &skeleton, &pose, &[]).expect("it can be saved"));
        let library = PoseLibrary::read(&library.write()).expect("its own file");
        let saved = library.get(id).expect("it is there");
        let applied = applied(&skeleton, &other, saved, Sides::AsSaved).expect("it fits");
        for joint in skeleton.joints().filter(|&j| !skeleton.is_end_site(j)) {
            let [a, b] = [&applied.pose, &pose].map(|p| p.rotations[joint.index()]);
            assert!(a.angle_between(b) < 1e-3, "{joint:?}");
        }
        // The height is the saved one's, the place where the figure was.
        let place = applied.pose.translations[0];
        assert!((place.y - pose.translations[0].y).abs() < 1e-5);
        assert!(place.x == other.translations[0].x && place.z == other.translations[0].z);
    }

    #[test]
    fn of_selected_joints_nothing_else_is_touched() {
        let (skeleton, pose, other) = walking();
        let joint = skeleton.joints().nth(2).expect("there are more");
        let saved = saved("Knee", &skeleton, &pose, &[joint]).expect("it can be saved");
        let applied = applied(&skeleton, &other, &saved, Sides::AsSaved).expect("it fits");
        assert_eq!(applied.joints, [joint]);
        for index in 0..skeleton.joint_count() {
            let is_it = index == joint.index();
            assert_eq!(
                applied.pose.rotations[index] == other.rotations[index],
                !is_it
            );
        }
    }

    #[test]
    fn mirrored_twice_is_what_was_saved() {
        let (skeleton, pose, _) = walking();
        let once_saved = saved("A", &skeleton, &pose, &[]).expect("it can be saved");
        let once = applied(&skeleton, &pose, &once_saved, Sides::Mirrored).expect("it fits");
        let again = saved("B", &skeleton, &once.pose, &[]).expect("it can be saved");
        let twice = applied(&skeleton, &pose, &again, Sides::Mirrored).expect("it fits");
        for joint in skeleton.joints() {
            let [a, b] = [&twice.pose, &pose].map(|p| p.rotations[joint.index()]);
            assert!(a.angle_between(b) < 2e-3, "{joint:?}");
        }
        // One leg's turn is found on the other one.
        let pair = skeleton.symmetric_pairs()[0];
        let angle = |pose: &LocalPose, joint: JointId| {
            pose.rotations[joint.index()].angle_between(Quat::IDENTITY)
        };
        assert!((angle(&once.pose, pair.left) - angle(&pose, pair.right)).abs() < 1e-3);
    }

    #[test]
    fn names_stay_apart_and_a_file_is_merged_once() {
        let (skeleton, pose, _) = walking();
        let mut library = PoseLibrary::default();
        let one = saved("Pose", &skeleton, &pose, &[]).expect("it can be saved");
        let first = library.add(one.clone());
        let second = library.add(one);
        library.rename(first, "Pose 2");
        library.rename(second, "  ");
        let names = library.entries().iter().map(|e| e.pose.name.as_str());
        assert_eq!(names.collect::<Vec<_>>(), ["Pose 2 2", "Pose 2"]);
        let again = poses::read(&library.write()).expect("its own file");
        assert_eq!(library.merge(again), 0);
        assert!(library.remove(first).is_some() && library.remove(first).is_none());
    }

    #[test]
    fn another_skeleton_without_such_joints_takes_nothing() {
        let (skeleton, pose, _) = walking();
        let arm = by_name("arm").expect("a sample");
        let saved = saved("Walk", &skeleton, &pose, &[]).expect("it can be saved");
        let rest = LocalPose::rest(arm.skeleton());
        assert_eq!(applied(arm.skeleton(), &rest, &saved, Sides::AsSaved), None);
    }
}
