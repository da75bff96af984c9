"""Clouds as E57 files, the laser scanners' exchange format."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import numpy as np

from ..errors import FormatError
from ..types.cloud import PointCloud
from ..types.pose import Pose
from .atomic import replacing
from .cloud_columns import BLOCK, COLUMNS, SCALARS, as_rows, from_columns, known_name
from .e57_header import open_new
from .e57_xml import check_e57_xml

if TYPE_CHECKING:
    pass

_PLACE = {"cartesianX": "x", "cartesianY": "y", "cartesianZ": "z"}
_SPHERE = ("sphericalRange", "sphericalAzimuth", "sphericalElevation")
_NORMALS = {"nor:normalX": "nx", "nor:normalY": "ny", "nor:normalZ": "nz"}
_INVALID = ("cartesianInvalidState", "sphericalInvalidState")
_NORMALS_URI = "http://www.libe57.org/E57_NOR_surface_normals.txt"
_OURS_URI = "urn:murkscan:point-columns:1"
_SMALL = 10_000
"""Points for which there is room at least: a file may hold thousands of small scans."""
_OURS = "murk:"
"""Prefix of our own columns; `signal` is E57's intensity."""
_FIELDS = {
    **{ours: theirs for theirs, ours in (_PLACE | _NORMALS).items()},
    **{name: _OURS + name for name in SCALARS},
    "signal": "intensity",
}
"""What E57 calls our columns."""


