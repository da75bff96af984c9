"""Clouds in every format, told by the suffix."""

import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path

import numpy as np

from ..errors import InputError
from ..types.cloud import PointCloud
from .cloud_columns import BLOCK
from .copc import writing_copc
from .e57 import iterate_e57, writing_e57
from .las import iterate_las, writing_las
from .ply_foreign import iterate_ply, writing_shown_ply
from .xyz import iterate_xyz, writing_csv, writing_xyz

CLOUD_SUFFIXES = (".ply", ".las", ".laz", ".e57", ".xyz", ".csv")
"""The formats that are read and written."""
_OTHER_TEXTS = (".txt", ".asc", ".pts")
"""Other names of text files, as CloudCompare and scanners write them, which are only read."""

_Writing = AbstractContextManager[Callable[[PointCloud], None]]
_WRITERS: dict[str, Callable[[Path], _Writing]] = {
    ".ply": writing_shown_ply,
    ".xyz": writing_xyz,
    ".csv": writing_csv,
}


def writing_cloud_file(path: Path, *, wkt: str = "", extent: float = np.inf) -> _Writing:
    """Write a cloud block by block, in the format of the suffix.

    The file appears whole when the context ends, or not at all. XYZ keeps positions and normals
    only. In PLY the names of the scalar fields begin with `scalar_`, as CloudCompare has them, and
    `signal` stands there a second time as `quality`, the one field that MeshLab shows.
    A name that ends in .copc.laz is written as COPC, in the order of an octree.

    Args:
        path: The file; its suffix is one of .ply, .las, .laz, .e57, .xyz and .csv.
        wkt: Coordinate system as well-known text, which LAS, LAZ and E57 keep; empty for none.
        extent: Size of the cloud along its longest edge, at most [m]: LAS and LAZ count in finer
            steps where it is below 1 km.

    Raises:
        InputError: The suffix is another.
        DeviceError: The disk is full or cannot be written.
    """
    check_cloud_suffix(path)
    suffix = path.suffix.lower()
    if path.name.lower().endswith(".copc.laz"):
        return writing_copc(path, wkt, extent)
    if suffix in (".las", ".laz"):
        return writing_las(path, wkt, extent)
    if suffix == ".e57":
        return writing_e57(path, wkt)
    return _WRITERS[suffix](path)


def iterate_cloud_file(path: Path, *, block: int = BLOCK) -> Iterator[PointCloud]:
    """Read a cloud of any of the formats, some points at a time.

    Columns that the file does not have say nothing: no normals, signal 0, posterior 1, sigma 0.

    Args:
        path: The file; its suffix is one of .ply, .las, .laz, .e57, .xyz, .csv, or of another text:
            .txt, .asc, .pts.
        block: Points at a time, at most.

    Raises:
        InputError: The suffix is another.
        FormatError: The file is not what its suffix says, or damaged; memory stays bounded.
        FileNotFoundError: There is no such file.
    """
    check_cloud_to_read(path)
    suffix = path.suffix.lower()
    if suffix == ".ply":
        return iterate_ply(path, block=block)
    if suffix == ".e57":
        return iterate_e57(path, block=block)
    if suffix in (".xyz", ".csv", *_OTHER_TEXTS):
        return iterate_xyz(path, block=block)
    return iterate_las(path, block=block)


def load_cloud_file(path: Path) -> PointCloud:
    """Read a whole cloud of any of the formats; see `iterate_cloud_file`.

    Points that cannot be (`PointCloud.is_sound`) are left out, and a warning says how many.
    """
    cloud = PointCloud.concatenate(list(iterate_cloud_file(path)))
    sound = cloud.is_sound()
    if not sound.all():
        warnings.warn(
            f"{path}: {(~sound).sum():,} of {len(cloud):,} points were left out, since they have "
            "no place, or a sigma or a normal that cannot be.",
            stacklevel=2,
        )
    return cloud[sound]


def check_cloud_suffix(path: Path) -> None:
    """Refuse now what writing would refuse after an hour of other work.

    Raises:
        InputError: The suffix is none of a cloud.
    """
    _check(path, CLOUD_SUFFIXES)


def check_cloud_to_read(path: Path) -> None:
    """Refuse now what reading would refuse after an hour of other work.

    Raises:
        InputError: The suffix is none of a cloud.
    """
    _check(path, (*CLOUD_SUFFIXES, *_OTHER_TEXTS))


def _check(path: Path, suffixes: tuple[str, ...]) -> None:
    if path.suffix.lower() not in suffixes:
        raise InputError(f"{path} has no suffix of a cloud; give one of {', '.join(suffixes)}.")
