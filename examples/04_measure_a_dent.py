"""A dent
======

Find a dent in a scanned hull, and say how deep it is, and how sure that is.

The scan is made up here, with a dent of 2 mm and noise of 0.15 mm a point; of a real one, take
`ms.Project("dive").load_cloud()`, or `murkscan measure dive dents`.
"""

# sphinx_gallery_thumbnail_path = "ship/dome.png"

import numpy as np

import murkscan as ms
from murkscan.measure import Sample, deviation_from_smooth, find_dents

profile, line = np.divmod(np.arange(90 * 300), 300)
x, y = (
    6e-4 * (line - 150),
    2e-3 * (profile - 45),
)  # 0.6 mm along the stripe, 2 mm from it to the next
away = np.hypot(x - 0.02, y + 0.01) / 0.03
dent = np.where(away < 1, 2e-3 * (1 + np.cos(np.pi * away)) / 2, 0.0)
hull = 0.8 + x**2 / 1.2 + y**2 / 5
z = hull + dent + 1.5e-4 * np.random.default_rng(0).standard_normal(len(x))

count, one = len(x), np.ones(len(x), np.float32)
cloud = ms.PointCloud(
    points=np.stack([x, y, z], axis=1),
    normals=np.tile(np.array([0, 0, -1], np.float32), (count, 1)),
    signal=100 * one,
    posterior=one,
    sigma=1.5e-4 * one,
    sigma_common=0 * one,
    frame=profile.astype(np.int32),
    scan_line=line.astype(np.int32),
    laser=np.zeros(count, np.uint8),
    branch=np.zeros(count, np.uint8),
)

sample = Sample.from_cloud(cloud)
search = find_dents(sample, deviation_from_smooth(sample, largest=0.15), smallest=0.02)
print(f"what departs by more than {search.threshold * 1e3:.2f} mm is told")
for found in search.dents:
    low, high = (1e3 * end for end in found.depth.interval)
    x_mm, y_mm, _ = 1e3 * found.place
    print(
        f"dent at x {x_mm:.1f}, y {y_mm:.1f} mm: {low:.2f} to {high:.2f} mm deep, "
        f"{found.diameter.value * 1e3:.0f} mm wide, {found.volume.value * 1e6:.1f} cm³"
    )
