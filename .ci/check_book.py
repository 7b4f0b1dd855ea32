#!/usr/bin/env python3
"""Runs the commands of the book and compares its reference pages with what they leave.

usage: check_book.py PROGRAM [PAGE ...]

Each page runs in an empty folder of its own with a copy of cases/. Comments before code blocks say what a block
is; docs/contributors/book.md lists them.
"""

import csv
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).resolve().parent.parent / "docs"
PAGES = [
    "install.md",
    "first-study.md",
    *sorted(f"how-to/{path.name}" for path in (DOCS / "how-to").glob("*.md")),
]
BLOCK = re.compile(
    r"(?:^<!-- (?P<mark>[^\n]*?) -->\n)?^```(?P<kind>\w+)\n(?P<text>.*?)^```$", re.MULTILINE | re.DOTALL
)


def blocks(page):
    """What a page has to be written or run, in order: (name of a file, None) or (None, options), and the text."""
    for block in BLOCK.finditer((DOCS / page).read_text(encoding="utf-8")):
        mark, text = block["mark"] or "", block["text"]
        if mark.startswith("file: "):
            yield mark[6:], None, text
        elif mark == "run" or mark.startswith("run with: "):
            yield None, mark[len("run with: ") :], text
        elif block["kind"] == "sh" and not mark.startswith("not run: "):
            sys.exit(f"{page}: shell commands without a comment that says whether they run:\n{text}")


def commands(text):
    """Commands of a block, lines that end in a backslash joined."""
    return [line for line in text.replace("\\\n", " ").splitlines() if line.strip()]


def run(page, folder, program):
    """Runs all of `page` in `folder`."""
    (folder / "bin").mkdir()
    (folder / "bin" / "wakemix").symlink_to(program)
    shutil.copytree(DOCS.parent / "cases", folder / "cases")
    environment = {**os.environ, "PATH": f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"}
    for name, options, text in blocks(page):
        if name:
            (folder / name).write_text(text, encoding="utf-8")
            continue
        for command in commands(text):
            command = f"{command} {options}".strip()
            print(f"{page}: {command}", flush=True)
            done = subprocess.run(
                ["bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True
            )
            if done.returncode:
                sys.exit(f"exit code {done.returncode}\n{done.stdout}{done.stderr}")


def words(*pages):
    """Everything in backticks on `pages`."""
    text = "".join((DOCS / page).read_text(encoding="utf-8") for page in pages)
    found = set(re.findall(r"`([^`\n]+)`", text))
    # A field stands there with its path, such as `turbines[].control.kind`.
    return found | {part for name in found for part in re.split(r"\[\]\.?|\.", name)}


def channel(column):
    """Column of a series as the page calls it: no turbine, blade or gauge 1, no unit."""
    name = column.rpartition("_")[0]
    if name.startswith("Wind."):
        return name
    return re.sub(r"\d", "1", name.rpartition(".")[2])


def keys(value):
    """All keys of a JSON value; a key with a space or a capital is the name of a channel or a turbine."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if re.fullmatch(r"[a-z][a-z0-9_]*", key):
                yield key
            yield from keys(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from keys(inner)


def missing(study):
    """What the study in the folder `study` holds and the reference pages do not name."""
    channels, outputs = words("reference/channels.md"), words("reference/outputs.md", "summary.md")
    for path in study.rglob("*"):
        if path.name == "series.csv":
            with path.open(encoding="utf-8") as file:
                header = next(csv.reader(file))
            yield from (
                f"reference/channels.md: {column}" for column in header if channel(column) not in channels
            )
        if path.suffix == ".json":
            found = json.loads(path.read_text(encoding="utf-8"))
            yield from (f"{path.name}: `{key}` is on no page" for key in keys(found) if key not in outputs)
        if path.is_file():
            name = re.sub(r"-\d{4}\.", "-0000.", path.name)
            if path.parent.name == "planes":
                name = re.sub(r"^.*?(-(?:mean|last|phases))?\.nc$", r"NAME\1.nc", name)
            name = re.sub(r"^\w+\.outb$", "T1.outb", re.sub(r"^inflow-\w+", "inflow-T2", name))
            if path.parent.name in ("planes", "volumes"):
                name = f"{path.parent.name}/{name}"
            if path.parent.name == "figures":
                name = f"figures/*{path.suffix}"
            if name not in outputs:
                yield f"reference/outputs.md: {path.relative_to(study)} is not named"


def main():
    program, pages = Path(sys.argv[1]).resolve(), sys.argv[2:] or PAGES
    found = set()
    for page in pages:
        with tempfile.TemporaryDirectory() as folder:
            run(page, Path(folder), program)
            for study in Path(folder).glob("runs/*"):
                found.update(missing(study))
    if found:
        sys.exit("\n".join(sorted(found)))
    print(f"book: the commands of {len(pages)} pages run, and the reference pages name what they leave")


main()
