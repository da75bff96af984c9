"""The pictures that every scan gets."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

from ..types.arrays import ColourImage
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from ..types.trajectory import Trajectory
from .base import AbstractColours
from .depth import Depth
from .plain import Plain
from .render import fit_and_draw
from .subject import Subject
from .views import View, standard_views

PICTURES = {
    "isometric": "aslant from above",
    "isometric-depth": "aslant from above, coloured by the distance from the camera",
    "front": "from the front, as the camera sees it",
    "front-depth": "from the front, coloured by the distance from the camera",
    "back": "from behind",
    "left": "from the left",
    "right": "from the right",
    "top": "from above",
    "bottom": "from below",
}
"""Names of the pictures, in the order to show them, and what stands under each."""
_THREADS = 2
"""Pictures that are drawn at once; each takes 0.2 GB while it is."""


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
    jobs = list(_pictures(trajectory))
    subject = Subject.of(surface)
    # Letters are written here, since their library is made for one thread.
    with ThreadPoolExecutor(_THREADS) as pool:
        drawings = pool.map(lambda job: fit_and_draw(subject, job[1], job[2], size), jobs)
        for (name, _, _), drawing in zip(jobs, drawings, strict=True):
            yield name, drawing.write()


def _pictures(trajectory: Trajectory | None) -> Iterator[tuple[str, View, AbstractColours]]:
    """Name each picture, and say from where and in which colours it is drawn."""
    views = standard_views(trajectory)
    front = next(view for view in views if view.name == "front")
    x, y, z = (float(part) for part in front.view_from_world[2])
    for view in views:
        yield view.name, view, Plain()
        if view.name in ("isometric", "front"):
            yield f"{view.name}-depth", view, Depth((x, y, z), front.start)
