"""Writes the inertials of our own robots into their files: of the shapes that are seen, each full and of the density of
water, which is what MuJoCo gives a shape that says nothing (1000 kg/m3). Shapes that overlap count twice.

    python3 make_inertials.py ../../src/urdf/sample/*.urdf
"""

import math
import pathlib
import re
import sys
import xml.etree.ElementTree as ET

import numpy as np

DENSITY = 1000.0


def turn(rpy):
    (sr, cr), (sp, cp), (sy, cy) = [(math.sin(a), math.cos(a)) for a in rpy]
    x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return z @ y @ x


def numbers(text):
    return np.array([float(word) for word in text.split()])


def body_of(visual):
    """Mass, centre in the link, inertia about the centre in the link's axes."""
    shape = visual.find("geometry")[0]
    if shape.tag == "box":
        x, y, z = numbers(shape.get("size"))
        mass = DENSITY * x * y * z
        own = mass / 12 * np.diag([y * y + z * z, x * x + z * z, x * x + y * y])
    elif shape.tag == "cylinder":
        r, h = float(shape.get("radius")), float(shape.get("length"))
        mass = DENSITY * math.pi * r * r * h
        across = mass * (3 * r * r + h * h) / 12
        own = np.diag([across, across, mass * r * r / 2])
    else:
        r = float(shape.get("radius"))
        mass = DENSITY * 4 / 3 * math.pi * r**3
        own = 0.4 * mass * r * r * np.eye(3)
    origin = visual.find("origin")
    xyz = numbers(origin.get("xyz", "0 0 0")) if origin is not None else np.zeros(3)
    rot = turn(numbers(origin.get("rpy", "0 0 0"))) if origin is not None else np.eye(3)
    return mass, xyz, rot @ own @ rot.T


def inertial(link):
    bodies = [body_of(visual) for visual in link.findall("visual")]
    if not bodies:
        return None
    mass = sum(m for m, _, _ in bodies)
    centre = sum(m * c for m, c, _ in bodies) / mass
    whole = np.zeros((3, 3))
    for m, c, own in bodies:
        arm = c - centre
        whole += own + m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    number = lambda x: f"{x + 0.0:.6g}" if abs(x) > 1e-12 else "0"
    xyz = " ".join(number(x) for x in centre)
    parts = [("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2)]
    tensor = " ".join(f'{name}="{number(whole[a, b])}"' for name, a, b in parts)
    return f'    <inertial><origin xyz="{xyz}"/><mass value="{number(mass)}"/><inertia {tensor}/></inertial>\n'


def main():
    for name in sys.argv[1:]:
        path = pathlib.Path(name)
        text = re.sub(r"    <inertial>.*?</inertial>\n", "", path.read_text())
        for link in ET.fromstring(text).findall("link"):
            line = inertial(link)
            if line:
                head = f'  <link name="{link.get("name")}">\n'
                assert head in text, (name, head)
                text = text.replace(head, head + line)
        path.write_text(text)


main()
