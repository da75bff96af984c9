"""Rows of whole numbers, told apart as quickly as single numbers."""

import math

import numpy as np
from jaxtyping import Int

from ..types.arrays import Indices

_MOST = 2**63
"""Keys that a whole number can tell apart."""


def row_keys(rows: Int[np.ndarray, "n k"]) -> Indices:
    """Give one whole number for each row: the same for equal rows, in the order of the rows.

    NumPy's `unique` of keys takes a twentieth of the time of its `unique` of rows, which are
    compared byte by byte.
    """
    if len(rows) == 0:
        return np.zeros(0, np.int64)
    low = rows.min(axis=0)
    spans = [int(top) - int(bottom) + 1 for top, bottom in zip(rows.max(axis=0), low, strict=True)]
    if math.prod(spans) >= _MOST:
        return np.unique(rows, axis=0, return_inverse=True)[1].ravel()
    return np.asarray(np.ravel_multi_index(tuple((rows - low).T), spans))
