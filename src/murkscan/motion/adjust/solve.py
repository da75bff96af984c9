"""Sparse Gauss-Newton over all unknowns of all passes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from ...types.arrays import Indices, Scalars
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
_TOGETHER, _TOGETHER_TIME = 0.02, 0.2
"""Size of a tile whose ties err together [m], [s]: planes share points over three cells of 5 mm."""
_LEAST_STIFF = 0.2
"""Share of their weights that ties hold at least: with less, most of them are no normal noise."""
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


def _blocks(ties: Ties) -> Indices:
    """Number the tile of the surface in which each tie lies: neighbours err together."""
    place = np.floor(ties.point_a / _TOGETHER).astype(np.int64)
    key = np.column_stack([np.floor(ties.time_a / _TOGETHER_TIME).astype(np.int64), place])
    return np.asarray(np.unique(key, axis=0, return_inverse=True)[1]).ravel()


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
    together, since their planes share points, and normal equations alone would not know. Tiles are
    far more than unknowns: residuals of a block that settles some unknowns alone add up to nothing.

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
    forces = of_log.jacobian.T @ random.normal(size=(len(of_log.residuals), count))
    there = [ties for ties in groups if len(ties)]
    blocks = [_blocks(ties) for ties in there]
    # Residuals are smaller than errors by what was fitted to them (MacKinnon and White, 1985: HC1).
    num = sum(int(block.max()) + 1 for block in blocks)
    fitted = np.sqrt(num / max(num - layout.num_of_paths, num / 4)) if num else 1.0
    parts = []
    for ties, block in zip(there, blocks, strict=True):
        linear = linearise(ties, state.paths)
        weights, _ = robust_weights(linear, ties, least=1.0)
        parts.append(sum_ties(linear, _stiffness(ties, weights) * weights))
        signs = fitted * random.choice([-1.0, 1.0], (int(block.max()) + 1, count))
        for k in range(count):
            if as_seen:
                noise = linear.residuals * signs[block, k]
            else:
                noise = random.normal(size=len(ties)) / np.sqrt(weights)
            drawn = sum_ties(replace(linear, residuals=noise), weights, with_matrix=False)
            np.add.at(forces[:, k], drawn.places.ravel(), drawn.vector.ravel())
    return join(of_log, TieSums.stack(parts) if parts else None, layout).draw(forces)
