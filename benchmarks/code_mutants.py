"""Put small errors into the code, one at a time, and count how many of them the tests notice.

`python benchmarks/code_mutants.py [COUNT [FOLDER]]`; what is done in FOLDER is not done again.
"""

import ast
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from harness import Figure, tell

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ("_kernels", "extract", "optics", "geometry", "calibrate", "measure")
LONGEST = 1800.0
"""Seconds after which a run of tests counts as a failure: an error may make a loop endless."""
COMPARED = {ast.Lt: ("<", "<="), ast.LtE: ("<=", "<"), ast.Gt: (">", ">="), ast.GtE: (">=", ">"),
            ast.Eq: ("==", "!="), ast.NotEq: ("!=", "==")}  # fmt: skip
COMPUTED = {ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*"),
            ast.Pow: ("**", "*"), ast.FloorDiv: ("//", "*"), ast.Mod: ("%", "*")}  # fmt: skip
NOTE = """
Errors are drawn at random, with a fixed seed, from all places of the rooms {rooms} where one symbol
can be another: a comparison (`<` for `<=`), an operation (`+` for `-`), a number (1.1 times as
large, an integer one larger), `and` for `or`, `min` for `max`. Each is put alone into a copy of the
code; the tests of its room run until the first fails, of a kernel those of all rooms that use it,
and for what these let pass the whole suite. Some errors change nothing that can be seen: a `<=`
between real numbers that are never equal, a number that only says how much is done at once.

What nobody noticed:

{survivors}
"""


@dataclass(frozen=True)
class Mutant:
    """One symbol of a file, and what stands in its place."""

    path: str
    line: int
    start: int
    end: int
    text: str

    def apply(self, tree: Path) -> None:
        """Put it into a copy of the code."""
        lines = (ROOT / self.path).read_text("utf-8").splitlines(keepends=True)
        row = lines[self.line - 1].encode()
        lines[self.line - 1] = (row[: self.start] + self.text.encode() + row[self.end :]).decode()
        (tree / self.path).write_text("".join(lines), "utf-8")

    def undo(self, tree: Path) -> None:
        """Put the file back as it was."""
        shutil.copy(ROOT / self.path, tree / self.path)

    def __str__(self) -> str:
        row = (ROOT / self.path).read_text("utf-8").splitlines()[self.line - 1]
        return f"`{self.path}:{self.line}`: `{self.text}` in `{row.strip()}`"


def find_mutants(path: Path) -> Iterator[Mutant]:
    """List all errors that can be made in a file."""
    text = path.read_text("utf-8")
    rows = text.splitlines()
    for node in ast.walk(ast.parse(text)):
        for line, start, end, other in _changes(node, rows):
            yield Mutant(path.relative_to(ROOT).as_posix(), line, start, end, other)


def _changes(node: ast.AST, rows: list[str]) -> Iterator[tuple[int, int, int, str]]:
    """Give line, first and last byte, and the other symbol of each change of a node."""
    match node:
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in COMPARED:
            yield from _between(left, right, *COMPARED[type(op)], rows)
        case ast.BinOp(left=left, op=op, right=right) if type(op) in COMPUTED:
            yield from _between(left, right, *COMPUTED[type(op)], rows)
        case ast.BoolOp(op=op, values=[left, right]):
            words = ("and", "or") if isinstance(op, ast.And) else ("or", "and")
            yield from _between(left, right, *words, rows)
        case ast.Constant(value=int() | float() as value) if not isinstance(value, bool):
            other = value + 1 if isinstance(value, int) else float(f"{1.1 * value:.6g}") or 0.1
            yield node.lineno, node.col_offset, node.end_col_offset or 0, repr(other)
        case ast.Name(id="min" | "max" as name) | ast.Attribute(attr="min" | "max" as name):
            end = node.end_col_offset or 0
            yield node.end_lineno or 0, end - 3, end, "max" if name == "min" else "min"


