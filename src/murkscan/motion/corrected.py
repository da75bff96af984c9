"""A motion corrected by what the scan's lasers, or its legs, saw of the same places."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from ..types.arrays import Scalars
from ..types.laser import Axis
from ..types.measured import Measured
from ..types.pose import Pose
from ..types.profile import Profile
from ..types.trajectory import Trajectory
from .adjust import Adjusted, Seams, adjust_passes
from .adjust.passes import make_pass
from .adjust.sureness import Sureness, judge_directions

FEWEST = 20
"""Profiles below which there is nothing to correct: a spline of some pieces."""
_BLIND = 1.5
"""Longest stretch [s] whose relief may lie on something else than its like: three tiles in a row.
Beyond, the way has settled in a wrong place there (`docs/benchmarks/trajectory.md`)."""
_WORSE = 1.2
"""How far passes may lie apart where they overlap, in how far they did before: those that lay on
one another already lie there again but for other pairs of facets and their noise."""


@dataclass(frozen=True, eq=False)
class Correction:
    """How a scan's own surface corrects its log."""

    trajectory: Trajectory
    """world_from_camera, with its errors."""
    moved: Scalars
    """How far each pose was moved [m]."""
    sureness: tuple[Sureness, ...]
    instruments: dict[str, tuple[float, float, float]]
    """Errors of instruments: found, its standard deviation, and the stated one, in m, s and rad."""
    num_tiles: int
    """Pieces of surface that were found twice by their relief."""
    blind: float
    """Longest stretch [s] whose relief does not lie on its like in the end."""
    seams: Seams
    """How far passes lie apart where they overlap, of passes that were corrected together."""
    astray: float
    """Longest stretch [s] in which its relief is not that of another pass that it lies on."""

    @property
    def is_astray(self) -> bool:
        """Whether some of it does not lie where other passes saw the same."""
        return self.astray > _BLIND

    @property
    def is_sound(self) -> bool:
        """Whether it may be believed: it has not settled in a wrong place."""
        return self.blind <= _BLIND and self.seams.after <= _WORSE * self.seams.before


def correct_motion(
    measured: Measured,
    parts: Iterable[Profile],
    logged: Trajectory,
    axes: Sequence[Axis],
    *,
    tell: Callable[[str], None] = lambda words: None,
) -> Correction | None:
    """Correct a scan's trajectory; None where it saw no place twice.

    Args:
        measured: What is known of the motion.
        parts: The profiles, in order of frames.
        logged: world_from_camera as logged, at the times of the frames that have a pose.
        axes: The camera axis along which each laser sits.
        tell: Is told what is being done.
    """
    times, mount = logged.times, measured.vehicle_from_camera
    one = make_pass(parts, times, axes, mount, measured.navigation)
    if len(times) < FEWEST or len(one.points) == 0:
        return None
    adjusted = adjust_passes([one], tell=tell)
    if not any(map(len, adjusted.groups)):
        return None
    ways = adjusted.trajectory(0, times), adjusted.trajectory_as_logged(0, times)
    found, blind = (_as_camera(way, measured) for way in ways)
    if measured.is_placed and measured.navigation.position is None:
        # Where a way begins that is summed up from velocities, no instrument has measured.
        found = replace(found, positions=found.positions + logged.positions[0] - found.positions[0])
    return Correction(
        found,
        np.linalg.norm(found.positions - logged.positions, axis=1),
        tuple(judge_directions(blind, found, found.line_of_sight())),
        judge_instruments(adjusted, 0),
        adjusted.tiles_of(0),
        adjusted.blind,
        adjusted.seams,
        adjusted.astray[0],
    )


def judge_instruments(adjusted: Adjusted, number: int) -> dict[str, tuple[float, float, float]]:
    """Give the errors of a pass's instruments as `Correction.instruments` has them."""
    log = adjusted.logs[number]
    stated = {log.layout.name(place): sigma for place, sigma in log.priors()}
    return {
        name: (value, sigma, stated[name])
        for name, (value, sigma) in adjusted.instrument_errors(number).items()
    }


def _as_camera(way: Trajectory, measured: Measured) -> Trajectory:
    """Give world_from_camera of world_from_vehicle, in the scan's own world."""
    camera = way.follow_mount(measured.vehicle_from_camera)
    if measured.is_placed:
        return replace(camera, positions=camera.positions + measured.origin)
    return _from_first(camera)


def _from_first(way: Trajectory) -> Trajectory:
    """Count a way from its first pose, which then has no error."""
    turn = Rotation.from_quat(way.quaternions[0], scalar_first=True).as_matrix()
    errors, first = way.errors, way.positions[0]
    if errors is not None:
        arms = (way.positions - first)[:, :, None]
        shifts = errors[:, :3] - errors[:1, :3] - np.cross(errors[:1, 3:], arms, axis=1)
        errors = np.concatenate([shifts, errors[:, 3:] - errors[:1, 3:]], axis=1)
    return replace(way, errors=errors).carry(Pose(turn.T, -turn.T @ first))
