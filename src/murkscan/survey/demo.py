"""The demo: simulate a recording, scan it as any other, and hold the model against the truth."""

import time
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np

from ..capture import open_recording
from ..io.rig_toml import load_rig
from ..motion import ConstantSpeed
from ..project import Project, Stage
from ..simulate import HULL_SPEED, distance_to_surface, hull_scene
from ..types.arrays import Scalars
from .progress import Progress, silent
from .scan import scan
from .settings import describe
from .simulate import simulate_recording


@dataclass(frozen=True)
class Errors:
    """How far points lie from the true surface."""

    count: int
    rms: float
    """Root mean square distance [m]."""
    within_95: float
    """Distance within which 95 % of the points lie [m]."""
    largest: float
    """Largest distance [m]."""

    @classmethod
    def from_distances(cls, distances: Scalars) -> "Errors":
        """Summarise signed distances [m]; NaN where there are none."""
        if len(distances) == 0:
            return cls(0, np.nan, np.nan, np.nan)
        size = np.abs(distances)
        rms = float(np.sqrt(np.mean(size**2)))
        return cls(len(size), rms, float(np.quantile(size, 0.95)), float(size.max()))


def run_demo(
    out: Path, *, noise: float = 0.0, progress: Progress = silent
) -> tuple[Project, Errors]:
    """Simulate a hull's recording, scan it, and compare the cloud with the true hull.

    Args:
        out: Folder for `recording` and `scan`.
        noise: Standard deviation of a pixel's noise [grey levels].
        progress: Told how far each stage is.

    Returns:
        The scan, and the errors of its cloud.

    Raises:
        DeviceError: The disk is full.
    """
    scene = hull_scene(noise=noise)
    stage = Stage(out / "recording", {"murkscan": version("murkscan"), "scene": describe(scene)})
    if stage.result() is None:
        since = time.monotonic()
        stage.begin()
        simulate_recording(scene, stage.folder, progress=progress)
        stage.finish({"frames": len(scene.times)}, since=since)
    rig = load_rig(out / "recording" / "rig.toml")
    recording = open_recording(out / "recording" / "frames", wavelength=rig.wavelength)
    motion = ConstantSpeed(HULL_SPEED, "y")
    project = scan(recording, rig, motion, out=out / "scan", progress=progress)
    distances = distance_to_surface(scene.surface, project.load_cloud().points)
    return project, Errors.from_distances(distances)
