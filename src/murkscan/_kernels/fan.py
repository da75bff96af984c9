"""A fan of laser rays behind a port: its own rays, where camera rays meet it, where points lie.

The surface is S(t, range) = start(t) + range · direction(t), with t the tangent of the angle from
the fan's middle inside the housing: straight lines, but no plane.
"""

from typing import NamedTuple

import numpy as np

from .compiled import loop, part
from .refraction import Interfaces, trace_ray

_Ray = tuple[float, float, float, float, float, float]
"""Start x y z and direction x y z."""

_SAMPLES = 33
"""Rays of a fan among which the one that meets a camera ray, or a point, is looked for."""
_STEP = 1e-5
"""Change of t over which a derivative is taken; its relative error is the square of that."""


class Fan(NamedTuple):
    """The fan inside its housing: where it starts, its middle, the way it spreads, how far."""

    origin: tuple[float, float, float]
    direction: tuple[float, float, float]
    tangent: tuple[float, float, float]
    edge: float
    """Largest t."""


@part(error_model="numpy", inline="always")
def _fan_ray(t: float, fan: Fan, interfaces: Interfaces) -> _Ray:
    """Start and direction, outside its port, of a fan's ray."""
    c = 1.0 / np.sqrt(1.0 + t * t)
    s = c * t
    (ax, ay, az), (bx, by, bz), (ox, oy, oz) = fan.direction, fan.tangent, fan.origin
    x, y, z, dx, dy, dz = trace_ray(c * ax + s * bx, c * ay + s * by, c * az + s * bz, interfaces)
    return x + ox, y + oy, z + oz, dx, dy, dz


@loop(error_model="numpy")
def trace_fan_rays(
    tangents: np.ndarray, fan: Fan, interfaces: Interfaces
) -> tuple[np.ndarray, np.ndarray]:
    """Starts and directions (n 3) of the fan's rays at some t (n)."""
    starts, leaving = np.empty((len(tangents), 3)), np.empty((len(tangents), 3))
    for i in range(len(tangents)):
        x, y, z, dx, dy, dz = _fan_ray(tangents[i], fan, interfaces)
        starts[i, 0], starts[i, 1], starts[i, 2] = x, y, z
        leaving[i, 0], leaving[i, 1], leaving[i, 2] = dx, dy, dz
    return starts, leaving


@part(error_model="numpy", inline="always")
def _cross(
    ax: float, ay: float, az: float, bx: float, by: float, bz: float
) -> tuple[float, float, float]:
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@part(error_model="numpy", inline="always")
def _moment(t: float, ray: _Ray, camera_ray: _Ray) -> float:
    """Volume that two lines span, 0 where they meet; without a port it is linear in t."""
    x, y, z, dx, dy, dz = ray
    ox, oy, oz, ex, ey, ez = camera_ray
    nx, ny, nz = _cross(ex, ey, ez, dx, dy, dz)
    return np.sqrt(1.0 + t * t) * ((x - ox) * nx + (y - oy) * ny + (z - oz) * nz)


@part(error_model="numpy")
def _meeting(
    ends: tuple[float, float, float, float], camera_ray: _Ray, fan: Fan, interfaces: Interfaces
) -> _Ray:
    """The fan's ray that meets the camera's, between two t with moments of opposite sign.

    Inverse quadratic interpolation: the moment is almost linear in t, so that three rays will do.
    Bisection where it leaves the bracket.
    """
    low, at_low, high, at_high = ends
    t = (low * at_high - high * at_low) / (at_high - at_low)
    ray = _fan_ray(t, fan, interfaces)
    for _ in range(60):
        at_t = _moment(t, ray, camera_ray)
        new = (
            low * at_high * at_t / ((at_low - at_high) * (at_low - at_t))
            + high * at_low * at_t / ((at_high - at_low) * (at_high - at_t))
            + t * at_low * at_high / ((at_t - at_low) * (at_t - at_high))
        )
        if at_t * at_low > 0.0:
            low, at_low = t, at_t
        else:
            high, at_high = t, at_t
        new = new if low < new < high else 0.5 * (low + high)
        step, t = abs(new - t), new
        if step < 1e-10 or at_t == 0.0 or not np.isfinite(at_t):
            break
        ray = _fan_ray(t, fan, interfaces)
    return ray


@part(error_model="numpy", inline="always")
def _depth_of_meeting(ray: _Ray, camera_ray: _Ray) -> float:
    """How far along the camera's ray the two are nearest; infinite if that is behind either."""
    x, y, z, dx, dy, dz = ray
    ox, oy, oz, ex, ey, ez = camera_ray
    nx, ny, nz = _cross(ex, ey, ez, dx, dy, dz)
    x, y, z = x - ox, y - oy, z - oz
    ax, ay, az = _cross(x, y, z, dx, dy, dz)
    bx, by, bz = _cross(x, y, z, ex, ey, ez)
    square = nx * nx + ny * ny + nz * nz
    depth = (ax * nx + ay * ny + az * nz) / square if square > 0.0 else np.inf
    reach = bx * nx + by * ny + bz * nz
    return depth if depth >= 0.0 and reach >= 0.0 else np.inf


