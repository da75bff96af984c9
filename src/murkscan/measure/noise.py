"""How much the points around a place scatter."""

import numpy as np

from ..errors import EstimationError
from ..geometry.plane_fit import fit_plane
from ..types.arrays import Points, Scalars
from ..types.cloud import PointCloud

NEIGHBOURS = 40
"""Points around a place whose scatter about their plane tells its noise."""
_PROBES = 60
"""Places at which a scan's noise is looked at."""


def noise_at(cloud: PointCloud, places: Points) -> Scalars:
    """Give the standard deviation of a point of the scan at each place [m].

    It is the stated noise of the nearest point, or the scatter of the points around it about their
    plane where that is larger: the stated one knows neither speckle nor a finder's slips.

    Args:
        cloud: The scan's points.
        places: Where, on the surface [m].
    """
    return np.array([_noise_around(cloud, place[None]) for place in places])


def usual_noise(cloud: PointCloud) -> float:
    """Give the usual standard deviation of a point of the scan [m]."""
    some = np.linspace(0, len(cloud) - 1, min(_PROBES, len(cloud))).astype(int)
    return float(np.median(noise_at(cloud, cloud.points[some])))


def _noise_around(cloud: PointCloud, place: Points) -> float:
    away = np.linalg.norm(cloud.points - place, axis=1)
    count = min(NEIGHBOURS, len(away))
    around = np.argpartition(away, count - 1)[:count]
    stated = float(cloud.sigma[around[np.argmin(away[around])]])
    try:
        fit = fit_plane(cloud.points[around])
    except EstimationError:
        return stated
    return max(stated, float(np.std(fit.residuals[fit.inliers])))
