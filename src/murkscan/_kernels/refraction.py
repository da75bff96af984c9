"""Light through the windows of a housing: rays outwards, and points back in.

Everything starts at the origin, inside, in air (index 1), and leaves through the interfaces in
order. Without interfaces a ray is what it was.
"""

from typing import NamedTuple

import numpy as np

from .compiled import loop, part


class Interfaces(NamedTuple):
    """The surfaces between the media, from inside out: parallel planes or concentric spheres."""

    curved: bool
    vector: tuple[float, float, float]
    """Unit normal of the planes, outwards, or centre of the spheres [m]."""
    sizes: np.ndarray
    """Distance of each plane from the origin, or radius of each sphere [m]; increasing."""
    indices: np.ndarray
    """Refractive index inside, and behind each surface; one more than sizes."""


@part(error_model="numpy", inline="always")
def _refract(
    dx: float, dy: float, dz: float, nx: float, ny: float, nz: float, ratio: float
) -> tuple[float, float, float]:
    """Snell's law as a vector; n points the way the light goes. NaN at total reflection."""
    cosine = dx * nx + dy * ny + dz * nz
    bend = np.sqrt(1.0 - ratio * ratio * (1.0 - cosine * cosine)) - ratio * cosine
    return ratio * dx + bend * nx, ratio * dy + bend * ny, ratio * dz + bend * nz


@part(error_model="numpy")
def trace_ray(
    dx: float, dy: float, dz: float, interfaces: Interfaces
) -> tuple[float, float, float, float, float, float]:
    """Where a ray from the origin leaves the last surface, and whereto; NaN if it never does."""
    curved, (vx, vy, vz) = interfaces.curved, interfaces.vector
    sizes, indices = interfaces.sizes, interfaces.indices
    x, y, z = 0.0, 0.0, 0.0
    for i in range(len(sizes)):
        size = sizes[i]
        if curved:
            ox, oy, oz = x - vx, y - vy, z - vz
            along = ox * dx + oy * dy + oz * dz
            across = ox * ox + oy * oy + oz * oz - size * size
            step = -along + np.sqrt(along * along - across)
            nx, ny, nz = (
                (ox + step * dx) / size,
                (oy + step * dy) / size,
                (oz + step * dz) / size,
            )
        else:
            cosine = dx * vx + dy * vy + dz * vz
            step = (size - (x * vx + y * vy + z * vz)) / cosine
            # A ray that never gets to the plane is lost, and with it all that follows.
            hit = 1.0 if cosine > 0.0 else np.nan
            nx, ny, nz = vx * hit, vy * hit, vz * hit
            step *= hit
        x, y, z = x + step * dx, y + step * dy, z + step * dz
        dx, dy, dz = _refract(dx, dy, dz, nx, ny, nz, indices[i] / indices[i + 1])
    return x, y, z, dx, dy, dz


@loop(error_model="numpy")
def trace_rays(directions: np.ndarray, interfaces: Interfaces) -> tuple[np.ndarray, np.ndarray]:
    """Follow unit directions (n 3) from the origin out of the last surface: starts, directions."""
    starts, leaving = np.empty_like(directions), np.empty_like(directions)
    for i in range(len(directions)):
        x, y, z, dx, dy, dz = trace_ray(
            directions[i, 0], directions[i, 1], directions[i, 2], interfaces
        )
        starts[i, 0], starts[i, 1], starts[i, 2] = x, y, z
        leaving[i, 0], leaving[i, 1], leaving[i, 2] = dx, dy, dz
    return starts, leaving


