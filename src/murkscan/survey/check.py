"""Is everything in a scan's folder still as it was written?"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import MurkscanError
from ..io.checksum import mark_file
from ..project import (
    ACCEPT,
    GEOREFERENCE,
    MEASURE,
    SIMULATE,
    STAGES,
    Kind,
    Project,
    Record,
    read_record,
    record_of,
)
from .progress import Progress, silent

_RECORD = ".stage.json"
"""What the name of a measurement's record ends in."""


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
    """Compare every file of a scan's stages and measurements with its checksum.

    Args:
        project: A scan, a merged cloud, or the folder of a simulated recording.
        progress: Told of each stage.

    Raises:
        MissingResult: The folder holds none of these.
        FormatError: scan.json is damaged.
    """
    if _is_simulation(project.root):
        return [_check_folder(project, SIMULATE, project.root, [""])]
    project.load_scan()
    checks, kinds = [], (*STAGES, GEOREFERENCE, MEASURE, ACCEPT)
    for done, kind in enumerate(kinds):
        progress("check", done, len(kinds))
        folder = project.root / kind.word
        if folder.is_dir():
            checks.append(_check_folder(project, kind, folder, _list_labels(folder, kind)))
    progress("check", len(kinds), len(kinds))
    return checks


def _is_simulation(root: Path) -> bool:
    """Tell a simulation's folder, which holds its record itself, from a scan's stage."""
    is_stage = (root.resolve().parent / "scan.json").exists()
    return not is_stage and read_record(record_of(root)) is not None


def _list_labels(folder: Path, kind: Kind[Any]) -> list[str]:
    """Name the stages that share a folder; one alone has no name."""
    if kind is not MEASURE:
        return [""]
    return [file.name.removesuffix(_RECORD) for file in sorted(folder.glob(f"*{_RECORD}"))]


def _check_folder(
    project: Project, kind: Kind[Any], folder: Path, labels: Sequence[str]
) -> StageCheck:
    records = {label: read_record(record_of(folder, label)) for label in labels}
    marks = {name: mark for one in records.values() if one for name, mark in one.files.items()}
    missing = [name for name in marks if not (folder / name).is_file()]
    changed = [
        name for name, mark in marks.items()
        if name not in missing and mark_file(folder / name) != mark
    ]  # fmt: skip
    states = [_tell_state(project, kind, label, record) for label, record in records.items()]
    state = "; ".join(filter(None, states))
    known = {*marks, *(record_of(folder, label).name for label in labels)}
    foreign = [] if state else [name for name in _list_files(folder) if name not in known]
    return StageCheck(
        kind.word,
        num_whole=len(marks) - len(changed) - len(missing),
        changed=_below(project, folder, changed),
        missing=_below(project, folder, missing),
        foreign=_below(project, folder, foreign),
        state=state,
    )


def _tell_state(project: Project, kind: Kind[Any], label: str, record: Record | None) -> str:
    named = f"{label}: " if label else ""
    if record is not None and record.result is None:
        return f"{named}not finished"
    if kind is SIMULATE:
        return ""
    try:
        project.finished(kind, label)
    except MurkscanError as error:
        return f"{named}{error}"
    return ""


def _below(project: Project, folder: Path, names: Sequence[str]) -> tuple[str, ...]:
    return tuple((folder / name).relative_to(project.root).as_posix() for name in names)


def _list_files(folder: Path) -> Iterator[str]:
    for file in sorted(folder.rglob("*")):
        if file.is_file() and not file.name.startswith("."):
            yield file.relative_to(folder).as_posix()
