"""Write measurements of a vehicle's instruments as columns that `--navigation` reads."""

from pathlib import Path

import numpy as np

from ..types.navigation import Navigation
from .text import save_text


def save_navigation(path: Path, navigation: Navigation) -> None:
    """Write attitude, depth and velocity, which were measured at the same times.

    Args:
        path: The CSV.
        navigation: Its attitude and its depth are known.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    attitude, depth, velocity = navigation.attitude, navigation.depth, navigation.velocity
    assert attitude is not None
    assert depth is not None
    names = ["time_s", "roll_deg", "pitch_deg", "heading_deg", "depth_m"]
    columns = [attitude.times[:, None], np.degrees(attitude.values), depth.values]
    if velocity is not None:
        names += ["vx_m_s", "vy_m_s", "vz_m_s"]
        columns.append(velocity.values)
    rows = [",".join(f"{value:.6f}" for value in row) for row in np.hstack(columns).tolist()]
    save_text(path, "\n".join([",".join(names), *rows]) + "\n")
