"""Clouds as LAS and LAZ files, the surveyors' format."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import FormatError, InputError
from ..types.cloud import PointCloud
from .atomic import replacing
from .blocks import rows_at_once
from .cloud_columns import BLOCK, COLUMNS, as_rows, from_columns, known_name
from .las_header import check_las_header
from .laz_chunks import check_laz_chunks

if TYPE_CHECKING:
    pass

_STEPS = (5e-7, 1e-5)
"""Steps of the coordinates [m]: the second, a tenth of the noise of the best points, where the
points' extent has no room for the first, by which a cloud elsewhere is the same to a micrometre."""
_ROOM = 1000.0
"""Extent up to which the first is taken [m]; 2³¹ of them are 1074 m."""
_EXTRA = [name for name in COLUMNS.names or () if name not in "xyz"]
_BRIGHTEST = 65535
_POINT_FORMAT = 6


@contextmanager
def writing_las(
    path: Path, wkt: str = "", extent: float = np.inf
) -> Iterator[Callable[[PointCloud], None]]:
    """Write a cloud block by block, packed where the suffix is .laz.

    Coordinates are in metres, in steps of 0.0005 mm from the whole metre next to the first points;
    of 0.01 mm where the cloud extends over more than 1 km.
    What LAS has no field for are extra dimensions with the names of cloud.ply's columns; `signal`
    is the intensity, too. The file appears whole when the context ends, or not at all.

    Args:
        path: The file.
        wkt: Coordinate system as well-known text; empty for none.
        extent: Size of the cloud along its longest edge, at most [m].

    Raises:
        InputError: Points lie farther than 21 km from the first ones, or are not finite.
        DeviceError: The disk is full or cannot be written.
    """
    import laspy

    header = make_las_header(laspy, wkt, extent)
    is_placed = False
    with replacing(path) as aside, blaming_the_disk():
        writer = laspy.open(aside, mode="w", header=header, do_compress=_is_laz(path))
        with writer:

            def write(cloud: PointCloud) -> None:
                nonlocal is_placed
                if len(cloud) == 0:
                    return
                require_finite(cloud, path)
                if not is_placed:
                    # laspy writes the header anew when it closes, with this.
                    writer.header.offsets = np.round(cloud.points.mean(axis=0))
                    is_placed = True
                writer.write_points(as_las_points(laspy, writer.header, cloud, path))

            yield write


def make_las_header(laspy: Any, wkt: str, extent: float) -> Any:
    """Make the header of a cloud's file, with the extra dimensions that hold its columns."""
    header = laspy.LasHeader(point_format=_POINT_FORMAT, version="1.4")
    header.generating_software = "murkscan"
    header.scales = np.full(3, _STEPS[0] if extent < _ROOM else _STEPS[1])
    header.global_encoding.wkt = True  # always, with these points (LAS 1.4 R15, table 4)
    if wkt:
        header.vlrs.append(laspy.vlrs.known.WktCoordinateSystemVlr(wkt))
    header.add_extra_dims([laspy.ExtraBytesParams(name, COLUMNS[name]) for name in _EXTRA])
    return header


def iterate_las(path: Path, *, block: int = BLOCK) -> Iterator[PointCloud]:
    """Read the points of a LAS or LAZ file, some at a time.

    Raises:
        FormatError: The file is no such file, or holds fewer points than it says.
        FileNotFoundError: There is no such file.
    """
    import laspy

    check_las_header(path)
    with _blaming(path):
        # One thread: the others believe the sizes that a file states before they read it.
        backend = laspy.LazBackend.Lazrs
        with laspy.open(path, laz_backend=backend, read_evlrs=False) as reader:
            if reader.header.are_points_compressed:
                check_laz_chunks(path, reader.header)
            count = reader.header.point_count
            block = rows_at_once(reader.header.point_format.size, block)
            for start in range(0, count, block):
                points = reader.read_points(min(block, count - start))
                if len(points) < min(block, count - start):
                    raise FormatError(
                        f"{path} declares {count} points but holds {start + len(points)}; it is "
                        "cut off or damaged."
                    )
                yield _as_cloud(points)


@contextmanager
def blaming_the_disk() -> Iterator[None]:
    """Turn what lazrs says of a failed write into what Python says."""
    import lazrs

    try:
        yield
    except lazrs.LazrsError as error:
        raise OSError(None, "the disk is full, or takes no more") from error


@contextmanager
def _blaming(path: Path) -> Iterator[None]:
    """Turn what goes wrong inside into the file's fault."""
    try:
        yield
    except (FormatError, InputError):
        raise
    # Which error a damaged file ends in is up to laspy: any.
    except Exception as error:
        raise _unreadable(path) from error
    except BaseException as error:
        # What Rust throws when it finds itself in the wrong has no type that can be imported.
        if type(error).__name__ != "PanicException":
            raise
        raise _unreadable(path) from error


def _unreadable(path: Path) -> FormatError:
    return FormatError(
        f"{path} cannot be read as {'LAZ' if _is_laz(path) else 'LAS'}: it is damaged, or of a "
        "kind that is not known here. Save it anew as LAS 1.4, or as .ply."
    )


def _is_laz(path: Path) -> bool:
    return path.suffix.lower() == ".laz"


def as_las_points(laspy: Any, header: Any, cloud: PointCloud, path: Path) -> Any:
    """Give points as LAS has them.

    Raises:
        InputError: They lie too far from the header's offsets; `path` is what it calls the file.
    """
    away = float(np.abs(cloud.points - header.offsets).max())
    if away / header.scales[0] > np.iinfo(np.int32).max:
        raise InputError(
            f"{path} cannot hold points that lie {away:g} m from the first ones: LAS "
            "counts in steps. Export to .ply or .e57."
        )
    points = laspy.ScaleAwarePointRecord.zeros(len(cloud), header=header)
    for axis, name in enumerate("xyz"):
        points[name] = cloud.points[:, axis]
    rows = as_rows(cloud)
    for name in _EXTRA:
        points[name] = rows[name]
    points["intensity"] = np.clip(np.nan_to_num(cloud.signal), 0, _BRIGHTEST).astype(np.uint16)
    points["return_number"] = points["number_of_returns"] = np.ones(len(cloud), np.uint8)
    return points


def _as_cloud(points: Any) -> PointCloud:
    columns: dict[str, np.ndarray] = {}
    names = [*points.point_format.dimension_names]
    # The intensity stands first, so that a `signal` of ours comes over it.
    for name in names:
        ours = known_name(name)
        if ours is not None and ours not in "xyz":
            columns[ours] = np.asarray(points[name])
    for name in "xyz":
        columns[name] = np.asarray(points[name], float)
    return from_columns(columns)


def require_finite(cloud: PointCloud, path: Path) -> None:
    """Refuse points that are not finite.

    Raises:
        InputError: Some are; `path` is what it calls the file.
    """
    broken = len(cloud) - int(np.isfinite(cloud.points).all(axis=1).sum())
    if broken:
        raise InputError(f"{path} cannot hold the {broken} points that are not finite.")
