"""How far points scatter about the shape that was fitted to them: probing form and flatness."""

import math
from typing import NoReturn

import numpy as np

from ..errors import NotEnoughData
from ..geometry.correlated_errors import covariance_of_sums
from ..types.arrays import Indices, Scalars
from ..types.quantity import Quantity
from .fits import trust_plane
from .sample import Sample

LEFT_OUT = 0.003
"""Share of the points that may be left out, those farthest off: a few per mille, as in VDI/VDE
2634."""
_TAIL = LEFT_OUT / 2
"""Share beyond either end."""
_PEAKS = 9.0
"""Peaks that lie beyond an end for each patch's worth of points there: three standard deviations
up, patches of Gaussian errors are that much narrower."""
_FEW = 10.0
"""Degrees of freedom at least: that few points lie beyond is in the deviation already."""
_SKEWED = 0.1
"""Share of that deviation's square that few independent points beyond an end add to it: an end told
by one or two is too near rather than too far."""
_RARE = 0.2
"""Standard deviation, over the width, of what comes rarely, such as particles, of which one scan
meets two and the next none, so that no scan's own points show it. Simulated scans in water of
c = 0.3 to 3 /m differ by 22 to 47 % in all (benchmarks/acceptance.py)."""
_FEWEST = 667
"""Points below which that share is less than one point at either end."""


def measure_form(name: str, residuals: Scalars, profile: Indices, line: Indices) -> Quantity:
    """Give the width of the shell that holds all points but three in a thousand.

    Its truth is the width that ever more points, scanned in the same way, come to. The interval
    follows from how many points that err on their own lie beyond either end: points that err
    together count once. Beyond the ends the points are taken to fall off exponentially. What comes
    rarely, such as particles, is taken to add a fifth of the width.

    Args:
        name: What to call it.
        residuals: Signed distance of each point from the shape [m].
        profile: Number of each point's profile.
        line: Number of each point's scan line.

    Raises:
        NotEnoughData: Fewer than 667 points.

    References:
        Adler, The Geometry of Random Fields, 1981, section 6.9 (peaks above a level u of u² as many
        as patches that lie above it).
        David and Nagaraja, Order Statistics, 3rd edition, 2003, section 10.2.
    """
    if len(residuals) < _FEWEST:
        _refuse(len(residuals))
    errors = residuals - residuals.mean()
    patches = float(np.mean(errors**2)) / max(_variance_of_mean(errors, profile, line), 1e-300)
    ends = [_find_end(sign * errors, patches, profile, line) for sign in (1.0, -1.0)]
    width = sum(at for at, _, _ in ends)
    sigma = math.hypot(*(sigma for _, sigma, _ in ends), _RARE * width)
    degrees = max(sum(alone for _, _, alone in ends), _FEW)
    return Quantity(name, width, "m", sigma, 0.0, degrees)


def _find_end(
    values: Scalars, patches: float, profile: Indices, line: Indices
) -> tuple[float, float, float]:
    """Give the upper end of the shell, its deviation, and how many independent points lie beyond.

    Of an exponential tail, ten times as many points lie beyond a place that is nearer by 2.3 times
    its length.
    """
    shares = [1 - 10 * _TAIL, 1 - _TAIL]
    nearer, end = np.quantile(values, shares, method="median_unbiased")
    length = float(end - nearer) / math.log(10)
    beyond = (values > end).astype(float)
    share = float(beyond.mean())
    variance = _variance_of_mean(beyond - share, profile, line)
    # Where all points beyond are one patch, their own correlation cannot tell that it is large.
    alone = min(share**2 / max(variance, 1e-300), _PEAKS * patches * _TAIL)
    alone = max(alone, 0.1)
    return float(end), length * math.sqrt(1 / alone + _SKEWED / alone**2), alone


def _variance_of_mean(errors: Scalars, profile: Indices, line: Indices) -> float:
    weights = np.full((len(errors), 1), 1 / len(errors))
    return float(covariance_of_sums(weights, errors, profile, line)[0, 0])


def measure_flatness(sample: Sample) -> Quantity:
    """Give how far points scatter about their plane [m]; see `measure_form`.

    Raises:
        NotEnoughData: Fewer than 667 points, or three profiles.
        Degenerate: The points lie on one line.
    """
    if len(sample) < _FEWEST:
        _refuse(len(sample))
    fit, _ = trust_plane(sample)
    return measure_form("flatness", fit.residuals, sample.profile, sample.line)


def _refuse(count: int) -> NoReturn:
    raise NotEnoughData(
        f"It shows {count:,} points, and to tell a form of which three in a thousand are left out "
        f"takes {_FEWEST:,}: scan it more slowly or from nearer, or correct where it is."
    )
