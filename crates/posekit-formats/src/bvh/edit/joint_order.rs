//! Joints by other names and in another order.

use std::collections::BTreeMap;

use super::EditError;
use crate::bvh::document::implied_end_name;
use crate::bvh::{Bvh, BvhJoint, EndName, MAX_NAME_BYTES};

/// Renames every joint that is called `from`, End Sites with a name of their own among them. The End
/// Site below a joint that has none follows.
///
/// Where no joint is called `from` and it holds a `*`, it is a pattern: each `*` stands for any bytes, as
/// few as will do, and a `*` in `to` for what the one in `from` stood for. Where `to` has fewer, they are the
/// last ones of `from`: `mixamorig:*` to `*`, or `*:*` to `*`, takes a prefix off.
///
/// # Errors
/// When no joint has the name, the format cannot hold the new one, `to` has more `*` than `from`, or two joints of
/// different names would get the same one. The document is as it was then.
pub fn rename(bvh: &mut Bvh, from: &str, to: &str) -> Result<(), EditError> {
    let is_named = |joint: &&mut BvhJoint| joint.end_name != EndName::Implied || !joint.is_end_site;
    let mut joints: Vec<&mut BvhJoint> = bvh.joints.iter_mut().filter(is_named).collect();
    let has_name = joints.iter().any(|joint| joint.name == from.as_bytes());
    let new_names: Vec<Option<Vec<u8>>> = if has_name || !from.contains('*') {
        let new_name =
            |joint: &&mut BvhJoint| (joint.name == from.as_bytes()).then(|| to.as_bytes().to_vec());
        joints.iter().map(new_name).collect()
    } else {
        let pattern = Pattern::new(from, to)?;
        joints
            .iter()
            .map(|joint| pattern.new_name(&joint.name))
            .collect()
    };
    if new_names.iter().all(Option::is_none) {
        return Err(EditError::NoSuchJoint {
            name: from.to_owned(),
        });
    }
    if let Some(bad) = new_names.iter().flatten().find(|name| !can_be_name(name)) {
        return Err(EditError::BadName {
            name: String::from_utf8_lossy(bad).into_owned(),
        });
    }
    refuse_merged(&joints, &new_names)?;
    for (joint, name) in joints.iter_mut().zip(new_names) {
        if let Some(name) = name {
            joint.name = name;
        }
    }
    for index in 0..bvh.joints.len() {
        let joint = &bvh.joints[index];
        if let Some(parent) = joint.parent
            && joint.is_end_site
            && joint.end_name == EndName::Implied
        {
            bvh.joints[index].name = implied_end_name(&bvh.joints[parent].name);
        }
    }
    Ok(())
}

fn can_be_name(name: &[u8]) -> bool {
    !name.is_empty()
        && name.len() <= MAX_NAME_BYTES
        && name.trim_ascii() == name
        && !name
            .iter()
            .any(|byte| byte.is_ascii_control() || b"{}".contains(byte))
}

/// Refuses new names of which two joints share one although their old ones differed.
fn refuse_merged(joints: &[&mut BvhJoint], new_names: &[Option<Vec<u8>>]) -> Result<(), EditError> {
    let mut old_of: BTreeMap<&[u8], &[u8]> = BTreeMap::new();
    for (joint, new) in joints.iter().zip(new_names) {
        let new: &[u8] = new.as_ref().unwrap_or(&joint.name);
        if *old_of.entry(new).or_insert(&joint.name) != joint.name.as_slice() {
            return Err(EditError::MergedNames {
                name: String::from_utf8_lossy(new).into_owned(),
            });
        }
    }
    Ok(())
}

/// A name with `*` for any bytes, and what becomes of it.
struct Pattern<'a> {
    /// What stands between the stars of the old name; at least two.
    from: Vec<&'a [u8]>,
    /// What stands between those of the new one.
    to: Vec<&'a [u8]>,
}

