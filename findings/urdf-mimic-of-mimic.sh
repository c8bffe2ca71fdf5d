#!/usr/bin/env bash
# A URDF joint may mimic a joint that itself mimics another, as the second phalanx of a finger does. urchin 0.0.30 and
# yourdfpy 0.0.60 both know <mimic>, and both look up only the values that the caller gave: the joint at the end of such a
# chain takes its source as 0 and stands still, without a word. kinpy 0.6.1 and pytransform3d 3.17.0 let
# every mimic joint stand at 0 unless it is given a value of its own.
#
# Needs Python 3 with pip. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q yourdfpy==0.0.60 urchin==0.0.30 kinpy==0.6.1 pytransform3d==3.17.0
cat > finger.py <<'PY'
import logging
import sys
import warnings

import numpy as np

warnings.filterwarnings("ignore")
logging.disable(logging.CRITICAL)
import kinpy
import yourdfpy
from pytransform3d.urdf import UrdfTransformManager
from urchin import URDF


def joint(name, child, mimic=""):
    return f"""<link name="{child}"/><joint name="{name}" type="revolute"><parent link="palm"/><child link="{child}"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/>{mimic}</joint>"""


# All three hang on the palm, so that the angle of a link is the value of its joint.
text = f"""<robot name="finger"><link name="palm"/>{joint("first", "a")}
{joint("second", "b", '<mimic joint="first" multiplier="0.5"/>')}
{joint("third", "c", '<mimic joint="second" multiplier="0.5"/>')}</robot>"""
with open("finger.urdf", "w") as file:
    file.write(text)


def angles(transform_of):
    return [round(float(np.arctan2(m[1, 0], m[0, 0])), 4) for m in map(transform_of, "abc")]


urchin = URDF.load("finger.urdf")
yourdf = yourdfpy.URDF.load("finger.urdf")
yourdf.update_cfg({"first": 0.8})
by_kinpy = kinpy.build_chain_from_urdf(text).forward_kinematics({"first": 0.8})
manager = UrdfTransformManager()
manager.load_urdf(text)
manager.set_joint("first", 0.8)
found = {
    "urchin": angles(lambda link: urchin.link_fk(cfg={"first": 0.8}, link=link)),
    "yourdfpy": angles(lambda link: yourdf.get_transform(link, "palm")),
    "kinpy": angles(lambda link: by_kinpy[link].matrix()),
    "pytransform3d": angles(lambda link: manager.get_transform(link, "palm")),
}
print("asked for: 0.8, 0.4, 0.2")
for name, values in found.items():
    print(f"{name}: {values}")
chain_cut, ignored = [0.8, 0.4, 0.0], [0.8, 0.0, 0.0]
as_said = found["urchin"] == found["yourdfpy"] == chain_cut and found["kinpy"] == found["pytransform3d"] == ignored
sys.exit(0 if as_said else 1)
PY
venv/bin/python finger.py
