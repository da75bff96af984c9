"""How restless a vehicle is: its usual accelerations, from where its scans say that it was."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from .draws import draw_errors
from .log_terms import Log
from .path import WIDTH, Path
from .settings import AdjustSettings
from .solve import State
from .spline import evaluate
from .ties import Ties

_DRAWS = 8
"""Errors that are drawn: each is of a hundred accelerations or more."""


def learn_unrest(
    state: State, logs: Sequence[Log], groups: Sequence[Ties], settings: AdjustSettings
) -> tuple[Log, ...]:
    """Take for usual accelerations of each pass those of its path as it is known now.

    The mean square of an acceleration is that of what was found and of the errors that it may have:
    where nothing holds a path these are as large as was assumed, and so the assumption stays.

    Args:
        state: Where everything stands.
        logs: The logs, with the unrest that was assumed so far.
        groups: The ties.
        settings: As for the adjustment.

    References:
        Dempster, Laird and Rubin, Maximum likelihood from incomplete data via the EM algorithm,
        Journal of the Royal Statistical Society B 39, 1977: one step of it.
    """
    errors = draw_errors(state, logs, groups, settings, count=_DRAWS)
    learnt = []
    for log, path in zip(logs, state.paths, strict=True):
        start, size = log.layout.starts[log.number], log.layout.sizes[log.number]
        own = errors[start : start + size].reshape(-1, WIDTH * _DRAWS)
        spread = _accelerate(path, own).reshape(-1, WIDTH, _DRAWS)
        found = _accelerate(path, np.hstack([path.positions, path.turns]))
        usual = np.sqrt(np.mean(found**2 + (spread**2).mean(axis=2), axis=0))
        learnt.append(replace(log, unrest=tuple(map(float, usual))))
    return tuple(learnt)


def _accelerate(path: Path, controls: Float[np.ndarray, "k d"]) -> Float[np.ndarray, "n d"]:
    return evaluate(path.knots, controls, path.knots.middles, derivative=2)
