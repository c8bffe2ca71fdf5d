#!/usr/bin/env python3
"""Holds tools/fk_reference.py, and with it posekit, against Blender's BVH importer.

Run by hand, outside of CI, since Blender is large:

    python3.11 -m venv venv && venv/bin/pip install bpy==5.0.1 scipy
    venv/bin/python tools/fk_blender.py FILE.bvh ...

Imports each file as an armature with its axes left as they are and its rotations as
quaternions, steps through the frames, and compares where each bone's head is, and
how the bone has turned from rest, with the reference. Prints the largest
deviation; docs/conventions-elsewhere.md has what came out.

Two things are done to meet Blender half way. A bone's orientation in Blender has
its rest orientation in it, along the bone; that is taken out. And what a file
lacks must be there: two rotation channels, say, are something that Blender reads
differently, which is the other use of this script.
"""

import argparse
import contextlib
import io
import sys
from pathlib import Path

import bpy
import numpy as np
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).parent))
import fk_reference  # noqa: E402


def import_armature(path):
    """Blender's object for the file, in an otherwise empty scene."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_anim_bvh")
    with contextlib.redirect_stdout(io.StringIO()):
        bpy.ops.import_anim.bvh(
            filepath=path,
            target="ARMATURE",
            rotate_mode="QUATERNION",
            axis_forward="Y",
            axis_up="Z",
            frame_start=1,
            update_scene_duration=True,
        )
    return bpy.context.object


def matrices(armature, names, frames):
    """Each bone's 4 x 4 matrix, (frames, bones, 4, 4), its rest orientation taken out."""
    bones = [armature.pose.bones[name] for name in names]
    rest_inverse = [bone.bone.matrix_local.to_3x3().inverted().to_4x4() for bone in bones]
    result = np.empty((len(frames), len(names), 4, 4))
    for row, frame in enumerate(frames):
        bpy.context.scene.frame_set(int(frame) + 1)
        world = armature.matrix_world
        for column, bone in enumerate(bones):
            result[row, column] = np.array(world @ bone.matrix @ rest_inverse[column])
    return result


def compare(path, root_offset, most_frames):
    bvh = fk_reference.read_bvh(path)
    positions, orientations = fk_reference.forward_kinematics(bvh, root_offset)
    armature = import_armature(path)
    # Blender names duplicates apart in the order of the file, as posekit does.
    joints = [index for index, joint in enumerate(bvh.joints) if not joint.is_end_site]
    names = unique_names([bvh.joints[index].name for index in joints])
    every = max(1, -(-len(positions) // most_frames))
    frames = np.arange(0, len(positions), every)
    theirs = matrices(armature, names, frames)
    away = np.linalg.norm(theirs[..., :3, 3] - positions[np.ix_(frames, joints)], axis=2)
    turned = [
        (orientations[joint][frames].inv() * Rotation.from_matrix(theirs[:, column, :3, :3]))
        .magnitude()
        .max()
        for column, joint in enumerate(joints)
    ]
    height = fk_reference.height(bvh)
    worst = np.unravel_index(np.argmax(away), away.shape)
    print(
        f"{path}: {len(frames)} of {len(positions)} frames, {len(joints)} bones: position "
        f"{away.max() / height:.1e} of the height (joint {names[worst[1]]}, frame "
        f"{frames[worst[0]]}), orientation {max(turned):.1e} rad"
    )


def unique_names(names):
    seen, result = set(), []
    for name in names:
        candidate, number = name, 0
        while candidate in seen:
            number += 1
            candidate = f"{name}.{number:03d}"
        seen.add(candidate)
        result.append(candidate)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="+")
    parser.add_argument("--root-offset", choices=["replace", "add"], default="replace")
    parser.add_argument("--most-frames", type=int, default=300, help="step over frames beyond")
    args = parser.parse_args()
    for path in args.files:
        compare(path, args.root_offset, args.most_frames)


if __name__ == "__main__":
    main()
