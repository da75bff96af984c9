"""Small symmetric equations."""

import numpy as np

from .compiled import part


@part()
def solve(matrix: np.ndarray, right: np.ndarray) -> bool:
    """Solve symmetric equations in place by Cholesky's method; False where they are singular.

    `matrix` becomes its lower triangular root, `right` the solution.
    """
    n = len(right)
    for j in range(n):
        for k in range(j):
            matrix[j, j] -= matrix[j, k] ** 2
        if matrix[j, j] <= 1e-12:
            return False
        matrix[j, j] = np.sqrt(matrix[j, j])
        for i in range(j + 1, n):
            for k in range(j):
                matrix[i, j] -= matrix[i, k] * matrix[j, k]
            matrix[i, j] /= matrix[j, j]
    substitute(matrix, right)
    return True


@part()
def substitute(root: np.ndarray, right: np.ndarray) -> None:
    """Solve in place for one more right side, with the root that `solve` has left."""
    n = len(right)
    for i in range(n):
        for k in range(i):
            right[i] -= root[i, k] * right[k]
        right[i] /= root[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            right[i] -= root[k, i] * right[k]
        right[i] /= root[i, i]


@part()
def first_variance(root: np.ndarray) -> float:
    """Give the first element on the diagonal of the inverse, from the root."""
    n = len(root)
    column = np.zeros(n)
    column[0] = 1.0
    substitute(root, column)
    return column[0]
