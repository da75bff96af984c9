"""Which extractor? Hold each against the true centres of a recording in murky water."""

import numpy as np

import murkscan as ms
from murkscan.simulate import load_scene, simulate_frames

scene = load_scene("hull-c3")
made = list(simulate_frames(scene, 300, 312))
frames = [one.frame for one in made]
finders = (ms.Murk(), ms.GrayGravity(), ms.GaussianFit(), ms.Steger(), ms.ThresholdSkeleton())

for extractor in finders:
    background = extractor.learn(frames, scene.rig)
    errors, given, there = [], 0, 0
    for one, stripe in zip(made, extractor.extract(frames, scene.rig, background), strict=True):
        seen = one.stripe[one.stripe.crlb <= 0.5]
        truth = dict(zip(seen.pixels[:, 0].astype(int), seen.pixels[:, 1], strict=True))
        columns = stripe.pixels[:, 0].astype(int)
        error = np.array(
            [v - truth.get(u, np.inf) for u, v in zip(columns, stripe.pixels[:, 1], strict=True)]
        )
        errors.append(error[np.abs(error) < 1.5])
        given, there = given + len(stripe), there + len(truth)
    right = np.concatenate(errors)
    print(
        f"{type(extractor).__name__:18} {len(right) / there:6.1%} of the visible centres found, "
        f"{given - len(right):5} other points, RMS {np.sqrt(np.mean(right**2)):.3f} px"
    )
