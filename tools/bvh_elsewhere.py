#!/usr/bin/env python3
"""Tries how other programs read BVH files that have one peculiarity each.

Run by hand, outside of CI; it tries those programs that are installed:

    python3.11 -m venv venv
    venv/bin/pip install scipy pybvh==0.9.0 bvhio==1.5.4 bvhtoolbox==0.1.3 bpy==5.0.1
    npm install three@0.187                     # in a folder that --node names
    apt-get install assimp-utils                # 5.2.5 in Debian 12
    venv/bin/python tools/bvh_elsewhere.py --node FOLDER [--posekit target/debug/posekit]

Every file is a small skeleton with random rows; where its joints should be is computed here with SciPy, from the
same description and not from the text. Printed is for each file and program the largest distance of a joint from there,
in units of about a bone, or the error. With --posekit each file goes through `posekit convert --for PROGRAM` first: then
all should be read right, up to what the program cannot hold. The table in docs/conventions-elsewhere.md, which
crates/posekit-formats/src/bvh/elsewhere/rules.rs holds, says what came out.
"""

import argparse
import contextlib
import importlib
import importlib.metadata
import io
import json
import multiprocessing
import os
import re
import shutil
import subprocess
import tempfile
import warnings
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

POSITIONS = "Xposition Yposition Zposition"
ZXY = "Zrotation Xrotation Yrotation"
SIX = f"{POSITIONS} {ZXY}"
FRAMES = 6
SECONDS = 20  # what a program may take


def joint(name, offset, channels, children=(), end="Site"):
    return {
        "name": name,
        "offset": offset,
        "channels": channels.split(),
        "children": list(children),
        "end": end,
    }


def figure(names=("Hips", "Spine", "Head"), root_offset=(0, 0, 0), root=SIX, spine=ZXY, end="Site"):
    head = joint(names[2], (0, 0.5, 0.2), ZXY, end=end)
    limbs = [joint(names[1], (0, 1, 0), spine, [head]), joint("Leg", (0.3, -1, 0), ZXY)]
    return [joint(names[0], root_offset, root, limbs)]


def flat(roots):
    """All joints with the index of their parent, depth first."""
    found = []

    def walk(node, parent):
        found.append((node, parent))
        me = len(found) - 1
        for child in node["children"]:
            walk(child, me)

    for root in roots:
        walk(root, -1)
    return found


def random_rows(roots, seed=5):
    generator = np.random.default_rng(seed)
    rows = []
    for _ in range(FRAMES):
        row = []
        for node, parent in flat(roots):
            for channel in node["channels"]:
                if channel.lower().endswith("rotation"):
                    value = generator.uniform(-40, 40)
                elif parent < 0:
                    value = generator.uniform(-2, 2)
                else:
                    rest = node["offset"]["xyz".index(channel[0].lower())]
                    value = 1.5 * rest + generator.uniform(-0.1, 0.1)
                row.append(round(float(value), 4))
        rows.append(row)
    return rows


def text_of(roots, rows):
    lines = ["HIERARCHY"]

    def write(node, keyword):
        lines.extend([f"{keyword} {node['name']}", "{"])
        lines.append("OFFSET " + " ".join(map(str, node["offset"])))
        lines.append(" ".join(["CHANNELS", str(len(node["channels"])), *node["channels"]]))
        for child in node["children"]:
            write(child, "JOINT")
        if not node["children"]:
            lines.extend([f"End {node['end']}", "{", "OFFSET 0 1 0", "}"])
        lines.append("}")

    for root in roots:
        write(root, "ROOT")
    lines.extend(["MOTION", f"Frames: {len(rows)}", "Frame Time: 0.04"])
    lines.extend(" ".join(map(str, row)) for row in rows)
    return "\n".join(lines) + "\n"


