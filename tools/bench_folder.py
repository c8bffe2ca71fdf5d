#!/usr/bin/env python3
"""Measures the command on a lot of motion: a folder of 3,000 files, and single large files.

    cargo build --release && python3 tools/bench_folder.py ../shared/data/bandai

makes 3,000 copies of the .bvh files in the folder (800 MB of the Bandai-Namco ones) in a
temporary folder, runs `posekit fk` over them without writing arrays and with, and prints
seconds of CPU, of the wall clock, and the most memory. Then it makes one file of 100 MB, and
with --large one of 2 GB, of a file's rows, and prints what reading each of them takes.

CPU time and memory are what the system says of the finished process (wait4). Every figure
is the smallest of --runs runs: the one that other work on the machine disturbed least.
"""

import argparse
import os
import shutil
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


@dataclass
class Cost:
    """What a process took."""

    cpu_secs: float
    wall_secs: float
    peak_bytes: int


def cost_of(command):
    """Runs a command to its end, its output thrown away."""
    start = time.monotonic()
    null = os.open(os.devnull, os.O_RDWR)
    streams = [(os.POSIX_SPAWN_DUP2, null, stream) for stream in (0, 1, 2)]
    process = os.posix_spawn(command[0], command, os.environ, file_actions=streams)
    _, status, usage = os.wait4(process, 0)
    wall = time.monotonic() - start
    os.close(null)
    if status != 0:
        sys.exit(f"{' '.join(command)} ended with {os.waitstatus_to_exitcode(status)}")
    unit = 1 if sys.platform == "darwin" else 1024
    return Cost(usage.ru_utime + usage.ru_stime, wall, usage.ru_maxrss * unit)


def report(what, byte_count, command, runs):
    """Prints the least of several runs."""
    costs = [cost_of(command) for _ in range(runs)]
    cpu, wall = min(c.cpu_secs for c in costs), min(c.wall_secs for c in costs)
    peak = min(c.peak_bytes for c in costs)
    megabytes = byte_count / 1e6
    print(
        f"{what}: {megabytes:.0f} MB, {cpu:.2f} s of CPU, {wall:.2f} s, "
        f"{megabytes / cpu:.0f} MB/s of CPU, at most {peak / 1e6:.0f} MB of memory "
        f"({peak / byte_count:.2f} times the input)",
        flush=True,
    )


def copy_many(sources, folder, count):
    """Copies the files in turn until there are `count`; returns their size together."""
    folder.mkdir()
    byte_count = 0
    for index in range(count):
        source = sources[index % len(sources)]
        shutil.copyfile(source, folder / f"{index:04}.bvh")
        byte_count += source.stat().st_size
    return byte_count


def repeat_rows(source, path, byte_count):
    """One motion of that size, made of a file's own rows over and over."""
    header, rows = [], []
    with open(source, encoding="utf-8") as file:
        for line in file:
            (rows if header and header[-1].startswith("Frame Time") else header).append(line)
    rows = [row if row.endswith("\n") else row + "\n" for row in rows if row.strip()]
    block = "".join(rows)
    times = max(1, byte_count // len(block))
    text = "".join(
        f"Frames: {len(rows) * times}\n" if line.startswith("Frames") else line for line in header
    )
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
        for _ in range(times):
            file.write(block)
    return path.stat().st_size


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("folder", type=Path, help="a folder with .bvh files")
    parser.add_argument("--binary", type=Path, default=ROOT / "target/release/posekit")
    parser.add_argument("--count", type=int, default=3000, help="files to copy")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--large", action="store_true", help="also a file of 2 GB")
    args = parser.parse_args()
    sources = sorted(args.folder.glob("*.bvh"))
    if not sources:
        sys.exit(f"no .bvh files in {args.folder}")
    posekit = str(args.binary.resolve())
    largest = max(sources, key=lambda path: path.stat().st_size)
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        takes, arrays = scratch / "takes", scratch / "arrays"
        size = copy_many(sources, takes, args.count)
        one = [posekit, "fk", "-q", "--jobs", "1", str(takes)]
        report(f"{args.count} files, summaries, one job", size, one, args.runs)
        write = [posekit, "fk", "-q", "--jobs", "1", str(takes), "-o", str(arrays)]
        report(f"{args.count} files, to .npz, one job", size, write, 1)
        shutil.rmtree(arrays, ignore_errors=True)
        every = [posekit, "fk", "-q", str(takes)]
        report(f"{args.count} files, summaries, all cores", size, every, args.runs)
        shutil.rmtree(takes)
        sizes = [("100 MB", 100_000_000)] + [("2 GB", 2_000_000_000)] * args.large
        for name, wanted in sizes:
            path = scratch / "large.bvh"
            size = repeat_rows(largest, path, wanted)
            info = [posekit, "info", "-q", str(path)]
            report(f"one file of {name}, info", size, info, 1)
            fk = [posekit, "fk", "-q", str(path)]
            report(f"one file of {name}, fk", size, fk, 1)


if __name__ == "__main__":
    main()
