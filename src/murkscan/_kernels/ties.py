"""The normal equations of many equations that each join two moments of two ways."""

import numpy as np

from .compiled import loop


@loop(error_model="numpy")
def sum_groups(
    starts: np.ndarray,
    slopes_a: np.ndarray,
    slopes_b: np.ndarray,
    weights_a: np.ndarray,
    weights_b: np.ndarray,
    residuals: np.ndarray,
    weights: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Sum the normal equations of groups of ties that have the same control values.

    A tie's slope over control value j of its first way is weights_a[j]·slopes_a, and of its
    second −weights_b[j]·slopes_b.

    Args:
        starts: First tie of each group, and the count of ties at the end, g + 1.
        slopes_a: How a residual changes with place and turn at the first moment, n × 6.
        slopes_b: The same at the second; it counts with the other sign.
        weights_a: Spline weights at the first moment, n × 4.
        weights_b: At the second, n × 4.
        residuals: n.
        weights: One over the variance of each residual, n.

    Returns:
        Matrices JᵀWJ, g × 48 × 48 (control values of the first way, then of the second), and
        vectors JᵀWr, g × 48.
    """
    groups = len(starts) - 1
    matrix = np.zeros((groups, 48, 48))
    vector = np.zeros((groups, 48))
    row = np.empty(48)
    for g in range(groups):
        for n in range(starts[g], starts[g + 1]):
            for j in range(4):
                for k in range(6):
                    row[6 * j + k] = weights_a[n, j] * slopes_a[n, k]
                    row[24 + 6 * j + k] = -weights_b[n, j] * slopes_b[n, k]
            w = weights[n]
            for p in range(48):
                scaled = w * row[p]
                vector[g, p] += scaled * residuals[n]
                for q in range(p, 48):
                    matrix[g, p, q] += scaled * row[q]
        for p in range(48):
            for q in range(p):
                matrix[g, p, q] = matrix[g, q, p]
    return matrix, vector


@loop(error_model="numpy")
def sum_vectors(
    starts: np.ndarray,
    slopes_a: np.ndarray,
    slopes_b: np.ndarray,
    weights_a: np.ndarray,
    weights_b: np.ndarray,
    residuals: np.ndarray,
    weights: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Sum the vectors of `sum_groups` alone; the matrices are empty, g × 0 × 0."""
    groups = len(starts) - 1
    vector = np.zeros((groups, 48))
    for g in range(groups):
        for n in range(starts[g], starts[g + 1]):
            pull = weights[n] * residuals[n]
            for j in range(4):
                for k in range(6):
                    vector[g, 6 * j + k] += pull * weights_a[n, j] * slopes_a[n, k]
                    vector[g, 24 + 6 * j + k] -= pull * weights_b[n, j] * slopes_b[n, k]
    return np.zeros((groups, 0, 0)), vector
