"""What is packed for the page comes out again, as finely as is said."""

import base64
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from murkscan.view.packing import NO_VALUE, pack, pack_moves, pack_positions, pack_values


def unpack(text, count, columns, width):
    """Read it as the page's script does."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8).astype(np.int64)
    planes = planes.reshape(columns, width, count)
    folded = sum(planes[:, weight] << (8 * weight) for weight in range(width))
    steps = np.where(folded % 2 == 1, -(folded + 1) // 2, folded // 2)
    return np.cumsum(steps, axis=1).T % (1 << (8 * width))


@given(st.data(), st.integers(1, 4))
def test_whole_numbers_come_back(data, width):
    numbers = st.integers(0, 256**width - 1)
    shape = st.tuples(st.integers(1, 30), st.integers(1, 3))
    codes = data.draw(hnp.arrays(np.int64, shape, elements=numbers))
    np.testing.assert_array_equal(unpack(pack(codes, width), *codes.shape, width), codes)


@pytest.mark.parametrize("extent", [1e-4, 0.3, 5.0, 200.0])
@pytest.mark.parametrize("sigma", [0.0, 1e-5, 1e-3])
def test_positions_are_off_by_less_than_a_tenth_of_sigma(extent, sigma):
    points = np.random.default_rng(1).uniform(0, extent, (500, 3)) + np.array([5e5, -4e6, -30.0])
    packed = pack_positions(points, np.full(500, sigma))
    codes = unpack(packed.text, 500, 3, packed.num_bytes)
    off = np.abs(np.array(packed.low) + codes * packed.step - points).max()
    # Doubles at four thousand kilometres are good to a nanometre.
    allowed = max(min(2e-5, 0.1 * sigma) if sigma else 2e-5, extent / 256**3)
    assert off <= allowed + 2e-9


def test_one_point_is_a_place_too():
    packed = pack_positions(np.array([[1.0, 2.0, 3.0]]), np.zeros(1))
    assert packed.low == (1.0, 2.0, 3.0)
    np.testing.assert_array_equal(unpack(packed.text, 1, 3, packed.num_bytes), 0)


@pytest.mark.parametrize("extent", [0.3, 200.0])
def test_moved_places_are_as_exact_as_the_positions(extent):
    random = np.random.default_rng(2)
    points = random.uniform(0, extent, (500, 3))
    to = points + 3e-3 * random.standard_normal((500, 3))
    grid = pack_positions(points, np.full(500, 1e-3))
    text, least = pack_moves(points, to, grid)
    steps = unpack(text, 500, 3, grid.num_bytes + 1) + least
    places = np.array(grid.low) + (grid.codes_of(points) + steps) * grid.step
    assert np.abs(places - to).max() <= grid.step / 2 * (1 + 1e-9)
    assert pack_moves(points, points, grid) is None


def test_what_is_not_known_stays_unknown():
    values = np.array([3.0, np.nan, -2.0, np.inf])
    text, low, step = pack_values(values)
    codes = unpack(text, 4, 1, 2)[:, 0]
    np.testing.assert_allclose(low + codes[[0, 2]] * step, [3.0, -2.0], atol=step / 2)
    np.testing.assert_array_equal(codes[[1, 3]], NO_VALUE)


@pytest.mark.parametrize("value", [0.0, -7.5, np.nan])
def test_values_that_are_all_alike_are_kept(value):
    text, low, step = pack_values(np.full(3, value))
    codes = unpack(text, 3, 1, 2)[:, 0]
    assert np.isnan(value) == (codes == NO_VALUE).all()
    if np.isfinite(value):
        np.testing.assert_array_equal(low + codes * step, value)
