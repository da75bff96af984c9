"""How the points of several passes move together with the errors of their rigs and alignments.

A rig's errors move all passes that it saw, each along its own cameras; those of a pass's poses
move that pass alone, or all passes where they were adjusted together. A pass that is laid on others
by their overlap gives way to that: it turns and shifts as a whole, by what the errors of both sides
bring apart there, and by the error of the alignment itself.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import takewhile

import numpy as np
from jaxtyping import Float
from scipy.linalg import block_diag

from ..geometry.stripe_blur import Sight, is_facing
from ..types.arrays import Indices, Mask, Ratios, Vector
from ..types.cloud import PointCloud
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance
from ..types.trajectory import Trajectory
from .seen_points import find_pixels, look_back, shift_points
from .uncertainty import Shifts, error_modes

Moves = Float[np.ndarray, "6 parameters"]
_PART = 20_000
"""Points that are worked on at once: some tens of megabytes."""


@dataclass(frozen=True, eq=False)
class SeenPass:
    """How a pass was seen, in the merged world."""

    rig: Rig
    """Its rig as it moves."""
    trajectory: Trajectory
    """world_from_camera, with the merged cloud's frame numbers for times."""
    key: str
    """The same for passes of one rig, which share its errors."""


@dataclass(frozen=True, eq=False)
class Answer:
    """How a pass moves as a whole with every error."""

    centre: Vector
    """About which it turns [m]."""
    moves: Moves
    """Turn [rad] and shift [m] with each parameter of `MergedErrors.basis`."""


