"""The stripe on a ball, drawn by its light and found again."""

from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d

from murkscan.geometry.stripe_blur import Sight, is_readable
from murkscan.types.arrays import Points
from murkscan.types.sphere import Sphere

RADIUS, AWAY, LEAN = 0.05, 0.9, np.radians(20)
RISE = np.tan(LEAN)


def see_ball(
    aside: float,
    above: float,
    *,
    blur: float = 0.0,
    thickness: float = 1e-5,
    loss: float = 3.0,
    skirt: float = 0.0,
    count: int = 6001,
) -> tuple[Sphere, Points, Sight]:
    """Draw the stripe on a ball by its light, find its centres, and cut their rays with the sheet.

    The sheet leans by 20 degrees and lies above the ball's middle; through the sheet, light is
    summed over its thickness, and along u by a Gaussian. Gives the ball, the points and their
    sight; `blur` is 1σ of u, `thickness` that of the sheet [m], `loss` the share of light that the
    water takes for a metre of depth; of a lens with a `skirt`, that share of the light is blurred
    three times as much.
    """
    u = np.linspace(aside / AWAY - 0.06, aside / AWAY + 0.06, count)
    centre = np.array([aside, 0.0, AWAY])
    start = -above - RISE * (AWAY - RADIUS)
    offsets = np.linspace(-4, 4, 41) * thickness
    places, lights = [], []
    for off in offsets:
        # X = (u z, start + off / cos + rise z, z) lies on the ball: a quadratic in z.
        y = start + off / np.cos(LEAN)
        a = u**2 + RISE**2 + 1
        b = -u * aside + RISE * y - AWAY
        z = (-b - np.sqrt(np.maximum(b**2 - a * (aside**2 + y**2 + AWAY**2 - RADIUS**2), 0))) / a
        point = np.stack([u * z, y + RISE * z, z], axis=1)
        # The fan comes from beside the camera, as far away.
        facing = -np.einsum("ij,ij->i", point - centre, np.stack([u, 0 * u + RISE, 0 * u + 1], 1))
        lights.append(np.maximum(facing, 0) / z * np.exp(-loss * z))
        places.append(point[:, 1] / z)
    v, light = np.array(places), np.array(lights)
    light *= np.exp(-0.5 * (offsets / thickness) ** 2)[:, None]
    light *= np.abs(np.gradient(v, offsets, axis=0))
    seen = [(light * v).sum(axis=0), light.sum(axis=0)]
    if blur:
        near, far = (
            [gaussian_filter1d(one, size * blur / (u[1] - u[0])) for one in seen]
            for size in (1.0, 3.0)
        )
        seen = [(1 - skirt) * one + skirt * other for one, other in zip(near, far, strict=True)]
    # Beyond the ball there is no light, and no centre.
    z = start / (seen[0] / np.maximum(seen[1], 1e-300) - RISE)
    points, sight = on_sheet(u, z, start)
    # Those before the very rim, beyond which there is no ball.
    good = is_readable(Sphere(centre, RADIUS), points, sight) & (np.abs(u * AWAY - aside) < 0.043)
    return Sphere(centre, RADIUS), points[good], sight[good]


def on_sheet(u: np.ndarray, z: np.ndarray, start: float | np.ndarray) -> tuple[Points, Sight]:
    """Give points of the sheet, and from where they are seen."""
    points = np.stack([u * z, start + RISE * z, z], axis=1)
    ranges = np.linalg.norm(points, axis=1)
    ways = np.ones((len(u), 1))
    light = ways * [0.0, np.sin(LEAN), np.cos(LEAN)]
    return points, Sight(points / ranges[:, None], ways * [1.0, 0.0, 0.0], light, ranges)


def scan_ball(**drawn: float) -> tuple[Sphere, Points, Sight]:
    """See a ball while the sheet moves over it, by 2 mm from profile to profile."""
    parts = [see_ball(0.0, above, count=241, **drawn) for above in np.arange(-0.02, 0.021, 0.002)]
    ball = parts[0][0]
    columns = zip(*((s.rays, s.along, s.light, s.ranges) for _, _, s in parts), strict=True)
    points = np.concatenate([points for _, points, _ in parts])
    return ball, points, Sight(*map(np.concatenate, columns))


def put_back(points: Points, sight: Sight, depth: np.ndarray) -> tuple[Points, Sight]:
    """Move points nearer by so much of their depth [m], along their sheets, and say so."""
    u, start = points[:, 0] / points[:, 2], points[:, 1] - RISE * points[:, 2]
    moved, seen = on_sheet(u, points[:, 2] - depth, start)
    assert sight.ranges is not None
    assert seen.ranges is not None
    return moved, replace(seen, blur_shift=sight.ranges - seen.ranges)
