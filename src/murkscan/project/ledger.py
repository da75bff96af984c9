"""The files of a stage while it is made: a ledger, one line a file, that survives a kill.

A name is written down before its file is made, and its mark when it is whole. So whatever stops a
run, what it has made is known, and nothing else is ever removed.
"""

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path

from ..io.atomic import aside_of, replacing
from ..io.checksum import Mark, mark_file

Marks = Mapping[str, Mark | None]
"""Files by name, relative to the stage's folder; None for one that was begun and not finished."""


def ledger_of(folder: Path, label: str = "") -> Path:
    """Name the ledger of a stage; in a folder that several share, each has its label."""
    return folder / f".{label + '.' if label else ''}ledger.jsonl"


@contextmanager
def entering(ledger: Path, name: str) -> Iterator[Path]:
    """Enter a file into the ledger before and after it is made.

    Args:
        ledger: The ledger of its stage.
        name: The file, relative to the ledger's folder.

    Yields:
        Its path, at which it must be when the context ends.
    """
    _append(ledger, {"file": name})
    yield ledger.parent / name
    mark = mark_file(ledger.parent / name)
    _append(ledger, {"file": name, "size": mark.size, "blake2b": mark.blake2b})


def strike(ledger: Path, name: str) -> None:
    """Remove a file that is not to stay, and take it out of the ledger."""
    (ledger.parent / name).unlink(missing_ok=True)
    _append(ledger, {"file": name, "removed": True})


def read_ledger(ledger: Path) -> Marks:
    """Read the files that a stage has made so far; a line that a crash has torn says nothing."""
    try:
        about = ledger.stat()
        return _parse(ledger, about.st_ino, about.st_size, about.st_mtime_ns)
    except OSError:
        return {}


@lru_cache(maxsize=8)
def _parse(path: Path, inode: int, size: int, modified: int) -> Marks:
    marks: dict[str, Mark | None] = {}
    for line in path.read_text("utf-8", "replace").splitlines():
        with suppress(ValueError, KeyError, TypeError):
            entry = json.loads(line)
            name = str(entry["file"])
            if entry.get("removed"):
                marks.pop(name, None)
            else:
                marks[name] = Mark(entry["size"], entry["blake2b"]) if "size" in entry else None
    return marks


def write_ledger(ledger: Path, marks: Marks) -> None:
    """Begin a ledger with files that are there already."""
    entries = [
        {"file": name} | ({} if mark is None else {"size": mark.size, "blake2b": mark.blake2b})
        for name, mark in marks.items()
    ]
    with replacing(ledger) as aside:
        aside.write_text("".join(json.dumps(entry) + "\n" for entry in entries), "utf-8")


def close_ledger(ledger: Path) -> None:
    """Remove the ledger, when what it says stands elsewhere."""
    for file in (ledger, aside_of(ledger)):
        file.unlink(missing_ok=True)


def is_whole(path: Path, mark: Mark) -> bool:
    """Tell whether a file is there, of the size that it had."""
    try:
        return path.stat().st_size == mark.size
    except OSError:
        return False


def remove_files(folder: Path, marks: Marks) -> None:
    """Remove files that a stage has made, and folders that are empty then; nothing else."""
    for name in filter(_is_inside, marks):
        path = folder / name
        for file in (path, aside_of(path)):
            with suppress(FileNotFoundError):
                file.unlink()
    inner = {parent for name in filter(_is_inside, marks) for parent in Path(name).parents}
    for below in sorted(inner - {Path()}, reverse=True):
        with suppress(OSError):  # others have put something there
            (folder / below).rmdir()


def _is_inside(name: str) -> bool:
    """Distrust a list that has been tampered with."""
    path = Path(name)
    return not path.is_absolute() and ".." not in path.parts


def _append(ledger: Path, entry: Mapping[str, object]) -> None:
    # A line of its own even after one that a crash has torn; one write, so that threads do not mix.
    with ledger.open("ab", buffering=0) as file:
        file.write(f"\n{json.dumps(entry)}\n".encode())