def places(roots, rows):
    """Where all joints are: position channels replace the OFFSET, as posekit reads by default."""
    frames = []
    for row in rows:
        values = iter(row)
        points, turns = [], []
        for node, parent in flat(roots):
            local, turn = np.array(node["offset"], float), Rotation.identity()
            for channel in node["channels"]:
                value, axis = next(values), channel[0].lower()
                if channel.lower().endswith("position"):
                    local["xyz".index(axis)] = value
                else:
                    turn = turn * Rotation.from_euler(axis.upper(), value, degrees=True)
            if parent >= 0:
                local = points[parent] + turns[parent].apply(local)
                turn = turns[parent] * turn
            points.append(local)
            turns.append(turn)
        frames.append(points)
    return np.array(frames)


def cases():
    """Name, text and right places of every file."""
    made = {}

    def add(name, roots, change=lambda text: text):
        rows = random_rows(roots)
        made[name] = (change(text_of(roots, rows)), places(roots, rows))

    def named(*names):
        return figure(names)

    add("plain", figure())
    add("root offset", figure(root_offset=(0, 5, 1)))
    add("joint positions", figure(spine=SIX))
    add("one position", figure(root_offset=(0, 1, 0), root=f"Yposition {ZXY}"))
    add("two positions", figure(root_offset=(0, 1, 0), root=f"Xposition Zposition {ZXY}"))
    add("three positions, one rotation", figure(root=f"{POSITIONS} Zrotation"))
    add("two positions, four rotations", figure(root=f"Xposition Yposition {ZXY} Zrotation"))
    add("positions in another order", figure(root=f"Zposition Xposition Yposition {ZXY}"))
    add("rotations first", figure(root=f"{ZXY} {POSITIONS}"))
    add("no root position", figure(root_offset=(0, 1, 0), root=ZXY))
    add("no rotation", figure(spine=""))
    add("one rotation", figure(spine="Xrotation"))
    add("two rotations", figure(spine="Zrotation Xrotation"))
    add("four rotations", figure(spine=f"{ZXY} Zrotation"))
    add("an axis twice", figure(spine="Zrotation Xrotation Zrotation"))
    add("each joint its order", figure(spine="Xrotation Yrotation Zrotation"))
    add("blank in a name", named("Hips", "Left Arm", "Head"))
    add("names equal to the blank", named("Hips", "Left Arm", "Left Hand"))
    add("names equal", named("Hips", "Spine", "Spine"))
    add("colon in names", named("mixamorig:Hips", "mixamorig:Spine", "Head"))
    add("slash in a name", named("Hips", "a/b", "Head"))
    add("bracket in a name", named("Hips", "Spine[0]", "Head"))
    add("dot in a name", named("Hips", "Spine.001", "Head"))
    add("name ends in .bones", named("Hips", "Spine.bones", "Head"))
    add("name of 70 bytes", named("Hips", "S" * 70, "Head"))
    add("several roots", figure() + figure(("Hips2", "Spine2", "Head2")))
    add("no frames", figure(), lambda text: text.split("Frames:")[0] + "Frames: 0\nFrame Time: 0.04\n")
    add("frame time 0", figure(), lambda text: text.replace("Time: 0.04", "Time: 0"))
    add("fewer frames announced", figure(), lambda text: text.replace("Frames: 6", "Frames: 4"))
    add("channels in capitals", figure(root="XPOSITION YPOSITION ZPOSITION ZROTATION XROTATION YROTATION"))
    add("keywords in other capitals", figure(), lambda text: text.replace("HIERARCHY", "Hierarchy"))
    add("no blank after Frames:", figure(), lambda text: text.replace("Frames: ", "Frames:"))
    add("brace on the line of the name", figure(), lambda text: text.replace("\n{", " {"))
    add("OFFSET and CHANNELS on one line", figure(), lambda text: text.replace("\nCHANNELS", " CHANNELS"))
    add("CHANNELS before OFFSET", figure(), lambda text: re.sub(r"(OFFSET.*\n)(CHANNELS.*\n)", r"\2\1", text))
    add("name after End Site", figure(end="Site Tip"))
    add("name instead of Site", figure(end="Tip"))
    add("rows on two lines", figure(), lambda text: re.sub(r"(?m)^((?:-?\d\S* ){7})(?=-?\d)", r"\1\n", text))
    add("byte order mark", figure(), lambda text: "\ufeff" + text)
    add("comment", figure(), lambda text: text.replace("MOTION", "# by hand\nMOTION"))
    return made


