"""How restless a vehicle is: its usual accelerations, from where its scans say that it was."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from .draws import draw_errors
from .log_terms import LASTING, UNREST, Log
from .path import WIDTH, Path
from .settings import AdjustSettings
from .solve import State
from .spline import evaluate

_WITHIN = 1e-9
"""Rounding of a path's end [s]."""


def learn_unrest(
    state: State,
    logs: Sequence[Log],
    errors: Float[np.ndarray, "u m"],
    settings: AdjustSettings,
) -> tuple[Log, ...]:
    """Take for usual such accelerations of each pass as its path shows.

    They are changed until logs and assumptions alone would let accelerations be as large as those
    that are seen: their mean square is that of what was found and of the errors that it may have.
    Where no tie says more than the log, both are the same, and what was assumed stays. It is never
    exceeded. A path turns away from its log's own attitude: where that was measured, and perhaps
    stamped by another clock, turns say nothing of the vehicle's unrest, and are not learnt.

    Args:
        state: Where everything stands.
        logs: The logs, with the unrest that was assumed so far.
        errors: Some that the state may have, drawn.
        settings: As for the adjustment.
    """
    draws = errors.shape[1]
    alone = draw_errors(state, logs, (), settings, count=draws)
    learnt = []
    for log, path in zip(logs, state.paths, strict=True):
        found = _accelerate(path, np.hstack([path.positions, path.turns]))
        known, open_to = (
            (_accelerate(path, own.reshape(-1, WIDTH * draws)) ** 2)
            .reshape(-1, WIDTH, draws)
            .mean(axis=(0, 2))
            for own in (log.layout.of_path(log.number, drawn) for drawn in (errors, alone))
        )
        usual = log.unrest * np.sqrt((np.mean(found**2, axis=0) + known) / open_to)
        usual = np.minimum(usual, UNREST)
        if log.navigation.accuracy.attitude_noise is not None:
            usual[3:] = log.unrest[3:]
        learnt.append(replace(log, unrest=tuple(map(float, usual))))
    return tuple(learnt)


def _accelerate(path: Path, controls: Float[np.ndarray, "k d"]) -> Float[np.ndarray, "n d"]:
    """Compute mean accelerations over as long as one lasts: shorter pieces show no larger ones."""
    times = np.arange(path.knots.start, path.knots.end + _WITHIN, LASTING)
    return np.diff(evaluate(path.knots, controls, times, derivative=1), axis=0) / LASTING
