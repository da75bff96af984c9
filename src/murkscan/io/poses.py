"""Logs of poses as loggers write them; our own form, and TUM's."""

import warnings
from pathlib import Path

import numpy as np

from ..types.trajectory import Trajectory
from .atomic import replacing
from .pose_reading import PoseConvention, PoseFile, read_poses
from .text_table import read_text_table

_HEADER = ("time_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz")


def read_pose_log(path: Path | str, convention: PoseConvention | None = None) -> PoseFile:
    """Read a log of poses world_from_camera, or world_from_vehicle, and say how it was understood.

    Columns are known by their names, in any order: our own (time_s, x_m, y_m, z_m, qw, qx, qy,
    qz), those of EuRoC and of `rostopic echo -p`, and northing, easting, depth with roll, pitch
    and heading. Without names eight numbers a line are TUM: time, position, quaternion x y z w.

    Args:
        path: The file; see `read_text_table` for what parts the columns.
        convention: What the file does not say by itself, or says wrongly.

    Raises:
        FormatError: The file is missing or no such log; the message names the line.
        InputError: A convention is given for what the log does not have, or names otherwise.
    """
    path = Path(path)
    return read_poses(path, read_text_table(path, "pose log"), convention or PoseConvention())


def load_poses(path: Path | str) -> Trajectory:
    """Read a log of poses; see `read_pose_log`. A warning says how many lines are left out."""
    read = read_pose_log(path)
    if read.left_out:
        warnings.warn(f"{path}: {read.tell_left_out()}", stacklevel=2)
    return read.log


def save_poses(path: Path, trajectory: Trajectory) -> None:
    """Write a log in our own form, to the last bit.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    columns = (trajectory.times[:, None], trajectory.positions, trajectory.quaternions)
    rows = np.concatenate(columns, axis=1).tolist()
    lines = [",".join(_HEADER)] + [",".join(map(repr, row)) for row in rows]
    with replacing(path) as aside:
        aside.write_text("\n".join(lines) + "\n", "utf-8")