@part(error_model="numpy")
def _depth_on_fan(
    camera_ray: _Ray,
    tangents: np.ndarray,
    moments: np.ndarray,
    fan: Fan,
    interfaces: Interfaces,
) -> float:
    """How far along the camera's ray it first meets the fan, NaN if never.

    Followed from every pair of t between which the moment changes sign: a curved sheet may be
    met twice.
    """
    nearest = np.inf
    for j in range(len(tangents) - 1):
        if moments[j] * moments[j + 1] <= 0.0:
            ends = (tangents[j], moments[j], tangents[j + 1], moments[j + 1])
            ray = _meeting(ends, camera_ray, fan, interfaces)
            nearest = min(nearest, _depth_of_meeting(ray, camera_ray))
    return nearest if nearest < np.inf else np.nan


@loop(error_model="numpy")
def meet_fan(
    origins: np.ndarray, directions: np.ndarray, fan: Fan, interfaces: Interfaces
) -> np.ndarray:
    """Points (n 3) at which rays (n 3, n 3) first meet the fan; NaN where they do not.

    A fan's ray P + r q and a camera ray O + s D meet where their moment
    D · (q × P) + q · (D × O) is 0; some of the fan's rays bracket the one that does.
    """
    # A hair beyond the edge, so that a pixel that sees the very edge is not lost to rounding.
    edge = fan.edge * (1.0 + 1e-9)
    tangents = np.linspace(-edge, edge, _SAMPLES)
    starts, sampled = trace_fan_rays(tangents, fan, interfaces)
    sampled *= np.sqrt(1.0 + tangents * tangents).reshape(-1, 1)
    turns = np.empty_like(starts)
    for j in range(_SAMPLES):
        qx, qy, qz = sampled[j]
        px, py, pz = starts[j]
        turns[j, 0], turns[j, 1], turns[j, 2] = _cross(qx, qy, qz, px, py, pz)
    points, moments = np.empty_like(origins), np.empty(_SAMPLES)
    for i in range(len(origins)):
        ox, oy, oz = origins[i]
        ex, ey, ez = directions[i]
        mx, my, mz = _cross(ex, ey, ez, ox, oy, oz)
        for j in range(_SAMPLES):
            by_turn = ex * turns[j, 0] + ey * turns[j, 1] + ez * turns[j, 2]
            moments[j] = by_turn + sampled[j, 0] * mx + sampled[j, 1] * my + sampled[j, 2] * mz
        depth = _depth_on_fan((ox, oy, oz, ex, ey, ez), tangents, moments, fan, interfaces)
        points[i, 0], points[i, 1], points[i, 2] = ox + depth * ex, oy + depth * ey, oz + depth * ez
    return points


@part(error_model="numpy", inline="always")
def _nearest_sample(x: float, y: float, z: float, starts: np.ndarray, sampled: np.ndarray) -> int:
    """Which of the rays passes nearest to the point."""
    best, least = 0, np.inf
    for j in range(len(starts)):
        wx, wy, wz = x - starts[j, 0], y - starts[j, 1], z - starts[j, 2]
        ax, ay, az = _cross(wx, wy, wz, sampled[j, 0], sampled[j, 1], sampled[j, 2])
        square = ax * ax + ay * ay + az * az
        best, least = (j, square) if square < least else (best, least)
    return best


@part(error_model="numpy", inline="always")
def _step_to_foot(
    x: float, y: float, z: float, t: float, fan: Fan, interfaces: Interfaces
) -> tuple[float, float, float]:
    """Gauss-Newton step of t, and the range and signed distance at the present one."""
    sx, sy, sz, dx, dy, dz = _fan_ray(t, fan, interfaces)
    lx, ly, lz, lex, ley, lez = _fan_ray(t - _STEP, fan, interfaces)
    hx, hy, hz, hex_, hey, hez = _fan_ray(t + _STEP, fan, interfaces)
    x, y, z = x - sx, y - sy, z - sz
    reach = x * dx + y * dy + z * dz
    half = 0.5 / _STEP
    tx = half * (hx - lx + reach * (hex_ - lex))
    ty = half * (hy - ly + reach * (hey - ley))
    tz = half * (hz - lz + reach * (hez - lez))
    nx, ny, nz = _cross(dx, dy, dz, tx, ty, tz)
    square = nx * nx + ny * ny + nz * nz
    x, y, z = x - reach * dx, y - reach * dy, z - reach * dz
    step = (x * tx + y * ty + z * tz) / square
    return step, reach, (x * nx + y * ny + z * nz) / np.sqrt(square)


@loop(error_model="numpy")
def locate_points(points: np.ndarray, fan: Fan, interfaces: Interfaces) -> np.ndarray:
    """Angle, range and signed distance (n 3) of points; NaN behind the start of their ray.

    The foot of a point is where what separates them is at right angles to the surface.
    """
    tangents = np.linspace(-fan.edge, fan.edge, _SAMPLES)
    starts, sampled = trace_fan_rays(tangents, fan, interfaces)
    found = np.empty_like(points)
    for i in range(len(points)):
        x, y, z = points[i]
        t = tangents[_nearest_sample(x, y, z, starts, sampled)]
        reach, distance = np.nan, np.nan
        for _ in range(60):
            step, reach, distance = _step_to_foot(x, y, z, t, fan, interfaces)
            t += step
            if not abs(step) > 1e-9:
                break
        # A nanometre behind counts as on the port.
        ahead = 1.0 if reach >= -1e-9 else np.nan
        found[i, 0], found[i, 1], found[i, 2] = (
            np.arctan(t) * ahead,
            reach * ahead,
            distance * ahead,
        )
    return found
