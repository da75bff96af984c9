"""Facets of two legs that lie on one another."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial import cKDTree

from ...types.arrays import Directions, Indices, Mask, Points, Scalars
from .legs import Facets, Leg, make_facets
from .normals import steady_normals
from .path import Path
from .relief import make_heights
from .restless import slopes_of_errors
from .ties import Ties

Rows = Bool[np.ndarray, "rows"]
"""Which rows of a leg's cells."""
_AGREE = 0.8
"""Cosine of the angle between normals up to which two facets may be of one surface."""
_BEYOND = 1.0
"""Cells by which the nearest facet may lie aside; beyond that the leg's rim has been passed."""
_GOLDEN = (5**0.5 - 1) / 2
_SLOWEST = 0.01
"""Speed of a line over the surface below which it is not known where it was when [m/s]."""
_STEEP = 0.3
"""Cosine of the angle between a sheet and a surface's normal below which it only grazes it."""


@dataclass(frozen=True, eq=False)
class Side:
    """A leg's facets, made ready to be paired."""

    facets: Facets
    tree: cKDTree
    directions: Directions
    """Normals of which only that counts which is no noise."""
    smooth: Directions
    """Mean normals of patches: what counts where bumps may not be those of the other leg."""
    relief: float
    """Variance of the bumps that these leave [m²]."""
    path: Path
    """Where the leg lies."""
    delays: Float[np.ndarray, "r 3"]
    """How much later the leg saw what lies beside each row [s/m], in the world."""

    def at_places(self, which: Indices, aside: Directions) -> tuple[Scalars, Points]:
        """Give when the leg saw what lies aside of some facets, and where its vehicle saw it.

        A place that both legs have seen is one place only if it is the same for both: were a
        facet's middle taken for what lies millimetres aside of it, a way whose errors go on from
        one leg to the other would seem to be seen, by its slope over those millimetres.

        Args:
            which: Facets.
            aside: From their middles, in the world [m].
        """
        rows = self.facets.row[which]
        later = np.einsum("ni,ni->n", self.delays[rows], aside)
        knots = self.path.knots
        times = np.clip(self.facets.leg.row_times[rows] + later, knots.start, knots.end)
        poses = self.path.at(times)
        places = self.facets.points[which] + aside
        return times, np.einsum("nji,nj->ni", poses.rotations, places - poses.positions)


def make_sides(
    legs: Sequence[Leg],
    paths: Sequence[Path],
    errors: Sequence[Float[np.ndarray, "k 6 m"]] | None = None,
) -> list[Side]:
    """Fit each leg's facets where its path lies, and make them ready to be paired.

    Args:
        legs: All legs.
        paths: All paths.
        errors: Some that the control values of each path may have, drawn; None: none.
    """
    sides = []
    for leg in legs:
        path = paths[leg.number]
        facets = make_facets(leg, path)
        made = None if errors is None else slopes_of_errors(facets, path, errors[leg.number])
        sides.append(make_side(facets, path, made))
    return sides


def make_side(facets: Facets, path: Path, made: Float[np.ndarray, "r 2"] | None = None) -> Side:
    """Make a leg's facets ready to be paired, where its path lies; `made` as `steady_normals`."""
    directions, smooth = steady_normals(facets, made)
    heights = make_heights(facets)
    relief = float(np.var(heights))
    tree = cKDTree(facets.points)
    return Side(facets, tree, directions, smooth, relief, path, _delays(facets))