impl<'a> Pattern<'a> {
    fn new(from: &'a str, to: &'a str) -> Result<Self, EditError> {
        let parts = |text: &'a str| text.split('*').map(str::as_bytes).collect::<Vec<_>>();
        let pattern = Self {
            from: parts(from),
            to: parts(to),
        };
        if pattern.to.len() > pattern.from.len() {
            return Err(EditError::TooManyStars {
                from: from.to_owned(),
                to: to.to_owned(),
            });
        }
        Ok(pattern)
    }

    /// The new name of a joint that the pattern fits.
    fn new_name(&self, name: &[u8]) -> Option<Vec<u8>> {
        let stars = self.stars(name)?;
        let used = &stars[stars.len() + 1 - self.to.len()..];
        let mut new = self.to[0].to_vec();
        for (star, part) in used.iter().zip(&self.to[1..]) {
            new.extend_from_slice(star);
            new.extend_from_slice(part);
        }
        Some(new)
    }

    /// What each star stands for.
    fn stars<'n>(&self, name: &'n [u8]) -> Option<Vec<&'n [u8]>> {
        let (first, rest) = self.from.split_first()?;
        let (last, middle) = rest.split_last()?;
        let mut left = name.strip_prefix(*first)?;
        let mut stars = Vec::with_capacity(rest.len());
        for part in middle {
            let at = memchr::memmem::find(left, part)?;
            stars.push(&left[..at]);
            left = &left[at + part.len()..];
        }
        stars.push(left.strip_suffix(*last)?);
        Some(stars)
    }
}

/// Puts the joints, and the columns of every row with them, in the order of another document with
/// the same joints. Channels stay as they are within their joint.
///
/// # Errors
/// When a joint is missing in one of the two, hangs from another parent, or shares its name.
pub fn reorder_like(bvh: &mut Bvh, other: &Bvh) -> Result<(), EditError> {
    let places = places_by_path(bvh)?;
    let other_places = places_by_path(other)?;
    let only_here = places.keys().find(|path| !other_places.contains_key(*path));
    let only_there = other_places.keys().find(|path| !places.contains_key(*path));
    if let Some(path) = only_here.or(only_there) {
        return Err(different(path));
    }
    let mut order = vec![0; bvh.joints.len()];
    for (path, &other_place) in &other_places {
        order[other_place] = places[path];
    }
    let mut new_place = vec![0; order.len()];
    for (place, &old) in order.iter().enumerate() {
        new_place[old] = place;
    }
    let starts = bvh.column_starts();
    let columns: Vec<usize> = order
        .iter()
        .flat_map(|&joint| starts[joint]..starts[joint + 1])
        .collect();
    let mut joints: Vec<BvhJoint> = order
        .iter()
        .map(|&joint| bvh.joints[joint].clone())
        .collect();
    for joint in &mut joints {
        joint.parent = joint.parent.map(|parent| new_place[parent]);
    }
    let values: Vec<f64> = bvh
        .rows()
        .flat_map(|row| columns.iter().map(move |&column| row[column]))
        .collect();
    bvh.joints = joints;
    if let Some(motion) = &mut bvh.motion {
        motion.values = values;
    }
    Ok(())
}

fn different(path: &[Vec<u8>]) -> EditError {
    let name = path.last().map_or(String::new(), |name| {
        String::from_utf8_lossy(name).into_owned()
    });
    EditError::DifferentJoints { name }
}

/// Every joint's index by the names from the root to it, which tell it apart even where a name is
/// used in two limbs.
fn places_by_path(bvh: &Bvh) -> Result<BTreeMap<Vec<Vec<u8>>, usize>, EditError> {
    let mut paths: Vec<Vec<Vec<u8>>> = Vec::with_capacity(bvh.joints.len());
    for joint in &bvh.joints {
        let mut path = joint
            .parent
            .map_or_else(Vec::new, |parent| paths[parent].clone());
        path.push(joint.name.clone());
        paths.push(path);
    }
    let mut places = BTreeMap::new();
    for (place, path) in paths.into_iter().enumerate() {
        if places.insert(path, place).is_some() {
            return Err(EditError::AmbiguousJoint {
                name: bvh.joints[place].name().into_owned(),
            });
        }
    }
    Ok(places)
}
