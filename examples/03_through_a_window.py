"""Through a window
================

A camera behind a flat window in water: the same pixels, other points.

A rig calibrated in air keeps its lens; the window and the water are written down beside it.
"""

import math
from dataclasses import replace

import numpy as np

import murkscan as ms
from murkscan.types.port import FlatPort, Layer
from murkscan.types.water import Water

camera = ms.Camera((1920, 1200), (1400.0, 1400.0), (959.5, 599.5))
in_air = ms.Rig(camera, (ms.Laser.from_baseline_angle(0.25, math.radians(76), "y"),))

window = FlatPort(np.array([0.0, 0.0, 1.0]), 0.02, (Layer(0.01, 1.49),))
in_sea = replace(in_air, camera=replace(camera, port=window), water=Water(salinity_psu=35.0))
in_lake = replace(in_sea, water=Water(salinity_psu=0.0))

pixels = np.array([[960.0, 500.0], [960.0, 600.0], [960.0, 700.0]])
for name, rig in (("air", in_air), ("sea", in_sea), ("lake", in_lake)):
    depths = ms.RaySheet().locate(pixels, rig, 0)[:, 2]
    print(f"{name:5}", "  ".join(f"{depth * 1e3:7.1f} mm" for depth in depths))
