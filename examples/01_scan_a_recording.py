"""A whole scan
============

The main path of the package, on a recording that is simulated first.
"""

from dataclasses import replace
from pathlib import Path
from tempfile import mkdtemp

import murkscan as ms
from murkscan.simulate import load_scene
from murkscan.survey.simulate import simulate_recording

folder = Path(mkdtemp(prefix="murkscan-"))
scene = load_scene("sphere-c0.3")
simulate_recording(replace(scene, times=scene.times[60:140]), folder / "recording")

# From here on as with a recording of your own.
rig = ms.load_rig(folder / "recording" / "rig.toml")
recording = ms.open_recording(folder / "recording" / "frames", wavelength=rig.wavelength)
motion = ms.ConstantSpeed(0.1, along=rig.lasers[0].axis)
project = ms.scan(recording, rig, motion, out=folder / "scan")
cloud, mesh = project.load_cloud(), project.load_mesh()

print(f"{len(cloud)} points, {len(mesh.faces)} triangles")
print(f"open {project.root / 'report' / 'index.html'}")
