"""Laws of the keys of rows."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from murkscan.geometry.row_keys import row_keys


@pytest.mark.parametrize("most", [3, 2**40])
@given(data=st.data())
def test_keys_are_equal_and_in_order_as_the_rows_are(most, data):
    shape = data.draw(st.tuples(st.integers(0, 20), st.integers(1, 3)))
    rows = data.draw(arrays(np.int64, shape, elements=st.integers(-most, most)))
    keys = row_keys(rows)
    wanted = np.unique(rows, axis=0, return_inverse=True)[1].ravel()
    assert np.array_equal(np.unique(keys, return_inverse=True)[1].ravel(), wanted)