def _delays(facets: Facets) -> Float[np.ndarray, "r 3"]:
    """Give how time goes on across each row of a leg [s/m]: not at all within its sheet."""
    leg, rows = facets.leg, len(facets.leg.row_times)
    held = np.maximum(np.bincount(facets.row, minlength=rows), 1)[:, None]

    def total(values: Float[np.ndarray, "n d"]) -> Float[np.ndarray, "r d"]:
        return np.stack([np.bincount(facets.row, v, minlength=rows) for v in values.T], axis=1)

    centre, column = total(facets.points) / held, total(facets.column[:, None] * 1.0) / held
    off = (facets.column - column[facets.row, 0])[:, None]
    across = np.cross(total(off * (facets.points - centre[facets.row])), total(facets.slants))
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    there = np.flatnonzero(np.bincount(facets.row, minlength=rows) > 1)
    delays = np.zeros((rows, 3))
    if len(there) < 3:
        return delays
    speed = np.gradient(centre[there], leg.row_times[there], axis=0)
    pace = np.einsum("ni,ni->n", speed, across[there])
    pace = np.copysign(np.maximum(np.abs(pace), _SLOWEST), pace)
    delays[there] = across[there] / pace[:, None]
    return delays


def pair_facets(a: Side, b: Side, reach: float, most: int, *, bumps_match: Rows) -> Ties:
    """Tie the facets of one leg to those of another that lie nearest.

    The direction is the mean normal of both, which takes the curve out of the distance between
    their middles to second order (Rusinkiewicz, A symmetric objective function for ICP, SIGGRAPH
    2019).

    Args:
        a: The one leg.
        b: The other.
        reach: How far along the normal they may lie apart [m].
        most: Ties that are enough; of more, some are drawn, always the same.
        bumps_match: In which rows of the one leg they lie within a bump's width of one another.
            Where that is not known, bumps are noise, and ties say nothing of the shift along the
            surface: otherwise they would hold the legs wherever they lie.
    """
    first = _draw(np.arange(len(a.facets)), 2 * most)
    size = max(a.facets.leg.size, b.facets.leg.size)
    found = b.tree.query(
        a.facets.points[first], distance_upper_bound=float(np.hypot(reach, _BEYOND * size))
    )
    distance, second = np.asarray(found[0]), np.asarray(found[1])
    near = np.isfinite(distance)
    ties = _tie(a, b, first[near], second[near], reach, bumps_match=bumps_match)
    return ties[_draw(np.arange(len(ties)), most)]


def measure_apart(a: Side, b: Side, reach: float) -> tuple[Scalars, Indices]:
    """Give how far each facet of a leg lies in front of another leg [m], and the rows of these."""
    one, two = a.facets, b.facets
    size = max(one.leg.size, two.leg.size)
    found = b.tree.query(one.points, distance_upper_bound=float(np.hypot(reach, _BEYOND * size)))
    first = np.flatnonzero(np.isfinite(found[0]))
    second = np.asarray(found[1])[first]
    normal = a.directions[first] + b.directions[second]
    length = np.linalg.norm(normal, axis=1)
    normal /= np.maximum(length, 1e-12)[:, None]
    between = one.points[first] - two.points[second]
    off = np.einsum("ni,ni->n", normal, between)
    lateral = np.linalg.norm(between - off[:, None] * normal, axis=1)
    kept = (length > 2 * _AGREE) & (np.abs(off) < reach) & (lateral < _BEYOND * size)
    return off[kept], one.row[first[kept]]


def _draw(which: Indices, most: int) -> Indices:
    """Draw some of many, spread evenly and without a pattern: by multiples of the golden ratio."""
    if len(which) <= most:
        return which
    return which[(which * _GOLDEN) % 1.0 < most / len(which)]


