"""The real recordings that finders are judged by: where they lie, and with what they were made."""

import math
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from harness import DATA

from murkscan import Camera, Laser, Rig, open_recording
from murkscan.capture import AbstractRecording
from murkscan.capture.folder import list_pictures
from murkscan.types.plane import Plane
from murkscan.types.water import Water

_SHEET = math.radians(65.0)
"""Lean of the stage's laser sheet, and of those that nobody measured."""


@dataclass(frozen=True)
class Shot:
    """One recording as a user would give it to `murkscan scan`, and its rig."""

    name: str
    """Its table in real_truth.toml."""
    folder: str
    """Below ../shared/data."""
    rig: Rig
    only: Sequence[str] = ()
    """Pictures of the folder that are in it; none: all of them."""
    without: Sequence[str] = ()
    """Pictures of the folder that are left out."""

    @property
    def is_here(self) -> bool:
        """Tell whether the recording lies beside this checkout."""
        return (DATA / self.folder).is_dir()

    def pictures(self) -> list[str]:
        """Name its pictures in their order."""
        names = list_pictures(DATA / self.folder)
        return [n for n in names if (not self.only or n in self.only) and n not in self.without]

    @contextmanager
    def opened(self) -> Iterator[AbstractRecording]:
        """Open it, through links where not all of the folder is meant."""
        with tempfile.TemporaryDirectory() as scratch:
            for name in self.pictures():
                (Path(scratch) / name).symlink_to(DATA / self.folder / name)
            yield open_recording(scratch, wavelength=self.rig.wavelength)


@dataclass(frozen=True)
class RealSet:
    """Recordings that are judged as one, and what they are for."""

    name: str
    shots: tuple[Shot, ...]
    is_stage: bool = False
    """Whether it is a scan on the linear stage, for which there are bars of their own."""
    num_fitted: int = 0
    """First frames of each recording by which settings may be fitted; these are judged apart."""


def _stage_rig(column: float) -> Rig:
    """Make the stage's rig: its principal point lies where its bed does on that day."""
    camera = Camera((640, 480), (850.4, 850.4), (column, 239.5))
    laser = Laser.from_baseline_angle(0.0373, _SHEET, "x")
    return Rig(camera, (laser,), wavelength=650e-9)


def _sheet_rig(
    camera: Camera, normal: tuple[float, float, float], distance: float, nm: float
) -> Rig:
    plane = Plane(np.array(normal) / np.linalg.norm(normal), distance / np.linalg.norm(normal))
    return Rig(camera, (Laser.from_sheet(plane),), wavelength=nm * 1e-9)


def _bare_rig(size: tuple[int, int], focal: float, axis: str, *, wet: bool) -> Rig:
    """Make a rig of which only the picture's size and the stripe's direction are known."""
    camera = Camera(size, (focal, focal), ((size[0] - 1) / 2, (size[1] - 1) / 2))
    laser = Laser.from_baseline_angle(0.1, _SHEET, axis)
    return Rig(camera, (laser,), water=Water() if wet else None)


GREEN = _sheet_rig(
    Camera((640, 480), (620.0, 620.0), (319.5, 239.5)), (-0.9057, 0.1395, -0.4004), 0.1657, 532
)
ARM = _sheet_rig(
    Camera((1280, 960), (1298.0, 1298.0), (639.5, 479.5)), (-0.0156, 0.8954, 0.4451), -0.0160, 640
)
UNDERWATER = Camera((648, 486), (702.6, 703.5), (303.1, 227.2))
_AIR = Rig(UNDERWATER, (Laser.from_baseline_angle(0.1, _SHEET, "y"),))
_WET = Rig(UNDERWATER, _AIR.lasers, water=Water())
_BOX = _bare_rig((925, 1920), 1500.0, "x", wet=True)

SETS = {
    one.name: one
    for one in (
        RealSet(
            "stage_stairs",
            (Shot("stage_stairs", "stage_stairs/scan", _stage_rig(328.0)),),
            is_stage=True,
            num_fitted=65,
        ),
        RealSet(
            "stage_pyramid",
            (Shot("stage_pyramid", "stage_pyramid", _stage_rig(330.0)),),
            is_stage=True,
        ),
        RealSet(
            "stage_three_levels",
            (Shot("stage_three_levels", "stage_three_levels", _stage_rig(315.3)),),
            is_stage=True,
        ),
        RealSet(
            "green_laser",
            (Shot("green_laser", "green_laser/laser_on_board", GREEN),),
            num_fitted=31,
        ),
        RealSet("arm_poses", (Shot("arm_poses", "arm_poses", ARM),), num_fitted=30),
        RealSet(
            "laser_in_water",
            (
                Shot("box_of_one_laser", "laser_in_water", _BOX, only=("featured1.jpg",)),
                Shot("box_of_two_lasers", "laser_in_water", _BOX, only=("featured.jpg",)),
            ),
        ),
        RealSet(
            "underwater_line",
            (
                Shot("line_in_air", "underwater_line/air", _AIR),
                Shot("line_in_water", "underwater_line/water", _WET, without=("steps.png",)),
                Shot("steps", "underwater_line/water", _WET, only=("steps.png",)),
            ),
        ),
    )
}
