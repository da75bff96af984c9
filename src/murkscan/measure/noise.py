"""How much the points around a place scatter."""

import numpy as np

from ..errors import EstimationError
from ..geometry.plane_fit import fit_plane
from ..types.arrays import Points, Scalars
from .sample import Sample

NEIGHBOURS = 40
"""Points around a place whose scatter about their plane tells its noise."""


def noise_at(sample: Sample, places: Points) -> Scalars:
    """Give the standard deviation of a point of the scan at each place [m].

    It is the stated noise of the nearest point, or the scatter of the points around it about their
    plane where that is larger: the stated one knows neither speckle nor a finder's slips.

    Args:
        sample: The scan's points.
        places: Where, on the surface [m].
    """
    return np.array([_noise_around(sample, place[None]) for place in places])


def _noise_around(sample: Sample, place: Points) -> float:
    away = np.linalg.norm(sample.cloud.points - place, axis=1)
    count = min(NEIGHBOURS, len(away))
    around = np.argpartition(away, count - 1)[:count]
    stated = float(sample.cloud.sigma[around[np.argmin(away[around])]])
    try:
        fit = fit_plane(sample.cloud.points[around])
    except EstimationError:
        return stated
    return max(stated, float(np.std(fit.residuals[fit.inliers])))
