"""How far to trust the parameters of a fit."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from jaxtyping import Float

from ..geometry.correlated_errors import covariance_of_fit
from ..geometry.shape import AnyShape, Slopes
from ..geometry.shape_fit import ShapeFit
from ..geometry.stripe_blur import expect_blur, loss_moves, sheet_moves
from ..types.quantity import Quantity
from .sample import Sample

_BLUR_MODEL = 0.35
"""Share of the blur's effect that its formula leaves open at each part of a stripe: root mean
square over two simulated pipes, in water of c = 0.3 and 1.5 /m, by Murk, most of it at their flanks
and where the water's skirt adds to the lens (tests/measure/test_blur_model.py)."""
_PART = 0.4
"""Size of a part over which it is off alike: change of the sine of the angle between normal and
stripe. The middle of those pipes is off alike up to 0.2 and more on both sides."""
_MOST_SHIFTED = 2000
"""Points for which the rig's errors are traced: they vary slowly over a shape."""

Shape = TypeVar("Shape", bound=AnyShape)

LinearMap = Float[np.ndarray, "q p"]
"""Change of each quantity with each parameter of a fit."""


@dataclass(frozen=True, eq=False)
class FitUncertainty:
    """Both parts of the uncertainty of a fit's parameters."""

    independent: Float[np.ndarray, "p p"]
    """Covariance from what differs between points."""
    degrees: float
    """Degrees of freedom behind it."""
    common: Float[np.ndarray, "p modes"] | None
    """How the parameters move with each independent error of the rig, at one standard deviation;
    None where the rig states none."""

    def as_quantities(
        self, values: dict[str, float], units: Sequence[str], how: LinearMap
    ) -> tuple[Quantity, ...]:
        """Give quantities that follow from the parameters, with their uncertainty.

        Args:
            values: Each quantity by its name.
            units: Their units.
            how: How each changes with each parameter.
        """
        independent = np.sqrt(np.maximum(np.einsum("qp,pr,qr->q", how, self.independent, how), 0))
        common = None if self.common is None else np.linalg.norm(how @ self.common, axis=1)
        return tuple(
            Quantity(
                name,
                value,
                units[i],
                float(independent[i]),
                None if common is None else float(common[i]),
                self.degrees,
            )
            for i, (name, value) in enumerate(values.items())
        )


def trust_fit(fit: ShapeFit[Shape], sample: Sample) -> tuple[ShapeFit[Shape], FitUncertainty]:
    """Move a fit to what is known of the blur beforehand, and find how far it is to be trusted.

    A small ball, or a pipe, is larger with less blur, and hardly fits worse: where its points leave
    that open, the stripe's width tells more.

    Args:
        fit: The fit to the sample's points.
        sample: The points that were fitted.
    """
    inside = fit.inliers
    independent = covariance_of_fit(
        fit.slopes[inside], fit.residuals[inside], sample.profile[inside], sample.line[inside]
    )
    by_model = moves_of_formula(fit, sample)
    matrix = independent.matrix + by_model @ by_model.T
    expected, spread, gain = _weigh_blur(fit, sample, matrix)
    if sample.sight is not None and gain.any():
        fit = fit.moved(gain * (expected - fit.blur), sample.cloud.points, sample.sight)
    keep = np.eye(len(gain))
    keep[:, -1] -= gain
    by_light = np.column_stack([keep @ moves_of_light(fit, sample), spread * gain])
    matrix = keep @ matrix @ keep.T + by_light @ by_light.T
    common = _common_moves(fit, sample)
    common = None if common is None else keep @ common
    return fit, FitUncertainty(matrix, independent.degrees, common)


def _weigh_blur(
    fit: ShapeFit[AnyShape], sample: Sample, matrix: Float[np.ndarray, "p p"]
) -> tuple[float, float, Float[np.ndarray, " p"]]:
    """Weigh what is known of the blur beforehand against what the points tell.

    Returns:
        The blur that is expected and its standard deviation [m²], and by how much each parameter
        changes for each square metre by which the fitted blur falls short of it.

    References:
        Gelb, Applied Optimal Estimation, 1974, section 4.2 (the gain).
    """
    known = None if sample.sight is None else expect_blur(sample.sight[fit.inliers])
    if known is None or len(matrix) == _count_own(fit, sample):
        return 0.0, 0.0, np.zeros(len(matrix))
    expected, spread = known
    return expected, spread, matrix[:, -1] / (matrix[-1, -1] + spread**2)


