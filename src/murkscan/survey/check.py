"""Is everything in a scan's folder still as it was written?"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from ..errors import MurkscanError
from ..io.checksum import mark_file
from ..project import STAGES, Project, read_record
from .progress import Progress, silent


@dataclass(frozen=True)
class StageCheck:
    """What became of the files of one stage."""

    word: str
    num_whole: int
    """Files that are as they were written."""
    changed: tuple[str, ...]
    """Those that are not, relative to the scan's folder."""
    missing: tuple[str, ...]
    foreign: tuple[str, ...]
    """Files in its folder that it has not made; they are never touched."""
    state: str
    """What else is to be said of it, in words; empty where it is finished and up to date."""


def check_project(project: Project, *, progress: Progress = silent) -> list[StageCheck]:
    """Compare every file of a scan's stages with its checksum.

    Args:
        project: A scan, or a merged cloud.
        progress: Told of each stage.

    Raises:
        MissingResult: The folder holds no scan.
        FormatError: scan.json is damaged.
    """
    project.load_scan()
    checks = []
    for done, kind in enumerate(STAGES):
        progress("check", done, len(STAGES))
        folder = project.root / kind.word
        if folder.is_dir():
            try:
                project.finished(kind)
                state = ""
            except MurkscanError as error:
                state = "not finished" if _is_begun(folder) else str(error)
            checks.append(_check_stage(folder, state))
    progress("check", len(STAGES), len(STAGES))
    return checks


def _is_begun(folder: Path) -> bool:
    record = read_record(folder)
    return record is not None and record.result is None


def _check_stage(folder: Path, state: str) -> StageCheck:
    record = read_record(folder)
    files = record.files if record is not None else {}
    changed, missing = [], []
    for name, mark in files.items():
        if not (folder / name).is_file():
            missing.append(f"{folder.name}/{name}")
        elif mark_file(folder / name) != mark:
            changed.append(f"{folder.name}/{name}")
    foreign = [name for name in _others(folder) if name not in files] if not state else []
    whole = len(files) - len(changed) - len(missing)
    names = (tuple(changed), tuple(missing), tuple(f"{folder.name}/{name}" for name in foreign))
    return StageCheck(folder.name, whole, *names, state)


def _others(folder: Path) -> Iterator[str]:
    for file in sorted(folder.rglob("*")):
        if file.is_file() and file.name != "stage.json" and not file.name.startswith("."):
            yield file.relative_to(folder).as_posix()
