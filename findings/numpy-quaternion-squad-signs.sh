#!/usr/bin/env bash
# quaternion.squad of numpy-quaternion 2024.0.13 takes the signs of its keys as they are, while slerp of the same package
# goes the short way whatever the signs. q and -q are one rotation, and keys that come out of matrices, Euler angles or a
# capture system change sign from frame to frame: with one sign changed, squad through 0, 1, 2, 3 radians about one axis leaves
# them by 0.39 radians (22 degrees). Call unflip_rotors on the keys first.
#
# Needs Python 3 with pip. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q numpy-quaternion==2024.0.13 numpy==2.2.6 scipy==1.15.3
cat > way.py <<'PY'
import sys
import numpy as np
import quaternion

keys = quaternion.from_rotation_vector([[0, 0, angle] for angle in (0.0, 1.0, 2.0, 3.0)])
signs = keys * np.array([1, -1, 1, 1])  # the same rotations
key_times, times = np.arange(4.0), np.array([0.5, 1.5, 2.5])


def error(result):
    """The angle in radians between the result and the turn that the keys describe, which is t radians at time t."""
    truth = quaternion.from_rotation_vector([[0, 0, t] for t in times])
    return np.array([quaternion.rotation_intrinsic_distance(a, b) for a, b in zip(result, truth)])


plain = error(quaternion.squad(keys, key_times, times))
changed = error(quaternion.squad(signs, key_times, times))
mended = error(quaternion.squad(quaternion.unflip_rotors(signs), key_times, times))
short = quaternion.rotation_intrinsic_distance(
    quaternion.slerp(signs[0], signs[1], 0, 1, 0.5), quaternion.slerp(keys[0], keys[1], 0, 1, 0.5)
)
print(f"squad, signs alike: off by {plain.round(6)} radians at {times}")
print(f"squad, one sign changed: off by {changed.round(3)}")
print(f"squad after unflip_rotors: off by {mended.round(6)}")
print(f"slerp, one sign changed: off by {short:.6f}")
sys.exit(0 if plain.max() < 1e-6 and 0.3 < changed.max() < 0.5 and mended.max() < 1e-6 and short < 1e-6 else 1)
PY
venv/bin/python way.py
