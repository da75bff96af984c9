"""Which extractor? Hold each against the true centres of a simulated recording."""

import numpy as np

import murkscan as ms
from murkscan.simulate import hull_scene, simulate_frames

scene = hull_scene(num_frames=40, noise=2.5)
made = [one for one in simulate_frames(scene) if len(one.stripe)]

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
