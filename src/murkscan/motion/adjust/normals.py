"""Normals of a leg's facets of which only that is left which is neither noise nor motion."""

import numpy as np
from jaxtyping import Float

from ...types.arrays import Directions, Indices
from .legs import Facets
from .restless import fit_rows, keep_rows, share_of_signal

Slopes = Float[np.ndarray, "n 2"]
"""Along the way and across it."""

_PATCH = 16
"""Cells of a patch, along and across, over which a surface counts as plain or rough as a whole."""
_STEEPEST = 2.0
"""Most by which slopes are taken to be flattened: bumps of four cells."""


def steady_normals(
    facets: Facets, made: Float[np.ndarray, "r 2"] | None = None
) -> tuple[Directions, Directions]:
    """Compute normals without noise, and normals of patches.

    On a plain surface normals differ by noise only, and would seem to fix the shift along it: the
    share of a slope that noise explains is taken away (James and Stein, Estimation with quadratic
    loss, 1961), patch by patch and in each direction of its own: a seam has slopes across it, and
    along it noise. On a rough one planes over some cells are flatter than what they stand for,
    which is put right then.

    Args:
        facets: The leg.
        made: Variance of the slopes, along the way and across it, that errors of the way may
            have made of each row as a whole; None: of a way without errors.
    """
    patches = -(-facets.leg.num_columns // _PATCH)
    band = facets.row // _PATCH
    _, which = np.unique(band * patches + facets.column // _PATCH, return_inverse=True)
    count = np.bincount(which)
    noise = facets.variance[:, None] * facets.slope_variance
    smooth = _smooth_normals(facets, which, np.bincount(which, noise.sum(axis=1)) / count**2)
    off = np.einsum("nki,ni->nk", facets.axes, facets.normals - smooth)
    common = fit_rows(facets, off)
    of_rows = keep_rows(facets, common, noise, made)
    steady = _keep_signal(off - common, noise, which) + of_rows
    rough = np.einsum("nk,nki->ni", steady, facets.axes)
    steep = smooth + _steepen(facets, smooth, rough)
    return (
        steep / np.linalg.norm(steep, axis=1, keepdims=True),
        smooth / np.linalg.norm(smooth, axis=1, keepdims=True),
    )


def _keep_signal(slopes: Slopes, noise: Slopes, patch: Indices) -> Slopes:
    """Take the share of slopes away that noise explains, in each patch along both its own axes."""
    count = np.bincount(patch)
    level = np.stack([np.bincount(patch, n) for n in noise.T], axis=1) / count[:, None]
    scale = np.sqrt(np.maximum(level, 1e-300))
    white = slopes / scale[patch]
    products = np.einsum("ni,nj->nij", white, white).reshape(-1, 4)
    seen = np.stack([np.bincount(patch, p) for p in products.T], axis=1) / count[:, None]
    squares, axes = np.linalg.eigh(seen.reshape(-1, 2, 2))
    keep = np.einsum("pik,pk,pjk->pij", axes, share_of_signal(squares, np.ones_like(squares)), axes)
    return np.asarray(np.einsum("nij,nj->ni", keep[patch], white) * scale[patch])


def _smooth_normals(facets: Facets, patch: Indices, noise: Float[np.ndarray, " p"]) -> Directions:
    """Give each facet the normal of its patch: of a surface bent evenly, and what stands out of it.

    What patches side by side have in common, or what grows evenly from one to the next, is left
    out: a vehicle that heaves, pitches or rolls makes the like of a plain surface, and would be
    held along it by its own errors.

    Args:
        facets: The leg.
        patch: Number of each facet's patch.
        noise: Variance of each patch's mean normal.
    """
    count = np.bincount(patch)

    def mean(values: Float[np.ndarray, "n d"], number: Indices) -> Float[np.ndarray, "m d"]:
        held = np.maximum(np.bincount(number), 1)
        return np.stack([np.bincount(number, v) for v in values.T], axis=1) / held[:, None]

    places = np.stack([np.ones(len(facets)), facets.row, facets.column], axis=1)
    means, middles = mean(facets.normals, patch), mean(places, patch)
    weights = np.sqrt(count)[:, None]
    bent = np.linalg.lstsq(weights * middles, weights * means, rcond=None)[0]
    off = means - middles @ bent
    band = (middles[:, 1] // _PATCH).astype(np.int64)
    aside = (middles[:, 2] - mean(middles, band)[band, 2])[:, None]
    off -= mean(off, band)[band]
    off -= aside * (mean(aside * off, band) / np.maximum(mean(aside**2, band), 1e-12))[band]
    stands_out = share_of_signal(np.einsum("ni,ni->n", off, off), noise)
    return np.asarray(places @ bent + (stands_out[:, None] * off)[patch])


def _steepen(facets: Facets, mean: Directions, off: Directions) -> Directions:
    """Make slopes as steep as the heights of neighbouring cells say.

    A plane over three cells is flatter than bumps of some cells' width are. Where two legs' cells
    lie aside of one another by the same over a stretch, as of a vehicle that keeps its speed, the
    rest would look like a shift of the leg, anew each time that facets are paired.
    """
    steep = off.copy()
    for axis, step in enumerate(((1, 0), (0, 1))):
        along = facets.axes[:, axis]
        part = np.einsum("ni,ni->n", off, along)[:, None] * along
        steep += (_flatness(facets, mean, off, step) - 1) * part
    return steep


def _flatness(facets: Facets, mean: Directions, off: Directions, step: tuple[int, int]) -> float:
    """Give by what slopes along rows or columns are to be multiplied.

    Between a cell and its next neighbour, and the one after, the mean slope is to explain the
    difference of their heights; from both follows what would hold close by (Richardson, The
    deferred approach to the limit, 1927).
    """
    near, far = (_explain(facets, mean, off, (n * step[0], n * step[1])) for n in (1, 2))
    return float(np.clip((4 * near - far) / 3, 1.0, _STEEPEST))


def _explain(facets: Facets, mean: Directions, off: Directions, step: tuple[int, int]) -> float:
    """Give the factor of slopes that explains heights of facets some cells apart best."""
    leg = facets.leg
    place = np.full((len(leg.row_times) + step[0], leg.num_columns + step[1]), -1)
    place[facets.row, facets.column] = np.arange(len(facets))
    other = place[facets.row + step[0], facets.column + step[1]]
    one = np.flatnonzero(other >= 0)
    other = other[one]
    between = facets.points[other] - facets.points[one]
    plain, rough = (np.einsum("ni,ni->n", n[one] + n[other], between) / 2 for n in (mean, off))
    square = float(rough @ rough)
    return -float(plain @ rough) / square if square > 0 else 1.0
