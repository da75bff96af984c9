"""What an acceptance test says in sentences."""

import math
from collections.abc import Sequence

from .finding import Decision, Finding

_MOST = 20
"""Scans that one may be asked for, to decide what one scan left open."""
_COVERAGE = 1.96
"""Standard deviations of half a 95 % interval."""


def decide_all(findings: Sequence[Finding]) -> Decision:
    """Decide the whole: failed by one that failed, passed only by all that have a limit."""
    found = {one.decision for one in findings}
    for decision in (Decision.FAILED, Decision.UNDECIDED, Decision.PASSED):
        if decision in found:
            return decision
    return Decision.NO_LIMIT


def tell_verdict(findings: Sequence[Finding]) -> str:
    """Say what the whole comes to, in one sentence."""
    decision, limited = decide_all(findings), [one for one in findings if one.limit is not None]
    if decision is Decision.NO_LIMIT:
        return "Measured, and not decided: [limits] states no limit for what was tested."
    some = [one for one in limited if one.decision is decision]
    of = f"{len(some)} of {len(limited)}"
    if decision is Decision.PASSED:
        return f"Passed: {_count(len(limited))} within the limit, with all of the interval."
    names = ", ".join(dict.fromkeys(f"{one.what} of {one.artefact}" for one in some))
    if decision is Decision.FAILED:
        return f"Failed: {of} errors beyond the limit, with all of the interval: {names}."
    return f"Undecided: {of} errors with an interval that reaches over the limit: {names}."


def _count(number: int) -> str:
    return "the one error is" if number == 1 else f"all {number} errors are"


def tell_what_decides(one: Finding) -> str:
    """Say what would decide an error that is not decided.

    Raises:
        ValueError: It is decided, or has no limit.
    """
    if one.limit is None or one.decision is not Decision.UNDECIDED:
        raise ValueError(f"{one.what} of {one.artefact} is not undecided")
    room = abs(one.limit - abs(one.error))
    told = (
        f"{one.what.capitalize()} of {one.artefact}: {1e3 * abs(one.error):.3f} ± "
        f"{1e3 * one.half_width:.3f} mm against {1e3 * one.limit:g} mm is undecided; "
    )
    calibrated = _COVERAGE * one.sigma_calibrated
    if calibrated >= room:
        return told + (
            f"the artefact is known to ± {1e3 * calibrated:.3f} mm, and ± {1e3 * room:.3f} mm "
            "would decide it: have it calibrated better."
        )
    own = math.sqrt(max(one.half_width**2 - calibrated**2, 0.0))
    scans = math.ceil(own**2 / (room**2 - calibrated**2))
    if scans > _MOST:
        return told + (
            "the error lies too near the limit for any number of scans: scan from nearer or in "
            "clearer water, or agree on another limit."
        )
    return told + (
        f"about {max(scans, 2)} times as many points would decide it: move that much more slowly, "
        "or merge that many passes."
    )
