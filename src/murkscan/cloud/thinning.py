"""One point a voxel: the mean of what lies in it, weighted by how well each point is known."""

from collections.abc import Iterable, Iterator

import numpy as np

from ..geometry.voxels import VoxelGrid
from ..types.arrays import Vector
from ..types.cloud import PointCloud

_MOST = 6_000_000
"""Voxels that are held at once: about a gigabyte."""
_BLOCK = 500_000
"""Points that are given at once."""
_SUMS = np.dtype(
    [
        ("key", "i8"),
        ("weight", "f8"),
        ("information", "f8"),
        ("points", "f8", 3),
        ("normals", "f4", 3),
        ("signal", "f8"),
        ("posterior", "f8"),
        ("sigma_common", "f8"),
        ("reflectance", "f8"),
        ("blur_shift", "f8"),
        ("width", "f8"),
        ("best", "f8"),
        ("frame", "i4"),
        ("scan_line", "i4"),
        ("laser", "u1"),
        ("branch", "u1"),
    ]
)
"""What is kept of a voxel: sums times weight, 1/σ², and which point was known best."""
_MEANS = ("signal", "posterior", "sigma_common", "reflectance", "blur_shift", "width")
"""What is averaged."""
_NUMBERS = ("frame", "scan_line", "laser", "branch")
"""What tells which point was known best."""
_SPREAD = 0x9E3779B97F4A7C15
"""Knuth's multiplicative hash: sorts voxels into shares of equal size."""


def thin_cloud(cloud: PointCloud, voxel: float) -> PointCloud:
    """Replace the points of each voxel by their mean; see `thin_clouds`."""
    return PointCloud.concatenate(list(thin_clouds(_Once(cloud), voxel)))


def thin_clouds(
    blocks: Iterable[PointCloud], voxel: float, *, most: int = _MOST
) -> Iterator[PointCloud]:
    """Replace the points of each voxel by one, over a cloud that comes in blocks.

    Positions, normals, signal and posterior are means weighted by 1/σ²; sigma is that of the mean,
    1/√Σ(1/σ²). sigma_common is not averaged down: the errors that it stands for are the same for
    all points, so it is the weighted mean. Frame, scan line and laser are those of the point known
    best. A point without sigma counts as the median of its block does; where no point of a voxel
    has one, sigma stays 0.

    Memory is bounded: where the voxels do not fit, the blocks are gone through again, for another
    share of the voxels each time.

    Args:
        blocks: The cloud; it must be possible to go through it more than once.
        voxel: Edge of a voxel [m]. The grid lies askew to the axes, so that a flat wall does not
            fall into two layers.
        most: Voxels that are held at once.

    Raises:
        InputError: The edge is not positive, or too small for where the points lie.
    """
    left = [(0, 1)]
    while left:
        sums = VoxelSums(*left.pop(), most=most)
        for block in blocks:
            sums.add(block, voxel)
        left += sums.left_out
        rows = sums.merged()
        yield from (_as_cloud(rows[k : k + _BLOCK]) for k in range(0, len(rows), _BLOCK))


class VoxelSums:
    """Sums over voxels, of those whose number falls into one share of all."""

    def __init__(self, share: int, shares: int, *, most: int = _MOST) -> None:
        self._share, self._shares, self._most = share, shares, most
        self._origin: Vector | None = None
        self._parts: list[np.ndarray] = []
        self.left_out: list[tuple[int, int]] = []
        """Shares for which there was no room: number, and of how many."""

    def add(self, cloud: PointCloud, voxel: float) -> None:
        """Add the points of a block."""
        if len(cloud) == 0:
            return
        if self._origin is None:
            self._origin = np.round(cloud.points[0])
        grid = VoxelGrid(cloud.points, voxel, self._origin)
        rows = _mine(_sum(cloud, grid), self._share, self._shares)
        # Like sizes are merged with like, so that no voxel is merged more than log n times.
        while self._parts and len(self._parts[-1]) <= 2 * len(rows):
            rows = _merge([self._parts.pop(), rows])
        self._parts.append(rows)
        if sum(map(len, self._parts)) > self._most:
            self._parts = [self.merged()]
            while len(self._parts[0]) > self._most:
                self._halve()

    def _halve(self) -> None:
        """Keep half of the voxels, and leave the others for another time."""
        self.left_out.append((self._share + self._shares, 2 * self._shares))
        self._shares *= 2
        self._parts = [_mine(self._parts[0], self._share, self._shares)]

    def merged(self) -> np.ndarray:
        """Give one row a voxel."""
        return _merge([np.zeros(0, _SUMS), *self._parts])


class _Once:
    """A cloud as blocks."""

    def __init__(self, cloud: PointCloud) -> None:
        self._cloud = cloud

    def __iter__(self) -> Iterator[PointCloud]:
        for start in range(0, len(self._cloud), _BLOCK):
            yield self._cloud[start : start + _BLOCK]


def _sum(cloud: PointCloud, grid: VoxelGrid) -> np.ndarray:
    known = np.isfinite(cloud.sigma) & (cloud.sigma > 0)
    usual = float(np.median(cloud.sigma[known])) if known.any() else 1.0
    weight = np.where(known, cloud.sigma, usual).astype(float) ** -2
    rows = np.zeros(len(cloud), _SUMS)
    rows["key"] = grid.keys
    rows["weight"], rows["information"] = weight, np.where(known, weight, 0.0)
    rows["points"] = cloud.points * weight[:, None]
    rows["normals"] = cloud.normals * weight[:, None]
    for name in _MEANS:
        rows[name] = getattr(cloud, name) * weight
    for name in _NUMBERS:
        rows[name] = getattr(cloud, name)
    rows["best"] = weight
    return _merge([rows])


def _merge(parts: list[np.ndarray]) -> np.ndarray:
    rows = np.concatenate(parts)
    if len(rows) == 0:
        return rows
    order = np.argsort(rows["key"], kind="stable")
    rows = rows[order]
    starts = np.flatnonzero(np.concatenate([[True], np.diff(rows["key"]) != 0]))
    merged = rows[starts]
    if len(starts) == len(rows):
        return merged
    for name in ("weight", "information", "points", "normals", *_MEANS):
        merged[name] = np.add.reduceat(rows[name], starts, axis=0)
    merged["best"] = np.maximum.reduceat(rows["best"], starts)
    voxel = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(rows))))
    is_best = np.flatnonzero(rows["best"] == merged["best"][voxel])[::-1]
    for name in _NUMBERS:
        # Of equals the first one counts: it is written last.
        merged[name][voxel[is_best]] = rows[name][is_best]
    return merged


def _mine(rows: np.ndarray, share: int, shares: int) -> np.ndarray:
    if shares == 1:
        return rows
    mixed = rows["key"].astype(np.uint64) * np.uint64(_SPREAD) >> np.uint64(32)
    return rows[mixed % np.uint64(shares) == share]


def _as_cloud(rows: np.ndarray) -> PointCloud:
    weight = rows["weight"]
    length = np.linalg.norm(rows["normals"], axis=1, keepdims=True)
    with np.errstate(divide="ignore"):
        sigma = np.where(rows["information"] > 0, rows["information"] ** -0.5, 0.0)
    return PointCloud(
        points=rows["points"] / weight[:, None],
        normals=rows["normals"] / np.where(length > 0, length, 1),
        sigma=sigma.astype(np.float32),
        **{name: (rows[name] / weight).astype(np.float32) for name in _MEANS},
        **{name: np.ascontiguousarray(rows[name]) for name in _NUMBERS},
    )
