"""A profile plotted
=================

One frame's profile with the interval that holds it in 95 of 100 cases, drawn by matplotlib.

The scan is that of example 01; of your own, take ``ms.Project("dive")``.
"""

from importlib import import_module

import matplotlib.pyplot as plt
import numpy as np

project = import_module("01_scan_a_recording").project

profiles = project.load_profile()
number = int(np.median(profiles.frame))
profile = profiles[profiles.frame == number]
x, depth = 1e3 * profile.points[:, 0], 1e3 * profile.points[:, 2]
half = 1.96e3 * profile.sigma

figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
axes.fill_between(x, depth - half, depth + half, alpha=0.3, label="95 %, its own noise")
axes.plot(x, depth, ".", markersize=2, label=f"frame {number}")
axes.invert_yaxis()  # nearer is higher
axes.set(xlabel="x, to the right [mm]", ylabel="z, from the camera [mm]")
axes.legend(frameon=False)

print(f"{len(profile)} points, {np.ptp(depth):.1f} mm deep, ± {np.median(half):.2f} mm")
