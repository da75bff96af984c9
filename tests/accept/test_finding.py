"""Errors, intervals, limits, and what is decided."""

import math

import pytest

from murkscan.accept import Decision, Finding
from murkscan.accept.words import decide_all, tell_verdict, tell_what_decides
from murkscan.types.quantity import Quantity


def find(error_mm, *, own=0.1, calibrated=0.0, limit=1.0, common=None) -> Finding:
    found = Quantity(
        "spacing", 0.4 + error_mm / 1e3, "m", own / 1e3, common and common / 1e3, math.inf
    )
    limit = None if limit is None else limit / 1e3
    return Finding("sphere spacing", "balls A and B", 0.4, calibrated / 1e3, found, limit)


@pytest.mark.parametrize(
    ("error", "decision"),
    # The interval is ± 0.196 mm about the error, the limit 1 mm.
    [
        (0.0, Decision.PASSED), (0.8, Decision.PASSED), (-0.8, Decision.PASSED),
        (0.81, Decision.UNDECIDED), (-0.81, Decision.UNDECIDED), (1.19, Decision.UNDECIDED),
        (1.2, Decision.FAILED), (-1.2, Decision.FAILED),
    ],
)  # fmt: skip
def test_the_interval_guards_the_limit_on_both_sides(error, decision):
    assert find(error).decision is decision


def test_a_limit_below_the_interval_is_never_passed():
    assert find(0.0, limit=0.19).decision is Decision.UNDECIDED


def test_the_calibration_of_the_artefact_counts_and_that_of_the_rig_only_in_the_stated_interval():
    one = find(0.0, own=0.3, calibrated=0.4, common=1.2)
    assert one.half_width == pytest.approx(1.96e-3 * 0.5, rel=1e-3)
    assert one.stated_half_width == pytest.approx(1.96e-3 * 1.3, rel=1e-3)


def test_what_would_decide_is_said_with_its_number():
    # Half the interval has to shrink from 0.196 to 0.1 mm: 3.84 times as many points.
    assert "about 4 times as many points" in tell_what_decides(find(0.9))
    assert "have it calibrated better" in tell_what_decides(find(0.9, calibrated=0.06))
    assert "too near the limit" in tell_what_decides(find(0.99))
    with pytest.raises(ValueError, match="not undecided"):
        tell_what_decides(find(0.0))


def test_the_whole_fails_by_one_and_passes_only_by_all():
    passed, open_one, failed, free = (
        find(0.0), find(1.0), find(2.0), find(0.0, limit=None),
    )  # fmt: skip
    assert decide_all([passed, open_one, failed, free]) is Decision.FAILED
    assert decide_all([passed, open_one, free]) is Decision.UNDECIDED
    assert decide_all([passed, free]) is Decision.PASSED
    assert decide_all([free]) is Decision.NO_LIMIT
    assert "the one error is within" in tell_verdict([passed, free])
    assert "sphere spacing of balls A and B" in tell_verdict([failed, passed])
    assert "states no limit" in tell_verdict([free])
