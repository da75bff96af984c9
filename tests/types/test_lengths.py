"""Lengths in words."""

import pytest

from murkscan.types.lengths import in_mm


@pytest.mark.parametrize(
    ("length", "told"),
    [(0.13, "130"), (0.1284, "128"), (0.0996, "100"), (0.0994, "99"), (5.9e-4, "0.59"), (0.0, "0"),
     (2.5, "2500"), (-0.13, "-130")],
)  # fmt: skip
def test_a_length_is_told_without_a_power_of_ten(length, told):
    assert in_mm(length) == told


def test_more_digits_are_told_if_asked_for():
    assert in_mm(0.0146, digits=3) == "14.6"
    assert in_mm(1.4612, digits=3) == "1461"
