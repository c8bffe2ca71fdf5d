#!/usr/bin/env python3
"""Runs our bench of closed-form IK and the same jobs of ozz-animation in turn, and prints both with their ratio.

    python3 tools/bench_ik_ozz.py OZZ_CHECKOUT [--rounds 5] [--native]

The checkout is a clone of ozz-animation (tested with 0.16). Its two jobs and the maths they need are compiled with the
C++ compiler named by CXX (c++ if unset), for the instruction set that its release builds have, or with --native for
this machine's. Each figure is the least of all rounds: what other work on the machine disturbed least.
"""

import argparse
import os
import re
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
JOBS = ["two bones and a pole", "aim, with a direction that stays up"]
SOURCES = [
    "src/animation/runtime/ik_two_bone_job.cc",
    "src/animation/runtime/ik_aim_job.cc",
    "src/base/maths/simd_math.cc",
    "src/base/log.cc",
    "src/base/memory/allocator.cc",
]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkout", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--native", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        peer = Path(folder) / "bench_ik_ozz"
        compile_peer(arguments.checkout, peer, arguments.native)
        # Built before the first round, so that no round has to wait for it.
        ours = ["cargo", "bench", "-q", "-p", "posekit-formats", "--bench", "ik"]
        subprocess.run([*ours, "--no-run"], cwd=ROOT, check=True)
        least = {}
        for _ in range(arguments.rounds):
            for name, command in [("ozz-animation", [peer, "1"]), ("posekit", [*ours, "--", "1"])]:
                text = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
                for job in JOBS:
                    figure = float(re.search(rf"^{job}\s+([\d.]+)", text, re.MULTILINE)[1])
                    key = (name, job)
                    least[key] = min(figure, least.get(key, figure))
    print(f"{'':40}{'posekit, ns':>14}{'ozz, ns':>12}{'ratio':>8}")
    for job in JOBS:
        ours_ns, peer_ns = least["posekit", job], least["ozz-animation", job]
        print(f"{job:40}{ours_ns:14.1f}{peer_ns:12.1f}{ours_ns / peer_ns:8.2f}")


def compile_peer(checkout, program, is_native):
    flags = ["-O3", "-DNDEBUG", "-std=c++17", "-w"]
    if is_native:
        flags.append("-march=native")
    includes = [f"-I{checkout / folder}" for folder in ("include", "src", ".")]
    sources = [ROOT / "tools/bench_ik_ozz.cc", *(checkout / source for source in SOURCES)]
    compiler = os.environ.get("CXX", "c++")
    subprocess.run([compiler, *flags, *includes, *sources, "-o", program], check=True)


if __name__ == "__main__":
    main()
