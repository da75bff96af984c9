"""What a report is told beside the points: the recording, the pictures, the model."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date, datetime
from typing import Any

from ..types.background import Attenuation
from .placed import Placed
from .walls import DrawnWall


@dataclass(frozen=True)
class Recorded:
    """What was scanned."""

    name: str
    """The recording's file or folder; what a folder of frames belongs to."""
    size: tuple[int, int]
    """Width and height of the full frame [px]."""
    fields_per_picture: int = 1
    """2 where the recording is interlaced."""
    is_timed: bool = True
    """Whether times are real; otherwise they count pictures."""
    skips: Sequence[tuple[int, int, str]] = ()
    """What could not be read: index of the first frame, how many frames, and why."""
    remarks: Sequence[str] = ()
    """What is odd about the recording, with its cure."""
    motion: str = ""
    """How well the motion is known, in words."""
    correction: Sequence[str] = ()
    """How the scan itself has corrected the motion, or why it has not; sentences for the user."""
    unstated: Sequence[str] = ()
    """Whose errors are in no interval, since nothing is stated of them; sentences for the user."""
    attenuation: Attenuation | None = None
    """How murky the water was, where the glow told."""
    path: str = ""
    """Where the recording lay."""
    began: datetime | None = None
    """When it began, where the log of the poses says so."""
    written: datetime | None = None
    """When its files were last written."""
    scanned: datetime | None = None
    """When it was turned into a model."""
    rig_file: str = ""
    """The rig's file."""
    calibration: Mapping[str, Any] | None = None
    """The record of the calibration in that file, empty where there is none; None where the file
    is not known."""
    commands: Sequence[str] = ()
    """What was typed, in order; the same again gives the same scan."""

    @property
    def num_skipped(self) -> int:
        """Frames that could not be read."""
        return sum(count for _, count, _ in self.skips)

    @property
    def date(self) -> date | None:
        """The day of the recording, as far as it is known."""
        moment = self.began or self.written
        return None if moment is None else moment.date()


@dataclass(frozen=True)
class Shown:
    """A picture that the report shows."""

    path: str
    """Relative to the report's page, with forward slashes."""
    caption: str
    is_frame: bool = False
    """Whether it shows a frame of the recording, and what was found there."""


@dataclass(frozen=True)
class ModelSize:
    """What became of the points."""

    points: int
    """Points of the cloud."""
    outliers: int
    """Points that were taken out as outliers."""
    vertices: int
    faces: int
    size: tuple[float, float, float] | None
    """Extent of the cloud along the world's x, y and z [m]; None without points."""
    origin: tuple[float, ...] = (0.0, 0.0, 0.0)
    """Where the coordinates of mesh.stl and mesh.glb count from in the world [m]."""
    placed: Placed | None = None
    """Where it lies on the Earth, if somebody has said so."""
    walls: Sequence[DrawnWall] = ()
    """Walls that were drawn in elevation."""
