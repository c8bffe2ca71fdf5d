#!/usr/bin/env bash
# Quaternion.slerp of pyquaternion 0.9.9 changes the quaternions that it is given: it normalises both in place, and where
# they lie on opposite halves of the sphere it negates the *first* of them in place. Sampling a list of keys thus rewrites the
# keys: signs that were made consistent for a spline, a filter or a network are no longer so afterwards, and the result
# of such a step depends on which times were sampled before.
#
# Needs Python 3 with pip. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q pyquaternion==0.9.9 numpy==2.2.6
cat > keys.py <<'PY'
import sys
from pyquaternion import Quaternion

first = Quaternion(axis=[0, 0, 1], degrees=10)
second = -Quaternion(axis=[0, 0, 1], degrees=50)
long = Quaternion(2, 0, 0, 0)
before = [first.elements.copy(), second.elements.copy(), long.elements.copy()]
Quaternion.slerp(first, second, 0.5)
Quaternion.slerp(long, first, 0.5)
negated = abs(first.elements + before[0]).max() < 1e-12
kept = abs(second.elements - before[1]).max() < 1e-12
normalised = abs(long.elements).max() < 1.5
print(f"first key  {before[0].round(3)} -> {first.elements.round(3)}")
print(f"second key {before[1].round(3)} -> {second.elements.round(3)}")
print(f"a key of length 2 {before[2]} -> {long.elements.round(3)}")
sys.exit(0 if negated and kept and normalised else 1)
PY
venv/bin/python keys.py