@loop(error_model="numpy")
def aim_through_planes(points: np.ndarray, interfaces: Interfaces) -> np.ndarray:
    """Directions (n 3) from the origin whose rays reach the points; NaN inside the last plane.

    Newton's method for the tangent t of the angle in air. The offset it must make up,
    Σ hᵢ t / √(nᵢ² + (nᵢ² − 1) t²), grows with t and is concave where no index is below 1, so that
    steps from t = 0 come up to the root from below and never pass it.
    """
    (nx, ny, nz), sizes, indices = interfaces.vector, interfaces.sizes, interfaces.indices
    last = len(sizes)
    aims = np.empty_like(points)
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        depth = x * nx + y * ny + z * nz
        x, y, z = x - depth * nx, y - depth * ny, z - depth * nz
        offset = np.sqrt(x * x + y * y + z * z)
        tangent = 0.0 if depth >= sizes[last - 1] else np.nan
        for _ in range(60):
            reached, slope, inner = 0.0, 0.0, 0.0
            for k in range(last + 1):
                outer = sizes[k] if k < last else depth
                square = indices[k] * indices[k]
                inverse = 1.0 / (square + (square - 1.0) * tangent * tangent)
                part = (outer - inner) * np.sqrt(inverse)
                reached += part * tangent
                slope += part * inverse * square
                inner = outer
            step = (offset - reached) / slope
            tangent += step
            if not abs(step) > 1e-15 * (1.0 + tangent):
                break
        scale = tangent / offset if offset > 0.0 else tangent
        aims[i, 0], aims[i, 1], aims[i, 2] = nx + scale * x, ny + scale * y, nz + scale * z
    return aims


@part(error_model="numpy", inline="always")
def _sweep(
    turn: float, eccentricity: float, distance: float, interfaces: Interfaces
) -> tuple[float, float]:
    """Angle about the centre from the origin to the point, and its derivative by the turn.

    n r sin(angle to the radius) is the same all along the ray (Bouguer), so that each shell adds
    asin(p / n r_inner) − asin(p / n r_outer).
    """
    sizes, indices = interfaces.sizes, interfaces.indices
    product = eccentricity * np.sin(turn)
    change = eccentricity * np.cos(turn)
    angle, slope = turn, 1.0
    for k in range(len(sizes) + 1):
        if k > 0:
            inner = indices[k] * sizes[k - 1]
            angle += np.arcsin(product / inner)
            slope += change / np.sqrt(inner * inner - product * product)
        outer = indices[k] * (sizes[k] if k < len(sizes) else distance)
        angle -= np.arcsin(product / outer)
        slope -= change / np.sqrt(outer * outer - product * product)
    return angle, slope


@loop(error_model="numpy")
def aim_through_spheres(points: np.ndarray, interfaces: Interfaces) -> np.ndarray:
    """Directions (n 3) from the origin whose rays reach the points; NaN inside the last sphere.

    The ray stays in the plane of origin, centre and point. In it the swept angle grows with the
    turn from the radius through the origin, so there is one root between 0 and π: Newton's
    method, with bisection whenever a step leaves the bracket.
    """
    (cx, cy, cz), sizes = interfaces.vector, interfaces.sizes
    eccentricity = np.sqrt(cx * cx + cy * cy + cz * cz)
    ex, ey, ez = 0.0, 0.0, 1.0
    if eccentricity > 0.0:
        ex, ey, ez = -cx / eccentricity, -cy / eccentricity, -cz / eccentricity
    aims = np.empty_like(points)
    for i in range(len(points)):
        x, y, z = points[i, 0] - cx, points[i, 1] - cy, points[i, 2] - cz
        along = x * ex + y * ey + z * ez
        x, y, z = x - along * ex, y - along * ey, z - along * ez
        across = np.sqrt(x * x + y * y + z * z)
        distance = np.sqrt(along * along + across * across)
        wanted = np.arctan2(across, along) if distance >= sizes[-1] else np.nan
        low, high, turn = 0.0, np.pi, wanted
        for _ in range(60):
            angle, slope = _sweep(turn, eccentricity, distance, interfaces)
            low, high = (turn, high) if angle < wanted else (low, turn)
            new = turn + (wanted - angle) / slope
            new = new if low <= new <= high else 0.5 * (low + high)
            step, turn = abs(new - turn), new
            if not step > 1e-15:
                break
        scale = np.sin(turn) / across if across > 0.0 else 0.0
        forward = np.cos(turn) + 0.0 * wanted
        aims[i, 0] = forward * ex + scale * x
        aims[i, 1] = forward * ey + scale * y
        aims[i, 2] = forward * ez + scale * z
    return aims
