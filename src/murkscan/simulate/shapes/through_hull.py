"""A fitting through the shell: a flange with sharp edges, a bore, and a grating across it."""

from dataclasses import dataclass

import numpy as np

from ...types.arrays import Points
from ...types.mesh import Mesh
from ...types.pose import Pose
from .hull_form import HullForm
from .solids import join_meshes, rectangle_outline, refine_line, sweep_section, turn_profile

_STATION, _SHARE = 0.30, 0.85
"""Where it sits: before amidships, between keel and bilge keel."""
_FLANGE, _BORE, _TUBE = 0.024, 0.0155, 0.018
"""Radii of the flange, of the bore and of the tube that goes on inside [m]."""
_HEIGHT, _SUNK, _FLOOR, _END = 0.005, 0.003, 0.012, 0.014
"""How far the flange stands out, how far it is sunk into the shell, and how far behind the shell
the bore and its tube end [m]."""
_NUM_BARS, _BAR, _BEHIND = 3, 0.0024, 0.0015
"""Bars of the grating, their width, and how far their faces lie behind that of the flange [m]."""
_PUSHED, _DEPTH = 0.01975, 0.020
"""Radius within which the shell is pushed in, and how deep [m]. The slope that this leaves, two
cells wide, is hidden in the flange, and what is pushed in lies behind the bore."""
_CELL = 1.5e-3
"""Side of a triangle [m]."""


@dataclass(frozen=True, eq=False)
class ThroughHull:
    """A round fitting on the starboard shell. In its own frame z points outwards."""

    hull_from_fitting: Pose
    """Where it sits."""
    unit: float
    """Its size as a multiple of the one on a model that is 0.28 m broad."""

    @classmethod
    def on_starboard(cls, form: HullForm) -> "ThroughHull":
        """Place it on the shell, at a right angle to it."""
        station, share = np.array([_STATION]), np.array([_SHARE])
        outwards = form.normals(station, share)[0]
        across = np.cross([0.0, 1.0, 0.0], outwards)
        across /= np.linalg.norm(across)
        axes = np.stack([across, np.cross(outwards, across), outwards], axis=1)
        return cls(Pose(axes, form.points(station, share)[0]), form.unit)

    def mesh(self) -> Mesh:
        """Make the fitting: flange and tube in one, and the bars."""
        profile = [
            (_TUBE, -_END), (_TUBE, -_SUNK), (_FLANGE, -_SUNK), (_FLANGE, _HEIGHT),
            (_BORE, _HEIGHT), (_BORE, -_FLOOR),
        ]  # fmt: skip
        parts = [turn_profile(np.array(profile), step=_CELL), *(_bar(i) for i in range(_NUM_BARS))]
        fitting = join_meshes(parts)
        return Mesh(self.hull_from_fitting @ (fitting.vertices * self.unit), fitting.faces)

    def push_in(self, shell: Points) -> Points:
        """Make room for the bore: move what lies behind it inwards.

        Args:
            shell: Points of the starboard shell [m].
        """
        points = self.hull_from_fitting.inverse() @ shell / self.unit
        near = np.abs(points[:, 2]) < _FLANGE
        behind = near & (np.hypot(points[:, 0], points[:, 1]) < _PUSHED)
        inwards = self.hull_from_fitting.rotation[:, 2] * (_DEPTH * self.unit)
        return shell - behind[:, None] * inwards


def _bar(index: int) -> Mesh:
    """Make a bar of the grating along y; its ends are in the flange."""
    half = (_BORE + _FLANGE) / 2
    y = refine_line(np.array([[-half, 0.0], [half, 0.0]]), _CELL)[:, 0]
    middles = np.zeros((len(y), 3))
    middles[:, 0] = (index - (_NUM_BARS - 1) / 2) * 2 * _BORE / (_NUM_BARS + 1)
    middles[:, 1], middles[:, 2] = y, _HEIGHT - _BEHIND
    section = rectangle_outline(_BAR, -1.5 * _BAR, 0.0, _CELL)
    across, outwards = np.tile([-1.0, 0, 0], (len(y), 1)), np.tile([0, 0, 1.0], (len(y), 1))
    return sweep_section(np.tile(section, (len(y), 1, 1)), middles, across, outwards)
