"""Draw a surface or a cloud."""

import cv2
import numpy as np

from ..errors import InputError, NotEnoughData
from ..types.arrays import ColourImage, Points
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .base import AbstractColours, Legend
from .light import light_up
from .plain import Plain
from .splats import splat_points
from .surface import cast_mesh
from .views import View
from .window import Relief, Window
from .writing import write_on

_BACKGROUND = 0.985
_EVEN = 0.5
"""Share of the light that falls evenly where colours have to be read off a scale."""


def render(
    surface: Mesh | PointCloud,
    view: View,
    *,
    colours: AbstractColours | None = None,
    size: tuple[int, int] = (1280, 960),
) -> ColourImage:
    """Draw a surface, without perspective, with a scale bar and, for its colours, a colour bar.

    The light comes from the upper left and hollows are darker; edges are smoothed by four samples a
    pixel. The same input gives the same picture. A cloud is drawn as one small disc a point.

    Args:
        surface: What to draw, in the world frame [m].
        view: From where.
        colours: How to colour it; None: plain.
        size: Width and height of the picture [px].

    Raises:
        NotEnoughData: There is nothing to draw.
        InputError: A point is not finite, or the picture is below 64 x 64 pixels.
    """
    world = surface.vertices if isinstance(surface, Mesh) else surface.points
    _require_something(surface, world)
    colours = Plain() if colours is None else colours
    legend = colours.legend(world)
    points = world @ view.view_from_world.T
    window = Window.around(points, size, with_bar=legend is not None)
    samples = window.as_samples(points)
    if isinstance(surface, Mesh):
        relief = cast_mesh(surface, samples, window)
    else:
        normals = surface.normals @ view.view_from_world.T
        relief = splat_points(samples, normals, window)
    return write_on(_develop(relief, view, window, colours, legend), view, window, legend)


def _require_something(surface: Mesh | PointCloud, points: Points) -> None:
    if len(points) == 0 or (isinstance(surface, Mesh) and len(surface.faces) == 0):
        raise NotEnoughData("There is nothing to draw: the surface has no points or no triangles.")
    broken = len(points) - int(np.isfinite(points).all(axis=1).sum())
    if broken:
        raise InputError(
            f"{broken} of {len(points)} points to draw are not finite; leave them out."
        )


def _develop(
    relief: Relief, view: View, window: Window, colours: AbstractColours, legend: Legend | None
) -> ColourImage:
    """Light and colour the samples, and make pixels of them."""
    rows, columns = np.nonzero(relief.seen)
    at = np.stack([columns, rows, relief.depth[rows, columns]], axis=1)
    in_view = (at - np.array([*window.centre, 0.0])) / window.scale
    outside = relief.outside[rows, columns]
    paint = colours.paint(in_view @ view.view_from_world, outside, legend)
    light = light_up(relief)[rows, columns]
    if legend is not None:
        light = _EVEN + (1 - _EVEN) * light
    samples = np.full((*relief.depth.shape, 3), _BACKGROUND, np.float32)
    samples[rows, columns] = np.clip(paint * light[:, None], 0, 1)
    picture = cv2.resize(samples, window.size, interpolation=cv2.INTER_AREA)
    return np.rint(picture * 255).astype(np.uint8)
