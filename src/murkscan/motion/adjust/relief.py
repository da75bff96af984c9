"""A leg's relief: how far it stands out of its own smooth surface."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.ndimage import uniform_filter
from scipy.spatial import cKDTree

from ...types.arrays import Indices, Scalars
from .legs import Facets
from .path import Path
from .restless import fit_rows, heights_of_errors, keep_rows

_SMOOTH = 0.06
"""Size over which a leg's surface is its own mean [m]: below it, relief."""
FLATTEST = 0.05e-3
"""RMS of a relief below which there is nothing to find [m]."""


@dataclass(frozen=True, eq=False)
class Relief:
    """A leg's facets, each with how far it stands out of the leg's own smooth surface."""

    facets: Facets
    tree: cKDTree
    heights: Scalars
    """[m]"""
    noise: Scalars
    """Variance of each that is noise [m²]."""

    def is_flat(self, which: Indices) -> bool:
        """Whether some facets show no more than their noise."""
        seen = float(np.var(self.heights[which]))
        return seen < FLATTEST**2 + float(np.mean(self.noise[which]))


def make_relief(facets: Facets, path: Path, errors: Float[np.ndarray, "k 6 m"]) -> Relief:
    """Make a leg's relief, but for what a vehicle that is not where its path lies makes of it.

    Args:
        facets: The leg.
        path: Where it lies.
        errors: Some that its control values may have, drawn.
    """
    heights = make_heights(facets)[:, None]
    common = fit_rows(facets, heights)
    noise = (facets.variance / facets.count)[:, None]
    made = heights_of_errors(facets, path, errors, _window(facets))[:, None]
    steady = heights - common + keep_rows(facets, common, noise, made)
    return Relief(facets, cKDTree(facets.points), steady[:, 0], noise[:, 0])


def make_heights(facets: Facets) -> Scalars:
    """Compute how far each facet stands out of its leg's own smooth surface [m]."""
    leg = facets.leg
    shape = (len(leg.row_times), leg.num_columns)
    window = _window(facets)

    def smooth(values: Scalars) -> Scalars:
        image = np.zeros(shape)
        image[facets.row, facets.column] = values
        return uniform_filter(image, window, mode="constant")[facets.row, facets.column]

    share = smooth(np.ones(len(facets)))
    origin = facets.points.mean(axis=0)
    mean = np.stack([smooth(p) for p in (facets.points - origin).T], axis=1) / share[:, None]
    normal = np.stack([smooth(n) for n in facets.normals.T], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.einsum("ni,ni->n", facets.points - origin - mean, normal)


def _window(facets: Facets) -> int:
    return 2 * round(_SMOOTH / facets.leg.size / 2) + 1
