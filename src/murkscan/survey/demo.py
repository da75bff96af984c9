"""The demo: simulate a recording, scan it as any other, and hold the model against the truth."""

import time
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numpy as np

from ..capture import open_recording
from ..geometry.mesh_distance import distance_to_mesh
from ..io.mesh_files import load_mesh
from ..io.rig_toml import load_rig
from ..motion import ConstantSpeed
from ..project import Project, Stage
from ..simulate import as_standalone, parse_scene, read_scene
from ..types.arrays import Scalars
from .progress import Progress, silent
from .scan import scan
from .simulate import simulate_recording

_SCENE = "demo"
_SPEED = 0.1
"""Of the camera in that scene [m/s]."""
FALSE = 0.01
"""Distance from the truth beyond which a point is false: a particle, or a ghost [m]."""
_COMPARED = 20_000
"""Points of the cloud that are held against the truth."""


@dataclass(frozen=True)
class Errors:
    """How far points lie from the true surface."""

    count: int
    """Points that were compared."""
    false: int
    """Those that lie so far off that they are no points of the surface."""
    rms: float
    """Root mean square distance of the others [m]."""
    within_95: float
    """Distance within which 95 % of the others lie [m]."""

    @classmethod
    def from_distances(cls, distances: Scalars) -> "Errors":
        """Summarise distances [m], infinite for false points; NaN where there are no others."""
        true = distances[np.isfinite(distances)]
        if len(true) == 0:
            return cls(len(distances), len(distances), np.nan, np.nan)
        rms = float(np.sqrt(np.mean(true**2)))
        return cls(len(distances), len(distances) - len(true), rms, float(np.quantile(true, 0.95)))


def run_demo(out: Path, *, progress: Progress = silent) -> tuple[Project, Errors]:
    """Simulate a hull's recording, scan it, and compare the cloud with the true hull.

    Args:
        out: Folder for `recording` and `scan`.
        progress: Told how far each stage is.

    Returns:
        The scan, and the errors of its cloud, of which at most 20 000 points spread evenly over it
        are compared.

    Raises:
        DeviceError: The disk is full.
    """
    text, name, folder = read_scene(_SCENE)
    scene = parse_scene(text, name, folder)
    text = as_standalone(text, scene.rig, folder)
    stage = Stage(out / "recording", {"murkscan": version("murkscan"), "scene": text})
    if stage.result() is None:
        since = time.monotonic()
        stage.begin()
        simulate_recording(scene, stage.folder, text=text, progress=progress)
        stage.finish({"frames": len(scene)}, since=since)
    rig = load_rig(out / "recording" / "rig.toml")
    recording = open_recording(out / "recording" / "frames", wavelength=rig.wavelength)
    motion = ConstantSpeed(_SPEED, rig.lasers[0].axis)
    project = scan(recording, rig, motion, out=out / "scan", progress=progress)
    points = project.load_cloud().points
    compared = points[:: max(len(points) // _COMPARED, 1)]
    truth = load_mesh(out / "recording" / "truth" / "mesh.ply")
    return project, Errors.from_distances(distance_to_mesh(compared, truth, within=FALSE))
