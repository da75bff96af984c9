import numpy as np
import pytest

from murkscan.report.trust import judge_trust


def test_both_parts_add_as_squares():
    trust = judge_trust(np.full(2, 3e-3), np.full(2, 4e-3), is_stated=True)
    assert trust.total.median == pytest.approx(5e-3)
    assert trust.common.median == pytest.approx(4e-3)


def test_what_nobody_states_is_an_unknown_common_part_not_a_zero_one():
    assert judge_trust(np.array([1e-3]), np.zeros(1), is_stated=False).common is None
