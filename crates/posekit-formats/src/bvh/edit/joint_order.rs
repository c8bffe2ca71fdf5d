//! Joints by other names and in another order.

use std::collections::BTreeMap;

use super::EditError;
use crate::bvh::{Bvh, BvhJoint, MAX_NAME_BYTES};

/// Renames every joint that is called `from`. The End Site below it follows.
///
/// # Errors
/// When no joint has the name, or the format cannot hold the new one.
pub fn rename(bvh: &mut Bvh, from: &str, to: &str) -> Result<(), EditError> {
    let holds = !to.is_empty()
        && to.len() <= MAX_NAME_BYTES
        && to.trim() == to
        && !to
            .chars()
            .any(|letter| letter.is_control() || "{}".contains(letter));
    if !holds {
        return Err(EditError::BadName {
            name: to.to_owned(),
        });
    }
    let mut is_renamed = vec![false; bvh.joints.len()];
    for (joint, is_renamed) in bvh.joints.iter_mut().zip(&mut is_renamed) {
        if !joint.is_end_site && joint.name == from.as_bytes() {
            joint.name = to.as_bytes().to_vec();
            *is_renamed = true;
        }
    }
    if !is_renamed.contains(&true) {
        return Err(EditError::NoSuchJoint {
            name: from.to_owned(),
        });
    }
    for joint in bvh.joints.iter_mut().filter(|joint| joint.is_end_site) {
        if joint.parent.is_some_and(|parent| is_renamed[parent]) {
            joint.name = format!("{to}_end").into_bytes();
        }
    }
    Ok(())
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
