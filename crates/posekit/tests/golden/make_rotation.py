"""Golden numbers for posekit's rotations, from SciPy's Rotation.

Run in this folder: python3 make_rotation.py > rotation.json
Written with SciPy 1.17.1 and NumPy 2. Nothing here is random without a seed, and nothing is fetched.

Conventions: quaternions x, y, z, w; matrices as rows; radians. Upper-case orders are intrinsic in
SciPy as they are in posekit: from_euler("ZXY", [z, x, y]) is Rz(z) * Rx(x) * Ry(y).
SciPy's own logarithm loses digits in a few places (it switches to series at 1e-3), so expected rotation
vectors are the ones that the rotation was made from, with the quaternion computed by SciPy from them,
wherever that is unique.
"""

import itertools
import json
import sys

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

RNG = np.random.default_rng(20260101)
PI = np.pi


def numbers(array):
    return np.asarray(array, dtype=float).tolist()


def complete_orders():
    return ["".join(p) for p in itertools.product("XYZ", repeat=3) if p[0] != p[1] != p[2]]


def euler_cases():
    cases = []
    for order in complete_orders():
        proper = order[0] == order[2]
        low, high = (0.0, PI) if proper else (-PI / 2, PI / 2)
        for _ in range(6):
            first, last = RNG.uniform(-PI, PI, 2)
            middle = RNG.uniform(low + 0.01, high - 0.01)
            rotation = Rotation.from_euler(order, [first, middle, last])
            cases.append(
                {
                    "order": order,
                    "angles": numbers([first, middle, last]),
                    "quat": numbers(rotation.as_quat()),
                    "matrix": numbers(rotation.as_matrix()),
                    "scipy_angles": numbers(rotation.as_euler(order)),
                }
            )
    return cases


def gimbal_cases():
    """At the lock and close to it: only the rotation can be compared."""
    cases = []
    for order in complete_orders():
        proper = order[0] == order[2]
        ends = (0.0, PI) if proper else (-PI / 2, PI / 2)
        for end in ends:
            for distance in (0.0, 1e-14, 1e-11, 1e-8, 1e-6, 1e-3):
                inward = distance if end == min(ends) else -distance
                first, last = RNG.uniform(-PI, PI, 2)
                rotation = Rotation.from_euler(order, [first, end + inward, last])
                cases.append(
                    {
                        "order": order,
                        "angles": numbers([first, end + inward, last]),
                        "distance": distance,
                        "quat": numbers(rotation.as_quat()),
                    }
                )
    return cases


def incomplete_cases():
    """The rotation of one and two axes, and turns beyond one revolution."""
    cases = []
    for order in ["X", "Y", "Z"] + ["".join(p) for p in itertools.permutations("XYZ", 2)]:
        for span in (PI, 50 * PI):
            angles = RNG.uniform(-span, span, len(order))
            rotation = Rotation.from_euler(order, angles if len(order) > 1 else angles[0])
            cases.append(
                {"order": order, "angles": numbers(angles), "quat": numbers(rotation.as_quat())}
            )
    return cases


def nearest_cases():
    """The least angle to a random rotation that an incomplete order can leave, by dense search and
    golden refinement with nothing shared with posekit's closed form."""
    from scipy.optimize import minimize

    cases = []
    for order in ["X", "Y", "Z"] + ["".join(p) for p in itertools.permutations("XYZ", 2)]:
        for _ in range(4):
            target = Rotation.random(rng=RNG)
            matrix = target.as_matrix()

            # Minimising the squared matrix distance minimises the angle: |A - B|^2 = 4 - 4 cos(angle).
            def distance(angles):
                made = Rotation.from_euler(order, angles if len(order) > 1 else angles[0])
                return float(np.sum((made.as_matrix() - matrix) ** 2))

            starts = itertools.product(np.linspace(-PI, PI, 9)[:-1], repeat=len(order))
            best = min(
                (minimize(distance, s, method="BFGS", options={"gtol": 1e-12}) for s in starts),
                key=lambda found: found.fun,
            )
            made = Rotation.from_euler(order, best.x if len(order) > 1 else best.x[0])
            residual = (made.inv() * target).magnitude()
            cases.append(
                {"order": order, "quat": numbers(target.as_quat()), "residual": float(residual)}
            )
    return cases


