"""How exactly each extractor finds the centre of a synthetic stripe, beside the limit of noise."""

import math

import numpy as np
from harness import Figure, tell

from murkscan.extract import (
    AbstractExtractor,
    GaussianFit,
    GrayGravity,
    Steger,
    ThresholdSkeleton,
)
from murkscan.types.camera import Camera
from murkscan.types.frame import Frame
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig

SIZE = (2000, 200)
"""Pixels along the stripe and across it."""
RIG = Rig(
    Camera(SIZE, (1000.0, 1000.0), (1000.0, 100.0)), (Laser.from_baseline_angle(0.2, 1.1, "y"),)
)
CENTRES = 90.3 + 0.01 * np.arange(SIZE[0])
PEAK = 200.0
FRAMES = 10
EXTRACTORS: dict[AbstractExtractor, float | None] = {
    GrayGravity(): 0.08,
    GaussianFit(): 0.05,
    Steger(): 0.05,
    ThresholdSkeleton(): None,
}
"""Extractors, and their bars at a width of 2 px and noise of 1 %."""


def draw(width: float, noise: float, seed: int) -> Frame:
    """Draw a slightly slanted Gaussian stripe in white noise."""
    across = np.arange(SIZE[1])[:, None]
    light = 10 + PEAK * np.exp(-0.5 * ((across - CENTRES) / width) ** 2)
    light = light + noise * np.random.default_rng(seed).standard_normal(light.shape)
    return Frame(np.clip(np.rint(light), 0, 255).astype(np.uint8), seed, float(seed))


def measure(extractor: AbstractExtractor, width: float, noise: float) -> tuple[float, float]:
    """Give the RMS error [px], and the share of errors within their sigma."""
    frames = [draw(width, noise, seed) for seed in range(FRAMES)]
    background = extractor.learn(frames, RIG)
    errors, sigmas = [], []
    for stripe in extractor.extract(frames, RIG, background):
        first = stripe[stripe.branch == 0]
        errors.append(first.pixels[:, 1] - CENTRES[first.pixels[:, 0].astype(int)])
        sigmas.append(first.sigma)
    error, sigma = np.concatenate(errors), np.concatenate(sigmas)
    return float(np.sqrt(np.mean(error**2))), float(np.mean(np.abs(error) < sigma))


def main() -> None:
    figures = []
    for percent in (1.0, 3.0):
        noise = 2.55 * percent
        for width in (1.0, 2.0, 4.0):
            case = f"width {width:g} px, noise {percent:g} %"
            bound = 1.062 * math.sqrt(width) * noise / PEAK
            figures.append(Figure(f"{case}: bound of one scan line", bound, "px"))
            for extractor, bar in EXTRACTORS.items():
                name = type(extractor).__name__
                rms, within = measure(extractor, width, noise)
                is_the_case = percent == 1 and width == 2
                bar = bar if is_the_case else None
                figures.append(Figure(f"{case}: {name}", rms, "px RMS", at_most=bar))
                if is_the_case:
                    figures.append(Figure(f"{case}: {name}, errors within sigma", within))
    tell(
        "stripe_accuracy",
        "Centres of a synthetic stripe",
        figures,
        note="A Gaussian stripe of peak 200 in white noise, 8 bit, 20 000 scan lines a case. The "
        "bound is Cramér and Rao's for one scan line, 1.062 · √w · s / A; Steger's filter averages "
        "over neighbouring scan lines, so it may pass below it on a straight stripe. Published, "
        "for comparison: 0.047 px at 1 % noise, 0.081 px at 3 % (Su et al. 2024).",
    )


if __name__ == "__main__":
    main()
