"""One adjustment of everything that boards, stripes and logs tell, with what it is worth."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from ...errors import InputError, NotConverged
from ...types.arrays import Scalars
from ...types.pose import Pose
from ...types.rig import Rig
from ...types.rig_covariance import RigCovariance
from .covariance import Worth, assess
from .log import LoggedPoses, Stand
from .normal_equations import NormalEquations
from .observations import Boards, Observed, Sighting
from .priors import Beforehand
from .residuals import Linearised, Observations, Rows, State, is_of_stand, linearise, residuals_of
from .weights import Weights, weigh

_MAX_STEPS, _MAX_TRIALS = 60, 12
_MAX_ROUNDS, _AGREED = 4, 1.1
"""Rounds in which photos are given the weight that their disagreement leaves them, and the growth
of it that needs no other round."""
_SETTLED = 1e-6
"""Fall of the sum of squares, in variances, below which all parameters rest to 0.001 sigma."""
_NEGLIGIBLE = 1e-9
"""The same as a share of the sum."""


@dataclass(frozen=True, eq=False)
class Adjustment:
    """A rig that explains all sightings, and what it is worth."""

    rig: Rig
    """The rig, with the covariance of all parameters that were estimated or considered."""
    names: tuple[str, ...]
    """The parameters that were estimated."""
    prior: RigCovariance
    """What was known of them beforehand."""
    changes: Scalars
    """By how much each has changed from where it started, its value beforehand."""
    camera_from_boards: tuple[Pose, ...]
    """Where the board was in each photo."""
    corner_residuals: tuple[Float[np.ndarray, "_ 2"], ...]
    """Corner as found minus corner as projected, of each photo [px]."""
    stripe_residuals: tuple[Float[np.ndarray, "..."], ...]
    """How far each stripe point is off across the stripe, of each photo [px]."""
    corner_shares: tuple[Float[np.ndarray, "..."], ...]
    """What each corner counts: 1, or less where it stands out."""
    stripe_shares: tuple[Float[np.ndarray, "..."], ...]
    """The same for stripe points."""
    corner_sigma: float
    """Standard deviation of a corner along u or v, told from the residuals [px]."""
    stripe_sigma: float
    """The same of a stripe point, across the stripe [px]."""
    worth: Worth
    """What the photos tell of the parameters, one by one and together."""
    stand: Stand | None = None
    """Where the board stood in the world, and the clock's offset, where there was a log."""

    @property
    def sigma(self) -> Scalars:
        """Standard deviation of each of the names."""
        return self.worth.covariance.select(self.names).sigma

    @property
    def view_rms(self) -> tuple[float, ...]:
        """Root mean square distance of a corner from its projection, of each photo [px]."""
        return tuple(rms_of(residuals) for residuals in self.corner_residuals)

    @property
    def rms(self) -> float:
        """The same of all photos [px]."""
        return rms_of(np.concatenate(self.corner_residuals))


def rms_of(residuals: Float[np.ndarray, "_ 2"]) -> float:
    """Compute the root mean square length of residuals."""
    return float(np.sqrt(np.mean(np.sum(residuals**2, axis=1))))


def adjust(
    rig: Rig,
    sightings: Sequence[Sighting],
    names: Sequence[str],
    *,
    prior: RigCovariance | None = None,
    considered: Sequence[str] = (),
    logged: LoggedPoses | None = None,
    stand: Stand | None = None,
) -> Adjustment:
    """Adjust parameters of a rig, and the place of every board, to what the photos show.

    Each of the rig's parameters is free (among `names`), known beforehand to some deviation (among
    `names` and in the prior, whose mean is the rig's present value), or fixed. Gross outliers are
    let go; noise is told from the residuals. Where whole photos disagree more than their points
    do, the covariance is widened by as much.

    Args:
        rig: The rig to start from; its water is what the photos were taken in.
        sightings: What the photos show.
        names: The parameters to estimate, as `perturb_rig` names them.
        prior: What is known beforehand, of some of them and of those considered.
        considered: Parameters that are not estimated but, as the prior says, not exact either:
            their errors go into the covariance.
        logged: A log of the vehicle's poses, where the board stood still.
        stand: Where the board stood, at least roughly; needed with a log.

    Raises:
        InputError: A board's points cannot be seen by the rig as it starts.
        NotConverged: No end after 60 steps.

    References:
        Triggs et al., Bundle adjustment: a modern synthesis, 2000; Marquardt, An algorithm for
        least-squares estimation of nonlinear parameters, 1963.
    """
    names = tuple(names)
    known = Beforehand.of(prior or RigCovariance(), names, tuple(considered))
    observed = Observations(Observed.of(sightings), logged)
    state = State(rig, names, np.zeros(len(names)), Boards.of(sightings), stand)
    dispersion = 1.0
    for _ in range(_MAX_ROUNDS):
        state = _descend(state, observed, known.information, dispersion)
        end = state.rebase((*names, *considered))
        found = linearise(end, observed, _scale(end, observed))
        weights = weigh(found, num_photos=len(sightings), dispersion=dispersion)
        equations = NormalEquations.of(found, weights, len(sightings))
        worth = assess(equations, end.names, known, dispersion)
        if worth.dispersion <= _AGREED * dispersion:
            break
        # Photos that disagree tell less than their points' noise promises: what was known before
        # must not give way to them as if they told more.
        dispersion = worth.dispersion
    return _sum_up(end, found, weights, worth, sightings, state, prior or RigCovariance())


