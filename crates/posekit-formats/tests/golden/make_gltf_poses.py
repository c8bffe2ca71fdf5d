"""Where the joints of glTF files are, at rest and in their animations, by NumPy and nothing of ours.

Writes gltf_poses.json: for the real rigs of ../shared/data/rigs, the small inputs of ../shared/cases, and for
spline.gltf and sparse.gltf, which it makes, where every joint of the first skin (every node, where there is none) is in
the world. Whole 4 x 4 matrices with all scales are multiplied down from
the scene's roots, as section 3.5.3 of the glTF 2.0 specification says; animations are sampled as appendix C
says, each sampler by its own few lines.

    python3 make_gltf_poses.py ../../../../../shared
"""

import base64
import json
import pathlib
import struct
import sys

import numpy as np

HERE = pathlib.Path(__file__).parent
TYPES = {5120: ("i1", 127.0), 5121: ("u1", 255.0), 5122: ("<i2", 32767.0), 5123: ("<u2", 65535.0), 5126: ("<f4", None)}
INDICES = {5121: "u1", 5123: "<u2", 5125: "<u4"}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}
# File, and what of its animations is sampled: name and times in seconds.
RIGS = {
    "rig-human.glb": [],
    "rig-fox.glb": [],
    "fox-animations.glb": [("Bark", [0.0, 0.31, 0.9]), ("Howl", [0.777])],
    "knight.glb": [("1H_Melee_Attack_Chop", [0.0, 0.4567]), ("Walking_A", [0.1, 0.71])],
}
CASES = {
    "cubic_rotation.gltf": [("Swing", [0.0, 0.3, 0.5, 1.0])],
    "cubic_sign.gltf": [("Swing", [0.0, 0.25, 0.5, 0.9, 1.0])],
    "mirror_scale.gltf": [("Wave", [0.0, 0.5, 1.0])],
    "mixamo_like.gltf": [("mixamo.com", [0.0, 0.25, 1.0])],
    "step_keys.gltf": [("Snap", [0.0, 0.2, 0.25, 0.6]), ("Late", [0.0, 2.0, 2.5, 3.0])],
}


def load(path):
    data = path.read_bytes()
    if data[:4] != b"glTF":
        document = json.loads(data)
        uri = document["buffers"][0]["uri"]
        return document, base64.b64decode(uri.split(",", 1)[1])
    length = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20:20 + length]), data[20 + length + 8:]


def accessor(document, binary, index):
    said = document["accessors"][index]
    kind, most = TYPES[said["componentType"]]
    width = WIDTHS[said["type"]]

    def rows(of, kind, width, count):
        view = document["bufferViews"][of["bufferView"]]
        start = view.get("byteOffset", 0) + of.get("byteOffset", 0)
        stride = view.get("byteStride", width * np.dtype(kind).itemsize)
        return np.array([np.frombuffer(binary, kind, width, start + row * stride) for row in range(count)])

    numbers = np.zeros((said["count"], width))
    if "bufferView" in said:
        numbers = rows(said, kind, width, said["count"]).astype(np.float64)
    if "sparse" in said:
        sparse = said["sparse"]
        places = rows(sparse["indices"], INDICES[sparse["indices"]["componentType"]], 1, sparse["count"])
        numbers[places[:, 0]] = rows(sparse["values"], kind, width, sparse["count"])
    return numbers if most is None else np.maximum(numbers / most, -1.0)


def slerp(a, b, t):
    dot = a @ b
    if dot < 0.0:
        b, dot = -b, -dot
    angle = np.arccos(min(dot, 1.0))
    if angle < 1e-9:
        return a
    return (np.sin((1 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle)


def sample(document, binary, sampler, path, time):
    times = accessor(document, binary, sampler["input"])[:, 0]
    values = accessor(document, binary, sampler["output"])
    kind = sampler.get("interpolation", "LINEAR")
    if kind == "CUBICSPLINE":
        values = values.reshape(len(times), 3, -1)
    time = np.clip(time, times[0], times[-1])
    k = min(np.searchsorted(times, time, side="right") - 1, len(times) - 1)
    if k == len(times) - 1:
        value = values[k] if kind != "CUBICSPLINE" else values[k][1]
    else:
        secs = times[k + 1] - times[k]
        t = (time - times[k]) / secs
        if kind == "STEP":
            value = values[k]
        elif kind == "LINEAR":
            value = slerp(values[k], values[k + 1], t) if path == "rotation" else (1 - t) * values[k] + t * values[k + 1]
        else:
            value = (
                (2 * t**3 - 3 * t**2 + 1) * values[k][1]
                + secs * (t**3 - 2 * t**2 + t) * values[k][2]
                + (-2 * t**3 + 3 * t**2) * values[k + 1][1]
                + secs * (t**3 - t**2) * values[k + 1][0]
            )
    return value / np.linalg.norm(value) if path == "rotation" else value


def matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1]), dtype=np.float64)
    turn = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])
    whole = np.eye(4)
    whole[:3, :3] = turn @ np.diag(node.get("scale", [1, 1, 1]))
    whole[:3, 3] = node.get("translation", [0, 0, 0])
    return whole


