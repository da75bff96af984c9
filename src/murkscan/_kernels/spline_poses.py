"""Poses of a way between its control values, and what points seen from there say of them."""

import math

import numpy as np

from .compiled import loop, part


@loop(error_model="numpy")
def evaluate_poses(
    piece: np.ndarray,
    along: np.ndarray,
    positions: np.ndarray,
    turns: np.ndarray,
    reference: np.ndarray,
    steps: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Evaluate a way R(t) = Exp(φ(t))·R₀(t) with splines φ, R₀ and position.

    Args:
        piece: First control value that counts at each time, n.
        along: Where in the piece each time lies, 0 to 1, n.
        positions: Control values of the position, k × 3.
        turns: Control values of φ, k × 3.
        reference: Control rotations of R₀ as quaternions wxyz, k × 4.
        steps: Rotation vectors from each of them to the next, (k − 1) × 3.

    Returns:
        Weights of the four control values n × 4, positions n × 3, rotations n × 3 × 3, and by what
        the way turns for a change of φ, n × 3 × 3.

    References:
        Kim, Kim and Shin, A general construction scheme for unit quaternion curves, SIGGRAPH 1995,
        equation (4); Solà, Deray, Atchuthan, A micro Lie theory for state estimation in robotics,
        2018, equation (145).
    """
    count = len(piece)
    weights, places = np.empty((count, 4)), np.empty((count, 3))
    rotations, turned_by = np.empty((count, 3, 3)), np.empty((count, 3, 3))
    reached = np.empty((3, 3))
    for n in range(count):
        _weigh(along[n], weights[n])
        i = piece[n]
        w, x, y, z = reference[i]
        share = weights[n, 1] + weights[n, 2] + weights[n, 3]
        for j in range(3):
            w, x, y, z = _turn_further(w, x, y, z, share, steps[i + j])
            share -= weights[n, j + 1]
        _as_matrix(w, x, y, z, reached)
        p, q, r = 0.0, 0.0, 0.0
        for d in range(3):
            places[n, d] = 0.0
            for j in range(4):
                places[n, d] += weights[n, j] * positions[i + j, d]
        for j in range(4):
            p += weights[n, j] * turns[i + j, 0]
            q += weights[n, j] * turns[i + j, 1]
            r += weights[n, j] * turns[i + j, 2]
        _turn_all(p, q, r, reached, rotations[n], turned_by[n])
    return weights, places, rotations, turned_by


@loop(error_model="numpy")
def lever_points(
    positions: np.ndarray,
    rotations: np.ndarray,
    turned_by: np.ndarray,
    points: np.ndarray,
    direction: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Place points along a direction, and tell how that changes with the pose they were seen from.

    Args:
        positions: Of the vehicle at the moment of each point, n × 3.
        rotations: world_from_vehicle then, n × 3 × 3.
        turned_by: Turn for a change of φ then, n × 3 × 3.
        points: In the vehicle's frame, n × 3.
        direction: In the world, n × 3.

    Returns:
        How far each point lies along its direction, n; and the slopes, n × 6.
    """
    count = len(points)
    place, slopes = np.empty(count), np.empty((count, 6))
    for n in range(count):
        r, p, d = rotations[n], points[n], direction[n]
        x = r[0, 0] * p[0] + r[0, 1] * p[1] + r[0, 2] * p[2]
        y = r[1, 0] * p[0] + r[1, 1] * p[1] + r[1, 2] * p[2]
        z = r[2, 0] * p[0] + r[2, 1] * p[1] + r[2, 2] * p[2]
        t = positions[n]
        place[n] = d[0] * (x + t[0]) + d[1] * (y + t[1]) + d[2] * (z + t[2])
        u, v, w = y * d[2] - z * d[1], z * d[0] - x * d[2], x * d[1] - y * d[0]
        for k in range(3):
            slopes[n, k] = d[k]
            by = turned_by[n]
            slopes[n, 3 + k] = by[0, k] * u + by[1, k] * v + by[2, k] * w
    return place, slopes


@part(error_model="numpy")
def _weigh(s: float, weights: np.ndarray) -> None:
    """Give the weights of a uniform cubic B-spline (de Boor 1978, chapter IX)."""
    weights[0] = (1 - s) ** 3 / 6
    weights[1] = (4 - 6 * s**2 + 3 * s**3) / 6
    weights[2] = (1 + 3 * s + 3 * s**2 - 3 * s**3) / 6
    weights[3] = s**3 / 6


@part(error_model="numpy")
def _turn_further(
    w: float, x: float, y: float, z: float, share: float, step: np.ndarray
) -> tuple[float, float, float, float]:
    """Give a rotation followed by a share of a rotation vector, in its own axes."""
    a, b, c = share * step[0], share * step[1], share * step[2]
    angle = math.sqrt(a * a + b * b + c * c)
    # sin(angle / 2) / angle, which is 1/2 where there is no turn.
    size = math.sin(angle / 2) / angle if angle > 1e-9 else 0.5
    e, a, b, c = math.cos(angle / 2), size * a, size * b, size * c
    return (
        w * e - x * a - y * b - z * c,
        w * a + x * e + y * c - z * b,
        w * b - x * c + y * e + z * a,
        w * c + x * b - y * a + z * e,
    )


@part(error_model="numpy")
def _as_matrix(w: float, x: float, y: float, z: float, matrix: np.ndarray) -> None:
    """Give the matrix of a unit quaternion."""
    matrix[0, 0], matrix[1, 1] = 1 - 2 * (y * y + z * z), 1 - 2 * (x * x + z * z)
    matrix[2, 2] = 1 - 2 * (x * x + y * y)
    matrix[0, 1], matrix[1, 0] = 2 * (x * y - z * w), 2 * (x * y + z * w)
    matrix[0, 2], matrix[2, 0] = 2 * (x * z + y * w), 2 * (x * z - y * w)
    matrix[1, 2], matrix[2, 1] = 2 * (y * z - x * w), 2 * (y * z + x * w)


@part(error_model="numpy")
def _turn_all(
    p: float, q: float, r: float, reached: np.ndarray, rotation: np.ndarray, turned_by: np.ndarray
) -> None:
    """Turn a matrix by Exp(φ), and give how that turns with φ, about the target's axes."""
    square = p * p + q * q + r * r
    angle = max(math.sqrt(square), 1e-6)
    first, second = (1 - math.cos(angle)) / angle**2, (angle - math.sin(angle)) / angle**3
    _add_up(p, q, r, 1 - second * square, first, second, turned_by)
    turn = np.empty((3, 3))
    _add_up(p, q, r, 1 - first * square, math.sin(angle) / angle, first, turn)
    for i in range(3):
        for j in range(3):
            rotation[i, j] = (
                turn[i, 0] * reached[0, j] + turn[i, 1] * reached[1, j] + turn[i, 2] * reached[2, j]
            )


@part(error_model="numpy")
def _add_up(
    p: float, q: float, r: float, one: float, skew: float, outer: float, matrix: np.ndarray
) -> None:
    """Give one·I + skew·[φ]× + outer·φφᵀ."""
    matrix[0, 0], matrix[1, 1] = one + outer * p * p, one + outer * q * q
    matrix[2, 2] = one + outer * r * r
    matrix[0, 1], matrix[1, 0] = outer * p * q - skew * r, outer * p * q + skew * r
    matrix[0, 2], matrix[2, 0] = outer * p * r + skew * q, outer * p * r - skew * q
    matrix[1, 2], matrix[2, 1] = outer * q * r - skew * p, outer * q * r + skew * p
