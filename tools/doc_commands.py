#!/usr/bin/env python3
"""Runs every command that README.md and the guide under docs/ show.

    cargo build --release && python3 tools/doc_commands.py

A fenced block that is marked `console` holds commands after `$ ` and, if it wants,
what they print. All of a page's commands run in one shell folder of their own, in
order, so that a page reads as it works; the pages do not depend on each other. A
command must end with exit code 0, unless the line before the block, or the line
before that, is `<!-- exit N -->`: then its last command must end with N.

What a command prints is compared with what the page shows under it, line by line;
trailing spaces do not count. `...` alone on a line stands for any lines, also none;
within a line it stands for any text. Where a page shows nothing under a command,
anything may be printed. Output is standard output and standard error together.

    $ posekit fk walk.bvh -o walk.npz      compared
    note: ...

A block marked `python` runs in the same folder too, by this interpreter, after the
commands before it; so do the pages' own promises about NumPy get kept. A Python
block whose imports are not installed is passed over, and said so. What must not run
(installing, shell functions) stands in a block marked `sh` or `text`.

The binary is --binary or the newest that stands under target/.
Exits 1 when anything is not as shown.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COMMAND_SECONDS = 120
EXIT_MARK = re.compile(r"<!--\s*exit (\d+)\s*-->")


@dataclass
class Block:
    """A fenced block: its language, where its text starts, and the exit code it promises."""

    language: str
    first_line: int
    lines: list
    exit_code: int = 0


@dataclass
class Step:
    """One command and the output that is shown under it."""

    command: str
    line: int
    shown: list
    exit_code: int = 0


def blocks(text):
    """The fenced blocks of a Markdown page, in order."""
    found, current, fence = [], None, ""
    lines = text.splitlines()
    for number, line in enumerate(lines, start=1):
        start = re.match(r"\s*(`{3,})(\w*)", line)
        if current is None and start:
            fence = start.group(1)
            marks = [EXIT_MARK.search(before) for before in lines[max(0, number - 3) : number - 1]]
            code = next((int(mark.group(1)) for mark in marks if mark), 0)
            current = Block(start.group(2), number + 1, [], code)
        elif current is not None and line.strip() == fence:
            found.append(current)
            current = None
        elif current is not None:
            current.lines.append(line)
    if current is not None:
        raise ValueError(f"the block that starts at line {current.first_line - 1} never ends")
    return found


def steps(block):
    """The commands of a console block. A command goes on while its lines end in a backslash."""
    result, goes_on = [], False
    for offset, line in enumerate(block.lines):
        if goes_on:
            result[-1].command += "\n" + line
        elif line.startswith("$ "):
            result.append(Step(line[2:], block.first_line + offset, []))
        elif result:
            result[-1].shown.append(line)
        elif line.strip():
            raise ValueError(f"line {block.first_line + offset}: output before any command")
        goes_on = line.endswith("\\") and (goes_on or line.startswith("$ "))
    if result:
        result[-1].exit_code = block.exit_code
    return result


def matches(shown, printed):
    """Whether printed lines are the shown ones, with `...` as the docstring has it."""
    pattern = []
    for line in shown:
        if line.strip() == "...":
            pattern.append(r"(?:[^\n]*\n)*?")
        else:
            pieces = (re.escape(piece) for piece in line.rstrip().split("..."))
            pattern.append("[^\n]*".join(pieces) + r"\n")
    text = "".join(line.rstrip() + "\n" for line in printed)
    return re.fullmatch("".join(pattern), text) is not None


def trimmed(lines):
    """Without the empty lines at both ends."""
    lines = [line.rstrip() for line in lines]
    while lines and not lines[0]:
        lines.pop(0)
    while lines and not lines[-1]:
        lines.pop()
    return lines


def run(command, folder, environment):
    """The exit code and the lines that were printed."""
    try:
        done = subprocess.run(
            command,
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=COMMAND_SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return 124, [f"took more than {COMMAND_SECONDS} s"]
    return done.returncode, done.stdout.decode("utf-8", "replace").splitlines()


def check_step(step, folder, environment):
    """What is wrong with a command, or None."""
    code, printed = run(["bash", "-c", step.command], folder, environment)
    if code != step.exit_code:
        return f"ended with {code}, not {step.exit_code}", printed
    shown = trimmed(step.shown)
    if shown and not matches(shown, trimmed(printed)):
        return "printed something else than is shown", printed
    return None


def check_python(block, folder, environment):
    """What is wrong with a Python block, None, or the name of a module that is not here."""
    source = "\n".join(block.lines)
    for module in re.findall(r"^\s*(?:import|from) (\w+)", source, re.MULTILINE):
        code, _ = run([sys.executable, "-c", f"import {module}"], folder, environment)
        if code != 0:
            return module
    code, printed = run([sys.executable, "-c", source], folder, environment)
    return (f"ended with {code}", printed) if code else None


def check_page(page, environment):
    """Runs a page in a scratch folder; returns how many things ran and how many were wrong."""
    name = page.relative_to(ROOT)
    ran = wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for block in blocks(page.read_text(encoding="utf-8")):
            results = []
            if block.language == "console":
                for step in steps(block):
                    results.append((step.line, step.command, check_step(step, folder, environment)))
            elif block.language == "python":
                result = check_python(block, folder, environment)
                if isinstance(result, str):
                    print(f"{name}:{block.first_line}: passed over, there is no {result} here")
                    continue
                results.append((block.first_line, "the Python block", result))
            for line, what, result in results:
                ran += 1
                if result is not None:
                    wrong += 1
                    why, printed = result
                    print(f"{name}:{line}: {what}\n  {why}:")
                    print("".join(f"  | {text}\n" for text in printed), end="")
    return ran, wrong


def binary_folder(given):
    if given is not None:
        return given.resolve().parent
    candidates = [ROOT / "target" / profile / "posekit" for profile in ("release", "debug")]
    built = [path for path in candidates if path.exists()]
    if not built:
        sys.exit("no posekit under target/: cargo build --release, or name it with --binary")
    return max(built, key=lambda path: path.stat().st_mtime).parent


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--binary", type=Path, help="the posekit to run [default: the newest built]")
    parser.add_argument("pages", nargs="*", type=Path, help="pages [default: README.md and docs/]")
    args = parser.parse_args()
    environment = dict(os.environ, NO_COLOR="1", COLUMNS="100", LC_ALL="C.UTF-8", MPLBACKEND="Agg")
    # Mesa's device choosing layer complains on stderr where there is no desktop session.
    environment["NODEVICE_SELECT"] = "1"
    environment["PATH"] = f"{binary_folder(args.binary)}{os.pathsep}{environment['PATH']}"
    everything = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
    pages = [page.resolve() for page in args.pages] or everything
    ran = wrong = 0
    for page in pages:
        page_ran, page_wrong = check_page(page, environment)
        ran, wrong = ran + page_ran, wrong + page_wrong
    print(f"{len(pages)} pages, {ran} commands and Python blocks, {wrong} not as shown")
    return 1 if wrong or not ran else 0


if __name__ == "__main__":
    sys.exit(main())
