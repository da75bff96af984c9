"""Flags that say which part of a scan is measured, and what a measurement prints."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated

from cyclopts import Group, Parameter

from ..errors import InputError
from ..ui.values import read_box, read_numbers
from .options import MaybePlace
from .paths import ScanFolder
from .words import print_table, say, tell

if TYPE_CHECKING:
    from ..measure import Selection
    from ..types.cylinder import Cylinder
    from ..types.measurement import Measurement
    from ..types.plane import Plane
    from ..types.quantity import Quantity

_SHOWN = {"m": ("mm", 1e3), "m2": ("cm²", 1e4), "m3": ("cm³", 1e6), "rad": ("°", 180 / math.pi)}
"""Units as people read them, and how many go into ours."""
_PLACES = ("x", "y", "z")
"""Coordinates, which are in metres as flags take them; lengths are in millimetres."""
_DIGITS = 6
"""Digits behind the point, at most: a nanometre, or what a hair's width is of a hundred metres."""
_FARTHEST = 1e8
"""Distance from the origin beyond which a place is none [m]."""

_MEANING = (
    "in 95 of 100 scans the truth lies within value ± 95%; 1σ is a standard deviation, a bit over "
    'half of that: "own" is the points\' noise, which more '
    'points lessen, "common" is what all points share, such as the calibration\'s error'
)

_PROVE = (
    "murkscan accept --help, to prove such numbers: how far a scan of an artefact of known size, "
    "in the same water, is off"
)

PART = Group("Which part of the scan", sort_key=11)
CloudScan = Annotated[
    ScanFolder, Parameter(help="Folder of the scan, with a finished cloud stage.")
]
MeshScan = Annotated[
    ScanFolder, Parameter(help="Folder of the scan, with finished cloud and mesh stages.")
]
Name = Annotated[str, Parameter(help="What to call it: OUT/measure/NAME.json.")]


@Parameter(name="*", group=PART)
@dataclass(frozen=True)
class PartFlags:
    """Which part of the scan: all of it, --near-m and --within-mm, or --box-m."""

    near_m: MaybePlace = None
    """Middle of the part that is measured, as X,Y,Z [m]; with --within-mm."""
    within_mm: float | None = None
    """How far the part reaches from there [mm]."""
    box_m: MaybePlace = None
    """The part as two corners of a box, X,Y,Z,X,Y,Z [m]."""

    def select(self) -> "Selection | None":
        """Give the part; None: all of the scan."""
        from ..measure import Ball, Box

        is_ball = self.near_m is not None
        if is_ball != (self.within_mm is not None) or (is_ball and self.box_m is not None):
            raise InputError(
                "Choose a part with --near-m and --within-mm together, or with --box-m."
            )
        if self.near_m is not None and self.within_mm is not None:
            return Ball(read_place("--near-m", self.near_m), self.within_mm / 1e3)
        if self.box_m is None:
            return None
        return Box(*read_box("--box-m", self.box_m))


def read_place(flag: str, text: str) -> tuple[float, float, float]:
    """Read X,Y,Z [m]."""
    place = _read_three(flag, text)
    if max(map(abs, place)) > _FARTHEST:
        raise InputError(f"{flag} {text} is no place on Earth; give X,Y,Z in metres.")
    return place


def read_plane(point_m: str, normal: str) -> "Plane":
    """Read a plane from --point-m and --normal."""
    import numpy as np

    from ..types.plane import Plane

    direction = np.array(_read_direction("--normal", normal))
    return Plane.through(np.array(read_place("--point-m", point_m)), direction)


def read_cylinder(point_m: str, axis: str, radius_mm: float) -> "Cylinder":
    """Read a cylinder from --point-m, --axis and --radius-mm."""
    import numpy as np

    from ..types.cylinder import Cylinder

    if not 0 < radius_mm < float("inf"):
        raise InputError(f"--radius-mm must be above 0, got {radius_mm:g}.")
    direction = np.array(_read_direction("--axis", axis))
    point = np.array(read_place("--point-m", point_m))
    return Cylinder(point, direction / np.linalg.norm(direction), radius_mm / 1e3)


def _read_direction(flag: str, text: str) -> tuple[float, float, float]:
    direction = _read_three(flag, text)
    largest = max(map(abs, direction))
    if not largest:
        raise InputError(f"{flag} 0,0,0 is no direction; give one such as 0,1,0.")
    # Of numbers near the ends of their range the squares have none.
    return _three(part / largest for part in direction)


def _read_three(flag: str, text: str) -> tuple[float, float, float]:
    numbers = read_numbers(text, 3)
    if numbers is None:
        raise InputError(
            f"{flag} {text!r} is not X,Y,Z; give three numbers such as 0.12,0.5,0.803."
        )
    return _three(numbers)


def print_measurement(
    out: Path,
    name: str,
    found: "Measurement",
    *,
    endings: tuple[str, ...] = (),
    then: str = _PROVE,
) -> None:
    """Print a measurement as a table, what its intervals lack, and where it was written.

    Args:
        out: Folder of the scan.
        name: What the measurement is called.
        found: The measurement.
        endings: Of the files that were written beside its .json.
        then: What to do next.
    """
    from ..project import Project, load_georeference
    from ..project.unstated import list_unstated

    rows = [_row(quantity) for quantity in found.quantities]
    columns = (found.kind, "value", "±95%", "1σ own", "1σ common", "unit")
    print_table("", columns, rows)
    if found.places and (place := load_georeference(Project(out))) is not None:
        tell("place", *(f"{what}: {place.describe(at)}" for what, at in found.places.items()))
    for text in (*found.remarks, *list_unstated(Project(out))):
        say(text)
    tell("meaning", _MEANING)
    tell("made", *(str(out / "measure" / f"{name}{end}") for end in (".json", *endings)))
    tell("next", then)


def tell_of_report(out: Path) -> str:
    """Say where anomalies and dents are listed for others to read."""
    return f"murkscan report {quote(str(out))}: its page lists them, with pictures"


def _row(quantity: "Quantity") -> tuple[str, ...]:
    unit, scale = _SHOWN.get(quantity.unit, (quantity.unit, 1.0))
    if quantity.name in _PLACES:
        unit, scale = "m", 1.0
    half, common = scale * quantity.half_width, quantity.sigma_common
    # Set, as one coordinate of a cylinder's axis is, or given by the others, as of a direction.
    if half < 0.5 * 10.0**-_DIGITS:
        name, value = quantity.name.replace("_", " "), scale * quantity.value
        return (name, f"{value:.4f}", "–", "", "", unit)
    return (
        quantity.name.replace("_", " "),
        _round(scale * quantity.value, half),
        _round(half, half),
        _round(scale * quantity.sigma_independent, half),
        "unknown" if common is None else _round(scale * common, half),
        unit,
    )


def _round(value: float, uncertainty: float) -> str:
    """Write a number to two digits of its uncertainty, up to a millionth."""
    digits = 1 - math.floor(math.log10(uncertainty)) if uncertainty > 0 else 4
    return f"{value:.{min(max(digits, 0), _DIGITS)}f}"


def _three(numbers: Iterable[float]) -> tuple[float, float, float]:
    x, y, z = numbers
    return x, y, z
