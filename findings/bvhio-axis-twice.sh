#!/usr/bin/env bash
# bvhio 1.5.4 reads a joint that turns about one axis twice wrong, without a word: each of the two channels gets
# the value of the last one. A joint with the channels Zrotation Xrotation Zrotation (proper Euler angles,
# which the BVH format allows and some exporters write) and the values 30, 40, 10 is read as 10, 40, 10.
#
# Needs Python 3 with pip. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q bvhio==1.5.4 scipy==1.15.3
cat > arm.bvh <<'BVH'
HIERARCHY
ROOT Arm
{
	OFFSET 0 0 0
	CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Zrotation
	JOINT Hand
	{
		OFFSET 0 1 0
		CHANNELS 3 Zrotation Xrotation Yrotation
		End Site
		{
			OFFSET 0 1 0
		}
	}
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 0 30 40 10 0 0 0
0 0 0 30 40 10 0 0 0
BVH
cat > read.py <<'PY'
import sys
import bvhio
from scipy.spatial.transform import Rotation

root = bvhio.readAsHierarchy("arm.bvh")
root.loadPose(0)
hand = root.Children[0].PositionWorld
found = [hand.x, hand.y, hand.z]
meant, swapped = (
    Rotation.from_euler("ZXZ", angles, degrees=True).apply([0, 1, 0]) for angles in ([30, 40, 10], [10, 40, 10])
)
near = lambda a, b: max(abs(x - y) for x, y in zip(a, b)) < 1e-4
show = lambda place: "(" + ", ".join(f"{value:.4f}" for value in place) + ")"
print("the hand is read at", show(found), "and should be at", show(meant))
print("the last value for both channels about Z gives", show(swapped))
sys.exit(0 if near(found, swapped) and not near(found, meant) else 1)
PY
venv/bin/python -W ignore read.py
