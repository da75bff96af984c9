"""Sparse Gauss-Newton over all unknowns of all passes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from ...types.arrays import Scalars
from .log_terms import Log, prior_equations
from .path import Path
from .settings import AdjustSettings
from .ties import LinearTies, Ties, TieSums, linearise, sum_ties
from .unknowns import Equations, Layout

_ROBUST = 3.0
"""Standard deviations at which a tie counts a quarter."""
_STRAIGHT, _STRAIGHT_TURN = 10e-3, 10e-3
"""Steps over which the equations are about straight [m], [rad]: at an arm of a metre, a turn of a
hundredth leaves its tangent by 0.05 mm."""
_FIRST_DAMPING = 1e-2
_TRIES = 6
"""How often a step is made shorter, each time by a factor of ten in its damping."""
_GAIN = 0.05
"""Gain in the sum of squares below which a step was the last: one standard deviation of any
unknown is worth 1."""
_RIDGE = 1e-13
"""Share of its diagonal by which a matrix is made regular: of the step, not of the state."""


@dataclass(frozen=True, eq=False)
class State:
    """All that is unknown, as it stands."""

    paths: tuple[Path, ...]
    errors: Scalars
    """The whole vector of unknowns, of which only those that are no path's count."""

    def moved(self, step: Scalars, layout: Layout) -> "State":
        """Change all unknowns."""
        paths = tuple(
            path.moved(step[start : start + size])
            for path, start, size in zip(self.paths, layout.starts, layout.sizes, strict=True)
        )
        errors = self.errors.copy()
        errors[layout.num_of_paths :] += step[layout.num_of_paths :]
        return State(paths, errors)


@dataclass(frozen=True, eq=False)
class Normal:
    """Normal equations where a state stands: matrix · step = −vector."""

    matrix: sparse.csc_matrix
    vector: Scalars
    of_log: Equations

    def factor(self, damping: Scalars | float = 0.0) -> SuperLU:
        """Factor the matrix, with a little more on its diagonal."""
        diagonal = _RIDGE * self.matrix.diagonal() + damping
        return splu(
            (self.matrix + sparse.diags(diagonal)).tocsc(),
            permc_spec="MMD_AT_PLUS_A",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )

    def draw(self, forces: Float[np.ndarray, "u m"]) -> Float[np.ndarray, "u m"]:
        """Give the steps that some forces would make."""
        return self.factor().solve(forces)

    def step(self, damping: Scalars) -> Scalars:
        """Give the step to where the equations hold best, not far from here."""
        return -self.factor(damping).solve(self.vector)


def log_equations(state: State, logs: Sequence[Log], settings: AdjustSettings) -> Equations:
    """Give what all logs say, with what is stated of their errors."""
    own = [
        log.equations(path, state.errors, settings)
        for log, path in zip(logs, state.paths, strict=True)
    ]
    return Equations.stack([*own, prior_equations(logs, state.errors)])


def join(of_log: Equations, sums: TieSums | None, layout: Layout) -> Normal:
    """Add the normal equations of logs and ties."""
    matrix = (of_log.jacobian.T @ of_log.jacobian).tocsc()
    vector = of_log.jacobian.T @ of_log.residuals
    if sums is not None:
        matrix = matrix + scatter(sums, layout.count)
        np.add.at(vector, sums.places.ravel(), sums.vector.ravel())
    return Normal(matrix, vector, of_log)


def scatter(sums: TieSums, count: int) -> sparse.csc_matrix:
    """Lay the blocks of ties into one matrix."""
    rows = np.broadcast_to(sums.places[:, :, None], sums.matrix.shape)
    columns = np.broadcast_to(sums.places[:, None, :], sums.matrix.shape)
    entries = (sums.matrix.ravel(), (rows.ravel(), columns.ravel()))
    return sparse.coo_matrix(entries, shape=(count, count)).tocsc()


