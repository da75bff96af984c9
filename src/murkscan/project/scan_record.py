"""What scan.json says: what was scanned, with what."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any


@dataclass(frozen=True)
class RecordingRecord:
    """What scan.json says of a recording."""

    path: str
    fingerprint: Any
    """Changes with what the recording holds."""
    size: tuple[int, int]
    """Width and height of its pictures [px]."""
    is_timed: bool
    fields_per_picture: int
    written: datetime | None = None
    """When its last file was written."""


@dataclass(frozen=True)
class ScanRecord:
    """scan.json: what was scanned, with what."""

    versions: Mapping[str, str]
    recording: RecordingRecord | None
    """None for a cloud that was merged from other scans."""
    rig: Mapping[str, Any]
    """The tables of the rig file."""
    format: int = 1
    started: datetime | None = None
    command: tuple[str, ...] = ()
    """The words that were typed after `murkscan`."""
    rig_file: str = ""
    calibration: Mapping[str, Any] | None = None
    """The record of the rig's calibration."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    """The Choice of each kind."""
    passes: tuple["PassRecord", ...] = ()
    """The passes of a merged cloud."""
    origin: tuple[float, ...] = field(default=(0.0, 0.0, 0.0), metadata={"unit": "m"})
    """Where the coordinates of mesh.stl and mesh.glb count from in the world [m]."""


@dataclass(frozen=True)
class PassRecord:
    """A pass, as it was when it was merged."""

    path: str
    """Its folder or file, relative to the merged folder, with forward slashes."""
    identity: str
    """Changes with what its cloud and its poses hold."""
    scan: ScanRecord | None = None
    """What was scanned, with what; None for a cloud of another program."""
    carries_mount: bool = False
    """Whether its poses came through its rig's mount."""
    scale: float = field(default=1.0, metadata={"unit": "m"})
    """Length of the unit of a cloud of another program [m]."""
