"""What is known of parameters before the photos are looked at, as an adjustment needs it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ...errors import InputError
from ...types.rig_covariance import RigCovariance

_SINGULAR = 1e-12
"""Share of the largest eigenvalue below which parameters vary as one."""


@dataclass(frozen=True, eq=False)
class Beforehand:
    """A prior of estimated parameters, given those that are considered but not estimated."""

    information: Float[np.ndarray, "k k"]
    """Inverse covariance of the estimated ones while the considered ones are as given; zero for
    those of which nothing is known."""
    by_considered: Float[np.ndarray, "k c"]
    """Information times how the estimated ones would be expected to move with the considered."""
    considered: Float[np.ndarray, "c c"]
    """Covariance of the considered ones."""

    @classmethod
    def of(
        cls, prior: RigCovariance, names: Sequence[str], considered: Sequence[str]
    ) -> "Beforehand":
        """Split a prior.

        Raises:
            InputError: A parameter to be estimated has a deviation of 0.
        """
        places = [i for i, name in enumerate(names) if name in prior.names]
        known = [names[i] for i in places]
        joint = prior.select([*known, *considered]).matrix
        count = len(known)
        theirs, across = joint[count:, count:], joint[:count, count:]
        follows = across @ np.linalg.pinv(theirs, rcond=_SINGULAR, hermitian=True)
        own = _invert(joint[:count, :count] - follows @ across.T, known)
        information = np.zeros((len(names), len(names)))
        information[np.ix_(places, places)] = own
        by_considered = np.zeros((len(names), len(considered)))
        by_considered[places] = own @ follows
        return cls(information, by_considered, theirs)


def _invert(matrix: Float[np.ndarray, "k k"], names: Sequence[str]) -> Float[np.ndarray, "k k"]:
    sigma = np.sqrt(np.maximum(np.diag(matrix), 0.0))
    if not (sigma > 0).all():
        raise InputError(
            "A parameter with a deviation of 0 is fixed: leave it out of those to estimate, "
            f"{', '.join(names)}."
        )
    scale = np.outer(sigma, sigma)
    return np.linalg.pinv(matrix / scale, rcond=_SINGULAR, hermitian=True) / scale


def join(covariance: RigCovariance, prior: RigCovariance | None) -> RigCovariance:
    """Put what is known beforehand in the place of what a covariance says of the same names."""
    if prior is None:
        return covariance
    kept = [name for name in covariance.names if name not in prior.names]
    names = (*kept, *prior.names)
    matrix = covariance.select(names).matrix
    matrix[:, len(kept) :] = matrix[len(kept) :] = 0.0
    matrix[len(kept) :, len(kept) :] = prior.matrix
    return RigCovariance(names, matrix)


def indices_apart(known: RigCovariance, wanted: Sequence[str]) -> tuple[str, ...]:
    """Name the water's index, unless it is wanted: it belongs to the place, not to the rig."""
    return tuple(n for n in known.names if n.startswith("water.") and n not in wanted)
