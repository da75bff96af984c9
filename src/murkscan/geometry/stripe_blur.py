"""How a blurred stripe of some thickness misses a surface that curves.

The lens's blur mixes, into each scan line, light of its neighbours. On a straight stripe they
balance; on one that bends they pull the centre to the hollow side, and where it slopes in the
picture they pull it to the brighter neighbour. Let the inverse depth of the stripe be w(u), with
u = x / z, and its light I(u): blur of variance s_u² changes w by s_u² (w'' / 2 + w' I' / I).

In the plane of a scan line, a found centre moves along the sheet, in the direction e (below). Let
the stripe run along a, n be the surface's normal, v the line of sight, t = (n a) / (n e) and
T = a - t e, along which the stripe runs on the surface, with curvature k(T, T). With s = s_u z, the
distance from the surface changes by

    - s² (k(T, T) / 2 + (n a) (k(T, v) / (n v) + g t)),

for what reaches the camera of the light that the sheet carries is as n v over the cube of the
depth, and the water takes of it both ways: g is the share that is lost with each metre of depth.
Where e = v this is s² k (tan² f - 1) / 2, of a normal that leans by f along the stripe. The next
order, of a circle seen from far away, is s⁴ k³ (17 - 16 cos² f) / (8 cos⁶ f).

Through its thickness the sheet lights the surface beside its middle, too: nearer and farther, more
and less brightly. In the plane of a scan line let X' run along the surface as far as takes a metre
across the sheet; X'' = - k(X', X') e / (n e) lies in the sheet. Seen along q, across v, the mean of
light of variance h² lies off by h² (3/2 q X'' + q X' (k(X', e) / (n e) - g' v X')), which is
1 / (q e) as far along e; in g' are the water's share, and four over the depth for how much less a
metre farther away is lit, and is seen.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..types.arrays import Directions, Mask, Points, Scalars
from .shape import AnyShape

_LEAST_FACING = 0.5
"""Cosine of the angle between normal and line of sight, or the light, below which the stripe on a
curved surface is not to be trusted: 60 degrees. Where the light grazes, the stripe widens, and its
far side is darker than its near one."""
MOST_BLUR = 1.2
"""Most blur along a stripe, in widths of its core at right angles to it: it has a skirt, too. On
the hull it is 1.04 of them, and 1.18 where the stripe is rolled by 63° (benchmarks/murk.py, seed
0)."""
_LOST = 3.0
"""What the water takes of the light, there and back, for a metre of depth, and how far that is
open, 1σ [1/m]: of c = 0 to 3 /m, in which a stripe is seen well."""
_THICKNESS = 6e-8
"""Variance of the sheet's thickness, and how far it is open, 1σ [m²]: between none and that of a
line of 1 mm (1/e²) with 1.4 mrad, such as modules have, 0.9 m away in water."""


@dataclass(frozen=True, eq=False)
class Sight:
    """From where points were seen."""

    rays: Directions
    """Unit direction from the camera to each point."""
    along: Directions
    """Unit direction in which the stripe runs in the picture, at each point."""
    light: Directions | None = None
    """Unit direction of the light at each point, as far as it lies across the stripe; None where
    nobody knows."""
    ranges: Scalars | None = None
    """Distance of each point from the camera [m]; None where nobody knows."""
    blur_shift: Scalars | None = None
    """How much farther along its ray the blur had moved each point before the finder put it back
    [m]; None where no finder puts anything back."""
    widths: Scalars | None = None
    """1σ of the stripe at each point, as wide as it looks [m]; None where nobody knows, 0 where no
    finder has learnt it."""
    pulled_back: Mask | None = None
    """Whether each was put back to where it would be if what the sheet lights were alike bright
    across it; see `triangulate.undo_paint_pull`. None where none was."""

    def __getitem__(self, which: Mask) -> "Sight":
        """Pick some of the points."""
        return Sight(
            self.rays[which],
            self.along[which],
            *(
                None if column is None else column[which]
                for column in (
                    self.light,
                    self.ranges,
                    self.blur_shift,
                    self.widths,
                    self.pulled_back,
                )
            ),
        )


@dataclass(frozen=True, eq=False)
class _Stripe:
    """The stripe on a surface, as the module's docstring has it; one place a row."""

    shape: AnyShape
    normals: Directions
    sight: Sight
    across: Directions
    """Unit direction of the line of sight, as far as it lies across the stripe."""
    sheet: Directions
    """The direction e, in which a centre moves along its sheet; as long as `across` along it."""

    @classmethod
    def of(cls, shape: AnyShape, points: Points, sight: Sight) -> "_Stripe":
        aside = _dot(sight.along, sight.rays)[:, None]
        across = sight.rays - aside * sight.along
        length = np.linalg.norm(across, axis=1, keepdims=True)
        across = across / length
        light = across if sight.light is None else sight.light
        light = light / _dot(light, across)[:, None]
        return cls(
            shape, shape.normals(points), sight, across, light + aside / length * sight.along
        )

    @property
    def lean(self) -> Scalars:
        """Give t, the stripe's slope along its sheet."""
        return _dot(self.normals, self.sight.along) / _away_from_zero(
            _dot(self.normals, self.sheet)
        )

    @property
    def tangents(self) -> Directions:
        """Give T, a metre across the line of sight long."""
        return self.sight.along - self.lean[:, None] * self.sheet

    def bend(self, one: Directions, other: Directions) -> Scalars:
        """Give the curvature along two directions, as far as they lie on the surface [1/m]."""
        one, other = self._onto(one), self._onto(other)
        return (self._bend(one + other) - self._bend(one - other)) / 4

    def _bend(self, ways: Directions) -> Scalars:
        length = np.linalg.norm(ways, axis=1)
        return length**2 * self.shape.curvature(ways / np.maximum(length, 1e-300)[:, None])

    def _onto(self, ways: Directions) -> Directions:
        return ways - _dot(ways, self.normals)[:, None] * self.normals


