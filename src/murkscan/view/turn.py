"""The model turned once round: pictures for a film."""

import math
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from scipy.spatial.transform import Rotation

from ..types.arrays import ColourImage
from ..types.cloud import PointCloud
from ..types.mesh import Mesh
from ..types.trajectory import Trajectory
from .plain import Plain
from .render import draw
from .subject import Subject
from .views import View, front_view
from .window import Window

TURN = 144
"""Pictures of one turn: six seconds at 24 a second."""
_ABOVE = math.radians(15)
"""How far from above the viewer looks [rad]."""
_THREADS = 2


def draw_turn(
    surface: Mesh | PointCloud,
    trajectory: Trajectory | None = None,
    *,
    pictures: int = TURN,
    size: tuple[int, int] = (1280, 720),
) -> Iterator[ColourImage]:
    """Draw a surface from all around, in one scale, beginning as the camera saw it.

    Args:
        surface: What to draw, in the world frame [m].
        trajectory: How the camera went through the world; None: the world has the camera's axes.
        pictures: Of the whole turn.
        size: Width and height of each [px].

    Yields:
        The pictures in order, without any writing; a few are held in memory at a time.

    Raises:
        NotEnoughData: There is nothing to draw.
        InputError: A point is not finite, or the picture is below 64 x 64 pixels.
    """
    subject = Subject.of(surface)
    front = front_view(trajectory)
    views = [_turn(front, 2 * math.pi * number / pictures) for number in range(pictures)]
    windows = _windows(subject, front, views, size)
    jobs = list(zip(views, windows, strict=True))
    with ThreadPoolExecutor(_THREADS) as pool:
        for start in range(0, len(jobs), 2 * _THREADS):
            some = jobs[start : start + 2 * _THREADS]
            for drawing in pool.map(lambda job: draw(subject, job[0], Plain(), job[1], None), some):
                yield drawing.image


def _turn(front: View, angle: float) -> View:
    """Go round the object, and look at it a little from above."""
    turned = Rotation.from_euler("y", angle) if angle else Rotation.identity()
    tilted = Rotation.from_euler("x", _ABOVE)
    return View("turn", (tilted * turned).as_matrix() @ front.view_from_world, front.eye)


def _windows(
    subject: Subject, front: View, views: list[View], size: tuple[int, int]
) -> list[Window]:
    """Keep the object's middle in the picture's, in a scale at which no side is cut off."""
    points = subject.points @ front.view_from_world.T
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    x, y, z = np.abs(points - middle).max(axis=0)
    across, up = math.hypot(x, z), y * math.cos(_ABOVE) + math.hypot(x, z) * math.sin(_ABOVE)
    whole = Window.around(np.array([[-across, -up, 0.0], [across, up, 0.0]]), size, with_bar=False)
    in_world = middle @ front.view_from_world
    return [whole.centred_on(view.view_from_world @ in_world) for view in views]
