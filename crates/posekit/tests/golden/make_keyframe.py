"""Golden numbers for posekit's tracks, from SciPy and from the glTF 2.0 specification's formulas.

Run in this folder: python3 make_keyframe.py > keyframe.json
Written with SciPy 1.17.1 and NumPy 2. Nothing here is random without a seed, and nothing is fetched.

Quaternions are x, y, z, w. Slerp comes from scipy.spatial.transform.Slerp over all keys at once (it
takes the short way between neighbours whatever their signs), cubics of numbers and vectors from
scipy.interpolate.CubicHermiteSpline.
CUBICSPLINE is written down from appendix C.5 of the glTF 2.0 specification; squad from Shoemake's
formula with SciPy's rotations.
"""

import json
import sys

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation, Slerp

RNG = np.random.default_rng(20260505)


def numbers(array):
    return np.asarray(array, dtype=float).tolist()


def random_times(count):
    return np.cumsum(RNG.uniform(0.05, 1.5, count)) - 1.0


def inside(times, count=25):
    """Times within the keys, the keys themselves included."""
    return np.sort(np.concatenate([times, RNG.uniform(times[0], times[-1], count)]))


def random_signs(quats):
    return quats * RNG.choice([-1.0, 1.0], len(quats))[:, None]


def slerp_cases():
    cases = []
    for count in (2, 3, 9):
        for _ in range(4):
            times = random_times(count)
            rotations = Rotation.random(count, rng=RNG)
            at = inside(times)
            cases.append(
                {
                    "times": numbers(times),
                    "values": numbers(random_signs(rotations.as_quat())),
                    "at": numbers(at),
                    "expected": numbers(Slerp(times, rotations)(at).as_quat()),
                }
            )
    return cases


def hermite_cases():
    cases = []
    for count in (2, 5, 8):
        for _ in range(4):
            times = random_times(count)
            values = RNG.normal(size=(count, 3))
            slopes = RNG.normal(size=(count, 3)) * 3.0
            at = inside(times)
            cases.append(
                {
                    "times": numbers(times),
                    "values": numbers(values),
                    "slopes": numbers(slopes),
                    "at": numbers(at),
                    "expected": numbers(CubicHermiteSpline(times, values, slopes)(at)),
                }
            )
    return cases


def gltf_cubic_spline(times, values, incoming, outgoing, at):
    """Appendix C.5: v(t) = (2t^3 - 3t^2 + 1) v_k + t_d (t^3 - 2t^2 + t) b_k
    + (-2t^3 + 3t^2) v_{k+1} + t_d (t^3 - t^2) a_{k+1}; rotations are normalized."""
    result = []
    for now in at:
        k = int(np.clip(np.searchsorted(times, now, side="right") - 1, 0, len(times) - 2))
        d = times[k + 1] - times[k]
        t = (now - times[k]) / d
        v = (
            (2 * t**3 - 3 * t**2 + 1) * values[k]
            + d * (t**3 - 2 * t**2 + t) * outgoing[k]
            + (-2 * t**3 + 3 * t**2) * values[k + 1]
            + d * (t**3 - t**2) * incoming[k + 1]
        )
        result.append(v / np.linalg.norm(v))
    return np.array(result)


def cubic_spline_cases():
    """The specification interpolates the components as they are given: whoever writes the file chooses
    the signs. Here they are continuous first, as exporters write them; the track gets every other key
    and its tangents with the sign changed and must undo that."""
    cases = []
    for count in (2, 4, 7):
        for _ in range(5):
            times = random_times(count)
            values = Rotation.random(count, rng=RNG).as_quat()
            for k in range(1, count):
                if values[k] @ values[k - 1] < 0:
                    values[k] *= -1
            incoming, outgoing = RNG.normal(size=(2, count, 4))
            at = inside(times)
            expected = gltf_cubic_spline(times, values, incoming, outgoing, at)
            signs = RNG.choice([-1.0, 1.0], count)[:, None]
            cases.append(
                {
                    "times": numbers(times),
                    "values": numbers(values * signs),
                    "incoming": numbers(incoming * signs),
                    "outgoing": numbers(outgoing * signs),
                    "at": numbers(at),
                    "expected": numbers(expected),
                }
            )
    return cases


def slerp_between(a, b, t):
    return a * Rotation.from_rotvec((a.inv() * b).as_rotvec() * t)


def squad_cases():
    """Shoemake's squad: inner points s_i = q_i exp(-(log(q_i^-1 q_{i+1}) + log(q_i^-1 q_{i-1})) / 4)
    for evenly spaced keys, s = q at the ends."""
    cases = []
    for count in (3, 4, 8):
        for _ in range(4):
            step = RNG.uniform(0.1, 2.0)
            times = np.arange(count) * step
            # Neighbours within a right angle, as keys are.
            rotations = [Rotation.random(rng=RNG)]
            for _ in range(count - 1):
                axis = RNG.normal(size=3)
                turn = axis / np.linalg.norm(axis) * RNG.uniform(0.1, np.pi / 2)
                rotations.append(rotations[-1] * Rotation.from_rotvec(turn))
            inner = [rotations[0]]
            for i in range(1, count - 1):
                after = (rotations[i].inv() * rotations[i + 1]).as_rotvec()
                before = (rotations[i].inv() * rotations[i - 1]).as_rotvec()
                inner.append(rotations[i] * Rotation.from_rotvec(-(after + before) / 4))
            inner.append(rotations[-1])
            at = inside(times)
            expected = []
            for now in at:
                k = int(np.clip(np.searchsorted(times, now, side="right") - 1, 0, count - 2))
                t = (now - times[k]) / step
                outer = slerp_between(rotations[k], rotations[k + 1], t)
                between = slerp_between(inner[k], inner[k + 1], t)
                expected.append(slerp_between(outer, between, 2 * t * (1 - t)).as_quat())
            quats = np.array([r.as_quat() for r in rotations])
            cases.append(
                {
                    "times": numbers(times),
                    "values": numbers(random_signs(quats)),
                    "at": numbers(at),
                    "expected": numbers(expected),
                }
            )
    return cases


