"""Which extractor? Hold each against the true centres of a simulated recording."""

import numpy as np

import murkscan as ms
from murkscan.simulate import load_scene, simulate_frames

scene = load_scene("hull-c0.3")
made = list(simulate_frames(scene, 300, 312))

for extractor in (ms.GrayGravity(), ms.GaussianFit(), ms.Steger(), ms.ThresholdSkeleton()):
    background = extractor.learn([one.frame for one in made], scene.rig)
    errors, found, there = [], 0, 0
    for one in made:
        stripe = next(extractor.extract([one.frame], scene.rig, background))
        truth = dict(zip(one.stripe.pixels[:, 0].astype(int), one.stripe.pixels[:, 1], strict=True))
        columns = stripe.pixels[:, 0].astype(int)
        error = np.array(
            [v - truth.get(u, np.inf) for u, v in zip(columns, stripe.pixels[:, 1], strict=True)]
        )
        near = np.abs(error) < 1.5
        errors.append(error[near])
        found, there = found + near.sum(), there + len(truth)
    rms = np.sqrt(np.mean(np.concatenate(errors) ** 2))
    print(f"{type(extractor).__name__:18} {found / there:6.1%} found, RMS {rms:.3f} px")
