"""Pose logs: CSV with a header, or TUM."""

from pathlib import Path

import numpy as np

from ..errors import FormatError, InputError
from ..types.trajectory import Trajectory
from .atomic import replacing

_HEADER = ["time_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"]


def load_poses(path: Path | str) -> Trajectory:
    """Read a log of poses world_from_camera, or world_from_vehicle.

    A file whose first line names the columns time_s, x_m, y_m, z_m, qw, qx, qy, qz (in any order,
    others are ignored) is CSV; one of eight bare numbers a line is TUM: time, position,
    quaternion x y z w. Lines that start with # are comments.

    Raises:
        FormatError: The file is missing or neither; the message names the line.
    """
    path = Path(path)
    try:
        lines = path.read_text("utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not text in UTF-8"
        raise FormatError(f"The pose log {path} cannot be read: {reason}.") from error
    rows = [
        (i + 1, line) for i, line in enumerate(lines) if line.strip() and line.strip()[0] != "#"
    ]
    if not rows:
        raise FormatError(f"{path} holds no poses.")
    if "time_s" in rows[0][1]:
        table = _parse(path, rows[1:], _columns_of(path, rows[0][1]), ",")
        if len(table) == 0:
            raise FormatError(f"{path} holds no poses.")
    else:
        table = _parse(path, rows, [0, 1, 2, 3, 7, 4, 5, 6], None)
    return _as_trajectory(path, table)


def save_poses(path: Path, trajectory: Trajectory) -> None:
    """Write a log in the CSV form of `load_poses`, to the last bit.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    columns = (trajectory.times[:, None], trajectory.positions, trajectory.quaternions)
    rows = np.concatenate(columns, axis=1).tolist()
    lines = [",".join(_HEADER)] + [",".join(map(repr, row)) for row in rows]
    with replacing(path) as aside:
        aside.write_text("\n".join(lines) + "\n", "utf-8")


def _columns_of(path: Path, header: str) -> list[int]:
    names = [name.strip() for name in header.split(",")]
    missing = [name for name in _HEADER if name not in names]
    if missing:
        raise FormatError(
            f"{path} lacks the column {missing[0]}; its first line must name {','.join(_HEADER)}."
        )
    return [names.index(name) for name in _HEADER]


def _parse(
    path: Path, rows: list[tuple[int, str]], columns: list[int], separator: str | None
) -> np.ndarray:
    table = np.empty((len(rows), 8))
    for row, (number, line) in zip(table, rows, strict=True):
        cells = line.split(separator)
        try:
            if separator is None and len(cells) != len(columns):
                raise ValueError
            row[:] = [float(cells[column]) for column in columns]
        except (ValueError, IndexError) as error:
            raise FormatError(
                f"{path}, line {number} is not a pose: a CSV log starts with the line "
                f"{','.join(_HEADER)}, a TUM log has eight numbers a line."
            ) from error
        if not np.isfinite(row).all() or not 0.5 <= np.linalg.norm(row[4:]) <= 2:
            raise FormatError(f"{path}, line {number} has a number that is not finite, or a "
                "quaternion whose length is not 1; remove the line.")  # fmt: skip
    return table


def _as_trajectory(path: Path, table: np.ndarray) -> Trajectory:
    quaternions = table[:, 4:] / np.linalg.norm(table[:, 4:], axis=1, keepdims=True)
    try:
        return Trajectory(table[:, 0], table[:, 1:4], quaternions)
    except InputError as error:
        raise FormatError(
            f"{path}: the times of the poses do not strictly increase; sort the log and remove "
            "repeated times."
        ) from error