def positions(document, binary, animation=None, time=0.0):
    nodes = [dict(node) for node in document["nodes"]]
    for channel in animation["channels"] if animation else []:
        target = channel["target"]
        sampler = animation["samplers"][channel["sampler"]]
        nodes[target["node"]][target["path"]] = sample(document, binary, sampler, target["path"], time)
    parents = {child: parent for parent, node in enumerate(nodes) for child in node.get("children", [])}

    def world(index):
        above = world(parents[index]) if index in parents else np.eye(4)
        return above @ matrix(nodes[index])

    joints = document["skins"][0]["joints"] if "skins" in document else range(len(nodes))
    return {nodes[joint]["name"]: [round(float(x), 6) for x in world(joint)[:3, 3]] for joint in joints}


def make_spline(path):
    """A small rig with what the real ones have not: cubic splines, whole numbers, a matrix, scales, a node between."""
    random = np.random.default_rng(20)
    binary, views, accessors = b"", [], []

    def add(numbers, kind, component, width, normalized=False):
        nonlocal binary
        data = np.asarray(numbers).astype(kind).tobytes()
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        accessors.append({
            "bufferView": len(views) - 1, "componentType": component, "type": width,
            "count": np.asarray(numbers).shape[0] if np.asarray(numbers).ndim > 1 else len(numbers),
            **({"normalized": True} if normalized else {}),
        })
        binary += data + b"\0" * (-len(data) % 4)
        return len(accessors) - 1

    def near_quaternions(count, spread):
        out = np.zeros((count, 4))
        current = np.array([0.0, 0.0, 0.0, 1.0])
        for row in range(count):
            current = current + random.normal(0, spread, 4)
            current /= np.linalg.norm(current)
            out[row] = current
        return out

    times = add([0.0, 0.4, 1.1, 1.5], "<f4", 5126, "SCALAR")
    turns = near_quaternions(4, 0.3)
    cubic_turns = np.stack([random.normal(0, 0.5, (4, 4)), turns, random.normal(0, 0.5, (4, 4))], axis=1).reshape(12, 4)
    cubic_places = random.normal(0, 0.4, (12, 3))
    short_turns = np.round(near_quaternions(4, 0.4) * 32767)
    samplers = [
        {"input": times, "output": add(cubic_turns, "<f4", 5126, "VEC4"), "interpolation": "CUBICSPLINE"},
        {"input": times, "output": add(cubic_places, "<f4", 5126, "VEC3"), "interpolation": "CUBICSPLINE"},
        {"input": times, "output": add(short_turns, "<i2", 5122, "VEC4", True), "interpolation": "LINEAR"},
        {"input": times, "output": add(near_quaternions(4, 0.5), "<f4", 5126, "VEC4"), "interpolation": "STEP"},
    ]
    turned = matrix({"rotation": [0.0, 0.6, 0.0, 0.8], "scale": [0.5] * 3, "translation": [0.3, 0.1, -0.2]})
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [5]}],
        "nodes": [
            {"name": "tip", "translation": [0.0, 0.7, 0.1]},
            {"name": "fore", "translation": [0.1, 1.0, 0.0], "rotation": [0.6, 0.0, 0.0, 0.8], "children": [2]},
            {"name": "between", "matrix": [round(float(x), 9) for x in turned.T.flatten()], "children": [0]},
            {"name": "upper", "translation": [0.0, 0.5, 0.0], "scale": [2.0] * 3, "children": [1]},
            {"name": "hip", "translation": [0.0, 0.9, 0.0], "children": [3]},
            {"name": "Armature", "rotation": [-0.5, 0.5, 0.5, 0.5], "scale": [0.1] * 3, "translation": [1.0, 2.0, 3.0],
             "children": [4]},
        ],
        "skins": [{"joints": [0, 1, 3, 4]}],
        "animations": [{
            "name": "all kinds", "samplers": samplers,
            "channels": [
                {"sampler": sampler, "target": {"node": node, "path": where}}
                for sampler, node, where in [(0, 4, "rotation"), (1, 4, "translation"), (2, 3, "rotation"), (3, 1, "rotation")]
            ],
        }],
        "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(binary), "uri": "data:application/octet-stream;base64," + base64.b64encode(binary).decode()}],
    }
    path.write_text(json.dumps(document, indent=1) + "\n")