def _count_own(fit: ShapeFit[AnyShape], sample: Sample) -> int:
    """Count the parameters of a fit that are its shape's own."""
    return len(fit.shape.slopes(sample.cloud.points[:1])[0])


def moves_of_formula(fit: ShapeFit[AnyShape], sample: Sample) -> Float[np.ndarray, "p parts"]:
    """Give how a fit's parameters move where the blur's formula is off, by one part of the stripe.

    Each part is off by itself, in all profiles alike.

    Args:
        fit: The fit to the sample's points.
        sample: The points that were fitted.

    Returns:
        Moves at 1σ; no columns where the fit knows no blur.
    """
    inside, own = fit.inliers, _count_own(fit, sample)
    if sample.sight is None or fit.slopes.shape[1] == own:
        return np.zeros((fit.slopes.shape[1], 0))
    known = expect_blur(sample.sight[inside])
    blur = max(fit.blur, 0.0) if known is None else known[0]
    normals = fit.shape.normals(sample.cloud.points[inside])
    lean = np.einsum("ij,ij->i", normals, sample.sight.along[inside])
    numbers, part = np.unique(np.rint(lean / _PART), return_inverse=True)
    off = np.zeros((len(part), len(numbers)))
    off[np.arange(len(part)), part] = _BLUR_MODEL * blur * fit.slopes[inside, own]
    return _follow(fit.slopes[inside], off)


def moves_of_light(fit: ShapeFit[AnyShape], sample: Sample) -> Float[np.ndarray, "p 3"]:
    """Give how a fit's parameters move with what nobody knows of light and lens, at 1σ each.

    The columns are: what the blur's formula leaves open at all parts alike, what the water takes of
    the light, and the sheet's thickness. None of it moves anything where it is not known from where
    points were seen.

    Args:
        fit: The fit to the sample's points.
        sample: The points that were fitted.
    """
    inside, parameters = fit.inliers, fit.slopes.shape[1]
    moves = np.zeros((parameters, 3))
    if sample.sight is None:
        return moves
    own = _count_own(fit, sample)
    seen = fit.shape, sample.cloud.points[inside], sample.sight[inside]
    if parameters > own:
        # Of a lens that blurs in another way, the blur that is fitted takes up what it can: it is
        # held here, so that all of its effect counts.
        by_blur = _BLUR_MODEL * fit.blur * fit.slopes[inside, own:]
        moves[:own, :1] = _follow(fit.slopes[inside, :own], -by_blur)
    off = np.stack([loss_moves(*seen, fit.blur), sheet_moves(*seen)], axis=1)
    moves[:, 1:] = _follow(fit.slopes[inside], off)
    return moves


def _follow(slopes: Slopes, off: Float[np.ndarray, "n modes"]) -> Float[np.ndarray, "p modes"]:
    """Give how a fit's parameters follow where points move off the shape [m]."""
    scale = np.maximum(np.linalg.norm(slopes, axis=0), 1e-300)
    moves, *_ = np.linalg.lstsq(slopes / scale, -off, rcond=None)
    followed: Float[np.ndarray, "p modes"] = moves / scale[:, None]
    return followed


def _common_moves(fit: ShapeFit[AnyShape], sample: Sample) -> Float[np.ndarray, "p modes"] | None:
    """Give how a fit's parameters follow when the rig's errors move its points."""
    if sample.shifts is None:
        return None
    inside = np.flatnonzero(fit.inliers)
    some = inside[:: max(len(inside) // _MOST_SHIFTED, 1)]
    shifts = sample.shifts(some)
    normals = fit.shape.normals(sample.cloud.points[some])
    outwards = np.einsum("ij,ijm->im", normals, shifts)
    known = np.isfinite(outwards).all(axis=1)
    return _follow(fit.slopes[some][known], outwards[known])
