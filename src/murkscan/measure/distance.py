"""The distance between two points of a scan."""

import numpy as np

from ..errors import InputError
from ..optics.length import measure_length
from ..types.arrays import Indices, Points, Vector
from ..types.measurement import Measurement
from ..types.quantity import Quantity
from .noise import NEIGHBOURS, noise_at
from .remarks import remark_on_ends
from .sample import Sample

_FARTHEST = 0.01
"""Distance from a given place within which a point of the scan must lie [m]."""


def measure_distance(sample: Sample, ends: Points) -> Measurement:
    """Measure between the points of the scan that lie nearest to two places.

    The independent part is the stated noise of each end along its ray, or the scatter of the points
    around it where that is larger; what both share counts only as far as it stretches the length.

    Args:
        sample: The scan's points.
        ends: The two places [m].

    Raises:
        InputError: No point lies within 10 mm of a place.
        Degenerate: Both ends are the same point.
    """
    which = np.array([_nearest(sample, end) for end in ends])
    points = sample.cloud.points[which]
    sigma = noise_at(sample.cloud, points)
    common = np.zeros((2, 3, 0)) if sample.shifts is None else sample.shifts(which)
    length = measure_length(points, _directions(sample, which) * sigma[:, None], common)
    quantity = Quantity(
        "distance",
        length.value,
        "m",
        length.sigma_independent,
        None if sample.shifts is None else length.sigma_common,
        degrees=float(NEIGHBOURS - 3),
    )
    details = {"from_m": points[0].tolist(), "to_m": points[1].tolist()}
    remarks = remark_on_ends(ends, points, quantity.half_width)
    places = dict(zip(("from", "to"), points, strict=True))
    return Measurement("distance", (quantity,), details, remarks, places)


def _nearest(sample: Sample, end: Vector) -> int:
    away = np.linalg.norm(sample.cloud.points - end, axis=1)
    number = int(np.argmin(away))
    if away[number] > _FARTHEST:
        place = ",".join(f"{part:.10g}" for part in end)
        raise InputError(
            f"No point of the scan lies within {_FARTHEST * 1e3:.0f} mm of {place} m, "
            f"the nearest is {away[number] * 1e3:.0f} mm away; click both on the model's page "
            "(murkscan view), which has this command to copy."
        )
    return number


def _directions(sample: Sample, which: Indices) -> Points:
    """Give the direction in which each end errs: its ray; where none is known, the worst one."""
    if sample.sight is not None:
        return sample.sight.rays[which]
    between = np.diff(sample.cloud.points[which], axis=0)
    return np.repeat(between / max(float(np.linalg.norm(between)), 1e-300), 2, axis=0)
