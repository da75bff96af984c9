"""Plan a dive
===========

What a rig will see before it is lowered: how far, how well, and how fast it may go.

How far a diver sees is enough to say how murky the water is.
"""

import math

import numpy as np

import murkscan as ms
from murkscan.optics.medium import Medium
from murkscan.plan import Conditions, attenuation_from_visibility, forecast

camera = ms.Camera(size=(1920, 1200), focal_length=(1400.0, 1400.0), principal_point=(959.5, 599.5))
laser = ms.Laser.from_baseline_angle(baseline=0.3, angle=math.radians(70), axis="y")
rig = ms.Rig(camera, (laser,))

for visibility in (8.0, 4.0, 2.0, 1.0):
    water = Medium(attenuation_from_visibility(visibility))
    seen = forecast(rig, Conditions(water), depths=np.geomspace(0.4, 4.0, 24))
    near, far = seen.reach
    sigma = seen.median(seen.sigma_along)
    middle = int(np.argmin(np.abs(seen.depths - (near + far) / 2)))
    print(
        f"a diver sees {visibility:g} m: the rig sees from {near:.2f} to {far:.2f} m; "
        f"{seen.depths[middle]:.2f} m away a point is good to {sigma[middle] * 1e3:.2f} mm"
    )

spacing, rate = 0.002, 25.0
print(f"profiles 2 mm apart at 25 frames a second: no faster than {1e3 * spacing * rate:.0f} mm/s")
