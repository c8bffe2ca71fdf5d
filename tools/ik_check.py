#!/usr/bin/env python3
"""Checks by forward kinematics of other means what `posekit ik` says it left.

    posekit ik walk.bvh --end LeftHand --offset 0,0.1,0 -o out.bvh --json > summary.json
    python3 tools/ik_check.py out.bvh summary.json LeftHand,0,0,0

For every target of the summary, in their order, names the joint and the point of it (in its own space) that
was to be there. Reads the BVH and computes where that point is with `fk_reference.py` (a parser of its own,
rotations by SciPy, double precision), and exits 1 if in any frame its distance from the target differs from
the one that the summary says by more than 1e-5 of the skeleton's height. Prints the largest difference.
"""

import json
import sys

import numpy as np

from fk_reference import POSITION_TOLERANCE, forward_kinematics, read_bvh


def main(bvh_path, summary_path, *points):
    bvh = read_bvh(bvh_path)
    positions, orientations = forward_kinematics(bvh)
    names = [joint.name for joint in bvh.joints]
    with open(summary_path, encoding="utf-8") as file:
        summary = json.load(file)
    rest = np.zeros((len(bvh.joints), 3))
    for index, joint in enumerate(bvh.joints):
        rest[index] = joint.offset + (rest[joint.parent] if joint.parent >= 0 else 0)
    height = np.ptp(rest[:, 1])
    largest, count = 0.0, 0
    for frame in summary["frames"]:
        assert len(frame["targets"]) == len(points), "a point for every target"
        for point, target in zip(points, frame["targets"]):
            name, *coordinates = point.split(",")
            index = names.index(name)
            offset = np.array([float(number) for number in coordinates])
            at = positions[frame["frame"], index] + orientations[index][frame["frame"]].apply(offset)
            distance = np.linalg.norm(at - np.array(target["target"]))
            largest = max(largest, abs(distance - target["distance"]))
            count += 1
    print(f"{count} residuals, the largest difference {largest / height:.1e} of the height")
    return 0 if count and largest <= POSITION_TOLERANCE * height else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
