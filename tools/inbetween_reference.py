#!/usr/bin/env python3
"""The numbers of `posekit inbetween`, computed again with nothing shared but the file.

    posekit inbetween walk.bvh --keep 10 --method slerp,euler --report=walk10
    python3 tools/inbetween_reference.py walk.bvh --keep 10 walk10.csv

The parser is that of fk_reference.py; rotations are SciPy's, double precision. Slerp is
scipy.spatial.transform.Slerp over all kept frames; Euler angles are the file's own channels, unrolled
from kept frame to kept frame to the nearest equivalent of each triple, and interpolated by numpy.interp.
Frames kept are 0, N, 2N, ... and the last. The error of a joint is the angle of truth^-1 * filled over
the frames that were filled in. Prints the largest difference to the CSV and exits 1 if it is over 0.001
degrees (posekit poses in single precision; the distances are compared to 1e-5 of the largest).
"""

import argparse
import csv
import sys

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

import fk_reference


def rotation_channels(joint, rows):
    """The order of a joint's rotation channels and their values in degrees."""
    turning = [(column, name[0]) for column, name in joint.channels if name.endswith("rotation")]
    return "".join(axis for _, axis in turning), rows[:, [column for column, _ in turning]]


def nearest_equivalent(angles, previous, order):
    """The triple of the same rotation that is nearest to the one before: full turns, and for three
    different axes the flip of the outer ones by half a turn."""
    best = None
    flips = [angles]
    if len(order) == 3 and len(set(order)) == 3:
        flips.append([angles[0] + 180, 180 - angles[1], angles[2] + 180])
    for candidate in flips:
        candidate = np.array(candidate, dtype=float)
        candidate += 360 * np.round((previous - candidate) / 360)
        distance = np.sum((candidate - previous) ** 2)
        if best is None or distance < best[0]:
            best = (distance, candidate)
    return best[1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("bvh")
    parser.add_argument("csv")
    parser.add_argument("--keep", type=int, required=True)
    options = parser.parse_args()
    bvh = fk_reference.read_bvh(options.bvh)
    frames = len(bvh.rows)
    kept = np.array(sorted({*range(0, frames, options.keep), frames - 1}))
    filled = np.setdiff1d(np.arange(frames), kept)
    expected = {"slerp": {}, "euler": {}}
    for joint in bvh.joints:
        if joint.is_end_site:
            continue
        order, degrees = rotation_channels(joint, bvh.rows)
        truth = Rotation.from_euler(order, degrees, degrees=True)
        by_slerp = Slerp(kept, truth[kept])(filled)
        unrolled = [np.zeros(len(order))]
        for row in degrees[kept]:
            unrolled.append(nearest_equivalent(row, unrolled[-1], order))
        unrolled = np.array(unrolled[1:])
        angles = np.stack([np.interp(filled, kept, c) for c in unrolled.T], axis=1)
        by_euler = Rotation.from_euler(order, angles, degrees=True)
        for method, result in (("slerp", by_slerp), ("euler", by_euler)):
            error = np.degrees((truth[filled].inv() * result).magnitude())
            expected[method][joint.name] = (error.mean(), error.max())
    worst = 0.0
    compared = 0
    with open(options.csv, newline="") as file:
        for row in csv.DictReader(file):
            if row["method"] not in expected:
                continue
            table = expected[row["method"]]
            if row["joint"] == "*":
                wanted = (np.mean([m for m, _ in table.values()]), max(m for _, m in table.values()))
                print(f"{row['method']}: mean {wanted[0]:.6f}, most {wanted[1]:.6f} degrees")
            else:
                wanted = table[row["joint"]]
            found = (float(row["mean_deg"]), float(row["max_deg"]))
            worst = max(worst, *(abs(a - b) for a, b in zip(wanted, found)))
            compared += 1
    print(f"{compared} rows compared; the largest difference is {worst:.2e} degrees")
    return 0 if compared > 0 and worst < 1e-3 else 1


if __name__ == "__main__":
    sys.exit(main())
