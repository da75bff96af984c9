"""Point clouds as binary PLY files: the project's own columns, and what MeshLab shows of them."""

from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..errors import FormatError
from ..types.cloud import PointCloud
from .atomic import replacing

_COLUMNS = np.dtype(
    [(name, "<f8") for name in ("x", "y", "z")]
    + [(name, "<f4") for name in ("nx", "ny", "nz")]
    + [(name, "<f4") for name in ("signal", "posterior", "sigma", "sigma_common")]
    + [("frame", "<i4"), ("scan_line", "<i4"), ("laser", "u1")]
)
_TYPES = {"<f8": "double", "<f4": "float", "<i4": "int", "|u1": "uchar"}
"""What PLY calls them."""
_SCALARS = ("signal", "posterior", "sigma", "sigma_common", "frame", "scan_line", "laser")
_FORMAT = "format binary_little_endian 1.0"
_LONGEST_HEADER = 100
"""Lines of a header after which it is none."""
_LONGEST_LINE = 1000


def save_cloud(path: Path, cloud: PointCloud) -> None:
    """Write a cloud: positions and deviations in metres, signal in grey levels.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    rows = np.empty(len(cloud), _COLUMNS)
    for axis, name in enumerate("xyz"):
        rows[name] = cloud.points[:, axis]
        rows["n" + name] = cloud.normals[:, axis]
    for name in _SCALARS:
        rows[name] = getattr(cloud, name)
    with replacing(path) as aside, aside.open("wb") as file:
        file.write(_header(len(cloud)))
        file.write(rows.data)


def load_cloud(path: Path) -> PointCloud:
    """Read a cloud that `save_cloud` wrote; columns may stand in any order.

    Raises:
        FormatError: The file is no such cloud; a header that lies about the number of points costs
            no memory.
        FileNotFoundError: There is no such file.
    """
    with path.open("rb") as file:
        count, columns = _read_header(file, path)
        start = file.tell()
        there = path.stat().st_size - start
        if there != count * columns.itemsize:
            raise FormatError(
                f"{path} declares {count} points of {columns.itemsize} bytes but holds {there} "
                "bytes; it is cut off or damaged. Make it again with murkscan cloud."
            )
        rows = np.fromfile(file, columns, count)
    return PointCloud(
        points=np.stack([rows[name] for name in ("x", "y", "z")], axis=1),
        normals=np.stack([rows[name] for name in ("nx", "ny", "nz")], axis=1),
        **{name: np.ascontiguousarray(rows[name]) for name in _SCALARS},
    )


def _header(count: int) -> bytes:
    lines = ["ply", _FORMAT, "comment murkscan: metres", f"element vertex {count}"]
    lines += [f"property {_TYPES[_COLUMNS[name].str]} {name}" for name in _COLUMNS.names or ()]
    return "\n".join([*lines, "end_header", ""]).encode("ascii")


def _read_header(file: BinaryIO, path: Path) -> tuple[int, np.dtype[np.void]]:
    """Read up to the first point: the number of points, and the columns as they stand."""
    if file.readline(_LONGEST_LINE).rstrip() != b"ply":
        raise FormatError(f"{path} is not a PLY file.")
    count, names = -1, list[str]()
    for _ in range(_LONGEST_HEADER):
        line = file.readline(_LONGEST_LINE).decode("ascii", "replace").rstrip()
        words = line.split()
        if line == "end_header":
            _require_columns(names, count, path)
            return count, np.dtype([(name, _COLUMNS[name]) for name in names])
        if words[:2] == ["element", "vertex"] and words[2:3] and words[2].isdecimal() and count < 0:
            count = int(words[2])
        elif words[:1] == ["property"] and count >= 0:
            names.append(_known_column(words, path))
        elif line != _FORMAT and words[:1] not in (["comment"], ["obj_info"]):
            raise FormatError(f"{path} has the line {line[:60]!r}, which no murkscan cloud has.")
    raise FormatError(f"{path} is a PLY file without an end to its header.")


def _known_column(words: list[str], path: Path) -> str:
    name = words[-1]
    if name not in (_COLUMNS.names or ()) or words[1:] != [_TYPES[_COLUMNS[name].str], name]:
        raise FormatError(f"{path} has the unknown column {' '.join(words[1:])[:60]!r}.")
    return name


def _require_columns(names: list[str], count: int, path: Path) -> None:
    missing = [name for name in _COLUMNS.names or () if name not in names]
    if missing or count < 0 or len(set(names)) < len(names):
        raise FormatError(
            f"{path} lacks the column {missing[0]!r}."
            if missing
            else f"{path} has columns twice, or no points declared."
        )
