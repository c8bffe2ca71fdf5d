#!/usr/bin/env python3
"""Cyclic coordinate descent in NumPy, written apart from posekit: the numbers that its tests compare with.

    tools/ik_reference.py FILE --start RootJoint --end lWrist_end --target 0.5,0.75,0.5 --root 0,0.931395,0

Prints a JSON object: the distance that is left after each of the iterations asked for, for sweeps from the
tip and from the base. The figure is at rest, its root joint where --root says. The start joint keeps its
place and its orientation; every joint between it and the end turns, rigidly, by the angle between the vector
to the end and the vector to the target about their cross product.

Rotations are matrices (Rodrigues), positions of the chain are turned one by one: no quaternion, no linkage,
nothing in common with the solver but the definition.
"""

import argparse
import json

import numpy as np


def read_hierarchy(path):
    names, parents, offsets, stack, name = [], [], [], [], None
    with open(path, encoding="latin-1") as file:
        for line in file:
            words = line.split()
            if not words:
                continue
            if words[0] in ("ROOT", "JOINT"):
                name = words[1]
            elif words[:2] == ["End", "Site"]:
                name = names[stack[-1]] + "_end"
            elif words[0] == "{":
                parents.append(stack[-1] if stack else -1)
                stack.append(len(names))
                names.append(name)
                offsets.append(np.zeros(3))
            elif words[0] == "OFFSET":
                offsets[stack[-1]] = np.array([float(word) for word in words[1:4]])
            elif words[0] == "}":
                stack.pop()
            elif words[0] == "MOTION":
                break
    return names, parents, offsets


def path_between(parents, start, end):
    """Joints from the start up to the common ancestor and down to the end."""
    up, down = [start], [end]
    while parents[up[-1]] >= 0:
        up.append(parents[up[-1]])
    while parents[down[-1]] >= 0:
        down.append(parents[down[-1]])
    top = next(joint for joint in up if joint in down)
    climbing = up[: up.index(top) + 1]
    return climbing, down[: down.index(top)][::-1]


def rotation_matrix(axis, angle):
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def ccd(positions, pivots, target, iterations, from_base):
    """Turns the chain about each of its pivots (indices into positions) in turn; the distance after each
    iteration."""
    positions = positions.copy()
    left = []
    for _ in range(iterations):
        for pivot in pivots if from_base else reversed(pivots):
            at = positions[pivot]
            a, b = positions[-1] - at, target - at
            axis = np.cross(a, b)
            sine, cosine = np.linalg.norm(axis), a @ b
            if sine > 1e-15 * np.linalg.norm(a) * np.linalg.norm(b):
                turn = rotation_matrix(axis / sine, np.arctan2(sine, cosine))
                positions[pivot + 1 :] = (positions[pivot + 1 :] - at) @ turn.T + at
        left.append(float(np.linalg.norm(positions[-1] - target)))
    return left


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file")
    parser.add_argument("--start", default="RootJoint")
    parser.add_argument("--end", default="lWrist_end")
    parser.add_argument("--target", default="0.5,0.75,0.5")
    parser.add_argument("--root", default="0,0,0")
    parser.add_argument("--iterations", type=int, default=20)
    arguments = parser.parse_args()
    names, parents, offsets = read_hierarchy(arguments.file)
    vector = lambda text: np.array([float(number) for number in text.split(",")])
    places = []
    for parent, offset in zip(parents, offsets):
        places.append(vector(arguments.root) if parent < 0 else places[parent] + offset)
    climbing, descending = path_between(parents, names.index(arguments.start), names.index(arguments.end))
    chain = climbing + descending
    positions = np.array([places[joint] for joint in chain])
    # The link at the top of a chain that climbs is rigid: nothing bends there. Neither at the start.
    rigid = {0, len(chain) - 1} | ({len(climbing) - 1} if len(climbing) > 1 else set())
    pivots = [index for index in range(len(chain)) if index not in rigid]
    run = lambda from_base: ccd(
        positions, pivots, vector(arguments.target), arguments.iterations, from_base
    )
    print(json.dumps({"tip_to_base": run(False), "base_to_tip": run(True)}))


if __name__ == "__main__":
    main()
