"""murkscan turntable: the pose log of an object that turns before a camera that stands still."""

import math
from pathlib import Path
from shlex import quote

from cyclopts.types import PositiveFloat

from ..errors import InputError
from ..ui.values import read_numbers
from .options import Place
from .words import tell


def turntable(
    out: Path,
    *,
    point_m: Place,
    axis: Place = "0,1,0",
    turn_deg_s: float | None = None,
    seconds: PositiveFloat | None = None,
    step_deg: float | None = None,
    fps: PositiveFloat | None = None,
    pictures: int | None = None,
) -> None:
    """Write the pose log of a turntable from its axis and how fast it turns, for scan --poses.

    Either --turn-deg-s and --seconds, for a table that turns evenly; or --step-deg, --fps and
    --pictures, for one picture a step. The world turns with the object, and is the camera's frame
    at time 0.

    Parameters
    ----------
    out
        The log to write, ending in .csv.
    point_m
        A point of the axis in the camera's frame, as X,Y,Z (right, down, forward) [m].
    axis
        Direction of the axis there: 0,1,0 points down. The table turns about it by the right hand.
    turn_deg_s
        How fast it turns [degrees/s]; negative for the other way.
    seconds
        How long the recording is [s].
    step_deg
        Turn from one picture to the next [degrees]; negative for the other way.
    fps
        Pictures a second, as given to scan.
    pictures
        How many pictures there are.
    """
    rate, duration = _read_turn(turn_deg_s, seconds, step_deg, fps, pictures)
    point, direction = read_numbers(point_m, 3), read_numbers(axis, 3)
    if point is None or direction is None:
        raise InputError("--point-m and --axis take three numbers each, such as 0,0.1,0.6.")
    if out.suffix.lower() != ".csv":
        raise InputError(f"The log is written as .csv, not as {out.name}.")
    import numpy as np

    from ..io.poses import save_poses
    from ..motion import turn_about_axis

    way = turn_about_axis(
        np.array(point), np.array(direction), rate=math.radians(rate), duration=duration
    )
    save_poses(out, way)
    tell("made", f"{len(way.times):,} poses, {abs(rate) * duration / 360:.2f} turns: {out}")
    flags = "" if fps is None else f" --fps {fps:g}"
    tell(
        "next",
        f"murkscan scan RECORDING --rig RIG --poses {quote(str(out))}{flags} --out OUT "
        "--volume-m X,Y,Z,X,Y,Z",
        "where --volume-m gives two corners of the space above the table, and leaves the wall out",
    )


def _read_turn(
    turn_deg_s: float | None,
    seconds: float | None,
    step_deg: float | None,
    fps: float | None,
    pictures: int | None,
) -> tuple[float, float]:
    """Read how fast the table turns [degrees/s], and for how long [s]."""
    evenly, stepped = (turn_deg_s, seconds), (step_deg, fps, pictures)
    if turn_deg_s is not None and seconds is not None and stepped == (None,) * 3:
        return turn_deg_s, seconds
    if step_deg is not None and fps is not None and pictures is not None and evenly == (None,) * 2:
        return step_deg * fps, max(pictures, 1) / fps
    raise InputError(
        "Say how the table turns: by --turn-deg-s and --seconds, or by --step-deg, --fps and "
        "--pictures."
    )
