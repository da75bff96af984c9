"""An extractor of one's own that gives nonsense is refused with its name and the fault."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.extract import AbstractExtractor, GrayGravity, check_stripes, require_extractor
from murkscan.types.frame import Frame
from murkscan.types.stripe import Stripe

SIZE = (40, 30)
FRAMES = [Frame(np.zeros((30, 40), np.uint8), index=index, time=index / 10) for index in (3, 4)]


def stripe(frame, count=5):
    return Stripe(
        frame=np.full(count, frame.index, np.uint32),
        time=np.full(count, frame.time),
        pixels=np.stack([np.arange(float(count)), np.full(count, 7.0)], axis=1),
        sigma=np.full(count, 0.1, np.float32),
        signal=np.full(count, 50, np.float32),
        posterior=np.ones(count, np.float32),
        laser=np.zeros(count, np.uint8),
        branch=np.zeros(count, np.uint8),
    )


def check(stripes):
    return list(check_stripes(GrayGravity(), stripes, FRAMES, size=SIZE, laser=0))


def test_sound_stripes_pass_as_they_are():
    given = [stripe(FRAMES[0]), Stripe.empty()]
    passed = check(given)
    assert [len(one) for one in passed] == [5, 0]
    np.testing.assert_array_equal(passed[0].pixels, given[0].pixels)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"pixels": np.full((5, 2), 35.0)}, "outside of the picture of 40 × 30 px"),
        ({"pixels": np.full((5, 2), np.nan)}, "pixels that is no finite number"),
        ({"frame": np.full(5, 4, np.uint32)}, "another frame"),
        ({"time": np.zeros(5)}, "another time"),
        ({"laser": np.ones(5, np.uint8)}, "another laser"),
        ({"sigma": np.zeros(5, np.float32)}, "sigma that is not above 0"),
        ({"posterior": np.full(5, 2, np.float32)}, "no probability"),
    ],
)
def test_what_cannot_be_is_refused(change, says):
    with pytest.raises(InputError, match=f"GrayGravity: what it gave for frame 3 .*{says}"):
        check([replace(stripe(FRAMES[0]), **change), Stripe.empty()])


@pytest.mark.parametrize(("count", "says"), [(0, "gave 0"), (1, "gave 1"), (3, "gave more")])
def test_it_gives_one_stripe_a_frame(count, says):
    with pytest.raises(InputError, match=says):
        check([Stripe.empty()] * count)


class Plain(AbstractExtractor):
    def extract(self, frames, rig, background, *, laser=0):
        return iter(())


def test_its_settings_are_fields():
    require_extractor(GrayGravity())
    with pytest.raises(InputError, match="Plain must be a dataclass"):
        require_extractor(Plain())
