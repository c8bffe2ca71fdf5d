#!/usr/bin/env python3
"""Forward kinematics of BVH files by other means, to hold posekit's against.

Reads a BVH file with a parser of its own, written from the format's description
(Meredith and Maddock, "Motion Capture File Formats Explained", University of
Sheffield, 2001), turns angles into rotations with scipy.spatial.transform.Rotation
and chains them in double precision. Nothing here comes from posekit.

Its parser wants a well-formed file: names without spaces, one CHANNELS line a
joint, as many values as Frames promises. That is what the files that it is run
on are; how posekit treats others is tested elsewhere.

    posekit fk walk.bvh -o walk.npz
    python3 tools/fk_reference.py compare walk.bvh walk.npz

compares every joint of every frame, prints the largest deviation and exits 1 if
a position is off by more than 1e-5 of the skeleton's height or an orientation by
more than 1e-5 rad. More pairs may follow; --root-offset add takes the sum of a
root's OFFSET and its position channels, as the description has it, where the
default is that the channels replace it.

Needs NumPy and SciPy 1.4 or newer.
"""

import argparse
import sys
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

POSITION_TOLERANCE = 1e-5  # of the skeleton's height
ORIENTATION_TOLERANCE_RAD = 1e-5
UNIT_TOLERANCE = 1e-5  # of a quaternion's length


@dataclass
class Joint:
    """A ROOT, JOINT or End Site and where its channels are in a row."""

    name: str
    parent: int  # -1 for a ROOT
    offset: np.ndarray
    channels: list = field(default_factory=list)  # (column, "Xrotation")
    is_end_site: bool = False


@dataclass
class BvhFile:
    joints: list
    frame_time: float
    rows: np.ndarray  # (frames, columns), degrees and the file's length unit


def read_bvh(path):
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        hierarchy, _, motion = file.read().partition("MOTION")
    joints, column_count = parse_hierarchy(hierarchy.split())
    words = motion.replace(":", " ").split()
    if words[0] != "Frames" or words[2:4] != ["Frame", "Time"]:
        raise ValueError(f"{path}: no Frames and Frame Time after MOTION")
    frame_count, frame_time = int(words[1]), float(words[4])
    values = np.array(words[5:], dtype=np.float64)
    return BvhFile(joints, frame_time, values.reshape(frame_count, column_count))


def parse_hierarchy(words):
    """The joints in the file's order and the number of columns in a row."""
    joints, open_joints, column_count = [], [], 0
    words = iter(words)
    for word in words:
        if word in ("ROOT", "JOINT"):
            joints.append(Joint(next(words), open_joints[-1] if open_joints else -1, None))
        elif word == "End":
            assert next(words) == "Site"
            parent = open_joints[-1]
            joints.append(Joint(joints[parent].name + "_end", parent, None, is_end_site=True))
        elif word == "{":
            open_joints.append(len(joints) - 1)
        elif word == "}":
            open_joints.pop()
        elif word == "OFFSET":
            joints[open_joints[-1]].offset = np.array([float(next(words)) for _ in range(3)])
        elif word == "CHANNELS":
            for _ in range(int(next(words))):
                joints[open_joints[-1]].channels.append((column_count, next(words)))
                column_count += 1
        elif word != "HIERARCHY":
            raise ValueError(f"cannot make sense of {word!r}")
    return joints, column_count


def forward_kinematics(bvh, root_offset="replace"):
    """World positions (F, J, 3) and a list of J stacks of F world orientations."""
    frame_count = len(bvh.rows)
    positions = np.zeros((frame_count, len(bvh.joints), 3))
    orientations = []
    for index, joint in enumerate(bvh.joints):
        translation = np.tile(joint.offset, (frame_count, 1))
        rotation = Rotation.from_quat(np.tile([0.0, 0.0, 0.0, 1.0], (frame_count, 1)))
        added = joint.offset if root_offset == "add" and joint.parent < 0 else np.zeros(3)
        for column, channel in joint.channels:
            axis, values = channel[0], bvh.rows[:, column]
            coordinate = "XYZ".index(axis)
            if channel[1:].lower() == "position":
                translation[:, coordinate] = added[coordinate] + values
            else:
                # Turns about the axes that the turns before them carried along: they
                # multiply from the left to the right in the order of the channels.
                turn = Rotation.from_euler(axis, values[:, np.newaxis], degrees=True)
                rotation = rotation * turn
        if joint.parent < 0:
            positions[:, index] = translation
            orientations.append(rotation)
        else:
            parent = orientations[joint.parent]
            positions[:, index] = positions[:, joint.parent] + parent.apply(translation)
            orientations.append(parent * rotation)
    return positions, orientations


