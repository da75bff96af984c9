"""What is said of a recording's light: what it shows, and nothing of what cannot be told."""

import numpy as np
import pytest

from murkscan.extract.remarks import find_remarks
from murkscan.types.background import Noise
from murkscan.types.frame import Frame
from murkscan.types.stripe import Stripe

HEIGHT, WIDTH, COUNT = 40, 60, 12


def remarks(glow):
    """Give what is said of frames that show this much of one pattern of glow each."""
    pattern = np.random.default_rng(4).uniform(20, 60, (HEIGHT, WIDTH))
    frames = [Frame(np.zeros((HEIGHT, WIDTH), np.uint8), k, 0.04 * k) for k in range(COUNT)]
    seen = [(pattern * share).astype(np.float32) for share in glow]
    return find_remarks(frames, [Stripe.empty()] * COUNT, seen, Noise(4.0, 0.1, 255.0))


def test_an_exposure_that_moves_is_told():
    said = remarks(np.where(np.arange(COUNT) % 2, 1.0, 3.0))
    assert any("fix exposure and gain" in one for one in said)


@pytest.mark.filterwarnings("error")
def test_frames_without_any_glow_are_no_other_exposure():
    said = remarks(np.where(np.arange(COUNT) < 3, 0.0, 1.0))
    assert not any("factor" in one for one in said)