def catmull_rom_cases():
    """The cubic whose inner slopes are those of the parabola through three keys, by polynomial fits."""
    cases = []
    for count in (3, 6):
        for _ in range(4):
            times = random_times(count)
            values = RNG.normal(size=count)
            slopes = np.empty(count)
            for i in range(1, count - 1):
                parabola = np.polyfit(times[i - 1 : i + 2], values[i - 1 : i + 2], 2)
                slopes[i] = np.polyval(np.polyder(parabola), times[i])
            slopes[0] = (values[1] - values[0]) / (times[1] - times[0])
            slopes[-1] = (values[-1] - values[-2]) / (times[-1] - times[-2])
            at = inside(times)
            cases.append(
                {
                    "times": numbers(times),
                    "values": numbers(values),
                    "at": numbers(at),
                    "expected": numbers(CubicHermiteSpline(times, values, slopes)(at)),
                }
            )
    return cases


def bezier(times, values, handles, at):
    """An F-curve as Blender evaluates it: between two keys the Bezier curve through the key, its right handle,
    the next key's left handle and that key, handles shortened along their direction where they reach past the
    other key; the cubic of time is solved (here by numpy.roots, the companion matrix's eigenvalues), and the
    value taken there. `handles[k]` is [left time, left value, right time, right value] seen from the key."""
    result = []
    for now in at:
        k = int(np.clip(np.searchsorted(times, now, side="right") - 1, 0, len(times) - 2))
        span = times[k + 1] - times[k]

        def shortened(time, value):
            factor = min(1.0, span / abs(time)) if time else 1.0
            return time * factor, value * factor

        right = shortened(handles[k][2], handles[k][3])
        left = shortened(handles[k + 1][0], handles[k + 1][1])
        x = [times[k], times[k] + right[0], times[k + 1] + left[0], times[k + 1]]
        y = [values[k], values[k] + right[1], values[k + 1] + left[1], values[k + 1]]
        cubic = [
            -x[0] + 3 * x[1] - 3 * x[2] + x[3],
            3 * x[0] - 6 * x[1] + 3 * x[2],
            3 * x[1] - 3 * x[0],
            x[0] - now,
        ]
        roots = np.roots(cubic)
        real = roots[np.abs(roots.imag) < 1e-6].real
        t = float(np.clip(real[np.argmin(np.maximum(-real, real - 1))], 0, 1))
        s = 1 - t
        result.append(s**3 * y[0] + 3 * s * s * t * y[1] + 3 * s * t * t * y[2] + t**3 * y[3])
    return np.array(result)


def random_handles(times, values):
    """For each key [left time, left value, right time, right value]; some reach past the next key."""
    count = len(times)
    reach = RNG.uniform(0.05, 1.6, size=(count, 2))
    rise = RNG.normal(size=(count, 2)) * 40
    return np.stack([-reach[:, 0], rise[:, 0], reach[:, 1], rise[:, 1]], axis=1)


def euler_cases():
    """Three F-curves of angles in degrees in each of the twelve orders, and SciPy's rotation of the angles that
    they have at a time. SciPy's capital letters are intrinsic turns, multiplied left to right."""
    cases = []
    for order in ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"):
        times = random_times(4)
        values = RNG.uniform(-400, 400, size=(4, 3))
        handles = np.stack([random_handles(times, values[:, i]) for i in range(3)], axis=1)
        at = inside(times)
        angles = np.stack(
            [bezier(times, values[:, i], handles[:, i], at) for i in range(3)], axis=1
        )
        straight = np.stack([np.interp(at, times, values[:, i]) for i in range(3)], axis=1)
        cases.append(
            {
                "order": order,
                "times": numbers(times),
                "values": numbers(values),
                "handles": numbers(handles),
                "at": numbers(at),
                "angles": numbers(angles),
                "expected": numbers(Rotation.from_euler(order, angles, degrees=True).as_quat()),
                "linear": numbers(Rotation.from_euler(order, straight, degrees=True).as_quat()),
            }
        )
    return cases


def main():
    golden = {
        "slerp": slerp_cases(),
        "hermite": hermite_cases(),
        "cubic_spline": cubic_spline_cases(),
        "squad": squad_cases(),
        "catmull_rom": catmull_rom_cases(),
        "euler": euler_cases(),
    }
    lines = []
    for name, cases in golden.items():
        body = ",\n".join(json.dumps(case) for case in cases)
        lines.append(f'"{name}": [\n{body}\n]')
    sys.stdout.write("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    main()
