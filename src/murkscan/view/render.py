"""Draw a surface or a cloud."""

from dataclasses import dataclass

import numpy as np

from .._kernels.rasterise import average_samples, place_samples
from ..types.arrays import ColourImage, Points
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from .base import AbstractColours, Legend
from .light import light_up
from .plain import Plain
from .subject import Subject
from .views import View
from .window import SAMPLES, Relief, Window
from .writing import write_on

_BACKGROUND = 0.985
_EVEN = np.float32(0.5)
"""Share of the light that falls evenly where colours have to be read off a scale."""


@dataclass(frozen=True, eq=False)
class Drawing:
    """A picture before anything is written on it."""

    image: ColourImage
    view: View
    window: Window
    legend: Legend | None

    def write(self) -> ColourImage:
        """Write the view's name, the scales and the axes on it."""
        return write_on(self.image, self.view, self.window, self.legend)


def render(
    surface: Mesh | PointCloud,
    view: View,
    *,
    colours: AbstractColours | None = None,
    size: tuple[int, int] = (1280, 960),
    like: Mesh | PointCloud | None = None,
) -> ColourImage:
    """Draw a surface, without perspective, with a scale bar and, for its colours, a colour bar.

    The light comes from the upper left and hollows are darker; edges are smoothed by four samples a
    pixel. The same input gives the same picture. A cloud is drawn as one small disc a point.

    Args:
        surface: What to draw, in the world frame [m].
        view: From where.
        colours: How to colour it; None: plain.
        size: Width and height of the picture [px].
        like: Another surface, whose place, scale and range of colours the picture shall have, so
            that two can be compared; what lies outside is cut off.

    Raises:
        NotEnoughData: There is nothing to draw.
        InputError: A point is not finite, or the picture is below 64 x 64 pixels.
    """
    shown = None if like is None else Subject.of(like).points
    return fit_and_draw(Subject.of(surface), view, colours or Plain(), size, shown).write()


def fit_and_draw(
    subject: Subject,
    view: View,
    colours: AbstractColours,
    size: tuple[int, int],
    shown: Points | None = None,
) -> Drawing:
    """Draw what is seen from one side, as large as the picture allows with all points shown."""
    shown = subject.points if shown is None else shown
    legend = colours.legend(shown)
    window = Window.around(shown @ view.view_from_world.T, size, with_bar=legend is not None)
    return draw(subject, view, colours, window, legend)


def draw(
    subject: Subject, view: View, colours: AbstractColours, window: Window, legend: Legend | None
) -> Drawing:
    """Draw what is seen in a window; several threads may do so at once."""
    points = subject.points @ view.view_from_world.T
    relief = subject.look(view, window.as_samples(points), window)
    return Drawing(_develop(relief, view, window, colours, legend), view, window, legend)


def _develop(
    relief: Relief, view: View, window: Window, colours: AbstractColours, legend: Legend | None
) -> ColourImage:
    """Light and colour the samples, and make pixels of them."""
    points = np.empty((len(relief.seen), 3))
    place_samples(relief.seen, relief.depth, _world_from_samples(relief, view, window), points)
    paint = colours.paint(points, relief.outside, legend).astype(np.float32, copy=False)
    light = light_up(relief)
    if legend is not None:
        light = _EVEN + (1 - _EVEN) * light
    picture = np.empty((window.size[1], window.size[0], 3), np.uint8)
    average_samples(relief.seen, paint, light, _BACKGROUND, SAMPLES, picture)
    return picture


def _world_from_samples(relief: Relief, view: View, window: Window) -> np.ndarray:
    """Give the affine map from column, row and the relief's depth to the world, 3 x 4."""
    world_from_view = view.view_from_world.T / window.scale
    start = np.array([-window.centre[0], -window.centre[1], relief.start])
    return np.column_stack([world_from_view, world_from_view @ start])
