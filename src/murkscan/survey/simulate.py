"""Write a simulated recording, its rig and its truth."""

from pathlib import Path

import numpy as np

from ..io.images import write_image
from ..io.mesh_files import save_mesh
from ..io.parquet import save_true_stripe
from ..io.poses import save_poses
from ..io.rig_toml import save_rig
from ..io.times_csv import write_times
from ..simulate import Scene, sample_mesh, simulate_frames
from ..types.true_stripe import TrueStripe
from .progress import Progress, silent

_MESH_SPACING = 0.002
"""Spacing of the truth's mesh [m]: fine enough to look at; distances are taken to the surface."""


def simulate_recording(scene: Scene, out: Path, *, progress: Progress = silent) -> None:
    """Write frames/ with their times, rig.toml, poses.csv, and truth/ with stripes and mesh.

    Args:
        scene: What is recorded, by which rig, along which way.
        out: The folder; files that are there are replaced.
        progress: Told of each frame.

    Raises:
        DeviceError: The disk is full.
    """
    times: dict[str, float] = {}
    stripes: list[TrueStripe] = []
    for simulated in simulate_frames(scene):
        name = f"{simulated.frame.index:06d}.png"
        write_image(out / "frames" / name, simulated.frame.image)
        times[name] = simulated.frame.time
        stripes.append(simulated.stripe)
        progress("simulate", len(times), len(scene.times))
    write_times(out / "frames" / "times.csv", times)
    save_rig(out / "rig.toml", scene.rig)
    save_poses(out / "poses.csv", scene.trajectory.at(np.asarray(scene.times)))
    save_true_stripe(out / "truth" / "stripes.parquet", TrueStripe.concatenate(stripes))
    save_mesh(out / "truth" / "mesh.ply", sample_mesh(scene.surface, spacing=_MESH_SPACING))