def blur_moves(
    shape: AnyShape, points: Points, sight: Sight, blur: float
) -> tuple[Scalars, Scalars]:
    """Give how far a blur along the stripe moves points off a shape, and the slope of that.

    Args:
        shape: What they lie on.
        points: The points [m].
        sight: From where they were seen.
        blur: Variance of the blur across the line of sight, at their mean distance [m²].

    Returns:
        Change of each point's distance [m], and its change with the variance [1/m].
    """
    stripe = _Stripe.of(shape, points, sight)
    along, tangents = _dot(stripe.normals, sight.along), stripe.tangents
    facing = _away_from_zero(_dot(stripe.normals, sight.rays))
    own = stripe.bend(tangents, tangents)
    slope = -own / 2 - along * (stripe.bend(tangents, sight.rays) / facing)
    wide = np.ones(len(points))
    if sight.ranges is not None:
        slope = slope - along * stripe.lean * _usual_loss(own, sight.ranges)
        wide = (sight.ranges / sight.ranges.mean()) ** 2
    flat = 1 / (1 + stripe.lean**2)
    next_order = (own * flat) ** 3 * (17 - 16 * flat) / (8 * flat**3)
    slope, next_order, known = wide * slope, wide**2 * next_order, max(blur, 0.0)
    return blur * slope + known**2 * next_order, slope + 2 * known * next_order


def expect_blur(sight: Sight) -> tuple[float, float] | None:
    """Give what is known of the blur beforehand: between none and what the stripe's width allows.

    The width is that of the blur and of the sheet together.

    Args:
        sight: From where points of one shape were seen.

    Returns:
        Its variance and the standard deviation of that [m²]; None where no width is known.

    References:
        JCGM 100:2008, section 4.3.7 (what lies between two limits, and nothing else is known).
    """
    if sight.widths is None or not np.all(sight.widths > 0):
        return None
    most = MOST_BLUR**2 * float(np.mean(sight.widths**2))
    return most / 2, most / math.sqrt(12)


