"""Values as plain numbers and texts, and back."""

from dataclasses import dataclass, field, replace
from datetime import UTC, datetime

import numpy as np
import pytest
from jaxtyping import Float32

from murkscan.errors import FormatError
from murkscan.io.values import as_plain, from_plain, load_value, save_value
from murkscan.types.background import (
    Attenuation,
    Background,
    FixedPattern,
    Noise,
    Search,
    StripeShape,
)


@dataclass(frozen=True, eq=False)
class Learnt:
    """What an extractor may come to keep: arrays, values in values, and none of them."""

    ghost: Float32[np.ndarray, "h w"]
    shape: StripeShape | None
    names: tuple[str, ...]
    length: float = field(default=0.0, metadata={"unit": "m"})
    ghosts: tuple[Float32[np.ndarray, "h w"], ...] = ()
    when: datetime | None = None
    counts: dict[str, int] = field(default_factory=dict)


LEARNT = Learnt(
    np.arange(12, dtype=np.float32).reshape(3, 4) / 7,
    StripeShape(2.0, 0.1, 1, 1.0, 0.0),
    ("a", "b"),
    length=1.5,
    ghosts=(np.zeros((0, 2), np.float32), np.full((1, 1), np.nan, np.float32)),
    when=datetime(2026, 5, 1, tzinfo=UTC),
    counts={"snow": 3},
)


def test_a_value_comes_back_as_it_was(tmp_path):
    save_value(tmp_path / "a.json", LEARNT)
    back = load_value(tmp_path / "a.json", Learnt)
    np.testing.assert_array_equal(back.ghost, LEARNT.ghost)
    assert back.ghost.dtype == np.float32
    for one, other in zip(back.ghosts, LEARNT.ghosts, strict=True):
        np.testing.assert_array_equal(one, other)
    same = {"ghost": None, "ghosts": ()}
    assert vars(replace(back, **same)) == vars(replace(LEARNT, **same))


def test_what_an_extractor_has_learnt_comes_back(tmp_path):
    noise = Noise(1.0, 0.1, 255.0)
    shape = StripeShape(2.0, 0.1, 1, 1.0, 0.0, noise)
    pattern = FixedPattern(1, np.eye(3, dtype=np.float32), np.eye(3) > 0)
    water = Attenuation(1.0, 0.5, 2.0)
    rates, stays = np.linspace(0.1, 0.01, 5), np.linspace(0.2, 0.9, 5)
    deep = Search(1.5, 32, 5)
    learnt = Background(1.5, noise, (shape, shape), rates, stays, deep, (pattern,), water, ("odd",))
    save_value(tmp_path / "a.json", learnt)
    back = load_value(tmp_path / "a.json", Background)
    np.testing.assert_array_equal(back.rates, learnt.rates)
    np.testing.assert_array_equal(back.stays, learnt.stays)
    (same,) = back.fixed
    np.testing.assert_array_equal(same.levels, pattern.levels)
    np.testing.assert_array_equal(same.overlay, pattern.overlay)
    assert same.first_row == pattern.first_row
    for name in ("noise", "levels", "shapes", "search", "attenuation", "remarks"):
        assert getattr(back, name) == getattr(learnt, name)


def test_a_unit_stands_in_the_key():
    assert as_plain(LEARNT)["length_m"] == 1.5


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("ghost", None),
        ("ghost", {"dtype": "<f4", "shape": [3, 4], "zlib": "AAAA"}),
        ("ghost", as_plain(np.zeros((3, 4)))),
        ("ghost", as_plain(np.zeros(3, np.float32))),
        ("ghost", as_plain(np.zeros((3, 4), np.float32)) | {"shape": [5, 5]}),
        ("ghost", as_plain(np.zeros((3, 4), np.float32)) | {"dtype": "O"}),
        ("shape", {"width": 2.0}),
        ("shape", []),
        ("names", ["a", 7]),
        ("names", "ab"),
        ("length_m", "long"),
        ("length_m", True),
        ("when", "2026-77-01"),
        ("when", 2026),
        ("counts", {"snow": 1.5}),
    ],
)
def test_an_odd_value_is_one_sentence_that_names_the_file(key, value):
    with pytest.raises(FormatError, match=r"^a\.json is damaged: it has .* Delete it and run"):
        from_plain(Learnt, as_plain(LEARNT) | {key: value}, name="a.json")


def test_a_lost_key_is_named_and_one_of_a_later_version_is_left_out():
    plain = as_plain(LEARNT)
    from_plain(Learnt, plain | {"later": 1}, name="a.json")
    del plain["names"]
    with pytest.raises(FormatError, match="it has no names"):
        from_plain(Learnt, plain, name="a.json")
