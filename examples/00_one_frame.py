"""One picture
===========

Find the stripe in one picture, and turn it into points.

Everything here is a value: a rig, a frame, a stripe, a profile.
"""

# sphinx_gallery_thumbnail_path = "ship/frame.png"

import math

import numpy as np

import murkscan as ms
from murkscan.triangulate import triangulate

camera = ms.Camera(size=(720, 576), focal_length=(554.0, 554.0), principal_point=(359.5, 287.5))
laser = ms.Laser.from_baseline_angle(baseline=0.25, angle=math.radians(63.4), axis="y")
rig = ms.Rig(camera, (laser,))

# A picture of a flat wall that leans a little: a bright, slightly slanted line.
rows = np.arange(576)[:, None]
centre = 287.5 + 0.02 * np.arange(720)
image = np.rint(5 + 200 * np.exp(-0.5 * ((rows - centre) / 2) ** 2)).astype(np.uint8)
frame = ms.Frame(image, index=0, time=0.0)

extractor = ms.GrayGravity()
background = extractor.learn([frame], rig)
stripe = next(extractor.extract([frame], rig, background))
print(f"{len(stripe)} centres, sigma {np.median(stripe.sigma):.3f} px")

profile = triangulate(stripe, rig, ms.RaySheet())
near, far = profile.points[:, 2].min(), profile.points[:, 2].max()
print(f"{len(profile)} points from {near * 1e3:.1f} to {far * 1e3:.1f} mm before the camera,")
print(f"each known to {np.median(profile.sigma) * 1e6:.0f} µm along its ray")
