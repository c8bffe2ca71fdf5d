#!/usr/bin/env python3
"""The solvers that linearise, in NumPy, written apart from posekit: the numbers that its tests compare with.

    tools/ik_jacobian_reference.py FILE --root 0,0.931395,0

Prints a JSON object: for each solver the distance that is left after 1, 5 and 20 iterations on a chain of a
BVH file's rest pose. The start joint keeps its place and its orientation; every other joint of the chain but
the end turns as a ball joint.

The definition is that of the module `ik::least_squares`, with its default settings: residuals in lengths of
the chain, a turn by the rotation vector w as the quaternion (w / 2, 1), made unit. Here the Jacobian is a dense
matrix, positions are carried along one by one with rotation matrices, singular values are LAPACK's, and systems
are solved by LU: nothing is in common with the solvers but the formulas.
"""

import argparse
import json

import numpy as np

from ik_reference import path_between, read_hierarchy

REPORTED = (1, 5, 20)


def cayley_matrix(vector):
    x, y, z = vector / 2
    n = 1 + x * x + y * y + z * z
    return (
        np.array(
            [
                [1 + x * x - y * y - z * z, 2 * (x * y - z), 2 * (x * z + y)],
                [2 * (x * y + z), 1 - x * x + y * y - z * z, 2 * (y * z - x)],
                [2 * (x * z - y), 2 * (y * z + x), 1 - x * x - y * y + z * z],
            ]
        )
        / n
    )


class Chain:
    """Positions of a chain whose last one is to reach a target; all but the last are pivots."""

    def __init__(self, positions, target):
        self.positions = positions.copy()
        self.target = target
        self.reach = np.linalg.norm(np.diff(positions, axis=0), axis=1).sum()

    def residual(self):
        return (self.target - self.positions[-1]) / self.reach

    def distance(self):
        return float(np.linalg.norm(self.target - self.positions[-1]))

    def jacobian(self):
        arms = self.positions[-1] - self.positions[:-1]
        return np.hstack([np.cross(np.eye(3), arm).T for arm in arms]) / self.reach

    def move(self, step):
        # From the tip on: each turn carries what is beyond it, where it was.
        for pivot in reversed(range(len(self.positions) - 1)):
            turn = cayley_matrix(step[3 * pivot : 3 * pivot + 3])
            at = self.positions[pivot]
            self.positions[pivot + 1 :] = (self.positions[pivot + 1 :] - at) @ turn.T + at


def shortened(step, most):
    largest = np.abs(step).max()
    return step * (most / largest) if largest > most else step


def clamped(residual, most):
    length = np.linalg.norm(residual)
    return residual * (most / length) if length > most else residual


def transpose(is_conjugate):
    memory = {}

    def solve(chain):
        e, jacobian = chain.residual(), chain.jacobian()
        gradient = jacobian.T @ e
        direction = gradient
        if is_conjugate and memory:
            old = memory["gradient"]
            share = max(0.0, gradient @ (gradient - old) / (old @ old))
            direction = gradient + share * memory["direction"]
            if gradient @ direction < 0:
                direction = gradient
        memory.update(gradient=gradient, direction=direction)
        gain = jacobian @ direction
        return shortened(direction * (gain @ e) / (gain @ gain), np.pi / 4)

    return solve


def damped(chain):
    e, jacobian = clamped(chain.residual(), 0.5), chain.jacobian()
    damping = 0.1**2 + np.linalg.norm(e)
    step = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + damping * np.eye(3), e)
    return shortened(step, np.pi / 4)


def selectively_damped(chain):
    most = np.pi / 4
    e, jacobian = clamped(chain.residual(), 0.5), chain.jacobian()
    left, values, right = np.linalg.svd(jacobian, full_matrices=False)
    effects = np.linalg.norm(jacobian, axis=0)
    step = np.zeros(jacobian.shape[1])
    for u, value, v in zip(left.T, values, right):
        carried = np.linalg.norm(u)
        added_up = np.abs(v) @ effects / value
        bound = min(1.0, carried / added_up) * most
        part = (u @ e) / value * v
        step += shortened(part, bound)
    return shortened(step, most)


def run(chain, solve):
    left = {}
    for iteration in range(1, max(REPORTED) + 1):
        if chain.distance() > 1e-15:
            chain.move(solve(chain))
        if iteration in REPORTED:
            left[iteration] = chain.distance()
    return left


def levenberg(chain):
    left, factor, growth = {}, 0.1, 2.0
    cost = chain.residual() @ chain.residual()
    for iteration in range(1, max(REPORTED) + 1):
        e, jacobian = chain.residual(), chain.jacobian()
        if cost > 1e-28:
            square = jacobian @ jacobian.T
            damping = factor * cost + 1e-13 * np.trace(square)
            step = jacobian.T @ np.linalg.solve(square + damping * np.eye(3), e)
            step = shortened(step, 1.0)
            foretold = e @ e - (e - jacobian @ step) @ (e - jacobian @ step)
            before = chain.positions.copy()
            chain.move(step)
            after = chain.residual() @ chain.residual()
            if after <= cost:
                ratio = (cost - after) / foretold
                factor *= np.clip(1 - (2 * ratio - 1) ** 3, 0.2, 2.0)
                growth, cost = 2.0, after
            else:
                chain.positions = before
                factor, growth = factor * growth, growth * 2
        if iteration in REPORTED:
            left[iteration] = chain.distance()
    return left


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("file")
    parser.add_argument("--start", default="RootJoint")
    parser.add_argument("--end", default="lWrist_end")
    parser.add_argument("--target", default="0.5,0.75,0.5")
    parser.add_argument("--root", default="0,0,0")
    arguments = parser.parse_args()
    names, parents, offsets = read_hierarchy(arguments.file)
    vector = lambda text: np.array([float(number) for number in text.split(",")])
    places = []
    for parent, offset in zip(parents, offsets):
        places.append(vector(arguments.root) if parent < 0 else places[parent] + offset)
    climbing, descending = path_between(
        parents, names.index(arguments.start), names.index(arguments.end)
    )
    if len(climbing) > 1:
        parser.error("a chain that goes down only")
    positions = np.array([places[joint] for joint in descending])
    target = vector(arguments.target)
    fresh = lambda: Chain(positions, target)
    print(
        json.dumps(
            {
                "transpose, steepest": run(fresh(), transpose(False)),
                "transpose, conjugate": run(fresh(), transpose(True)),
                "damped": run(fresh(), damped),
                "selectively damped": run(fresh(), selectively_damped),
                "levenberg": levenberg(fresh()),
            },
            indent=1,
        )
    )


if __name__ == "__main__":
    main()
