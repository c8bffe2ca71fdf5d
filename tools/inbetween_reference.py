#!/usr/bin/env python3
"""The numbers of `posekit inbetween`, computed again with nothing shared but the file.

    posekit inbetween walk.bvh --keep 10 --method slerp,nlerp,matrix,rotvec,euler,euler:ZYX,squad --report=walk10
    python3 tools/inbetween_reference.py walk.bvh --keep 10 walk10.csv

The parser is that of fk_reference.py, the ways are those of inbetween_methods.py: NumPy and SciPy, double
precision. Euler angles are the file's own channels (`euler`) or SciPy's (`euler:ORDER`), run on from kept frame
to kept frame to the nearest equivalent of each triple. Frames kept are 0, N, 2N, ... and the last. The error of
a joint is the angle of truth^-1 * filled over the frames that were filled in. Prints the largest difference to
the CSV and exits 1 if it is over 0.001 degrees (posekit poses in single precision), or if a method of the CSV is
not known here.
"""

import argparse
import csv
import sys

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

import fk_reference
import inbetween_methods as methods


def rotation_channels(joint, rows):
    """The order of a joint's rotation channels and their values in degrees."""
    turning = [(column, name[0]) for column, name in joint.channels if name.endswith("rotation")]
    return "".join(axis for _, axis in turning), rows[:, [column for column, _ in turning]]


def kept_and_filled(frames, every):
    kept = np.array(sorted({*range(0, frames, every), frames - 1}))
    return kept, np.setdiff1d(np.arange(frames), kept)


def by_angles(unrolled, order, kept, filled):
    """Angles that were run on, interpolated one by one."""
    angles = np.stack([np.interp(filled, kept, column) for column in unrolled.T], axis=1)
    return Rotation.from_euler(order, angles)


def run_on(triples, order):
    previous = np.zeros(len(order))
    unrolled = []
    for triple in triples:
        if len(order) == 3 and len(set(order)) > 1:
            previous = methods.nearest_euler(triple, previous, order)
        else:
            previous = triple + 2 * np.pi * np.round((previous - triple) / (2 * np.pi))
        unrolled.append(previous)
    return np.array(unrolled)


def filled_by(method, truth, channels, kept, filled):
    """The rotations of the filled-in frames; channels are the order and the angles of the file."""
    if method == "slerp":
        return Slerp(kept, truth[kept])(filled)
    if method == "euler":
        order, radians = channels
        return by_angles(run_on(radians[kept], order), order, kept, filled)
    if method.startswith("euler:"):
        order = method.removeprefix("euler:")
        return by_angles(run_on(truth[kept].as_euler(order), order), order, kept, filled)
    keys = truth[kept].as_quat()
    if method == "squad":
        way = methods.squad_through(keys, kept.astype(float))
        return Rotation.from_matrix(np.array([way(float(frame)) for frame in filled]))
    make = {
        "nlerp": methods.nlerp,
        "lerp": methods.raw_lerp,
        "matrix": methods.matrix,
        "rotvec": methods.rotation_vector,
    }[method]
    made = []
    for gap, (first, last) in enumerate(zip(kept, kept[1:])):
        way = make(keys[gap], keys[gap + 1])
        for frame in range(first + 1, last):
            made.append(way((frame - first) / (last - first)))
    # The orthogonal factor of each: the nearest rotation.
    left, _, right = np.linalg.svd(np.array(made))
    return Rotation.from_matrix(left @ right)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("bvh")
    parser.add_argument("csv")
    parser.add_argument("--keep", type=int, required=True)
    options = parser.parse_args()
    bvh = fk_reference.read_bvh(options.bvh)
    kept, filled = kept_and_filled(len(bvh.rows), options.keep)
    with open(options.csv, newline="") as file:
        rows = list(csv.DictReader(file))
    asked = list(dict.fromkeys(row["method"] for row in rows))
    expected = {method: {} for method in asked}
    for joint in bvh.joints:
        if joint.is_end_site:
            continue
        order, degrees = rotation_channels(joint, bvh.rows)
        truth = Rotation.from_euler(order, degrees, degrees=True)
        for method in asked:
            made = filled_by(method, truth, (order, np.radians(degrees)), kept, filled)
            error = np.degrees((truth[filled].inv() * made).magnitude())
            expected[method][joint.name] = (error.mean(), error.max())
    worst = dict.fromkeys(asked, 0.0)
    for row in rows:
        table = expected[row["method"]]
        if row["joint"] == "*":
            wanted = (np.mean([m for m, _ in table.values()]), max(m for _, m in table.values()))
        else:
            wanted = table[row["joint"]]
        found = (float(row["mean_deg"]), float(row["max_deg"]))
        off = max(abs(a - b) for a, b in zip(wanted, found))
        worst[row["method"]] = max(worst[row["method"]], off)
    for method in asked:
        means = [mean for mean, _ in expected[method].values()]
        print(f"{method}: mean {np.mean(means):.6f} degrees; largest difference {worst[method]:.2e}")
    print(f"{len(rows)} rows compared; the largest difference is {max(worst.values()):.2e} degrees")
    return 0 if rows and max(worst.values()) < 1e-3 else 1


if __name__ == "__main__":
    sys.exit(main())