def _tie(
    a: Side, b: Side, first: Indices, second: Indices, reach: float, *, bumps_match: Rows
) -> Ties:
    one, two = a.facets, b.facets
    size = max(one.leg.size, two.leg.size)
    match = bumps_match[one.row[first]]
    direction, alike = _mean_normals(a, b, first, second, match)
    between = one.points[first] - two.points[second]
    off = np.einsum("ni,ni->n", direction, between)
    of_one, of_two = _middles(a, first, match), _middles(b, second, match)
    there_a, there_b = _meet(one.slants[first], two.slants[second], direction, off, of_one, of_two)
    aside = between + there_a - there_b
    lateral = np.linalg.norm(aside, axis=1)
    kept = (alike > _AGREE) & (np.abs(off) < reach) & (lateral < _BEYOND * size)
    kept &= _are_inner(one)[first] & _are_inner(two)[second]
    variance = of_one + of_two + _beside(one, first, aside) + _beside(two, second, aside)
    times_a, own_a = a.at_places(first[kept], there_a[kept])
    times_b, own_b = b.at_places(second[kept], (aside + there_b)[kept])
    count = len(own_a)
    return Ties(
        np.full(count, one.leg.number),
        times_a,
        own_a,
        np.full(count, two.leg.number),
        times_b,
        own_b,
        direction[kept],
        -off[kept],
        variance[kept],
    )


def _mean_normals(
    a: Side, b: Side, first: Indices, second: Indices, match: Mask
) -> tuple[Directions, Scalars]:
    """Give the mean normals of pairs, of bumps or of patches, and how much the two are alike."""
    total = np.where(
        match[:, None],
        a.directions[first] + b.directions[second],
        a.smooth[first] + b.smooth[second],
    )
    length = np.linalg.norm(total, axis=1)
    return total / np.maximum(length, 1e-12)[:, None], length / 2


def _middles(side: Side, which: Indices, match: Mask) -> Scalars:
    """Give the variance of the middles of some facets [m²], and of bumps where none match."""
    facets = side.facets
    own = facets.variance[which] / facets.count[which]
    return np.asarray(own + np.where(match, 0.0, side.relief))


def _meet(
    slant_a: Directions,
    slant_b: Directions,
    direction: Directions,
    off: Scalars,
    of_one: Scalars,
    of_two: Scalars,
) -> tuple[Points, Points]:
    """Give by what one comes from both surfaces to where they meet, each along its own sheet.

    A point that is off lies off along its sheet. Were places compared that lie over one another
    along the normal, noise of a height would be one of the moment, too, in step with it, and ways
    that let all heights shrink would seem to fit better. So would ways that turn sheets until they
    graze, were the arm of a turn to reach to the noisy point: of what is off by its sheet's length
    less is then off along the normal. Of thousands of ties that pull outweighs what a log says, and
    it never ends, since noise is as large as before in facets made anew. A place's arm has to reach
    to where the place most likely is.

    Args:
        slant_a: Along which points of the first sheets err.
        slant_b: Along which those of the second do.
        direction: Normals.
        off: How far the first lies in front of the second [m].
        of_one: Variance of the first height [m²].
        of_two: Of the second.

    References:
        Fuller, Measurement error models, 1987, section 3.2: slopes are taken at the estimate of
        the true point.
    """

    def along(slant: Directions) -> Directions:
        steep = np.einsum("ni,ni->n", slant, direction)
        steep = np.copysign(np.maximum(np.abs(steep), _STEEP), steep)
        return slant / steep[:, None]

    share = of_one / np.maximum(of_one + of_two, 1e-30)
    there_a = -(share * off)[:, None] * along(slant_a)
    return there_a, ((1 - share) * off)[:, None] * along(slant_b)


def _are_inner(facets: Facets) -> Mask:
    """Tell which facets have neighbours on all sides.

    A rim's plane has a slope that errs with the height of its middle, which looks like a shift.
    """
    inner = np.ones(len(facets), bool)
    for number in (facets.row, facets.column):
        inner &= (number > number.min(initial=1 << 30)) & (number < number.max(initial=0))
    return inner


def _beside(facets: Facets, which: Indices, aside: Directions) -> Scalars:
    """Give what a facet's slope adds to the variance of a tie halfway beside its middle [m²]."""
    along = np.einsum("ni,nki->nk", aside, facets.axes[which])
    slope = np.einsum("nk,nk->n", along**2, facets.slope_variance[which]) / 4
    return facets.variance[which] * slope
