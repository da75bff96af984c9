"""Accept a scan
=============

Hold a scanned ball bar against the limits that a client states: passed, failed or undecided.

The scan is made up here: two balls of 80 mm, 400 mm apart, with noise of 0.1 mm a point; of a real
one, `murkscan accept dive --test acceptance.toml` does the same, and writes a page to sign.
"""

import numpy as np

import murkscan as ms
from murkscan.accept import Finding
from murkscan.measure import Sample, find_ball, measure_spacing

RADIUS, APART, NOISE = 0.04, 0.4, 1e-4

profile, line = np.divmod(np.arange(36 * 120), 120)
x, y = 5e-4 * (line - 59.5), 1.8e-3 * (profile - 17.5)  # 0.5 mm along the stripe, 1.8 mm across
top = np.hypot(x, y) < 0.8 * RADIUS
out = np.stack([x, y, -np.sqrt(np.maximum(RADIUS**2 - x**2 - y**2, 0))], axis=1)[top] / RADIUS
random = np.random.default_rng(0)
balls = [
    out * (RADIUS + NOISE * random.standard_normal((len(out), 1))) + [side * APART / 2, 0.0, 0.9]
    for side in (-1, 1)
]

count = 2 * len(out)
one = np.ones(count, np.float32)
cloud = ms.PointCloud(
    points=np.concatenate(balls),
    normals=np.tile(out, (2, 1)).astype(np.float32),
    signal=100 * one,
    posterior=one,
    sigma=NOISE * one,
    sigma_common=0 * one,
    frame=np.tile(profile[top], 2).astype(np.int32),
    scan_line=np.concatenate([line[top], line[top] + 800]).astype(np.int32),
    laser=np.zeros(count, np.uint8),
    branch=np.zeros(count, np.uint8),
)

sample = Sample.from_cloud(cloud)
near = [np.array([side * APART / 2, 0.0, 0.865]) for side in (-1, 1)]  # read off the cloud
first, second = (find_ball(sample, place, RADIUS) for place in near)
for what, known, sigma, measured, limit in (
    ("probing size", 2 * RADIUS, 2e-6, first.diameter, 1e-4),
    ("probing form", 0.0, 0.0, first.form, 3e-4),
    ("sphere spacing", APART, 3e-6, measure_spacing(first, second), 1e-5),
):
    found = Finding(what, "the bar", known, sigma, measured, limit)
    print(
        f"{what}: error {1e3 * found.error:.3f} ± {1e3 * found.half_width:.3f} mm, "
        f"limit {1e3 * limit:g} mm: {found.decision.value}"
    )
