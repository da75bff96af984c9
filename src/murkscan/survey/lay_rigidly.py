"""Lay passes over one object on one another as rigid bodies, where they overlap."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..errors import Degenerate, NotEnoughData
from ..geometry.alignment import Alignment, align_clouds
from ..geometry.surface_points import nearest_in_cloud
from ..optics.merged_errors import MergedErrors, Moves
from ..project.passes import NumberedPass
from ..types.arrays import Indices, Mask
from ..types.cloud import PointCloud
from ..types.pose import Pose
from .progress import Progress


@dataclass(frozen=True, eq=False)
class Laid:
    """How a pass was laid on others; the first one stays."""

    alignment: Alignment | None = None
    shares: Sequence[float] = ()
    """Which share of its matches lies in each of the passes."""
    answers: Moves | None = None

    @property
    def pose(self) -> Pose:
        """Where it is laid."""
        return Pose.identity() if self.alignment is None else self.alignment.target_from_source


STAYS = Laid()


@dataclass(frozen=True, eq=False)
class _Placed:
    """What is in place, and what is known of its errors."""

    cloud: PointCloud
    """A sample of its points, by the merged cloud's count."""
    owner: Indices
    """Number of the pass of each."""
    errors: MergedErrors
    laid: Mapping[int, Laid]
    """How each of the passes was laid."""

    @cached_property
    def facing(self) -> Mask:
        """Which of its points turn neither from their camera nor from their light."""
        return self.errors.is_facing(self.owner, self.cloud)

    @classmethod
    def begin(cls, passes: Sequence[NumberedPass]) -> "_Placed":
        """Leave the first pass where it is."""
        cloud = passes[0].sample()
        errors = MergedErrors.of_passes([one.see(Pose.identity()) for one in passes])
        return cls(cloud, np.zeros(len(cloud), np.int64), errors, {0: STAYS})

    def add(self, number: int, one: NumberedPass, alignment: Alignment) -> "_Placed":
        """Lay a pass, and trace how its place follows the errors of both sides."""
        pose = alignment.target_from_source
        source, errors = one.sample().carry(pose), self.errors.place(number, one.see(pose))
        ours, theirs = (
            nearest_in_cloud(cloud, alignment.pairs.points) for cloud in (source, self.cloud)
        )
        owner, mine = self.owner[theirs], np.full(len(ours), number)
        apart = errors.shifts(mine, source[ours]) - errors.shifts(owner, self.cloud[theirs])
        errors = errors.lay(number, alignment.centre, alignment.covariance, alignment.answer(apart))
        answer = errors.answers[number]
        assert answer is not None
        shares = np.bincount(owner) / len(owner)
        return _Placed(
            PointCloud.concatenate([self.cloud, source]),
            np.append(self.owner, np.full(len(source), number)),
            errors,
            {**self.laid, number: Laid(alignment, shares.tolist(), answer.moves)},
        )


def lay_rigidly(
    passes: Sequence[NumberedPass],
    begin: Sequence[Pose],
    reach: float | None,
    progress: Progress,
) -> Mapping[int, Laid]:
    """Lay each pass on what is in place; one that does not overlap yet waits for others.

    Args:
        passes: Their points.
        begin: Where each lies in the world of the first, about.
        reach: Distance up to which surfaces are looked for in each other's place [m].
        progress: Told how many are in place.

    Returns:
        How each was laid, by its number, in the order in which they were.

    Raises:
        NotEnoughData: A pass is no surface, or far larger or smaller than the others.
        Degenerate: A pass overlaps none of the others.
    """
    placed, waiting = _Placed.begin(passes), list(range(1, len(passes)))
    progress("align", 1, len(passes))
    while waiting:
        refusal: Degenerate | None = None
        for number in waiting:
            try:
                alignment = _align(passes[number], number, placed, begin[number], reach)
            except Degenerate as error:
                refusal = error
                continue
            placed = placed.add(number, passes[number], alignment)
            waiting.remove(number)
            progress("align", len(placed.laid), len(passes))
            break
        else:
            left = passes[waiting[-1]]
            raise Degenerate(
                f"{left.source.path}: {refusal} {_compare_sizes(left, placed)} (A file that is not "
                "in metres needs its --unit.)"
            ) from refusal
    return placed.laid


def _align(
    one: NumberedPass, number: int, placed: _Placed, start: Pose, reach: float | None
) -> Alignment:
    """Lay a pass on others by what faced the cameras, if that tells all: flanks are seen wrong."""
    source = one.sample()
    facing = placed.errors.is_facing(np.full(len(source), number), source)
    try:
        with suppress(Degenerate, NotEnoughData):
            target = placed.cloud[placed.facing]
            found = align_clouds(source[facing], target, reach=reach, start=start)
            if not found.open_directions:
                return found
        return align_clouds(source, placed.cloud, reach=reach, start=start)
    except NotEnoughData as error:
        raise NotEnoughData(
            f"{one.source.path} cannot be laid on the passes before it. "
            f"{_compare_sizes(one, placed)} Give clouds of surfaces in metres, or their unit with "
            f"--unit. ({error})"
        ) from error


def _compare_sizes(one: NumberedPass, placed: _Placed) -> str:
    ours, theirs = (
        float(np.linalg.norm(np.ptp(cloud.points, axis=0)))
        for cloud in (one.sample(), placed.cloud)
    )
    return f"It measures {ours:.3g} m, and those before it {theirs:.3g} m."