def exp_log_cases():
    cases = []
    angles = [1e-300, 1e-100, 1e-17, 1e-12, 1e-9, 0.99e-8, 1.01e-8, 1e-6, 1e-4, 1e-3, 0.1, 1.0, 2.0]
    angles += [PI - d for d in (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-12)]
    for angle in angles:
        for _ in range(3):
            axis = RNG.normal(size=3)
            vector = axis / np.linalg.norm(axis) * angle
            rotation = Rotation.from_rotvec(vector)
            cases.append(
                {
                    "vector": numbers(vector),
                    "quat": numbers(rotation.as_quat()),
                    "matrix": numbers(rotation.as_matrix()),
                }
            )
    return cases


def slerp_cases():
    cases = []
    for kind in ("any", "long way", "close", "nearly half a turn"):
        for _ in range(6):
            start = Rotation.random(rng=RNG)
            angle = {"close": 1e-5, "nearly half a turn": PI - 1e-3}.get(kind)
            if angle is None:
                end = Rotation.random(rng=RNG)
            else:
                axis = RNG.normal(size=3)
                end = start * Rotation.from_rotvec(axis / np.linalg.norm(axis) * angle)
            a, b = start.as_quat(), end.as_quat()
            if kind == "long way" and a @ b > 0 or kind != "long way" and a @ b < 0:
                b = -b
            times = [0.0, 0.1, 0.25, 0.5, 0.9, 1.0]
            path = Slerp([0.0, 1.0], Rotation.concatenate([start, end]))(times)
            cases.append(
                {
                    "kind": kind,
                    "start": numbers(a),
                    "end": numbers(b),
                    "times": times,
                    "path": numbers(path.as_quat()),
                }
            )
    return cases


def swing_twist_cases():
    """Made from a swing and a twist, so that the parts are known beforehand."""
    cases = []
    for _ in range(20):
        axis = RNG.normal(size=3)
        axis /= np.linalg.norm(axis)
        across = np.cross(axis, RNG.normal(size=3))
        across /= np.linalg.norm(across)
        swing = Rotation.from_rotvec(across * RNG.uniform(0.0, PI - 0.01))
        angle = RNG.uniform(-PI, PI)
        twist = Rotation.from_rotvec(axis * angle)
        cases.append(
            {
                "axis": numbers(axis),
                "quat": numbers((swing * twist).as_quat()),
                "swing": numbers(swing.as_quat()),
                "twist": numbers(twist.as_quat()),
                "twist_angle": float(angle),
            }
        )
    return cases


def angular_velocity_cases():
    cases = []
    for _ in range(20):
        start, end = Rotation.random(rng=RNG), Rotation.random(rng=RNG)
        duration = float(RNG.uniform(0.001, 2.0))
        cases.append(
            {
                "from": numbers(start.as_quat()),
                "to": numbers(end.as_quat()),
                "duration": duration,
                "in_world": numbers((end * start.inv()).as_rotvec() / duration),
                "in_body": numbers((start.inv() * end).as_rotvec() / duration),
                "angle": float((start.inv() * end).magnitude()),
            }
        )
    return cases


def nearest_matrix_cases():
    """The orthogonal polar factor by singular value decomposition (NumPy)."""
    cases = []
    for size in (0.0, 1e-9, 1e-4, 0.1, 0.5):
        for scale in (1.0, 0.01, 100.0):
            matrix = (Rotation.random(rng=RNG).as_matrix() + size * RNG.normal(size=(3, 3))) * scale
            if np.linalg.det(matrix) <= 0:
                continue
            u, _, vt = np.linalg.svd(matrix)
            cases.append({"matrix": numbers(matrix), "nearest": numbers(u @ vt)})
    return cases


def main():
    golden = {
        "euler": euler_cases(),
        "gimbal": gimbal_cases(),
        "incomplete": incomplete_cases(),
        "nearest": nearest_cases(),
        "exp_log": exp_log_cases(),
        "slerp": slerp_cases(),
        "swing_twist": swing_twist_cases(),
        "angular_velocity": angular_velocity_cases(),
        "nearest_matrix": nearest_matrix_cases(),
    }
    lines = []
    for name, cases in golden.items():
        body = ",\n".join(json.dumps(case) for case in cases)
        lines.append(f'"{name}": [\n{body}\n]')
    sys.stdout.write("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    main()
