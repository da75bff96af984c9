"""Which extractor?
================

Hold each finder against the true centres of a recording in murky water.
"""

# sphinx_gallery_thumbnail_path = "benchmarks/murk.png"

import numpy as np

import murkscan as ms
from murkscan.simulate import load_scene, simulate_frames

scene = load_scene("hull-c3")
made = list(simulate_frames(scene, 300, 312))
frames = [one.frame for one in made]
finders = (ms.Murk(), ms.GrayGravity(), ms.GaussianFit(), ms.Steger(), ms.ThresholdSkeleton())

for extractor in finders:
    background = extractor.learn(frames, scene.rig)
    errors, given, found, there = [], 0, 0, 0
    for one, stripe in zip(made, extractor.extract(frames, scene.rig, background), strict=True):
        columns = one.stripe.pixels[:, 0].astype(int)
        truth = np.full(720, np.inf)
        truth[columns] = one.stripe.pixels[:, 1]
        visible = np.zeros(720, bool)
        visible[columns] = one.stripe.crlb <= 0.5  # a single scan line places it to half a pixel
        column = stripe.pixels[:, 0].astype(int)
        error = stripe.pixels[:, 1] - truth[column]
        right = np.abs(error) < 1.5
        errors.append(error[right & visible[column]])
        given, found = given + len(stripe), found + right.sum()
        there += visible.sum()
    seen = np.concatenate(errors)
    print(
        f"{type(extractor).__name__:18} {len(seen) / there:6.1%} of the visible centres found, "
        f"RMS {np.sqrt(np.mean(seen**2)):.3f} px; {1 - found / given:5.1%} of all points are false"
    )
