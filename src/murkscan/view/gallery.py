"""The pictures that every scan gets."""

from collections.abc import Iterator

from ..types.arrays import ColourImage
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from ..types.trajectory import Trajectory
from .depth import Depth
from .render import render
from .views import standard_views

PICTURES = (
    *("isometric", "isometric-depth", "front", "front-depth"),
    *("back", "left", "right", "top", "bottom"),
)
"""Names of the pictures, in the order to show them."""


def draw_pictures(
    surface: Mesh | PointCloud,
    trajectory: Trajectory | None = None,
    *,
    size: tuple[int, int] = (1280, 960),
) -> Iterator[tuple[str, ColourImage]]:
    """Draw the isometric view and the six standard ones, plain; the first two also by depth.

    Args:
        surface: What to draw, in the world frame [m].
        trajectory: How the camera went through the world; None: the world has the camera's axes.
        size: Width and height of each picture [px].

    Yields:
        Name and picture, each when it is drawn, in the order of `PICTURES`.

    Raises:
        NotEnoughData: There is nothing to draw.
    """
    views = standard_views(trajectory)
    front = next(view for view in views if view.name == "front")
    x, y, z = (float(part) for part in front.view_from_world[2])
    for view in views:
        yield view.name, render(surface, view, size=size)
        if view.name in ("isometric", "front"):
            by_depth = render(surface, view, colours=Depth((x, y, z), front.start), size=size)
            yield f"{view.name}-depth", by_depth
