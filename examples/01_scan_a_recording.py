"""A whole scan
============

The main path of the package, on a recording that is simulated first.

Later examples look at this scan. It lies in the folder for temporary files, and is made once: what
is done and unchanged is skipped.
"""

# sphinx_gallery_thumbnail_path = "view.png"

from dataclasses import replace
from pathlib import Path
from tempfile import gettempdir

import murkscan as ms
from murkscan.simulate import load_scene
from murkscan.survey.simulate import simulate_recording

folder = Path(gettempdir()) / "murkscan-examples"
if not (folder / "recording" / "truth" / "mesh.ply").exists():
    scene = load_scene("sphere-c0.3")
    simulate_recording(replace(scene, times=scene.times[88:112]), folder / "recording")

# From here on as with a recording of your own.
rig = ms.load_rig(folder / "recording" / "rig.toml")
recording = ms.open_recording(folder / "recording" / "frames", wavelength=rig.wavelength)
motion = ms.PoseLog(ms.load_poses(folder / "recording" / "poses.csv"))
project = ms.scan(recording, rig, motion, out=folder / "scan")
cloud, mesh = project.load_cloud(), project.load_mesh()

if __name__ == "__main__":
    print(f"{len(cloud)} points, {len(mesh.faces)} triangles")
    print(f"open {project.root / 'report' / 'index.html'}")