def make_sparse(path):
    """Sparse accessors of all kinds of index, over a view and over none; keys whose signs go the long way; late keys."""
    random = np.random.default_rng(21)
    binary, views, accessors = b"", [], []

    def view(numbers, kind):
        nonlocal binary
        data = np.asarray(numbers).astype(kind).tobytes()
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data + b"\0" * (-len(data) % 4)
        return len(views) - 1

    def add(count, width, base=None, places=None, values=None, index=5121):
        said = {"componentType": 5126, "type": width, "count": count}
        if base is not None:
            said["bufferView"] = view(base, "<f4")
        if places is not None:
            said["sparse"] = {
                "count": len(places),
                "indices": {"bufferView": view(places, INDICES[index]), "componentType": index},
                "values": {"bufferView": view(values, "<f4")},
            }
        accessors.append(said)
        return len(accessors) - 1

    # Blender's times after a BVH import: the first is at 1/24 s.
    times = np.arange(1, 6) / 24
    turns = random.normal(0, 1, (5, 4))
    turns /= np.linalg.norm(turns, axis=1)[:, None]
    cubic = np.zeros((15, 4))
    cubic[1::3] = turns
    cubic[0::3] = random.normal(0, 6, (5, 4))
    cubic[2::3] = random.normal(0, 6, (5, 4))
    wrong = cubic.copy()
    wrong[[1, 5, 9]] = 0.5
    samplers = [
        {"input": add(5, "SCALAR", times), "output": add(15, "VEC4", wrong, [1, 5, 9], cubic[[1, 5, 9]], 5123),
         "interpolation": "CUBICSPLINE"},
        {"input": add(5, "SCALAR", times * 0 + 1, [0, 1, 2, 3, 4], times, 5125),
         "output": add(5, "VEC3", None, [2, 3], random.normal(0, 1, (2, 3)), 5121)},
        # No view at all: zeros.
        {"input": add(5, "SCALAR", times), "output": add(5, "VEC3")},
    ]
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "extensionsUsed": ["KHR_materials_unlit"], "extensionsRequired": ["KHR_materials_unlit"],
        "nodes": [
            {"name": "base", "translation": [0.0, 1.0, 0.0], "children": [1]},
            {"name": "middle", "translation": [0.5, 0.5, 0.0], "children": [2]},
            {"name": "end", "translation": [0.0, 1.0, 0.0], "children": [3]},
            {"name": "tip", "translation": [0.2, 0.0, 0.3]},
        ],
        "animations": [{
            "name": "sparse", "samplers": samplers,
            "channels": [
                {"sampler": sampler, "target": {"node": node, "path": where}}
                for sampler, node, where in [(0, 0, "rotation"), (1, 1, "translation"), (2, 2, "translation")]
            ],
        }],
        "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(binary), "uri": "data:application/octet-stream;base64," + base64.b64encode(binary).decode()}],
    }
    path.write_text(json.dumps(document, indent=1) + "\n")


def poses(path, wanted):
    document, binary = load(path)
    by_name = {animation.get("name"): animation for animation in document.get("animations", [])}
    return {
        "rest": positions(document, binary),
        "samples": [
            {"animation": name, "time_secs": time, "positions": positions(document, binary, by_name[name], time)}
            for name, times in wanted for time in times
        ],
    }


def main():
    shared = pathlib.Path(sys.argv[1])
    make_spline(HERE / "spline.gltf")
    make_sparse(HERE / "sparse.gltf")
    out = {name: poses(shared / "data" / "rigs" / name, wanted) for name, wanted in RIGS.items()}
    out |= {name: poses(shared / "cases" / name, wanted) for name, wanted in CASES.items()}
    out["spline.gltf"] = poses(HERE / "spline.gltf", [("all kinds", [-1.0, 0.0, 0.13, 0.4, 0.77, 1.3, 1.5, 9.0])])
    out["sparse.gltf"] = poses(HERE / "sparse.gltf", [("sparse", [0.0, 1 / 24, 0.06, 0.1, 0.13, 0.19, 1.0])])
    lines = [f"{json.dumps(name)}: {json.dumps(value)}" for name, value in out.items()]
    (HERE / "gltf_poses.json").write_text("{\n" + ",\n".join(lines) + "\n}\n")


main()
