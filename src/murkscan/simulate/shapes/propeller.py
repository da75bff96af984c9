"""A propeller of four blades on its boss, and the shaft that carries it."""

import numpy as np
from jaxtyping import Float

from ...types.arrays import Scalars
from ...types.mesh import Mesh
from .hull_form import HullForm
from .solids import close_tube, join_meshes, turn_profile

Grid = Float[np.ndarray, "rings points"]

_NUM_BLADES = 4
_RADIUS, _BOSS, _SHAFT = 0.044, 0.0105, 0.006
"""Radii of the disc, of the boss and of the shaft [m]."""
_PITCH = 1.4
"""Way forward in one turn, in diameters."""
_CHORD, _THICKNESS = 0.032, 0.004
"""Largest breadth of a blade, and its thickness at the boss [m]."""
_SKEW = 0.45
"""How far the tip lags behind the root around the shaft [rad]."""
_BEHIND, _BELOW = 0.034, 0.052
"""Where the middle of the boss lies: behind the stern, and below the waterline [m]."""
_FIRST_BLADE = np.radians(20)
"""Angle of the first blade from athwartships [rad]: so that all four are seen from below."""
_CELL = 1.2e-3
"""Side of a triangle [m]."""


def propeller(form: HullForm) -> Mesh:
    """Make propeller and shaft behind the stern; the shaft comes out of the hull.

    Each blade lies on a helix of one pitch and has a lens as its section.
    """
    blades = [_blade(_FIRST_BLADE + i * 2 * np.pi / _NUM_BLADES) for i in range(_NUM_BLADES)]
    whole = join_meshes([_boss_and_shaft(), *blades])
    # z of the propeller points forward along the shaft (+ y of the hull), its y to the camera.
    hull_from_propeller = np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
    place = np.array([0.0, -form.length / 2 - _BEHIND * form.unit, -_BELOW * form.unit])
    return Mesh(form.unit * whole.vertices @ hull_from_propeller.T + place, whole.faces)


def _boss_and_shaft() -> Mesh:
    """Make a cap, the boss, the shaft, and its bearing that widens into the stern."""
    cap = np.linspace(0.05, 1, 10) * (np.pi / 2)
    aft = np.stack([_BOSS * np.sin(cap), -0.012 - 0.016 * np.cos(cap)], axis=1)
    boss = [(0.0095, 0.013), (_SHAFT, 0.013)]
    bearing = [(_SHAFT, 0.022), (0.0095, 0.022), (0.0095, 0.070), (0.0005, 0.130)]
    return turn_profile(np.concatenate([aft, boss, bearing]), step=_CELL)


def _blade(angle: float) -> Mesh:
    """Make one blade about z; its root is in the boss."""
    start = 0.7 * _BOSS / _RADIUS
    # Closer together at the tip, which is round.
    rounds = np.linspace(0, np.pi / 2, round(_RADIUS / _CELL))
    radius = _RADIUS * (start + (1 - start) * np.sin(rounds))[:, None]
    share = (radius / _RADIUS - start) / (1 - start)
    u, v = _lens()
    chord, thickness = _CHORD * _breadth(share) * u, _THICKNESS * (1 - 0.6 * share) * v
    pitch = np.arctan(_PITCH * 2 * _RADIUS / (2 * np.pi * radius))
    around = chord * np.cos(pitch) - thickness * np.sin(pitch)
    along = chord * np.sin(pitch) + thickness * np.cos(pitch)
    turn = angle - _SKEW * share**2 + around / radius
    return close_tube(np.stack([radius * np.cos(turn), radius * np.sin(turn), along], axis=-1))


def _lens() -> tuple[Scalars, Scalars]:
    """Give a section's outline: along it from - 1/2 to 1/2, across it at most 1/2 from 0."""
    u = np.linspace(-0.5, 0.5, round(_CHORD / _CELL) + 1)
    v = 0.5 * (1 - 3.6 * u * u)
    return np.concatenate([u, u[::-1]]), np.concatenate([-v, v[::-1]])


def _breadth(share: Grid) -> Grid:
    """Give a blade's breadth as a share of the largest, from its root (0) to its round tip (1)."""
    return (0.70 + 0.75 * share - 0.45 * share**2) * np.sqrt(1 - 0.96 * share**5)