@dataclass(frozen=True, eq=False)
class MergedErrors:
    """The independent errors of a merged cloud, and how its points move with them."""

    passes: Sequence[SeenPass | None]
    """None for a pass of which neither rig nor poses are known."""
    answers: Sequence[Answer | None]
    """One a pass; None for one that stays where it is."""
    is_joint: bool = False
    """Whether the passes' ways were adjusted together: error k of the poses of one is then error k
    of all."""

    @classmethod
    def of_passes(
        cls, passes: Sequence[SeenPass | None], *, is_joint: bool = False
    ) -> "MergedErrors":
        """Begin with passes of which none is laid on another."""
        return cls(passes, [None] * len(passes), is_joint)

    @cached_property
    def basis(self) -> Float[np.ndarray, "parameters modes"]:
        """Change of each parameter with each independent error, at one standard deviation.

        The parameters are those of each rig, in the order of its covariance, the errors of each
        pass's poses, or of all together, and six numbers of each pass's alignment.
        """
        rigs = [error_modes(covariance) for covariance in self._covariances.values()]
        return block_diag(*rigs, np.eye(self._num_pose_errors + self.num_alignments))

    def shifts(self, owner: Indices, cloud: PointCloud) -> Shifts:
        """Compute how far points move with each independent error, in the merged world [m].

        Args:
            owner: Number of the pass of each point.
            cloud: The points, with the merged cloud's frame numbers.
        """
        shifts = np.zeros((len(cloud), 3, self.basis.shape[1]))
        for number in np.unique(owner).tolist():
            mine = owner == number
            shifts[mine] = self._shift_pass(number, cloud[mine])
        return shifts

    def spread(self, owner: Indices, cloud: PointCloud) -> Ratios:
        """Compute the common standard deviation of points, in the direction where it is largest.

        The arguments are those of `shifts`; what comes back is in metres.
        """
        sigma = np.zeros(len(cloud), np.float32)
        for start in range(0, len(cloud), _PART):
            part = slice(start, start + _PART)
            shifts = self.shifts(owner[part], cloud[part])
            largest = np.linalg.eigvalsh(shifts @ shifts.transpose(0, 2, 1))[:, -1]
            sigma[part] = np.sqrt(np.maximum(largest, 0.0))
        return sigma

    def answer_rigs(self, apart: Shifts) -> Shifts:
        """Leave of errors that bring passes apart only those of rigs.

        What the others do is known already where the ways were adjusted together.
        """
        only = apart.copy()
        only[:, :, apart.shape[2] - self._num_pose_errors - self.num_alignments :] = 0.0
        return only

    @property
    def num_alignments(self) -> int:
        """Count the independent errors of the alignments, which are the last ones."""
        return 6 * len(self.passes)

    @property
    def is_stated(self) -> bool:
        """Whether a rig or an alignment says how far it may be off."""
        known = [one for one in self.passes if one is not None]
        seen = any(one.rig.covariance.names or one.trajectory.num_errors for one in known)
        return seen or any(one is not None for one in self.answers)

    def look_back(self, owner: Indices, cloud: PointCloud) -> Sight | None:
        """Find from where each point was seen; None where a pass does not know it.

        The arguments are those of `shifts`.
        """
        columns, ranges = np.zeros((3, len(cloud), 3)), np.zeros(len(cloud))
        widths = np.zeros(len(cloud))
        for number in np.unique(owner).tolist():
            one, mine = self.passes[number], owner == number
            if one is None:
                return None
            some = cloud[mine]
            seen = look_back(some, some.frame.astype(float), one.trajectory, one.rig)
            columns[:, mine], ranges[mine] = (seen.rays, seen.along, seen.light), seen.ranges
            widths[mine] = seen.widths
        rays, along, light = columns
        return Sight(rays, along, light, ranges, cloud.blur_shift.astype(float), widths)

    def is_facing(self, owner: Indices, cloud: PointCloud) -> Mask:
        """Tell which points turn neither from their camera nor from their light; see `is_facing`.

        Of a pass that does not know from where it was seen all count.
        """
        facing = np.ones(len(cloud), bool)
        for number in np.unique(owner).tolist():
            mine = owner == number
            sight = self.look_back(owner[mine], cloud[mine])
            if sight is not None:
                facing[mine] = is_facing(cloud.normals[mine].astype(float), sight)
        return facing

    def place(self, number: int, seen: SeenPass | None) -> "MergedErrors":
        """Say where a pass lies, of which only its own world was known."""
        passes = list(self.passes)
        passes[number] = seen
        return replace(self, passes=passes)

    def lay(
        self,
        number: int,
        centre: Vector,
        covariance: Float[np.ndarray, "6 6"],
        answer: Float[np.ndarray, "6 modes"],
    ) -> "MergedErrors":
        """Add how a pass was laid on those before it.

        Args:
            number: The pass.
            centre: About which it was turned [m].
            covariance: Of its turn [rad] and shift [m].
            answer: Its turn and shift with what each independent error brings apart.
        """
        size, axes = np.linalg.eigh(covariance)
        scale = np.linalg.norm(self.basis, axis=1)[:, None]
        scale = np.where(scale > 0, scale, 1.0)
        moves = answer @ np.linalg.pinv(self.basis / scale) / scale.T
        first = len(self.basis) - 6 * (len(self.passes) - number)
        moves[:, first : first + 6] += axes * np.sqrt(np.maximum(size, 0.0))
        answers = list(self.answers)
        answers[number] = Answer(centre, moves)
        return replace(self, answers=answers)

    def _shift_pass(self, number: int, cloud: PointCloud) -> Shifts:
        one, answer = self.passes[number], self.answers[number]
        shifts = np.zeros((len(cloud), 3, self.basis.shape[1]))
        if one is not None and one.rig.covariance.names:
            times = cloud.frame.astype(float)
            pixels = find_pixels(cloud.points, times, one.trajectory, one.rig)
            own = _complete(shift_points(pixels, cloud.laser, times, one.trajectory, one.rig))
            shifts[:, :, self._modes_of_rig(one.key)] = own
        if one is not None and one.trajectory.num_errors:
            by_poses = one.trajectory.shifts(cloud.points, cloud.frame.astype(float))
            shifts[:, :, self._modes_of_poses(number)] = by_poses
        if answer is not None:
            turns, moves = np.split(answer.moves @ self.basis, 2)
            arms = (cloud.points - answer.centre)[:, None]
            shifts += np.cross(turns.T, arms).transpose(0, 2, 1) + moves
        return shifts

    @property
    def _covariances(self) -> dict[str, RigCovariance]:
        return {one.key: one.rig.covariance for one in self.passes if one is not None}

    def _modes_of_rig(self, key: str) -> slice:
        counts = {name: error_modes(one).shape[1] for name, one in self._covariances.items()}
        first = sum(counts[name] for name in takewhile(lambda name: name != key, counts))
        return slice(first, first + counts[key])

    @property
    def _num_pose_errors(self) -> int:
        counts = [one.trajectory.num_errors for one in self.passes if one is not None]
        return max(counts, default=0) if self.is_joint else sum(counts)

    def _modes_of_poses(self, number: int) -> slice:
        after = [one.trajectory.num_errors for one in self.passes[number:] if one is not None]
        held = self._num_pose_errors if self.is_joint else sum(after)
        first = self.basis.shape[1] - 6 * len(self.passes) - held
        return slice(first, first + after[0])


def _complete(shifts: Shifts) -> Shifts:
    """Let a point that its pixel just misses move as the others do in the mean."""
    seen = np.isfinite(shifts).all(axis=(1, 2))
    mean = shifts[seen].mean(axis=0) if seen.any() else 0.0
    return np.where(seen[:, None, None], shifts, mean)