@contextmanager
def writing_e57(path: Path, wkt: str = "") -> Iterator[Callable[[PointCloud], None]]:
    """Write a cloud block by block, as one scan in double precision.

    Normals are those of the surface-normal extension, `signal` is the intensity, and the other
    columns of cloud.ply have the prefix murk. The file appears whole when the context ends, or not
    at all.

    Args:
        path: The file.
        wkt: Coordinate system as well-known text, its `coordinateMetadata`; empty for none.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    import pye57

    lib = pye57.libe57
    arrays = {name: np.zeros(BLOCK, _buffer_type(name)) for name in _FIELDS}
    with replacing(path) as aside, _open_to_write(pye57, aside, wkt) as file:
        points = _add_scan(lib, file)
        writer = points.writer(_buffers(lib, file.image_file, arrays))

        def write(cloud: PointCloud) -> None:
            for start in range(0, len(cloud), BLOCK):
                rows = as_rows(cloud[start : start + BLOCK])
                for name, array in arrays.items():
                    array[: len(rows)] = rows[name]
                writer.write(len(rows))

        yield write
        writer.close()


@contextmanager
def _open_to_write(pye57: Any, path: Path, wkt: str) -> Iterator[Any]:
    """Open a file; it is finished only if nothing goes wrong."""
    file = None
    try:
        file = open_new(pye57, path, wkt)
        yield file
        file.close()
    except BaseException as error:
        if file is not None:
            with suppress(pye57.libe57.E57Exception):
                file.close()
            # Otherwise pye57 closes it again when it is collected, and complains on stderr.
            del file.image_file
        if isinstance(error, pye57.libe57.E57Exception):
            words = "it cannot be opened, or the disk is full"
            raise OSError(None, words) from error
        raise


def iterate_e57(path: Path, *, block: int = BLOCK) -> Iterator[PointCloud]:
    """Read the points of an E57 file, scan after scan, in the file's common frame.

    Points that the file marks as invalid are left out.

    Raises:
        FormatError: The file is no such file, or a scan of it has no coordinates, or other points
            than it says.
        FileNotFoundError: There is no such file.
    """
    import pye57

    lib = pye57.libe57
    check_e57_xml(path)
    try:
        with pye57.E57(str(path)) as file:
            for number in range(file.scan_count):
                yield from _read_scan(lib, file, number, path, block)
    except FormatError:
        raise
    # Nodes may be of any kind in any place, and fail in any way.
    except Exception as error:
        raise FormatError(
            f"{path} cannot be read as E57: it is damaged, or of a kind that is not known here. "
            "Save it anew, or as .las."
        ) from error


def _add_scan(lib: Any, file: Any) -> Any:
    """Add one scan without points, and give where they go."""
    image = file.image_file
    image.extensionsAdd("nor", _NORMALS_URI)
    image.extensionsAdd(_OURS.rstrip(":"), _OURS_URI)
    scan, columns = lib.StructureNode(image), lib.StructureNode(image)
    scan.set("guid", lib.StringNode(image, f"{{{uuid4()}}}"))
    scan.set("name", lib.StringNode(image, "murkscan"))
    for name, theirs in _FIELDS.items():
        dtype = COLUMNS[name]
        if dtype.kind == "f":
            limits = np.finfo(dtype)
            precision = lib.E57_DOUBLE if dtype.itemsize == 8 else lib.E57_SINGLE
            node = lib.FloatNode(image, 0.0, precision, float(limits.min), float(limits.max))
        else:
            whole = np.iinfo(dtype)
            node = lib.IntegerNode(image, 0, int(whole.min), int(whole.max))
        columns.set(theirs, node)
    points = lib.CompressedVectorNode(image, columns, lib.VectorNode(image, True))
    scan.set("points", points)
    file.data3d.append(scan)
    return points


def _read_scan(lib: Any, file: Any, number: int, path: Path, block: int) -> Iterator[PointCloud]:
    header = file.get_header(number)
    if header.point_count == 0:
        return
    there = list(header.point_fields)
    is_placed = all(name in there for name in _PLACE)
    place = tuple(_PLACE) if is_placed else _SPHERE
    if not all(name in there for name in place):
        raise FormatError(f"{path} has no coordinates in its scan {number}.")
    world_from_scan = _pose(header)
    known = {name: _ours(name) for name in there}
    wanted = {name: ours for name, ours in known.items() if ours is not None}
    wanted |= {name: name for name in place}
    wanted |= {name: name for name in _INVALID if name in there}
    room = min(block, max(header.point_count, _SMALL))
    arrays = {name: np.zeros(room, _buffer_type(ours)) for name, ours in wanted.items()}
    reader = header.points.reader(_named_buffers(lib, file.image_file, arrays))
    total = 0
    while count := reader.read():
        total += count
        some = {wanted[name]: array[:count].copy() for name, array in arrays.items()}
        yield _as_cloud(some, place, world_from_scan)
    reader.close()
    if total != header.point_count:
        raise FormatError(
            f"{path} declares {header.point_count} points in its scan {number} but holds {total}; "
            "it is cut off or damaged."
        )


def _as_cloud(
    columns: dict[str, np.ndarray], place: tuple[str, ...], world_from_scan: Pose
) -> PointCloud:
    first, second, third = (columns.pop(name) for name in place)
    points = np.stack([first, second, third], axis=1)
    if place == _SPHERE:
        flat = first * np.cos(third)
        points = np.stack(
            [flat * np.cos(second), flat * np.sin(second), first * np.sin(third)], axis=1
        )
    valid = np.ones(len(points), bool)
    for name in _INVALID:
        valid &= columns.pop(name, np.zeros(len(points))) == 0
    if "nx" in columns and "ny" in columns and "nz" in columns:
        normals = np.stack([columns["n" + axis] for axis in "xyz"], axis=1)
        turned = normals @ world_from_scan.rotation.T
        columns |= {"n" + axis: turned[:, number] for number, axis in enumerate("xyz")}
    points = world_from_scan @ points
    columns |= {axis: points[:, number] for number, axis in enumerate("xyz")}
    return from_columns(columns)[valid]


def _pose(header: Any) -> Pose:
    if not header.has_pose():
        return Pose.identity()
    quaternion = np.asarray(header.rotation, float)[None]
    translation = np.asarray(header.translation, float)
    if not (
        np.isfinite(quaternion).all() and np.any(quaternion) and np.isfinite(translation).all()
    ):
        raise ValueError("the pose of a scan is not finite")
    return Pose.from_quaternion(quaternion, translation)


def _ours(name: str) -> str | None:
    """Give our name of a field; None for coordinates and what we do not know."""
    ours = _NORMALS.get(name) or known_name(name.removeprefix(_OURS))
    return None if ours in ("x", "y", "z") else ours


def _buffer_type(name: str) -> np.dtype[np.generic]:
    """Give the type of a column's buffer: pye57 takes no int32, and `long` for half its size."""
    dtype = COLUMNS[name] if name in (COLUMNS.names or ()) else np.dtype("f8")
    return np.dtype(np.longlong) if dtype == np.dtype("i4") else dtype


def _buffers(lib: Any, image: Any, arrays: dict[str, np.ndarray]) -> Any:
    return _named_buffers(lib, image, {_FIELDS[name]: array for name, array in arrays.items()})


def _named_buffers(lib: Any, image: Any, arrays: dict[str, np.ndarray]) -> Any:
    buffers = lib.VectorSourceDestBuffer()
    for name, array in arrays.items():
        buffers.append(lib.SourceDestBuffer(image, name, array, len(array), True, True))
    return buffers