def sheet_moves(shape: AnyShape, points: Points, sight: Sight) -> Scalars:
    """Give how far a sheet of usual thickness moves points off a shape [m].

    It is as uncertain as it is large.

    Args:
        shape: What they lie on.
        points: The points [m].
        sight: From where they were seen.
    """
    stripe = _Stripe.of(shape, points, sight)
    if sight.light is None or not np.any(shape.curvature(sight.along)):
        return np.zeros(len(points))
    return _THICKNESS * _thickness_slopes(stripe)


def moves_put_back(shape: AnyShape, points: Points, sight: Sight) -> Scalars:
    """Give by how much the finder has changed each point's distance for the blur, as read [m].

    The arguments are those of `sheet_moves`.
    """
    if sight.blur_shift is None:
        return np.zeros(len(points))
    stripe = _Stripe.of(shape, points, sight)
    # A centre that moves along its scan line moves its point along the sheet.
    sheetwards = sight.blur_shift / _dot(sight.rays, stripe.sheet)
    moved: Scalars = -_dot(stripe.normals, stripe.sheet) * sheetwards
    return moved


def loss_moves(shape: AnyShape, points: Points, sight: Sight, blur: float) -> Scalars:
    """Give how far points may lie off a shape for the light that the water takes, 1σ [m].

    The arguments are those of `blur_moves`.
    """
    stripe = _Stripe.of(shape, points, sight)
    if not np.any(shape.curvature(sight.along)):
        return np.zeros(len(points))
    moves: Scalars = blur * _LOST * _dot(stripe.normals, sight.along) * stripe.lean
    return moves


def is_readable(shape: AnyShape, points: Points, sight: Sight) -> Mask:
    """Tell which points do not lie where a curved surface turns from the camera or the light."""
    bent = np.abs(shape.curvature(sight.along)) > 0
    return ~bent | is_facing(shape.normals(points), sight)


def is_facing(normals: Directions, sight: Sight) -> Mask:
    """Tell which points do not turn from the camera or the light by 60 degrees or more."""
    ways = [way for way in (sight.rays, sight.light) if way is not None]
    facing = [np.abs(_dot(normals, way)) > _LEAST_FACING for way in ways]
    return np.asarray(np.all(facing, axis=0))


def _usual_loss(bend: Scalars, ranges: Scalars) -> Scalars:
    """Give g [1/m], on surfaces that curve."""
    return np.where(bend == 0, 0.0, 3 / ranges + _LOST)


def _thickness_slopes(stripe: _Stripe) -> Scalars:
    """Give the change of each point's distance with the variance of the sheet's thickness [1/m]."""
    sight, sheet, normals = stripe.sight, stripe.sheet, stripe.normals
    assert sight.light is not None  # `sheet_moves` asks
    beyond = np.cross(sheet, sight.along)
    beyond /= np.linalg.norm(beyond, axis=1, keepdims=True)
    # Across the line of sight in the plane of the scan line, which the sheet crosses in e.
    across = np.cross(sight.along, stripe.across)
    facing = _away_from_zero(_dot(normals, sheet))
    step = across / _away_from_zero(_dot(across, beyond))[:, None]
    step = step - (_dot(normals, step) / facing)[:, None] * sheet
    turn = -stripe.bend(step, step) / facing
    brighter = stripe.bend(step, sight.light) / _away_from_zero(_dot(normals, sight.light))
    if sight.ranges is not None:
        brighter = brighter - (4 / sight.ranges + _LOST) * _dot(step, sight.rays)
    if sight.pulled_back is not None:
        # It grows brighter over frames by paint and by shade: both were taken back.
        brighter = np.where(sight.pulled_back, 0.0, brighter)
    apart = _away_from_zero(_dot(across, sheet))
    centre = 1.5 * turn * apart + _dot(across, step) * brighter
    return _dot(normals, sheet) * centre / apart


def _away_from_zero(values: Scalars) -> Scalars:
    return np.where(np.abs(values) < 1e-9, 1e-9, values)


def _dot(one: Directions, other: Directions) -> Scalars:
    dots: Scalars = np.einsum("ij,ij->i", one, other)
    return dots
