"""A ball of known size in a scan: where it is, how much of it is seen, and the distance of two."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, KDTree

from ..errors import EstimationError, NotEnoughData
from ..geometry.shape_fit import ShapeFit
from ..geometry.sphere_fit import fit_sphere
from ..geometry.stripe_blur import is_readable
from ..types.arrays import Directions, Mask, Points, Scalars, Vector
from ..types.quantity import Quantity
from ..types.sphere import Sphere
from .fits import trust_sphere
from .form import measure_form
from .sample import Sample
from .trust import FitUncertainty

LEAST_SEEN = 0.1
"""Share of a ball's surface below which its centre and size mean little."""
_VOTES = 0.15
"""Radius, over the ball's, within which places agree that points point to: normals are good to
some five degrees."""
_MOST_VOTES = 3000
"""Points that are asked for the centre."""
_FEWEST = 20
"""Points that must agree on one."""
_START = 0.25
"""Distance from the ball's surface, over its radius, of points that it is first fitted to …"""
_BAND = 0.1
"""… and of those that belong to it in the end: what holds the ball is none of it."""
_ALIKE = 0.15
"""Difference from the known radius, over it, beyond which it is another thing."""


@dataclass(frozen=True, eq=False)
class FoundBall:
    """A ball in a scan."""

    sample: Sample
    """Its points, those that the fit left out among them."""
    fit: ShapeFit[Sphere]
    trust: FitUncertainty
    """How far to trust the centre's x, y and z, and the radius."""
    seen: float
    """Share of the whole ball's surface that the points of the fit cover."""

    @property
    def diameter(self) -> Quantity:
        """Its diameter [m]."""
        how = np.zeros((1, self.fit.slopes.shape[1]))
        how[0, 3] = 2.0
        values = {"diameter": 2 * self.fit.shape.radius}
        return self.trust.as_quantities(values, ("m",), how)[0]

    @property
    def form(self) -> Quantity:
        """How far its points scatter about the sphere [m]; see `measure_form`."""
        counted = self.sample[self._counts]
        return measure_form("form", self.distances, counted.profile, counted.line)

    @property
    def distances(self) -> Scalars:
        """Signed distance of its points from the sphere [m].

        What the stripe's blur moves is in it: it is a fault of the scan, too. Places that turn away
        from the camera or the light by 60 degrees or more do not count.
        """
        return self.fit.shape.distance_to(self.sample.cloud.points[self._counts])

    @property
    def _counts(self) -> Mask:
        """Tell which points count."""
        if self.sample.sight is None:
            return np.ones(len(self.sample), bool)
        return is_readable(self.fit.shape, self.sample.cloud.points, self.sample.sight)


def find_ball(sample: Sample, near: Vector, radius: float) -> FoundBall:
    """Find a ball of known size that holds a place, and fit a sphere to its points.

    Each point says where the centre is, a radius behind it along its normal; where most agree the
    ball is looked for, whatever else stands around.

    Args:
        sample: The scan's points.
        near: A place on the ball or in it [m].
        radius: Its radius, about [m].

    Raises:
        NotEnoughData: There is none, or less than a tenth of it is seen.
        Degenerate: Its points cover too little to tell its size.
        NotConverged: No sphere settles.
    """
    around = sample[np.linalg.norm(sample.cloud.points - near, axis=1) <= 2 * radius]
    centre = _vote_for_centre(around, near, radius)
    start = around[_off(around.cloud.points, centre, radius) < _START * radius]
    try:
        sphere = fit_sphere(start.cloud.points, sight=start.sight).shape
    except EstimationError as error:
        raise NotEnoughData(_no_ball(around, near, radius)) from error
    if abs(sphere.radius - radius) > _ALIKE * radius:
        raise NotEnoughData(
            f"what lies near {_place(near)} m has a diameter of {2e3 * sphere.radius:.1f} mm and "
            f"not of {2e3 * radius:g} mm: correct near_m or diameter_mm."
        )
    own = around[_off(around.cloud.points, sphere.centre, sphere.radius) < _BAND * radius]
    fit, trust = trust_sphere(own)
    seen = _share_seen(fit.shape.normals(own.cloud.points[fit.inliers]))
    if seen < LEAST_SEEN:
        raise NotEnoughData(
            f"the scan shows {seen:.0%} of its surface, and less than a tenth tells neither its "
            "size nor its centre well: scan it whole, from nearer or from above."
        )
    return FoundBall(own, fit, trust, seen)


def measure_spacing(first: FoundBall, second: FoundBall) -> Quantity:
    """Give the distance from centre to centre.

    Args:
        first: A ball.
        second: Another one of the same scan, so that the rig's errors move both together.
    """
    between = second.fit.shape.centre - first.fit.shape.centre
    length = float(np.linalg.norm(between))
    along = between / length
    variances = [float(along @ ball.trust.independent[:3, :3] @ along) for ball in (first, second)]
    common = None
    if first.trust.common is not None and second.trust.common is not None:
        moved = second.trust.common[:3] - first.trust.common[:3]
        common = float(np.linalg.norm(along @ moved))
    # JCGM 100:2008, equation (G.2b).
    degrees = sum(variances) ** 2 / sum(
        variance**2 / ball.trust.degrees
        for variance, ball in zip(variances, (first, second), strict=True)
    )
    return Quantity("spacing", length, "m", math.sqrt(sum(variances)), common, degrees)


def _vote_for_centre(sample: Sample, near: Vector, radius: float) -> Vector:
    """Find the place on which most points agree that it lies a radius behind them."""
    cloud = sample.cloud
    votes = (cloud.points - radius * cloud.normals)[:: max(len(sample) // _MOST_VOTES, 1)]
    tree = KDTree(votes)
    agree = tree.query_ball_point(votes, _VOTES * radius, return_length=True) if len(votes) else [0]
    if np.max(agree) < _FEWEST:
        raise NotEnoughData(_no_ball(sample, near, radius))
    most = tree.query_ball_point(votes[int(np.argmax(agree))], _VOTES * radius)
    centre: Vector = votes[most].mean(axis=0)
    return centre


def _no_ball(around: Sample, near: Vector, radius: float) -> str:
    return (
        f"no ball of {2e3 * radius:g} mm lies near {_place(near)} m, where the scan has "
        f"{len(around)} points: read a place on it off cloud/cloud.ply into near_m, or scan that "
        "part again."
    )


def _off(points: Points, centre: Vector, radius: float) -> Scalars:
    return np.abs(np.linalg.norm(points - centre, axis=1) - radius)


def _share_seen(directions: Directions) -> float:
    """Give the share of all directions that lie between some, by a map that keeps areas.

    References:
        Snyder, Map Projections: A Working Manual, USGS Professional Paper 1395, 1987, chapter 24
        (Lambert's azimuthal equal-area projection).
    """
    middle = directions.mean(axis=0)
    middle /= np.linalg.norm(middle)
    sides = np.linalg.svd(middle[None])[2][1:]
    facing = np.clip(directions @ middle, -0.999, 1.0)
    flat = (directions @ sides.T) * np.sqrt(2 / (1 + facing))[:, None]
    return float(ConvexHull(flat).volume) / (4 * math.pi)


def _place(point: Vector) -> str:
    return ",".join(f"{part:g}" for part in point)