def robust_weights(linear: LinearTies, ties: Ties, *, least: float) -> tuple[Scalars, float]:
    """Give each tie's weight [1/m²], small where it does not fit, and how far off ties are.

    Geman and McClure's weights, (1 + (r / 3s)²)⁻², in units of the ties' own spread s (median
    absolute residual), which also says by how much their stated variances are too small.

    Args:
        linear: The ties where the paths lie now.
        ties: The ties.
        least: Spread, in stated standard deviations, below which it is not believed.

    References:
        Geman and McClure, Statistical methods for tomographic image reconstruction, 1987.
    """
    scaled = linear.residuals / np.sqrt(ties.variance)
    spread = max(1.4826 * float(np.median(np.abs(scaled))), least) if len(ties) else 1.0
    keep: Float[np.ndarray, " n"] = (1 + (scaled / (_ROBUST * spread)) ** 2) ** -2
    return keep / (ties.variance * spread**2), spread


def improve(
    state: State,
    logs: Sequence[Log],
    groups: Sequence[Ties],
    settings: AdjustSettings,
    *,
    steps: int,
    least: float = 1.0,
) -> State:
    """Make some steps with the same ties, none of which makes the equations hold less well.

    Turns are no linear matter: a pass that no instrument holds level may swing by degrees in one
    step, and its equations then mislead. Steps that do not help are made anew, shorter.

    References:
        Marquardt, An algorithm for least-squares estimation of nonlinear parameters, 1963.
    """
    layout = logs[0].layout
    ties = Ties.concatenate([g for g in groups if len(g)]) if any(map(len, groups)) else None
    spreads = _spreads(state, [g for g in groups if len(g)], least)
    unit = _damping(layout)
    here, cost = _linearise_all(state, logs, ties, spreads, settings)
    # Without ties a way that begins anywhere is to reach its log in one step.
    damping = _FIRST_DAMPING if ties is not None else 0.0
    for _ in range(steps):
        for _ in range(_TRIES):
            there = state.moved(here.step(damping * unit), layout)
            after, reached = _linearise_all(there, logs, ties, spreads, settings)
            if reached <= cost:
                break
            damping = max(10 * damping, _FIRST_DAMPING)
        else:
            return state
        gained = cost - reached
        state, here, cost, damping = there, after, reached, damping / 10
        if gained < _GAIN:
            break
    return state


def _damping(layout: Layout) -> Scalars:
    """Give one over the squares of steps over which the equations are about straight."""
    unit = np.zeros(layout.count)
    of_paths = np.tile(np.repeat([_STRAIGHT, _STRAIGHT_TURN], 3), layout.num_of_paths // 6)
    unit[: layout.num_of_paths] = of_paths**-2.0
    return unit


def _spreads(state: State, groups: Sequence[Ties], least: float) -> Scalars:
    """Give each tie's standard deviation as its group shows it [m]."""
    if not groups:
        return np.zeros(0)
    found = []
    for ties in groups:
        _, spread = robust_weights(linearise(ties, state.paths), ties, least=least)
        found.append(spread * np.sqrt(ties.variance))
    return np.concatenate(found)


def _linearise_all(
    state: State,
    logs: Sequence[Log],
    ties: Ties | None,
    sigma: Scalars,
    settings: AdjustSettings,
) -> tuple[Normal, float]:
    """Give the normal equations of all there is, and the sum that they make smaller."""
    of_log = log_equations(state, logs, settings)
    cost = float(of_log.residuals @ of_log.residuals)
    if ties is None:
        return join(of_log, None, logs[0].layout), cost
    linear = linearise(ties, state.paths)
    square = (linear.residuals / (_ROBUST * sigma)) ** 2
    cost += _ROBUST**2 * float((square / (1 + square)).sum())
    weights = (1 + square) ** -2 / sigma**2
    return join(of_log, sum_ties(linear, weights), logs[0].layout), cost