def _descend(
    state: State,
    observed: Observations,
    information: Float[np.ndarray, "k k"],
    dispersion: float,
) -> State:
    """Step downhill until nothing moves any more."""
    damping = 1e-4
    for _ in range(_MAX_STEPS):
        scale = _scale(state, observed)
        found = linearise(state, observed, scale)
        if not np.isfinite(found.residuals).all():
            raise InputError(_out_of_sight(state))
        num_photos = len(state.boards.translations)
        weights = weigh(found, num_photos=num_photos, dispersion=dispersion)
        equations = NormalEquations.of(found, weights, num_photos)
        pull = information @ state.changes
        now = _cost(found.residuals, weights, state, information)
        for _ in range(_MAX_TRIALS):
            change, moves = equations.damp(damping).solve(information, pull)
            new, then = _try(state, change, moves, observed, scale, weights, information)
            if then <= now:
                break
            damping *= 10
        else:
            return state
        state, damping = new, max(damping / 10, 1e-9)
        if now - then < _SETTLED + _NEGLIGIBLE * now:
            return state
    raise NotConverged(
        f"The adjustment of {', '.join(state.names)} came to no end in {_MAX_STEPS} steps. Fix a "
        "parameter, or give a value with a deviation for one that the photos do not determine."
    )


def _try(
    state: State,
    change: Scalars,
    moves: Float[np.ndarray, "p 6"],
    observed: Observations,
    scale: Rows,
    weights: Weights,
    information: Float[np.ndarray, "k k"],
) -> tuple[State, float]:
    """Make a step; a rig that cannot be costs infinitely much."""
    new = state.move(change, moves)
    try:
        residuals = residuals_of(new, observed, scale)
    except InputError:
        return state, np.inf
    cost = _cost(residuals, weights, new, information)
    return new, cost if np.isfinite(cost) else np.inf


def _cost(
    residuals: Rows, weights: Weights, state: State, information: Float[np.ndarray, "k k"]
) -> float:
    by_prior = state.changes @ information @ state.changes
    return float(np.sum(weights.weigh(residuals) ** 2) + by_prior)


def _scale(state: State, observed: Observations) -> Rows:
    return observed.seen.pixels_to_sheet(state.rig, state.boards)


def _out_of_sight(state: State) -> str:
    nearest = float(state.boards.translations[:, 2].min())
    return (
        "Some points of the boards cannot be seen through the rig's port as it stands; the nearest "
        f"board is {nearest * 1e3:.0f} mm away. Check that the port's measures in the rig file and "
        "the board's squares are in millimetres."
    )


def _sum_up(
    end: State,
    found: Linearised,
    weights: Weights,
    worth: Worth,
    sightings: Sequence[Sighting],
    state: State,
    prior: RigCovariance,
) -> Adjustment:
    split, last = found.num_corner_rows, len(found.residuals) - found.num_log_rows
    of_rig = [name for name in worth.covariance.names if not is_of_stand(name)]
    corner_ends = np.cumsum([len(s.corners) for s in sightings])[:-1]
    stripe_ends = np.cumsum([len(s.stripe) for s in sightings])[:-1]
    return Adjustment(
        rig=replace(end.rig, covariance=worth.covariance.select(of_rig)),
        names=state.names,
        prior=prior,
        changes=state.changes,
        camera_from_boards=end.boards.as_poses(),
        corner_residuals=tuple(np.split(-found.residuals[:split].reshape(-1, 2), corner_ends)),
        stripe_residuals=tuple(np.split(found.residuals[split:last], stripe_ends)),
        corner_shares=tuple(np.split(weights.shares[:split:2], corner_ends)),
        stripe_shares=tuple(np.split(weights.shares[split:], stripe_ends)),
        corner_sigma=weights.corner_sigma,
        stripe_sigma=weights.stripe_sigma,
        worth=worth,
        stand=end.stand,
    )
