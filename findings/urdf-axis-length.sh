#!/usr/bin/env bash
# Readers of URDF part where an <axis> is not of length 1, as "1 1 0" or "0 0 2" in files written by hand. The format says
# that it should be normalised, without saying what a reader does if it is not. urchin 0.0.30 and pytransform3d 3.17.0
# normalise it. kinpy 0.6.1 and yourdfpy 0.0.60 do so for turns and not for slides: along an axis of length 2 a joint
# slides twice as far as its value says. ikpy 4.2.1 does it for neither, and with a turn its "rotation" shears and scales all that
# hangs on the joint. None of them says a word.
#
# Needs Python 3 with pip. Exits 0 while this is so, 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install -q yourdfpy==0.0.60 urchin==0.0.30 kinpy==0.6.1 pytransform3d==3.17.0 ikpy==4.2.1
cat > axis.py <<'PY'
import logging
import sys
import warnings

import numpy as np

warnings.filterwarnings("ignore")
logging.disable(logging.CRITICAL)
import kinpy
import yourdfpy
from ikpy.chain import Chain
from pytransform3d.urdf import UrdfTransformManager
from urchin import URDF


def robot(kind, axis):
    text = f"""<robot name="r"><link name="base"/><link name="tip"/>
<joint name="j" type="{kind}"><parent link="base"/><child link="tip"/><axis xyz="{axis}"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
    with open("r.urdf", "w") as file:
        file.write(text)
    return text


def by_yourdfpy(_, value):
    read = yourdfpy.URDF.load("r.urdf")
    read.update_cfg({"j": value})
    return read.get_transform("tip", "base")


def by_pytransform3d(text, value):
    manager = UrdfTransformManager()
    manager.load_urdf(text)
    manager.set_joint("j", value)
    return manager.get_transform("tip", "base")


readers = {
    "kinpy": lambda text, value: kinpy.build_chain_from_urdf(text).forward_kinematics({"j": value})["tip"].matrix(),
    "urchin": lambda _, value: URDF.load("r.urdf").link_fk(cfg={"j": value}, link="tip"),
    "pytransform3d": by_pytransform3d,
    "yourdfpy": by_yourdfpy,
    "ikpy": lambda _, value: Chain.from_urdf_file("r.urdf", base_elements=["base"]).forward_kinematics([0, value]),
}
expected = {
    "kinpy": (0.5, True), "urchin": (0.25, True), "pytransform3d": (0.25, True), "yourdfpy": (0.5, True), "ikpy": (0.5, False),
}
as_said = True
for name, read in readers.items():
    slide = float(read(robot("prismatic", "0 0 2"), 0.25)[2, 3])
    turn = np.asarray(read(robot("revolute", "1 1 0"), 0.5))[:3, :3]
    rigid = bool(np.abs(turn @ turn.T - np.eye(3)).max() < 1e-6)
    print(f"{name}: a slide by 0.25 along an axis of length 2 goes {slide:.3f}; a turn about 1 1 0 is a rotation: {rigid}")
    as_said &= (round(slide, 6), rigid) == expected[name]
sys.exit(0 if as_said else 1)
PY
venv/bin/python axis.py
