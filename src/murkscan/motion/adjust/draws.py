"""Errors that a state may have, drawn: what an adjustment states of its uncertainty."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from ...geometry.row_keys import row_keys
from ...types.arrays import Indices, Scalars
from .log_terms import Log
from .settings import AdjustSettings
from .solve import State, join, log_equations, robust_weights
from .ties import Ties, TieSums, as_placed, linearise, sum_ties

_TOGETHER = 0.02
"""Size of a tile of the surface whose ties err together [m]: planes share points over three cells
of 5 mm."""
_PULLS = 3
"""Directions in which a tile pulls."""
_LEAST_STIFF = 0.2
"""Share of their weights that ties hold at least: with less, most of them are no normal noise."""


def _stiffness(ties: Ties, weights: Scalars) -> float:
    """Compute by how much less than their weights ties hold a state, 1 for ties that all fit.

    A robust force w·r, w = (1 + u)⁻² with u = (r / 3s)², grows ever slower with r: what holds the
    state is its slope, (1 - 3u)·(1 + u)⁻³, for normal residuals three quarters of w.

    References:
        Huber, Robust statistics, 1981, section 6.3: (E ψ')⁻¹ E ψ² (E ψ')⁻¹.
    """
    share = weights * ties.variance
    keep = np.sqrt(share / share.max(initial=1e-300))
    slope = keep**2 * (4 * keep - 3)
    held = float((slope / ties.variance).sum() / (keep**2 / ties.variance).sum())
    return float(np.clip(held, _LEAST_STIFF, 1.0))


def _number_tiles(ties: Ties, state: State) -> Indices:
    """Number the tile of the surface in which each tie lies, whichever legs it joins.

    Neighbours err together, and so do ties between any two of the legs that saw a place: of three
    looks at it there are three ties, but of three noises two differences.
    """
    place = np.floor(as_placed(ties.pass_a, ties.time_a, ties.point_a, state.paths) / _TOGETHER)
    return np.unique(row_keys(place.astype(np.int64)), return_inverse=True)[1]


def draw_errors(
    state: State,
    logs: Sequence[Log],
    groups: Sequence[Ties],
    settings: AdjustSettings,
    *,
    count: int,
    as_seen: bool = False,
) -> Float[np.ndarray, "u m"]:
    """Draw errors that the state may have; one column a draw, the same ones each time.

    With noise of variance 1 in place of the residuals of whitened equations J, the solution has
    the covariance of the state: (JᵀJ)⁻¹Jᵀε. Of logs, ε is white, as their accuracy states. Ties
    that are `as_seen` err as their residuals do, with one random sign a tile: neighbours err
    together, since their planes share points, and so do all legs that saw a place; normal equations
    alone would not know. Tiles are far more than unknowns: residuals of a block that settles some
    unknowns alone add up to nothing.

    Args:
        state: Where everything stands.
        logs: The logs.
        groups: The ties.
        settings: As for the adjustment.
        count: How many draws.
        as_seen: Whether ties err as their residuals show, or by their stated variance.

    References:
        Liang and Zeger, Longitudinal data analysis using generalized linear models, Biometrika
        73(1), 1986, for the sandwich; Cameron, Gelbach and Miller, Bootstrap-based improvements for
        inference with clustered errors, Review of Economics and Statistics 90(3), 2008, for signs.
    """
    random = np.random.default_rng(0)
    layout = logs[0].layout
    of_log = log_equations(state, logs, settings)
    logged = of_log.jacobian.T @ random.normal(size=(len(of_log.residuals), count))
    there = [ties for ties in groups if len(ties)]
    if not there:
        return join(of_log, None, layout).draw(logged)
    tile = _number_tiles(Ties.concatenate(there), state)
    num = int(tile.max()) + 1
    signs = random.choice([-1.0, 1.0], (num, count))
    tied, parts = np.zeros_like(logged), []
    for ties, mine in zip(there, np.split(tile, np.cumsum([*map(len, there)])[:-1]), strict=True):
        linear = linearise(ties, state.paths)
        weights, _ = robust_weights(linear, ties, least=1.0)
        parts.append(sum_ties(linear, _stiffness(ties, weights) * weights))
        for k in range(count):
            if as_seen:
                noise = linear.residuals * signs[mine, k]
            else:
                noise = random.normal(size=len(ties)) / np.sqrt(weights)
            drawn = sum_ties(replace(linear, residuals=noise), weights, with_matrix=False)
            np.add.at(tied[:, k], drawn.places.ravel(), drawn.vector.ravel())
    normal = join(of_log, TieSums.stack(parts), layout)
    by_log, by_ties = np.split(normal.draw(np.hstack([logged, tied])), 2, axis=1)
    if not as_seen:
        return by_log + by_ties
    settled = layout.count - float((logged * by_log).sum()) / count
    return by_log + _unfitted(num, settled) * by_ties


def _unfitted(num: int, settled: float) -> float:
    """Give by what errors are larger than residuals, which are smaller by what was fitted to them.

    Of forces f that err as the logs state, with covariance N_log, the mean of f·N⁻¹f is the trace
    of N⁻¹N_log: the count of unknowns that logs settle (Hutchinson, 1990). Ties settle the others.
    A tile pulls in three directions, by its heights and by its slopes both ways: one unknown that
    is fitted takes one of the three.

    Args:
        num: Independent tiles.
        settled: Count of unknowns that ties settle.

    References:
        MacKinnon and White, Some heteroskedasticity-consistent covariance matrix estimators,
        Journal of Econometrics 29, 1985: HC1.
    """
    pulls = _PULLS * num
    return float(np.sqrt(pulls / max(pulls - settled, pulls / 4)))
