"""Golden numbers for the ways between orientations, from NumPy and SciPy.

Run in this folder: python3 make_inbetween.py > inbetween.json
Written with SciPy 1.17.1 and NumPy 2. The ways are those of tools/inbetween_methods.py, which shares nothing
with posekit: Slerp and Euler angles are SciPy's, the nearest rotation is the orthogonal factor of
scipy.linalg.polar, squad is written from Shoemake (1987). Matrices as rows; quaternions x, y, z, w.

Euler angles have two ways where an end's triple and its twin are equally near to the start, rotation vectors
where the ends are half a turn apart: cases within a hair of that are left out.
"""

import json
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[4] / "tools"))
import inbetween_methods as methods

RNG = np.random.default_rng(20260522)
TIMES = [0.1, 0.25, 0.5, 0.7, 0.95]
# Nearer than this, radians squared, and rounding would choose between two Euler triples.
TIE = 1e-3


def quat():
    q = RNG.normal(size=4)
    return q / np.linalg.norm(q)


def near(q, angle):
    axis = RNG.normal(size=3)
    axis /= np.linalg.norm(axis)
    x, y, z = axis * np.sin(angle / 2)
    w, v, u = np.cos(angle / 2), np.array([x, y, z]), q[:3]
    return np.append(q[3] * v + w * u + np.cross(u, v), q[3] * w - u @ v)


def is_tie(order, a, b):
    start = methods.Rotation.from_quat(a).as_euler(order)
    end = methods.Rotation.from_quat(b).as_euler(order)
    twin = np.array([end[0] + np.pi, np.pi - end[1], end[2] + np.pi])
    distances = []
    for angles in (end, twin):
        off = (start - angles) / (2 * np.pi)
        if np.any(np.abs(np.abs(off - np.round(off)) - 0.5) < 1e-6):
            return True
        distances.append(np.sum((angles + 2 * np.pi * np.round(off) - start) ** 2))
    return abs(distances[0] - distances[1]) < TIE


def case(a, b, before, after):
    found = methods.ways(a, b, before, after)
    skipped = [order for order in methods.TAIT_BRYAN if is_tie(order, a, b)]
    ways = {}
    for word, way in found.items():
        if word.removeprefix("euler:") in skipped:
            continue
        ways[word] = [[float(f"{x:.13g}") for x in way(t).ravel()] for t in TIMES]
    return {
        "start": a.tolist(),
        "end": b.tolist(),
        "before": None if before is None else before.tolist(),
        "after": None if after is None else after.tolist(),
        "ways": ways,
    }


def main():
    cases = []
    for index in range(24):
        a = quat()
        # Random pairs, and pairs as neighbouring keys of a motion are; signs of both kinds.
        b = quat() if index % 2 else near(a, RNG.uniform(0.05, 1.5)) * RNG.choice([-1, 1])
        if abs(a @ b) < 0.02:
            continue
        # Squad's keys within a right angle of each other, as Shoemake's way needs them.
        before = near(a, RNG.uniform(0.1, 1.2)) if index % 4 < 2 else None
        after = near(b, RNG.uniform(0.1, 1.2)) if index % 3 < 2 else None
        cases.append(case(a, b, before, after))
    json.dump({"times": TIMES, "cases": cases}, sys.stdout)
    sys.stdout.write("\n")


if __name__ == "__main__":
    main()
