"""Clouds as COPC: one LAZ file whose points stand in the order of an octree, for any viewer.

    header · info · other records │ a chunk a node, the root first │ table of chunks │ hierarchy

References:
    COPC specification 1.0, https://copc.io.
"""

import struct
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from ..errors import InputError
from ..geometry.octree import CellCounter, Octree, interleave, part_key
from ..types.cloud import PointCloud
from .atomic import replacing
from .las import as_las_points, blaming_the_disk, make_las_header, require_finite

_INFO = struct.Struct("<5d2Q2d88x")
"""Centre, half the edge of the root, spacing; place and size of the hierarchy; range of times."""
_ENTRY = np.dtype([("key", "<i4", 4), ("offset", "<u8"), ("size", "<i4"), ("points", "<i4")])
_EVLR = struct.Struct("<2x16sHQ32s")
_HEADER = 375
_USUAL = 50_000
"""Points of a node that has others below it: some 100 ms to load in a browser."""
_AT_ONCE = 1_000_000
"""Points that are sorted at once."""
_ROWS = 500_000
"""Points that are read at once."""
_ACROSS = 128
"""Points that lie side by side in a node: what the spacing of a root stands for."""
_FINER = 4
"""Levels that cells are counted beyond those which an even surface would need."""
_SEED = 0


@contextmanager
def writing_copc(
    path: Path, wkt: str = "", extent: float = np.inf
) -> Iterator[Callable[[PointCloud], None]]:
    """Write a cloud block by block as COPC.

    The blocks are kept on the disk beside the file, in 72 bytes a point, until all are there; then
    they are sorted by nodes, a million at a time. Everything else is as `writing_las` has it.

    Args:
        path: The file, ending in .copc.laz.
        wkt: Coordinate system as well-known text; empty for none.
        extent: Size of the cloud along its longest edge, at most [m].

    Raises:
        InputError: There are no points, they lie farther than 21 km from the first ones, or are
            not finite.
        DeviceError: The disk is full or cannot be written.
    """
    import laspy

    header, is_placed = make_las_header(laspy, wkt, extent), False
    header.mins, header.maxs = np.full(3, np.inf), np.full(3, -np.inf)
    with (
        replacing(path) as aside,
        blaming_the_disk(),
        tempfile.TemporaryDirectory(prefix=".copc-", dir=path.parent) as folder,
    ):
        spool = Path(folder) / "points"
        with spool.open("wb") as file:

            def write(cloud: PointCloud) -> None:
                nonlocal is_placed
                if len(cloud) == 0:
                    return
                require_finite(cloud, path)
                if not is_placed:
                    header.offsets, is_placed = np.round(cloud.points.mean(axis=0)), True
                points = as_las_points(laspy, header, cloud, path)
                header.grow(points)
                file.write(points.array.data)

            yield write
        if header.point_count == 0:
            raise InputError(f"{path} would have no points; there is nothing to write.")
        _sort(laspy, header, spool, aside)


