"""What an adjustment takes for granted, each number with its reason."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class AdjustSettings:
    """Settings of `adjust_passes`."""

    knot_step: float = 0.1
    """Length of a spline's piece [s]: at 0.2 s pieces leave 0.2 mm and 0.03° (RMS) of how the real
    vehicles of `docs/benchmarks/trajectory.md` move, and ties of some hundredths of a millimetre
    then bend the way by millimetres where they cannot tell; at 0.1 s 0.01 mm and 0.002°."""
    speed_wander: float = 0.2
    """How a speed that is only about known wanders, as a share of it, and velocity across it."""
    attitude_wander: float = np.deg2rad(3.0)
    """How an attitude that no instrument measured wanders [rad]."""
    wander_time: float = 2.5
    """Time over which either goes together with itself [s]: waves and a pilot's hand."""
    cell: float = 5e-3
    """Size of a facet [m]: below it is noise, above it marine growth is no plane."""
    tile: tuple[float, float] = (0.06, 0.15)
    """Size of a tile that is looked for in another sheet, along and across the way [m]: short
    along, since an uneven speed stretches it; wide enough for a score of bumps."""
    reach: float = 0.2
    """How far from its place by the log a tile is looked for at most [m], where the log is so
    uncertain: farther away more and more tiles look alike."""
    adrift: float = 0.2
    """Standard deviation of the place where a registered pass begins, if no instrument measured it
    [m]: as far as tiles are looked for."""
    rounds: int = 5
    """How often tiles are looked for, at most: each time they are less stretched."""
    cycles: int = 5
    """How often tiles are looked for anew after facets have been paired, at most: what lies right
    shows where its neighbours belong."""
    fine_rounds: int = 6
    """How often facets are paired, at most: from 8 mm apart down to 1 mm, and twice more."""
    inner_rounds: int = 5
    """How often facets are paired within passes before passes are looked for in one another."""
    ties: int = 10_000
    """Pairs of facets between two legs, at most: more add little and cost time."""
