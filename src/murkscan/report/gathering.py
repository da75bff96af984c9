"""Numbers of all points, gathered part by part, so that a scan need not fit into memory."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from ..types.arrays import Scalars
from ..types.cloud import PointCloud
from ..types.laser import Axis
from ..types.profile import Profile
from ..types.trajectory import Trajectory
from .belief import LEVELS, Belief
from .even_sample import EvenSample
from .recorded import ModelSize
from .spacing import spacing_across, spacing_along
from .timeline import FrameStatistics, frame_statistics
from .trust import Trust, judge_trust

_COLUMNS = ("signal", "depth", "range", "sigma", "along", "across")


@dataclass(frozen=True, eq=False)
class Gathered:
    """What all parts of a scan said."""

    parts: list[FrameStatistics]
    """Statistics of each part's frames."""
    values: dict[str, Scalars]
    """Numbers by their name, evenly picked; lengths in metres."""
    belief: Belief


def gather(
    profiles: Iterable[Profile], axes: Mapping[int, Axis], trajectory: Trajectory | None
) -> Gathered:
    """Look at each part once.

    Args:
        profiles: The points, in parts of whole frames.
        axes: The camera axis along which each laser sits, by its number.
        trajectory: world_from_camera; without it there are no distances along the motion.
    """
    parts: list[FrameStatistics] = []
    belief = Belief((0,) * (len(LEVELS) + 1), is_told=False)
    kept = {name: EvenSample() for name in _COLUMNS}
    for profile in profiles:
        parts.append(frame_statistics(profile))
        belief += Belief.from_posterior(profile.posterior)
        kept["signal"].add(profile.signal)
        kept["depth"].add(profile.points[:, 2])
        kept["range"].add(np.linalg.norm(profile.points, axis=1))
        kept["sigma"].add(profile.sigma)
        for laser, axis in axes.items():
            mine = profile[profile.laser == laser]
            kept["along"].add(spacing_along(mine, axis))
            if trajectory is not None:
                kept["across"].add(spacing_across(mine, trajectory, axis))
    return Gathered(parts, {name: some.values() for name, some in kept.items()}, belief)


def measure_cloud(
    cloud: PointCloud | Iterable[PointCloud] | None,
    num_outliers: int,
    mesh_size: tuple[int, int],
    *,
    is_stated: bool,
) -> tuple[ModelSize, Trust | None]:
    """Tell how large a cloud is and how far to trust its points; None without points.

    Args:
        cloud: The points, all at once or in blocks.
        num_outliers: Points that were taken out of it.
        mesh_size: Vertices and triangles of the surface.
        is_stated: Whether the rig states how well it is known.
    """
    blocks = [cloud] if isinstance(cloud, PointCloud) else cloud or ()
    num_points, ends = 0, []
    sigma, common = EvenSample(), EvenSample()
    for block in blocks:
        if not len(block):
            continue
        num_points += len(block)
        ends.append((block.points.min(axis=0), block.points.max(axis=0)))
        sigma.add(block.sigma)
        common.add(block.sigma_common)
    if not num_points:
        return ModelSize(0, num_outliers, *mesh_size, None), None
    low, high = np.min([end[0] for end in ends], axis=0), np.max([end[1] for end in ends], axis=0)
    x, y, z = (high - low).tolist()
    model = ModelSize(num_points, num_outliers, *mesh_size, (x, y, z))
    return model, judge_trust(sigma.values(), common.values(), is_stated=is_stated)
