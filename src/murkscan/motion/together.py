"""Several passes over one object, corrected together by what they saw of the same places."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from ..types.arrays import Vector
from ..types.laser import Axis
from ..types.measured import Measured
from ..types.pose import Pose
from ..types.profile import Profile
from ..types.trajectory import Trajectory
from .adjust import Adjusted, Pass, adjust_passes
from .adjust.passes import make_pass
from .adjust.sureness import judge_directions
from .corrected import FEWEST as FEWEST
from .corrected import Correction, judge_instruments


@dataclass(frozen=True, eq=False)
class LaidPass:
    """A scan that registration has laid on others as a rigid body."""

    measured: Measured
    profiles: Iterable[Profile]
    """In order of frames."""
    axes: Sequence[Axis]
    """The camera axis along which each laser sits."""
    trajectory: Trajectory
    """world_from_camera at the times of its frames, in its own world."""
    first_from_own: Pose
    """Where registration has laid its world in that of the first pass."""
    start: float = 0.0
    """What its log's clock shows when its recording's time is 0 [s]."""


def correct_together(
    laid: Sequence[LaidPass], *, tell: Callable[[str], None] = lambda words: None
) -> tuple[Correction, ...] | None:
    """Correct the ways of several passes; None where they saw no place twice.

    Error k of one pass comes together with error k of every other: all are of one adjustment.

    Args:
        laid: The passes, at least one; the result lies in the world of the first.
        tell: Is told what is being done.

    Raises:
        InputError: A pass has fewer than two profiles.
    """
    base = _find_base(laid)
    logs = _number_instruments(laid)
    passes = [_prepare(one, base, log) for one, log in zip(laid, logs, strict=True)]
    adjusted = adjust_passes(passes, tell=tell)
    if not any(map(len, adjusted.groups)):
        return None
    home = _find_home(laid[0], base, adjusted, passes[0])
    return tuple(
        _correction_of(number, laid, passes[number], adjusted, home) for number in range(len(laid))
    )


@dataclass(frozen=True, eq=False)
class _Base:
    """The world in which passes are adjusted: that of a log, whose z is vertical, if there is."""

    base_from_first: Pose
    origin: Vector
    """Where the base's measured places count from, in the log's own world [m]."""


def _find_base(laid: Sequence[LaidPass]) -> _Base:
    """Choose the world of the first pass that a log places, and count it from near the scan."""
    holder = next((one for one in laid if one.measured.is_placed), laid[0])
    origin = holder.measured.origin
    return _Base(Pose(np.eye(3), -origin) @ holder.first_from_own.inverse(), origin)


def _number_instruments(laid: Sequence[LaidPass]) -> list[int]:
    """Number the logs: passes of the same one share the errors of its instruments."""
    numbers: list[int] = []
    for this, one in enumerate(laid):
        same = (n for n in range(this) if _is_same_log(laid[n].measured, one.measured))
        numbers.append(next((numbers[n] for n in same), this))
    return numbers


def _is_same_log(one: Measured, other: Measured) -> bool:
    pairs = [
        (getattr(one.navigation, name), getattr(other.navigation, name))
        for name in ("attitude", "velocity", "rates", "position")
    ]
    known = [pair for pair in pairs if pair != (None, None)]
    return bool(known) and all(
        a is not None and b is not None and np.array_equal(a.values, b.values) for a, b in known
    )


def _prepare(one: LaidPass, base: _Base, log: int) -> Pass:
    """Take a pass for the adjustment: in the base's world, by the clock of its log."""
    measured, mount = one.measured, one.measured.vehicle_from_camera
    way = one.trajectory.carry(base.base_from_first @ one.first_from_own)
    way = replace(way, errors=None).follow_mount(mount.inverse())
    aside = measured.origin - base.origin
    navigation = measured.navigation.moved(seconds=one.start, shift=aside)
    navigation = replace(navigation, instruments=log)
    made = make_pass(one.profiles, way.times, one.axes, mount, navigation)
    late = way.times + one.start
    return replace(made, times=late, start=replace(way, times=late))


@dataclass(frozen=True, eq=False)
class _Home:
    """From the world of the adjustment to that of the first pass, which may begin with it."""

    first_from_base: Pose
    centre: Vector
    """In the base [m]."""
    errors: Float[np.ndarray, "6 m"]
    """Of the first pose, about the centre: a world that begins there does not have them."""

    def bring(self, way: Trajectory) -> Trajectory:
        """Carry a way to the world of the first pass."""
        assert way.errors is not None
        shift, turn = self.errors[:3], self.errors[3:]
        arms = (way.positions - self.centre)[:, :, None]
        moves = way.errors[:, :3] - shift - np.cross(turn[None], arms, axis=1)
        errors = np.concatenate([moves, way.errors[:, 3:] - turn], axis=1)
        return replace(way, errors=errors).carry(self.first_from_base)


def _find_home(first: LaidPass, base: _Base, adjusted: Adjusted, own: Pass) -> _Home:
    """Find the way back to the world of the first pass: its log's, or its camera's first frame."""
    count = adjusted.errors.shape[1]
    if first.measured.is_placed:
        return _Home(base.base_from_first.inverse(), np.zeros(3), np.zeros((6, count)))
    way = adjusted.trajectory(0, own.times[:2]).follow_mount(first.measured.vehicle_from_camera)
    assert way.errors is not None
    begin = Pose.from_quaternion(way.quaternions[:1], way.positions[0])
    return _Home(begin.inverse(), way.positions[0], way.errors[0])


def _correction_of(
    number: int, laid: Sequence[LaidPass], one: Pass, adjusted: Adjusted, home: _Home
) -> Correction:
    """Tell how one of the passes was corrected, beside where registration had laid it."""
    mine = laid[number]
    mount, times = mine.measured.vehicle_from_camera, mine.trajectory.times
    ways = adjusted.trajectory(number, one.times), adjusted.trajectory_as_logged(number, one.times)
    found, logged = (replace(way.follow_mount(mount), times=times) for way in ways)
    there = home.bring(found)
    rigid = mine.first_from_own @ mine.trajectory.positions
    return Correction(
        there,
        np.linalg.norm(there.positions - rigid, axis=1),
        tuple(judge_directions(logged, found, found.line_of_sight())),
        judge_instruments(adjusted, number),
        adjusted.tiles_of(number),
        adjusted.blind,
        adjusted.seams,
        adjusted.astray[number],
    )
