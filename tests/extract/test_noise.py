"""The noise that is learnt is the one by which a filter's answer scatters."""

import numpy as np
import pytest

from murkscan.capture import LaserColour
from murkscan.extract.matched_filter import MatchedFilter
from murkscan.extract.noise import learn_levels
from murkscan.simulate import as_colour

HEIGHT, WIDTH = 240, 320


def even_wall(seed, kind):
    """Draw a grey wall in a gradient of light, as a camera with or without a mosaic shows it."""
    light = np.linspace(40, 120, WIDTH)[None, :] + np.zeros((HEIGHT, 1))
    scatter = np.sqrt(1.0 + 0.04 * light)
    raw = light + scatter * np.random.default_rng(seed).standard_normal(light.shape)
    raw = np.clip(np.rint(raw), 0, 255).astype(np.uint8)
    return raw if kind == "mono" else LaserColour.mean(532e-9).grey(as_colour(raw, "rggb"))


@pytest.mark.parametrize("kind", ["mono", "mosaic"])
def test_a_filter_answers_noise_alone_by_one_standard_deviation(kind):
    images = [even_wall(seed, kind) for seed in range(6)]
    noise = learn_levels(images)
    template = MatchedFilter.of(1.5, noise).template
    half = len(template) // 2
    answers = np.apply_along_axis(np.convolve, 0, images[0].astype(float), template, "valid")
    level = images[0].astype(float)[half:-half]
    scores = answers / np.sqrt(noise.variance(level))
    # Grey from a mosaic mixes noise over some pixels: no single variance suits every filter.
    assert scores.std() == pytest.approx(1.0, rel=0.05 if kind == "mono" else 0.25)


@pytest.mark.parametrize("block", [1, 8])
def test_an_encoder_that_left_nearly_nothing_is_told_from_a_sensor_that_has_little_noise(block):
    rng = np.random.default_rng(0)
    shape = HEIGHT // block, WIDTH // block
    # 1 of 20 pixels, or of an encoder's blocks, is a level brighter than the rest.
    levels = np.kron(20 + (rng.random(shape) < 0.05), np.ones((block, block))).astype(np.uint8)
    noise = learn_levels([levels])
    assert noise.smoothed == (block > 1)
    # What an encoder leaves are steps of a level, which look like stripes to a filter.
    assert noise.variance(np.array([20.0]))[0] == pytest.approx(1.0 if block > 1 else 0.1, rel=0.2)
