"""The bare hull as one closed surface, with a place pushed in for its through-hull."""

import math

import numpy as np
from jaxtyping import Float

from ...types.mesh import Mesh
from .hull_form import HullForm
from .solids import Rings, grid_faces
from .through_hull import ThroughHull

Stations = Float[np.ndarray, "stations"]
Shares = Float[np.ndarray, "shares"]

_NUM_TRIANGLES = 260_000
"""Triangles of the shell."""
_CELL = 2.5e-3
"""Largest side of a cell on a model that is 0.28 m broad [m]: two cells lie hidden in the flange of
the through-hull."""
_DECK_CELLS = 12


def hull_body(form: HullForm, through_hull: ThroughHull) -> Mesh:
    """Make the shell and the deck, which lies in the waterline.

    Args:
        form: The lines.
        through_hull: The fitting whose bore goes through the starboard shell.

    Returns:
        A closed surface. Its shell lies on the lines, but for the vertices behind the fitting.
    """
    stations, shares = _grid(form)
    shell = form.points(np.repeat(stations, len(shares)), np.tile(shares, len(stations)))
    starboard = shell.reshape(len(stations), len(shares), 3)
    port = starboard[:, -2::-1] * [-1.0, 1.0, 1.0]
    across = np.linspace(-1, 1, _DECK_CELLS, endpoint=False)[1:]
    deck = starboard[:, :1] * np.stack([across, *np.ones((2, len(across)))], axis=1)
    starboard = through_hull.push_in(shell).reshape(starboard.shape)
    rings = np.concatenate([starboard, port, deck], axis=1)
    return _weld(rings, len(shares))


def _grid(form: HullForm) -> tuple[Stations, Shares]:
    """Choose stations, and depth shares that are evenly spaced around the midship section."""
    fine = np.linspace(0, 1, 2001)
    girth = np.linalg.norm(np.diff(form.points(np.zeros(2001), fine), axis=0), axis=1).cumsum()
    cell = min(math.sqrt(4 * form.length * girth[-1] / _NUM_TRIANGLES), _CELL * form.unit)
    stations = np.linspace(-1, 1, round(form.length / cell) + 1)
    spaced = np.linspace(0, girth[-1], round(girth[-1] / cell) + 1)
    return stations, np.interp(spaced, np.append(0, girth), fine)


def _weld(rings: Rings, waterline_to_keel: int) -> Mesh:
    """Join rings around the hull; those at the stem and at the stern have no breadth.

    There each vertex of port is its mirror image of starboard, and the deck is one vertex.
    """
    count, around = rings.shape[:2]
    number = np.arange(count * around).reshape(count, around)
    starboard = np.zeros(around, int)
    starboard[:waterline_to_keel] = np.arange(waterline_to_keel)
    port = slice(waterline_to_keel, 2 * waterline_to_keel - 1)
    starboard[port] = starboard[waterline_to_keel - 2 :: -1]
    number[[0, -1]] = number[[0, -1]][:, starboard]
    faces = grid_faces(np.append(number, number[:, :1], axis=1))
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    return Mesh(rings.reshape(-1, 3), faces).compact()
