"""From profiles to samples on frames and scan lines, some frames at a time."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from ..types.frame_times import FrameTimes
from ..types.laser import Axis
from ..types.profile import Profile
from ..types.trajectory import Trajectory
from .directions import SurfaceDirections
from .spacing import pick_strongest
from .swath import Swath, fill_rows, put_on_grids

_ROWS = 256
"""Frames that are laid out at a time: 20 MB at 1000 scan lines."""
_LEAST_POSTERIOR = 0.5
"""As the cloud has it: less is no surface."""


@dataclass(frozen=True, eq=False)
class SwathLayout:
    """How the points of a scan lie on its frames and scan lines."""

    frames: FrameTimes
    """The frames that were read."""
    trajectory: Trajectory
    """world_from_camera."""
    axis: Axis
    """The camera axis along which the laser sits."""
    size: tuple[int, int]
    """Width and height of the full frame [px]."""
    fields_per_picture: int
    """2 where the recording is interlaced."""
    directions: SurfaceDirections

    @property
    def reach(self) -> float:
        """How far the camera went along the motion [m]."""
        return float(np.ptp(self.trajectory.positions @ self.directions.along))

    @property
    def _step(self) -> int:
        """Rows from a scan line to the next in one frame: of a field, two."""
        return self.fields_per_picture if self.axis == "x" else 1

    def lay_out(self, profiles: Iterable[Profile], *, hole: float) -> Iterator[Swath]:
        """Give the samples of the frames that have points, some frames at a time.

        Args:
            profiles: The points, in parts of whole frames in order.
            hole: Distance of neighbours above which there is a hole between them [m].
        """
        for profile in profiles:
            kept = profile[profile.posterior >= _LEAST_POSTERIOR]
            kept = kept[pick_strongest(kept, self.axis)]
            numbers = np.unique(kept.frame)
            for some in np.array_split(numbers, -(-len(numbers) // _ROWS)) if len(numbers) else []:
                yield self._lay(kept[np.isin(kept.frame, some)], some, hole)

    def _lay(self, profile: Profile, numbers: np.ndarray, hole: float) -> Swath:
        """Lay out the points of the frames of these numbers."""
        side = 0 if self.axis == "y" else 1
        lines = self.size[side] // self._step + 1
        line = np.rint(profile.pixels[:, side]).astype(np.int64) // self._step
        row = np.searchsorted(numbers, profile.frame)
        to_surface = self.directions.as_matrix().T
        places = self.trajectory.transform(profile.points, profile.time) @ to_surface
        ranges = np.linalg.norm(profile.points, axis=1)
        columns = [*places.T, profile.points[:, 2], ranges]
        grids = put_on_grids(columns, row, np.clip(line, 0, lines - 1), (len(numbers), lines))
        (along, across, height, depth, far), cause = fill_rows(grids, hole=hole)
        read = np.searchsorted(self.frames.frame, numbers)
        times = self.frames.time[np.minimum(read, len(self.frames) - 1)]
        camera = self.trajectory.at(times).positions @ self.directions.along
        ones = np.ones((1, lines), np.int64)
        return Swath(
            along, across, height, depth, far, cause,
            frame=numbers.astype(np.int64)[:, None] * ones,
            read=read[:, None] * ones,
            lit=np.arange(len(numbers))[:, None] * ones,
            camera=camera[:, None] * ones,
        )  # fmt: skip