def read_pybvh(path):
    import pybvh

    clip = pybvh.read_bvh_file(path)
    kept = [index for index, node in enumerate(clip.nodes) if not node.is_end_site()]
    return clip.node_positions()[:, kept]


def read_bvhio(path):
    import bvhio

    root = bvhio.readAsHierarchy(path)
    frames = []
    for frame in range(len(root.Keyframes)):
        root.loadPose(frame)
        frames.append([list(joint.PositionWorld) for joint, _, _ in root.layout()])
    return frames


def read_bvhtoolbox(path):
    import bvhtoolbox

    writer = importlib.import_module("bvhtoolbox.convert.bvh2csv")
    table = f"{path}.csv"
    assert writer.write_joint_positions(bvhtoolbox.BvhTree(Path(path).read_text()), table)
    numbers = np.loadtxt(table, delimiter=",", skiprows=1, ndmin=2)[:, 1:]
    return numbers.reshape(len(numbers), -1, 3)


def read_blender(path):
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_anim_bvh")
    bpy.ops.import_anim.bvh(filepath=path, rotate_mode="QUATERNION", axis_forward="Y", axis_up="Z")
    armature = bpy.context.object
    frames = []
    for frame in range(1, int(armature.animation_data.action.frame_range[1]) + 1):
        bpy.context.scene.frame_set(frame)
        world = armature.matrix_world
        frames.append([list((world @ bone.matrix).to_translation()) for bone in armature.pose.bones])
    return frames


THREE = """
import fs from 'fs';
import * as THREE from 'three';
import { BVHLoader } from 'three/examples/jsm/loaders/BVHLoader.js';
console.warn = console.error = () => {};
const clip = new BVHLoader().parse(fs.readFileSync(process.argv[2], 'utf8'));
const bones = clip.skeleton.bones, mixer = new THREE.AnimationMixer(bones[0]);
const action = mixer.clipAction(clip.clip);
action.setLoop(THREE.LoopOnce); action.clampWhenFinished = true; action.play();
const frames = Array.from(clip.clip.tracks[0].times).map((time) => {
  mixer.setTime(time); bones[0].updateMatrixWorld(true);
  return bones.filter((bone) => bone.name !== 'ENDSITE')
    .map((bone) => new THREE.Vector3().setFromMatrixPosition(bone.matrixWorld).toArray());
});
process.stdout.write(JSON.stringify(frames));
"""


def read_three(path, node):
    script = Path(node).resolve() / "bvh_elsewhere.mjs"
    script.write_text(THREE)
    done = subprocess.run(
        ["node", script, Path(path).resolve()], capture_output=True, text=True, timeout=SECONDS, cwd=node
    )
    if done.returncode != 0:
        raise RuntimeError(next(line for line in done.stderr.splitlines() if "Error" in line))
    return json.loads(done.stdout)


def read_assimp(path):
    out = f"{path}.json"
    done = subprocess.run(
        ["assimp", "export", path, out, "-fassjson"], capture_output=True, text=True, timeout=SECONDS
    )
    if not os.path.exists(out):
        raise RuntimeError(next(line for line in (done.stdout + done.stderr).splitlines() if "ERROR" in line))
    scene = json.loads(Path(out).read_text())
    tracks = {}
    for track in scene["animations"][0]["channels"]:
        tracks.setdefault(track["name"], track)
    nodes = []

    def walk(node, parent):
        nodes.append((node, parent))
        me = len(nodes) - 1
        for child in node.get("children", []):
            walk(child, me)

    walk(scene["rootnode"], -1)
    frames = []
    for frame in range(max(len(track["rotationkeys"]) for track in tracks.values())):
        matrices = []
        for node, parent in nodes:
            matrix = np.array(node["transformation"]).reshape(4, 4)
            if track := tracks.get(node["name"]):
                at = [keys[min(frame, len(keys) - 1)][1] for keys in (track["positionkeys"], track["rotationkeys"])]
                matrix = np.eye(4)
                matrix[:3, 3] = at[0]
                matrix[:3, :3] = Rotation.from_quat(at[1][1:] + at[1][:1]).as_matrix()
            matrices.append(matrix if parent < 0 else matrices[parent] @ matrix)
        ends = [node["name"].startswith("EndSite_") for node, _ in nodes]
        frames.append([matrix[:3, 3] for matrix, is_end in zip(matrices, ends) if not is_end])
    return frames


