"""Which of several lines on boards belongs to which laser."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from jaxtyping import Float

from ...optics import distance_to_sheet
from ...types.arrays import Scalars
from ...types.laser import Laser
from ...types.plane import Plane
from .stripe import StripeOnBoard

Line = Float[np.ndarray, "_ 3"]
"""Points of one line in the camera frame [m]."""
_ON_SHEET = 0.01
"""Distance of a line's points from a sheet, over their distance from the camera, within which the
line is of that sheet: ten times what a calibrated sheet is off, a tenth of what two are apart."""
_FEW = 10
"""Points of a line that a sheet is laid through."""
_MANY = 40
"""Lines of which each two are tried as a sheet."""


def assign_lines(
    lines: Sequence[StripeOnBoard],
    points: Sequence[Line],
    numbers: Sequence[int],
    known: Mapping[int, Laser],
    index: float,
) -> list[StripeOnBoard]:
    """Tell which laser made each line: all lines of a laser lie in one sheet.

    Lines of known lasers are passed over. Of the others, the sheet that has most lines is taken
    first; sheets that are found together are numbered from left to right, or from top to bottom, as
    their lines are in the pictures.

    Args:
        lines: The lines, perhaps several a photo.
        points: Their points in the camera frame [m].
        numbers: Numbers of the lasers that are looked for.
        known: The other lasers of the rig, by number.
        index: Refractive index of what the rig is in.

    Returns:
        The lines of the lasers looked for, with their numbers; at most one a photo and laser.
    """
    left = [
        i
        for i, place in enumerate(points)
        if not any(
            _is_on(distance_to_sheet(place, laser, index), place) for laser in known.values()
        )
    ]
    sheets = list[list[int]]()
    for _ in numbers:
        members = _largest_sheet(left, lines, points)
        sheets.append(members)
        left = [i for i in left if i not in members]
    sheets.sort(key=lambda members: _position(members, lines))
    return [
        replace(lines[i], laser=number)
        for number, members in zip(sorted(numbers), sheets, strict=True)
        for i in members
    ]


def _largest_sheet(
    left: Sequence[int], lines: Sequence[StripeOnBoard], points: Sequence[Line]
) -> list[int]:
    """Find the lines of the sheet that passes through most photos."""
    best = list[int]()
    few = [left[i] for i in np.linspace(0, len(left) - 1, min(len(left), _MANY)).astype(int)]
    for first, second in combinations(few, 2):
        if lines[first].name == lines[second].name:
            continue
        plane = _plane_through(points[first], points[second])
        members = _members(plane, left, lines, points)
        if len(members) > len(best):
            best = members
    return best


def _plane_through(first: Line, second: Line) -> Plane:
    """Fit a plane to two lines, which count alike however long they are."""
    few = [p[np.linspace(0, len(p) - 1, _FEW).astype(int)] for p in (first, second)]
    both = np.concatenate(few)
    middle = both.mean(axis=0)
    return Plane.through(middle, np.linalg.svd(both - middle, full_matrices=False)[2][2])


def _members(
    plane: Plane, left: Sequence[int], lines: Sequence[StripeOnBoard], points: Sequence[Line]
) -> list[int]:
    """List the lines on a plane, the nearest one of each photo."""
    nearest = dict[str, tuple[float, int]]()
    for i in left:
        off = plane.distance_to(points[i])
        if _is_on(off, points[i]):
            size = float(np.median(np.abs(off)))
            nearest[lines[i].name] = min(nearest.get(lines[i].name, (np.inf, i)), (size, i))
    return [i for _, i in nearest.values()]


def _is_on(off: Scalars, points: Line) -> bool:
    distance = float(np.median(np.linalg.norm(points, axis=1)))
    return float(np.median(np.abs(off))) < _ON_SHEET * distance


def _position(members: Sequence[int], lines: Sequence[StripeOnBoard]) -> float:
    """Compute where in the pictures the lines of a sheet are, across themselves [px]."""
    if not members:
        return np.inf
    along = [np.ptp(lines[i].pixels, axis=0) for i in members]
    across = int(np.argmin(np.sum(along, axis=0)))
    return float(np.mean([lines[i].pixels[:, across].mean() for i in members]))
