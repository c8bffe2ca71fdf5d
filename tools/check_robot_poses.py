#!/usr/bin/env python3
"""Checks what posekit's robot solver found by Pinocchio's forward kinematics and the limits in the file.

    pip install pin
    cargo build --release -p posekit-formats --example robot_poses
    tools/check_robot_poses.py arm.urdf TIP_LINK [COUNT]

Prints how many poses were solved, the largest misses of position and orientation over those, and how many
values lie outside the limits that Pinocchio reads. Robots whose joints all turn or slide about one axis.
Exits 1 when a pose that was said to be solved is not.
"""

import json
import pathlib
import subprocess
import sys

import numpy as np
import pinocchio as pin

PROGRAM = pathlib.Path(__file__).parent.parent / "target/release/examples/robot_poses"
#: What the solver promises (1e-6), and rounding.
MOST = 1.01e-6


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    file, tip = sys.argv[1:3]
    count = sys.argv[3] if len(sys.argv) > 3 else "1000"
    program = subprocess.run([PROGRAM, file, tip, count], check=True, capture_output=True, text=True)
    model = pin.buildModelFromUrdf(file)
    data, frame = model.createData(), model.getFrameId(tip)
    solved, poses, outside = 0, 0, 0
    worst_position, worst_angle = 0.0, 0.0
    for line in program.stdout.splitlines():
        found = json.loads(line)
        poses += 1
        q = pin.neutral(model)
        for name, [value] in found["values"].items():
            joint = model.joints[model.getJointId(name)]
            if joint.nq == 2:
                q[joint.idx_q : joint.idx_q + 2] = np.cos(value), np.sin(value)
                continue
            q[joint.idx_q] = value
            low, high = model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q]
            outside += not low - 1e-12 <= value <= high + 1e-12
        if not found["solved"]:
            continue
        solved += 1
        pin.framesForwardKinematics(model, data, q)
        placed = data.oMf[frame]
        wanted = pin.Quaternion(*np.roll(found["orientation"], 1)).toRotationMatrix()
        angle = np.linalg.norm(pin.log3(wanted.T @ placed.rotation))
        distance = np.linalg.norm(placed.translation - found["position"])
        worst_position, worst_angle = max(worst_position, distance), max(worst_angle, angle)
    print(
        f"{solved} of {poses} solved; by Pinocchio's forward kinematics at most {worst_position:.2e} m and "
        f"{worst_angle:.2e} rad off; {outside} values outside limits"
    )
    sys.exit(1 if outside > 0 or worst_position > MOST or worst_angle > MOST else 0)


if __name__ == "__main__":
    main()