@dataclass(frozen=True, eq=False)
class _Cube:
    """The root of the octree, in steps of the coordinates."""

    low: np.ndarray
    edge: int

    @classmethod
    def around(cls, header: Any) -> "_Cube":
        ends = (np.array([header.mins, header.maxs]) - header.offsets) / header.scales
        low, high = np.rint(ends).astype(np.int64)
        return cls(low, int((high - low).max()) + 1)

    def keys(self, rows: np.ndarray, depth: int) -> np.ndarray:
        """Give the Morton keys of the cells of points."""
        steps = np.stack([rows[name] for name in "XYZ"], axis=1).astype(np.int64) - self.low
        return interleave((steps << depth) // self.edge)


def _sort(laspy: Any, header: Any, spool: Path, path: Path) -> None:
    """Write the file out of the points as they came."""
    dtype, cube = header.point_format.dtype(), _Cube.around(header)
    depth = _depth(header.point_count)
    counter = CellCounter()
    for rows in _read(spool, dtype):
        counter.add(cube.keys(rows, depth))
    tree = Octree.plan(*counter.counted(), depth, usual=_USUAL)
    buckets = np.minimum(np.cumsum(tree.expected) // _AT_ONCE, 2**31).astype(np.int64)
    names = _part(spool, dtype, cube, tree, buckets)
    spool.unlink()
    with path.open("wb+") as file:
        _write(laspy, header, file, cube, tree, names, dtype)


def _depth(count: int) -> int:
    """Choose the level at which cells are counted; a surface has four more of them a level."""
    even = np.log(max(count / _USUAL, 1.0)) / np.log(4)
    return int(np.ceil(even)) + _FINER


def _read(path: Path, dtype: np.dtype[Any]) -> Iterator[np.ndarray]:
    with path.open("rb") as file:
        while len(rows := np.fromfile(file, dtype, _ROWS)):
            yield rows


def _part(
    spool: Path, dtype: np.dtype[Any], cube: _Cube, tree: Octree, buckets: np.ndarray
) -> list[Path]:
    """Part the points by runs of nodes into files, each small enough to be sorted at once."""
    random = np.random.default_rng(_SEED)
    noted = np.dtype([("node", "<i4"), ("point", dtype)])
    names = [spool.with_name(f"bucket{number}") for number in range(int(buckets[-1]) + 1)]
    for rows in _read(spool, dtype):
        out = np.empty(len(rows), noted)
        out["node"], out["point"] = tree.assign(cube.keys(rows, tree.depth), random), rows
        out = out[np.argsort(out["node"], kind="stable")]
        bucket = buckets[out["node"]]
        for number in np.unique(bucket).tolist():
            low, high = np.searchsorted(bucket, [number, number + 1])
            with names[number].open("ab") as file:
                file.write(out[low:high].data)
    return [name for name in names if name.exists()]


def _write(
    laspy: Any,
    header: Any,
    file: BinaryIO,
    cube: _Cube,
    tree: Octree,
    names: list[Path],
    dtype: np.dtype[Any],
) -> None:
    import lazrs

    vlr = lazrs.LazVlr.new_for_compression(
        header.point_format.id, header.point_format.num_extra_bytes, True
    )
    info = laspy.VLR("copc", 1, "COPC info", bytes(_INFO.size))
    header.vlrs.insert(0, info)
    header.vlrs.append(laspy.vlrs.known.LasZipVlr(vlr.record_data()))
    header.are_points_compressed = True
    header.write_to(file)
    packer = lazrs.ParLasZipCompressor(file, vlr)
    packer.reserve_offset_to_chunk_table()
    counts = np.zeros(len(tree.expected), np.int64)
    noted = np.dtype([("node", "<i4"), ("point", dtype)])
    for name in names:
        counts += _pack(packer, np.fromfile(name, noted), len(counts))
        name.unlink()
    packer.done()
    file.seek(header.offset_to_point_data)
    sizes = [size for _, size in lazrs.read_chunk_table(file, vlr)]
    entries = _hierarchy(tree, counts, sizes, header.offset_to_point_data + 8)
    file.seek(0, 2)
    header.start_of_first_evlr, header.number_of_evlrs = file.tell(), 1
    file.write(_EVLR.pack(b"copc", 1000, entries.nbytes, b"COPC hierarchy"))
    place = file.tell()
    file.write(entries.tobytes())
    half = cube.edge * float(header.scales[0]) / 2
    centre = header.offsets + cube.low * header.scales + half
    info.record_data = _INFO.pack(
        *centre.tolist(), half, 2 * half / _ACROSS, place, entries.nbytes, 0.0, 0.0
    )
    file.seek(0)
    header.write_to(file, ensure_same_size=True)


def _pack(packer: Any, rows: np.ndarray, num_nodes: int) -> np.ndarray:
    """Pack the points of some nodes, a chunk each, and count them."""
    rows = rows[np.argsort(rows["node"], kind="stable")]
    counts = np.bincount(rows["node"], minlength=num_nodes)
    ends = np.cumsum(counts[counts > 0])
    points = np.ascontiguousarray(rows["point"])
    packer.compress_chunks([part.tobytes() for part in np.split(points, ends[:-1])])
    return counts


def _hierarchy(tree: Octree, counts: np.ndarray, sizes: list[int], start: int) -> np.ndarray:
    """List the nodes: level and cell, where the chunk is, and how many points it has."""
    entries = np.zeros(len(counts), _ENTRY)
    entries["key"][:, 0] = tree.levels()
    entries["key"][:, 1:] = part_key(np.concatenate(tree.keys))
    there = counts > 0
    entries["points"], entries["size"][there] = counts, sizes
    entries["offset"][there] = start + np.cumsum([0, *sizes])[:-1]
    return entries