def _between(
    left: ast.expr, right: ast.expr, old: str, new: str, rows: list[str]
) -> Iterator[tuple[int, int, int, str]]:
    """Find the symbol between two operands that stand in one line."""
    if left.end_lineno == right.lineno:
        row = rows[right.lineno - 1].encode()
        found = re.search(re.escape(old).encode(), row[left.end_col_offset : right.col_offset])
        if found:
            start = (left.end_col_offset or 0) + found.start()
            yield right.lineno, start, start + len(old), new


def tests_of(path: str) -> list[str]:
    """Name the tests of a file's room; of a kernel, those of the rooms that use it."""
    room, name = Path(path).parts[2], Path(path).stem
    rooms = {room}
    if room == "_kernels":
        for user in (ROOT / "src/murkscan").rglob("*.py"):
            if re.search(rf"_kernels(\.{name}| import .*\b{name}\b)", user.read_text("utf-8")):
                rooms.add(user.relative_to(ROOT / "src/murkscan").parts[0])
    return [f"tests/{one}" for one in sorted(rooms) if (ROOT / "tests" / one).is_dir()]


def find_failure(tree: Path, *tests: str) -> str:
    """Run tests in the copy until the first fails; name it, or nothing where all pass."""
    environment = os.environ | {"PYTHONPATH": str(tree / "src")}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-n", "2", "--dist", "loadfile", *tests]
    try:
        done = subprocess.run(
            command, cwd=tree, env=environment, capture_output=True, timeout=LONGEST, check=False,
            text=True,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        return f"no end within {LONGEST:g} s"
    failed = re.search(r"^(?:FAILED|ERROR) (\S+)", done.stdout, re.MULTILINE)
    return "" if done.returncode == 0 else failed.group(1) if failed else "pytest itself"


def judge(mutant: Mutant, tree: Path) -> tuple[str, str]:
    """Say who notices an error, the tests of its own room, the suite, or nobody; and by which."""
    mutant.apply(tree)
    try:
        if by := find_failure(tree, *tests_of(mutant.path)):
            return "room", by
        by = find_failure(tree)
        return ("suite", by) if by else ("nobody", "")
    finally:
        mutant.undo(tree)


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 120
    folder = Path(sys.argv[2]) if len(sys.argv) > 2 else Path(tempfile.mkdtemp())
    tree, notes = folder / "tree", folder / "done.jsonl"
    if not tree.exists():
        shutil.copytree(
            ROOT, tree, ignore=shutil.ignore_patterns(".git", ".venv", "*.nbi", "*.nbc")
        )
    files = [
        file for room in ROOMS for file in sorted((ROOT / "src/murkscan" / room).rglob("*.py"))
    ]
    every = [mutant for file in files for mutant in find_mutants(file)]
    drawn = random.Random(0).sample(every, count)
    told = map(json.loads, notes.read_text().splitlines()) if notes.exists() else ()
    done = {line["mutant"]: line["noticed"] for line in told}
    for mutant in drawn:
        if str(mutant) not in done:
            done[str(mutant)], by = judge(mutant, tree)
            line = {"mutant": str(mutant), "noticed": done[str(mutant)], "by": by}
            with notes.open("a") as file:
                file.write(json.dumps(line) + "\n")
        print(f"{done[str(mutant)]:7} {mutant}", file=sys.stderr, flush=True)
    by = Counter(done[str(mutant)] for mutant in drawn)
    survivors = [f"- {mutant}" for mutant in drawn if done[str(mutant)] == "nobody"]
    tell(
        "code_mutants",
        "Errors in the code that tests notice",
        [
            Figure("places where an error can be put", len(every)),
            Figure("errors drawn", count, at_least=120),
            Figure("noticed by the room's own tests", 100 * by["room"] / count, "%"),
            Figure("noticed", 100 * (1 - by["nobody"] / count), "%", at_least=85),
        ],
        note=NOTE.format(rooms=", ".join(ROOMS), survivors="\n".join(survivors) or "nothing"),
    )


if __name__ == "__main__":
    main()