def rest_positions(bvh):
    positions = np.zeros((len(bvh.joints), 3))
    for index, joint in enumerate(bvh.joints):
        base = positions[joint.parent] if joint.parent >= 0 else 0.0
        positions[index] = base + joint.offset
    return positions


def height(bvh):
    """The rest pose's extent along Y, or its largest one where it does not stand."""
    extent = np.ptp(rest_positions(bvh), axis=0)
    return extent[1] if extent[1] >= 0.5 * extent.max() else extent.max()


@dataclass
class Deviation:
    """The largest differences over all joints and frames of one file."""

    position: float  # of the skeleton's height
    orientation_rad: float
    unit: float  # of a quaternion's length from 1
    joint_frames: int

    def within_tolerance(self):
        # Written so that a NaN fails.
        return (
            self.position <= POSITION_TOLERANCE
            and self.orientation_rad <= ORIENTATION_TOLERANCE_RAD
            and self.unit <= UNIT_TOLERANCE
        )


def compare(bvh, arrays, root_offset):
    """Holds the arrays of `posekit fk` against the reference. Shapes must be equal."""
    positions, orientations = forward_kinematics(bvh, root_offset)
    ours, turns = arrays["positions"], arrays["orientations"]
    assert ours.shape == positions.shape, f"positions {ours.shape}, expected {positions.shape}"
    assert turns.shape == positions.shape[:2] + (4,), f"orientations {turns.shape}"
    assert list(arrays["parents"]) == [joint.parent for joint in bvh.joints], "parents differ"
    assert float(arrays["frame_time"]) == bvh.frame_time, "frame times differ"
    check_names(bvh, [str(name) for name in arrays["joint_names"]])
    if positions.size == 0:
        return Deviation(0.0, 0.0, 0.0, 0)
    away = np.linalg.norm(ours.astype(np.float64) - positions, axis=2)
    angles, lengths = [], []
    for index, orientation in enumerate(orientations):
        quaternions = turns[:, index].astype(np.float64)
        lengths.append(np.linalg.norm(quaternions, axis=1))
        angles.append((orientation.inv() * Rotation.from_quat(quaternions)).magnitude())
    return Deviation(
        position=away.max() / height(bvh),
        orientation_rad=np.max(angles),
        unit=np.abs(np.array(lengths) - 1.0).max(),
        joint_frames=away.size,
    )


def check_names(bvh, names):
    """Names must be the file's; a joint that shares its name may have a suffix."""
    given = [joint.name for joint in bvh.joints]
    for name, expected in zip(names, given):
        told_apart = given.count(expected) > 1 and name.startswith(expected + ".")
        assert name == expected or told_apart, f"joint {name!r}, expected {expected!r}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("action", choices=["compare"])
    parser.add_argument("pairs", nargs="+", metavar="FILE.bvh FILE.npz")
    parser.add_argument("--root-offset", choices=["replace", "add"], default="replace")
    args = parser.parse_args()
    if len(args.pairs) % 2:
        parser.error("files come in pairs: a .bvh and the .npz that posekit made of it")

    failures, worst, joint_frames = 0, Deviation(0.0, 0.0, 0.0, 0), 0
    for bvh_path, npz_path in zip(args.pairs[::2], args.pairs[1::2]):
        with np.load(npz_path) as arrays:
            deviation = compare(read_bvh(bvh_path), arrays, args.root_offset)
        joint_frames += deviation.joint_frames
        worst.position = max(worst.position, deviation.position)
        worst.orientation_rad = max(worst.orientation_rad, deviation.orientation_rad)
        good = deviation.within_tolerance()
        failures += not good
        print(
            f"{'ok  ' if good else 'FAIL'} position {deviation.position:.1e} of the height, "
            f"orientation {deviation.orientation_rad:.1e} rad  {bvh_path}"
        )
    print(
        f"{len(args.pairs) // 2} files, {joint_frames} joint-frames, root OFFSET "
        f"{args.root_offset}: worst position {worst.position:.1e} of the height, "
        f"worst orientation {worst.orientation_rad:.1e} rad, {failures} failed"
    )
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
