"""The ways between two orientations, written anew: NumPy and SciPy's Rotation, nothing of posekit.

Quaternions are x, y, z, w; orders are intrinsic; a way is a function of t in [0, 1] that gives a matrix, which
is no rotation for `matrix` and `lerp`. Squad is Shoemake's (1987, "Quaternion calculus and fast animation",
SIGGRAPH course notes 10), with the inner points s_i = q_i exp(-(log(q_i^-1 q_i+1) + log(q_i^-1 q_i-1)) / 4);
for keys that are not evenly spaced the velocity at a key is that of a parabola through its neighbours.
"""

import itertools

import numpy as np
from scipy.linalg import polar
from scipy.spatial.transform import Rotation, Slerp

TAIT_BRYAN = ["".join(axes) for axes in itertools.permutations("XYZ")]


def quat(rotation):
    return rotation.as_quat()


def short_side(a, b):
    """The quaternion of b's rotation on a's side of the sphere."""
    return -b if np.dot(a, b) < 0 else b


def nearest_rotation(matrix):
    """The orthogonal factor of the polar decomposition."""
    return Rotation.from_matrix(polar(matrix)[0])


def scaled(q):
    """v -> q v q*, whatever the length of q."""
    return np.dot(q, q) * Rotation.from_quat(q).as_matrix()


def arc(a, b, t):
    """Along the great circle between two quaternions as they are: sin((1-t)w)/sin w a + sin(tw)/sin w b."""
    omega = np.arccos(np.clip(np.dot(a, b), -1, 1))
    if np.sin(omega) < 1e-9:
        mixed = (1 - t) * a + t * b
        return mixed / np.linalg.norm(mixed)
    return (np.sin((1 - t) * omega) * a + np.sin(t * omega) * b) / np.sin(omega)


def nearest_euler(angles, previous, order):
    """The triple of the same rotation that is nearest to another, radians: whole turns, and the twin that
    an order of three axes has."""
    proper = order[0] == order[2]
    twin = np.array([angles[0] + np.pi, (-angles[1] if proper else np.pi - angles[1]), angles[2] + np.pi])
    candidates = []
    for candidate in (np.array(angles, dtype=float), twin):
        candidate = candidate + 2 * np.pi * np.round((previous - candidate) / (2 * np.pi))
        candidates.append((np.sum((candidate - previous) ** 2), candidate))
    return min(candidates, key=lambda entry: entry[0])[1]


def slerp(a, b):
    way = Slerp([0, 1], Rotation.from_quat([a, b]))
    return lambda t: way(t).as_matrix()


def raw_slerp(a, b):
    return lambda t: Rotation.from_quat(arc(a, b, t)).as_matrix()


def nlerp(a, b):
    b = short_side(a, b)
    return lambda t: Rotation.from_quat((1 - t) * a + t * b).as_matrix()


def raw_lerp(a, b):
    b = short_side(a, b)
    return lambda t: scaled((1 - t) * a + t * b)


def matrix(a, b):
    a, b = Rotation.from_quat(a).as_matrix(), Rotation.from_quat(b).as_matrix()
    return lambda t: (1 - t) * a + t * b


def rotation_vector(a, b):
    a, b = Rotation.from_quat(a).as_rotvec(), Rotation.from_quat(b).as_rotvec()
    length = np.linalg.norm(b)
    if length > 0:
        axis = b / length
        b = min((axis * (length + 2 * np.pi * turns) for turns in range(-2, 3)), key=lambda v: np.linalg.norm(v - a))
    return lambda t: Rotation.from_rotvec((1 - t) * a + t * b).as_matrix()


def euler(order, a, b):
    start = Rotation.from_quat(a).as_euler(order)
    end = nearest_euler(Rotation.from_quat(b).as_euler(order), start, order)
    return lambda t: Rotation.from_euler(order, (1 - t) * start + t * end).as_matrix()


def squad_through(keys, times):
    """A curve through all keys, over their times; keys are quaternions in order."""
    keys = [np.array(key, dtype=float) for key in keys]
    for index in range(1, len(keys)):
        keys[index] = short_side(keys[index - 1], keys[index])

    def body_log(a, b):
        return (Rotation.from_quat(a).inv() * Rotation.from_quat(b)).as_rotvec()

    def times_exp(q, vector):
        angle = np.linalg.norm(vector)
        axis = vector / angle if angle > 0 else np.zeros(3)
        x, y, z = axis * np.sin(angle / 2)
        w = np.cos(angle / 2)
        # q * (x, y, z, w) by hand: SciPy would lose the sign.
        qv, qw = q[:3], q[3]
        v = np.array([x, y, z])
        return np.append(qw * v + w * qv + np.cross(qv, v), qw * w - np.dot(qv, v))

    spans = np.diff(times)
    ways = [body_log(a, b) for a, b in zip(keys, keys[1:])]

    def velocity(index):
        before = ways[index - 1] / spans[index - 1] if index > 0 else None
        after = ways[index] / spans[index] if index < len(spans) else None
        if before is None or after is None:
            return after if before is None else before
        before_span, after_span = spans[index - 1], spans[index]
        return (before_span * after + after_span * before) / (before_span + after_span)

    inner = []
    for gap, way in enumerate(ways):
        change = [velocity(gap) * spans[gap], velocity(gap + 1) * spans[gap]]
        inner.append((times_exp(keys[gap], (change[0] - way) / 2), times_exp(keys[gap + 1], (way - change[1]) / 2)))

    def at(time):
        gap = int(np.clip(np.searchsorted(times, time, side="right") - 1, 0, len(spans) - 1))
        t = (time - times[gap]) / spans[gap]
        outer = arc(keys[gap], keys[gap + 1], t)
        middle = arc(*inner[gap], t)
        return Rotation.from_quat(arc(outer, middle, 2 * t * (1 - t))).as_matrix()

    return at


def squad(a, b, before, after):
    keys = [(-1, before), (0, a), (1, b), (2, after)]
    keys = [(time, key) for time, key in keys if key is not None]
    return squad_through([key for _, key in keys], np.array([time for time, _ in keys], dtype=float))


def ways(a, b, before=None, after=None):
    """Every method by the word that posekit has for it."""
    found = {
        "slerp": slerp(a, b),
        "rawslerp": raw_slerp(a, b),
        "nlerp": nlerp(a, b),
        "lerp": raw_lerp(a, b),
        "matrix": matrix(a, b),
        "rotvec": rotation_vector(a, b),
        "squad": squad(a, b, before, after),
    }
    for order in TAIT_BRYAN:
        found[f"euler:{order}"] = euler(order, a, b)
    return found


def angle_deg(a, b):
    """Between the rotations nearest to two matrices."""
    return np.degrees((nearest_rotation(a).inv() * nearest_rotation(b)).magnitude())
