"""Two lasers instead of a steady hand
====================================

A vehicle that holds neither speed nor distance, with no log at all but "about 0.1 m/s".

Two lines see every place twice, a second apart, which says how the vehicle moved in between. These
are the first stages of `murkscan scan`, which does it by itself.
"""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

import murkscan as ms
from murkscan.simulate import load_scene
from murkscan.survey.extract import extract_recording
from murkscan.survey.motion import follow_motion
from murkscan.survey.scan import begin_scan
from murkscan.survey.simulate import simulate_recording
from murkscan.survey.triangulate import triangulate_stripes

folder = Path(tempfile.mkdtemp())
scene = load_scene("two-lasers")
scene = replace(scene, times=scene.times[:64])
simulate_recording(scene, folder / "dive")

rig = ms.load_rig(folder / "dive" / "rig.toml")
recording = ms.open_recording(folder / "dive" / "frames")
project, about = ms.Project(folder / "scan"), ms.ConstantSpeed(0.1, "y", sigma=0.1)
begin_scan(project, recording, rig, settings={})
extract_recording(project, recording, rig, ms.Murk())
triangulate_stripes(project, rig, ms.RaySheet())

profile = project.load_profile()
middle = (np.abs(profile.pixels[:, 0] - 180) < 0.5) & (profile.laser == 0)
ends = profile[np.flatnonzero(middle)[[0, -1]]]


def length(trajectory):
    """Give how far the two ends of the scan lie apart on the plate [mm]."""
    return 1e3 * np.linalg.norm(np.diff(trajectory.transform(ends.points, ends.time), axis=0))


for adjust in (False, True):
    result = follow_motion(project, about, adjust=adjust)
    name = "corrected by what both lines saw" if adjust else "as the log has it"
    print(f"{name}: the ends lie {length(project.load_trajectory()):.1f} mm apart")
print(f"truly they lie {length(scene.trajectory):.1f} mm apart")
print("\n".join(result.correction))
