#!/usr/bin/env bash
# kinpy 0.6.1 turns a URDF joint that has no <axis> about Z. The element is optional and its default is X ("1 0 0"), which urchin
# 0.0.30, yourdfpy 0.0.60 and pytransform3d 3.17.0 take.
#
# Needs Python 3 with pip. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q kinpy==0.6.1 urchin==0.0.30 scipy==1.15.3
cat > hinge.py <<'PY'
import sys

import kinpy
import numpy as np
from scipy.spatial.transform import Rotation
from urchin import URDF

text = """<robot name="hinge"><link name="base"/><link name="leaf"/><joint name="j" type="revolute"><parent link="base"/>
<child link="leaf"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
with open("hinge.urdf", "w") as file:
    file.write(text)


def turn(matrix):
    return np.round(Rotation.from_matrix(matrix[:3, :3]).as_rotvec(), 6) + 0.0


by_kinpy = turn(kinpy.build_chain_from_urdf(text).forward_kinematics({"j": 0.5})["leaf"].matrix())
by_urchin = turn(URDF.load("hinge.urdf").link_fk(cfg={"j": 0.5}, link="leaf"))
print(f"rotation vector at 0.5: kinpy {by_kinpy}, urchin {by_urchin}")
sys.exit(0 if np.allclose(by_kinpy, [0, 0, 0.5]) and np.allclose(by_urchin, [0.5, 0, 0]) else 1)
PY
venv/bin/python hinge.py
