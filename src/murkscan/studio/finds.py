"""What lies in the folder: rigs, scans, recordings, folders of photographs."""

import os
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from ..io.rig_records import is_rig_record
from .sandbox import Sandbox

_DEEPEST = 4
"""Folders below the studio's that are looked into."""
_MOST = 1000
"""Folders that are looked at, so that a home folder or a network disk cannot hold the page up."""
_LONGEST_RIG = 2_000_000
"""Bytes of a rig file, at most: a long covariance has a tenth of it."""
_OF_RIG = frozenset({"[camera]", "[[laser]]", "[calibration]"})
_OF_TEST = frozenset({"[[ball]]", "[[bar]]", "[[plate]]", "[[step]]", "[limits]"})
_VIDEOS = {".mkv", ".mp4", ".mov", ".avi", ".ts", ".mts", ".m4v", ".h264", ".mcap", ".bag", ".sdp"}
_PHOTOS = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".pgm"}
_LOGS = {".csv", ".txt", ".tum", ".tlog", ".nmea", ".mcap", ".bag"}
_MESHES = {".stl", ".obj", ".ply", ".glb"}


@dataclass
class Found:
    """Names within the folder: each kind by name, scans and dives the newest first."""

    rigs: list[str] = field(default_factory=list)
    scans: list[str] = field(default_factory=list)
    """Folders with a scan, finished or not."""
    dives: list[str] = field(default_factory=list)
    """Folders into which a dive is shown while it goes on, or was."""
    recordings: list[str] = field(default_factory=list)
    """Videos, and folders of pictures."""
    photos: list[str] = field(default_factory=list)
    """Folders of pictures, and videos."""
    logs: list[str] = field(default_factory=list)
    meshes: list[str] = field(default_factory=list)
    tests: list[str] = field(default_factory=list)
    """Files of acceptance tests."""
    is_cut: bool = False
    """Whether there was more than is looked at."""


def look_around(sandbox: Sandbox) -> Found:
    """List what lies in the folder, as far as is quickly seen."""
    found, seen = Found(), 0
    for folder, folders, files in _walk(sandbox.root):
        seen += 1
        if seen > _MOST:
            found.is_cut = True
            break
        if (folder / "live" / "status.json").exists():
            found.dives.append(sandbox.name(folder))
        if "scan.json" in files:
            found.scans.append(sandbox.name(folder))
            folders.clear()
            continue
        _sort_in(found, sandbox, folder, files)
    root = sandbox.root
    found.scans.sort(key=lambda name: _changed(root / name / "scan.json"), reverse=True)
    found.dives.sort(key=lambda name: _changed(root / name / "live" / "status.json"), reverse=True)
    for names in (
        found.rigs,
        found.recordings,
        found.photos,
        found.logs,
        found.meshes,
        found.tests,
    ):
        names.sort()
    return found


def _changed(path: Path) -> int:
    with suppress(OSError):
        return path.stat().st_mtime_ns
    return 0


def _walk(root: Path) -> Iterator[tuple[Path, list[str], list[str]]]:
    for folder, folders, files in os.walk(root):
        deep = len(Path(folder).relative_to(root).parts)
        if "status.json" in files and Path(folder).name in ("live", "sight"):
            continue  # what is seen now is no recording
        folders[:] = sorted(
            name for name in folders if not name.startswith(".") and deep < _DEEPEST
        )
        yield Path(folder), folders, [name for name in files if not name.startswith(".")]


def _sort_in(found: Found, sandbox: Sandbox, folder: Path, files: list[str]) -> None:
    suffixes = {Path(name).suffix.lower() for name in files}
    # What a calibration drew is no photograph to calibrate on.
    is_drawn = any(name.endswith(".found.jpg") for name in files)
    if suffixes & _PHOTOS and not is_drawn and folder != sandbox.root:
        found.recordings.append(sandbox.name(folder))
        found.photos.append(sandbox.name(folder))
    for name in files:
        suffix, path = Path(name).suffix.lower(), folder / name
        if suffix == ".toml" and not is_rig_record(path) and _has_table(path, _OF_RIG):
            found.rigs.append(sandbox.name(path))
        if suffix == ".toml" and _has_table(path, _OF_TEST):
            found.tests.append(sandbox.name(path))
        if suffix in _VIDEOS:
            found.recordings.append(sandbox.name(path))
            found.photos.append(sandbox.name(path))
        if suffix in _LOGS and name != "times.csv":
            found.logs.append(sandbox.name(path))
        if suffix in _MESHES:
            found.meshes.append(sandbox.name(path))


def _has_table(path: Path, tables: frozenset[str]) -> bool:
    """Tell whether a TOML file has one of some tables; a scene has those of a rig inside others."""
    try:
        if not path.is_file() or path.stat().st_size > _LONGEST_RIG:
            return False
        lines = path.read_text("utf-8-sig", errors="replace").splitlines()
    except OSError:
        return False
    return any(line.strip() in tables for line in lines)