def programs(node):
    """Name, version and reader of everything that is installed."""
    found = []
    if node and (Path(node) / "node_modules/three").is_dir():
        package = json.loads((Path(node) / "node_modules/three/package.json").read_text())
        found.append(("three", package["version"], lambda path: read_three(path, node)))
    python = {"blender": ("bpy", read_blender), "pybvh": ("pybvh", read_pybvh), "bvhio": ("bvhio", read_bvhio)}
    python["bvhtoolbox"] = ("bvhtoolbox", read_bvhtoolbox)
    for name, (package, reader) in python.items():
        with contextlib.suppress(importlib.metadata.PackageNotFoundError):
            found.append((name, importlib.metadata.version(package), reader))
    if shutil.which("assimp"):
        said = subprocess.run(["assimp", "version"], capture_output=True, text=True).stdout
        found.append(("assimp", re.search(r"Version (\S+)", said).group(1), read_assimp))
    return found


def tried(reader, path, right, pipe):
    """In a process of its own, so that nothing is left of one program for the next."""
    warnings.simplefilter("ignore")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            read = np.array(reader(path), float)
        if read.ndim == 3 and read.shape[1] == right.shape[1] + 1:
            read = read[:, 1:]  # a root that convert put before several
        if read.shape != right.shape:
            pipe.send(f"{read.shape[0]} frames of {read.shape[1] if read.ndim > 1 else 0} joints")
        else:
            away = np.abs(read - right).max(initial=0.0)
            pipe.send("right" if away < 1e-4 else f"off by {away:.2g}")
    except BaseException as error:
        lines = [line for line in str(error).splitlines() if re.match(r"\w*(Error|Exception)\b", line)]
        said = lines[-1] if lines else f"{type(error).__name__}: {error}"
        pipe.send(said.splitlines()[0][:110])


def try_one(reader, path, right):
    here, there = multiprocessing.Pipe()
    process = multiprocessing.Process(target=tried, args=(reader, path, right, there))
    process.start()
    said = here.recv() if here.poll(SECONDS) else "takes too long"
    process.kill()
    process.join()
    return said


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--node", help="the folder in which three is installed")
    parser.add_argument("--posekit", help="convert each file for the program first, with this posekit")
    parser.add_argument("--only", nargs="*", help="only these programs")
    args = parser.parse_args()
    found = [program for program in programs(args.node) if not args.only or program[0] in args.only]
    print(", ".join(f"{name} {version}" for name, version, _ in found))
    with tempfile.TemporaryDirectory() as folder:
        for name, (text, right) in cases().items():
            print(name)
            for program, _, reader in found:
                path = Path(folder) / f"{program}.bvh"
                path.write_text(text, newline="")
                if args.posekit and program != "bvhtoolbox":
                    source = path.rename(path.with_suffix(".source.bvh"))
                    words = [args.posekit, "convert", "-q", source, path, "--for", program]
                    done = subprocess.run(words, capture_output=True, text=True)
                    if done.returncode != 0:
                        print(f"    {program:10}  posekit: {done.stderr.strip()}")
                        continue
            
                print(f"    {program:10}  {try_one(reader, str(path.resolve()), right)}")
                for left in Path(folder).iterdir():
                    left.unlink()


if __name__ == "__main__":
    main()
