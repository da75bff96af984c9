"""A bar keel and two bilge keels."""

import numpy as np

from ...types.arrays import Points, Scalars
from ...types.mesh import Mesh
from .hull_form import HullForm
from .solids import rectangle_outline, sweep_section

_CELL = 1.5e-3
"""Side of a triangle [m]."""
_KEEL_STATIONS, _KEEL_WIDTH, _KEEL_HEIGHT = (-0.80, 0.72), 0.008, 0.011
_BILGE_STATIONS, _BILGE_WIDTH, _BILGE_HEIGHT = (-0.42, 0.42), 0.003, 0.013
_BILGE_SHARE = 0.68
"""Depth share of the bilge keels: where the bottom turns up into the side."""
_SUNK = 0.008
"""How far each is sunk into the shell [m]."""
_RUN_OUT = 0.06
"""Length over which each rises at its ends [m]."""


def bar_keel(form: HullForm) -> Mesh:
    """Make the bar below the keel line."""
    stations = _stations(form, _KEEL_STATIONS)
    root = form.points(stations, np.ones(len(stations)))
    outwards = np.tile([0.0, 0.0, -1.0], (len(stations), 1))
    return _fin(form, root, outwards, width=_KEEL_WIDTH, height=_KEEL_HEIGHT)


def bilge_keel(form: HullForm, side: float) -> Mesh:
    """Make the fin along one bilge, at a right angle to the shell.

    Args:
        form: The lines.
        side: 1 for starboard, - 1 for port.
    """
    stations = _stations(form, _BILGE_STATIONS)
    shares = np.full(len(stations), _BILGE_SHARE)
    to_side = np.array([side, 1.0, 1.0])
    root, outwards = (
        form.points(stations, shares) * to_side,
        form.normals(stations, shares) * to_side,
    )
    outwards[:, 1] = 0.0
    outwards /= np.linalg.norm(outwards, axis=1, keepdims=True)
    return _fin(form, root, outwards, width=_BILGE_WIDTH, height=_BILGE_HEIGHT)


def _stations(form: HullForm, ends: tuple[float, float]) -> Scalars:
    length = (ends[1] - ends[0]) * form.length / 2
    return np.linspace(*ends, round(length / (_CELL * form.unit)) + 1)


def _fin(form: HullForm, root: Points, outwards: Points, *, width: float, height: float) -> Mesh:
    """Make a bar of rectangular section along a line [m]; it rises out of the shell at its ends."""
    along = (root[:, 1] - root[0, 1]) / (_RUN_OUT * form.unit)
    rise = np.sin(np.clip(np.minimum(along, along[-1] - along), 0, 1) * (np.pi / 2))
    top = (height + _SUNK / 2) * rise - _SUNK / 2
    outline = rectangle_outline(width, 0.0, height + _SUNK, _CELL)
    sections = np.tile(outline, (len(root), 1, 1))
    sections[..., 1] *= ((top + _SUNK) / (height + _SUNK))[:, None]
    sections[..., 1] -= _SUNK
    across = np.cross(outwards, [0.0, 1.0, 0.0])
    return sweep_section(form.unit * sections, root, across, outwards)
