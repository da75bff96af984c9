"""What photos tell of a rig's parameters: their covariance, and what hangs on one photo alone."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from ...errors import Degenerate
from ...types.arrays import Scalars
from ...types.rig_covariance import RigCovariance
from .normal_equations import NormalEquations
from .priors import Beforehand

_SINGULAR = 1e-13
"""Share of the information, by eigenvalue, below which a direction is not seen at all."""
_SURE = 2.0
"""Deviations by which photos must disagree more than by chance before that is believed."""


@dataclass(frozen=True, eq=False)
class Worth:
    """How well the parameters of an adjustment are known."""

    covariance: RigCovariance
    """Of the estimated and the considered parameters together."""
    dispersion: float
    """How much more whole photos disagree than their points' noise explains, as a ratio of
    variances; 1 unless it is above that for sure, as where a board is not flat. The photos'
    weight is lowered by it, and deviations are raised to the jackknife's where that is larger."""
    without_photo: Float[np.ndarray, "p k"]
    """By how much each estimated parameter would change without each photo, in its own unit."""
    sigma_without_photo: Float[np.ndarray, "p k"]
    """Standard deviation that each estimated parameter would have without each photo."""
    from_photos: Scalars
    """Share of each estimated parameter's variance beforehand that the photos took away: 1 where
    nothing was known of it, 0 where they tell nothing."""


def assess(
    equations: NormalEquations,
    names: Sequence[str],
    known: Beforehand,
    taken: float,
) -> Worth:
    """Tell what the parameters are worth, at the end of an adjustment.

    Args:
        equations: The last normal equations, by the estimated parameters and then the considered.
        names: All of these.
        known: What was known beforehand.
        taken: The dispersion by which the weights have been lowered already.

    Raises:
        Degenerate: Some parameters are not told from each other at all; the message names them.

    References:
        Schmidt, Application of state-space methods to navigation problems, 1966, for parameters
        that are considered; Cook, Detection of influential observation in linear regression,
        1977, for leaving out; Efron, The jackknife, the bootstrap and other resampling plans,
        1982; White, A heteroskedasticity-consistent covariance matrix estimator,
        Econometrica 48(4), 1980, with whole photos as what is independent.
    """
    information = known.information
    count = len(information)
    matrices, slopes = equations.reduce()
    own, slopes = matrices[:, :count, :count], slopes[:, :count]
    total = own.sum(axis=0) + information
    formal = _invert(total, names[:count])
    formal_without = np.linalg.pinv(total - own, rcond=_SINGULAR, hermitian=True)
    without = np.einsum("pij,pj->pi", formal_without, slopes)
    dispersion = taken * _dispersion(own, slopes, formal)
    sigma_without = np.sqrt(dispersion / taken * np.einsum("pii->pi", formal_without))
    mine = formal if dispersion == 1 else _widen(formal * (dispersion / taken), without)
    carried = formal @ (known.by_considered - matrices[:, :count, count:].sum(axis=0))
    theirs = known.considered
    joint = np.block(
        [[mine + carried @ theirs @ carried.T, carried @ theirs], [theirs @ carried.T, theirs]]
    )
    return Worth(
        RigCovariance(tuple(names), (joint + joint.T) / 2),
        dispersion,
        without,
        sigma_without,
        1 - np.diag(mine) * _precision(information),
    )


def _widen(
    covariance: Float[np.ndarray, "k k"], without: Float[np.ndarray, "p k"]
) -> Float[np.ndarray, "k k"]:
    """Raise deviations to at least the jackknife's over photos; the correlations stay."""
    count = len(without)
    jackknife = np.sqrt((count - 1) / count * np.sum(without**2, axis=0))
    scale = np.maximum(1.0, jackknife / np.sqrt(np.diag(covariance)))
    return covariance * np.outer(scale, scale)


def _precision(information: Float[np.ndarray, "k k"]) -> Scalars:
    """Give one over the variance of each parameter beforehand; 0 where nothing was known."""
    variances = np.diag(np.linalg.pinv(information, rcond=1e-15, hermitian=True))
    return np.divide(1.0, variances, out=np.zeros(len(variances)), where=variances > 0)


def _invert(matrix: Float[np.ndarray, "k k"], names: Sequence[str]) -> Float[np.ndarray, "k k"]:
    """Invert the information; refuse one that leaves parameters open, and name them."""
    size = np.sqrt(np.diag(matrix))
    if not (size > 0).all():
        unseen = [name for name, s in zip(names, size, strict=True) if not s > 0]
        raise Degenerate(
            f"The photos tell nothing at all of {', '.join(unseen)}; fix it, or give it a value "
            "with a deviation."
        )
    values, directions = np.linalg.eigh(matrix / np.outer(size, size))
    if values[0] < _SINGULAR * values[-1]:
        mixed = np.abs(directions[:, 0]) > 0.1 * np.abs(directions[:, 0]).max()
        raise Degenerate(
            "The photos do not tell "
            f"{' from '.join(name for name, m in zip(names, mixed, strict=True) if m)}; fix one "
            "of them, or give it a value with a deviation."
        )
    inverse = (directions / values) @ directions.T
    return inverse / np.outer(size, size)


def _dispersion(
    own: Float[np.ndarray, "p k k"],
    slopes: Float[np.ndarray, "p k"],
    formal: Float[np.ndarray, "k k"],
) -> float:
    """Give by how much photos pull in different directions, over what noise explains; at least 1.

    A photo's pull g has, at the end of a fit, the covariance H − H C H if its points are
    independent, so that Σ g·C·g has a known mean.
    """
    pulls = float(np.einsum("pi,ij,pj->", slopes, formal, slopes))
    shares = own @ formal
    squares = np.einsum("pij,pji->p", shares, shares)
    expected = float(np.einsum("pii->", shares) - squares.sum())
    if not expected > 0:
        return 1.0
    ratio = pulls / expected
    spread = np.sqrt(2 * float(squares.sum())) / expected
    return ratio if ratio > 1 + _SURE * spread else 1.0
