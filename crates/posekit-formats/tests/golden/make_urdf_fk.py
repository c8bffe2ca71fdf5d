"""Forward kinematics of the URDF files beside this script, and of our sample robots, by Pinocchio.

Writes urdf_fk.json: for each file, some rows of joint values and where every link then is, in the file's
own axes, and for the arms the Jacobian of the tip. Pinocchio reads the file itself, so reader and kinematics are both independent of ours; followers
are given their values by the two lines below that know the multipliers.

    pip install pin
    python3 make_urdf_fk.py
"""

import json
import pathlib

import numpy as np
import pinocchio as pin

HERE = pathlib.Path(__file__).parent
SAMPLES = HERE / "../../src/urdf/sample"
FILES = ["all_joint_kinds.urdf", "planar2.urdf", "arm6.urdf", "arm7.urdf"]
TIPS = {"planar2.urdf": "tip", "arm6.urdf": "tool", "arm7.urdf": "tool"}
ROWS = 5


def rotation_vector_to_quaternion(vector):
    return pin.Quaternion(pin.exp3(np.asarray(vector))).coeffs()


def configuration(model, values):
    """Pinocchio's own coordinates: cosine and sine for endless turns, quaternions for free ones."""
    q = pin.neutral(model)
    for joint_id in range(1, model.njoints):
        joint, name = model.joints[joint_id], model.names[joint_id]
        numbers = values[name]
        at = slice(joint.idx_q, joint.idx_q + joint.nq)
        if joint.nq == joint.nv == 1:
            q[at] = numbers
        elif joint.nv == 1:
            q[at] = [np.cos(numbers[0]), np.sin(numbers[0])]
        elif joint.nv == 3:
            q[at] = [numbers[0], numbers[1], np.cos(numbers[2]), np.sin(numbers[2])]
        else:
            q[at] = [*numbers[:3], *rotation_vector_to_quaternion(numbers[3:])]
    return q


def random_values(model, random):
    values = {}
    for joint_id in range(1, model.njoints):
        joint = model.joints[joint_id]
        if joint.nq == 1:
            low = model.lowerPositionLimit[joint.idx_q]
            high = model.upperPositionLimit[joint.idx_q]
            numbers = random.uniform(low, high, 1)
        else:
            numbers = random.uniform(-1.2, 1.2, joint.nv)
        values[model.names[joint_id]] = [round(float(number), 6) for number in numbers]
    if "oppose" in values:
        values["spin"] = [2.0 * values["lift"][0] - 0.1]
        values["oppose"] = [-0.5 * values["spin"][0] + 0.25]
    return values


def jacobian(model, data, values, tip):
    """By joint, the tip's velocity and angular velocity in the world for unit speed, and the singular values
    of all with a radian counting as much as half a metre, largest first."""
    pin.computeJointJacobians(model, data, configuration(model, values))
    frame = model.getFrameId(tip)
    columns = pin.getFrameJacobian(model, data, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
    scaled = np.diag([1, 1, 1, 0.5, 0.5, 0.5]) @ columns
    numbers = lambda array: [float(f"{number:.12g}") for number in array]
    return {
        "jacobian": {
            model.names[joint_id]: numbers(columns[:, model.joints[joint_id].idx_v])
            for joint_id in range(1, model.njoints)
        },
        "singular_values": numbers(np.linalg.svd(scaled, compute_uv=False)),
    }


def main():
    random = np.random.default_rng(20240601)
    out = {"pinocchio": pin.__version__, "files": []}
    for file in FILES:
        path = HERE / file if (HERE / file).exists() else SAMPLES / file
        model = pin.buildModelFromUrdf(str(path))
        data = model.createData()
        rows = []
        for _ in range(ROWS):
            values = random_values(model, random)
            pin.framesForwardKinematics(model, data, configuration(model, values))
            links = {}
            for frame_id, frame in enumerate(model.frames):
                if frame.type == pin.FrameType.BODY:
                    placed = data.oMf[frame_id]
                    quaternion = pin.Quaternion(placed.rotation).coeffs()
                    numbers = [*placed.translation, *quaternion]
                    links[frame.name] = [float(f"{number:.12g}") for number in numbers]
            row = {"values": values, "links": links}
            if file in TIPS:
                row |= jacobian(model, data, values, TIPS[file])
            rows.append(row)
        out["files"].append({"file": file, "rows": rows})
    text = json.dumps(out).replace('{"values"', '\n{"values"').replace('{"file"', '\n{"file"')
    (HERE / "urdf_fk.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
