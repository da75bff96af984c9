"""An acceptance test as plain values, for programs."""

from dataclasses import asdict
from typing import Any

from .finding import Finding
from .protocol import Protocol


def as_plain(protocol: Protocol) -> dict[str, Any]:
    """Give all numbers and words of a protocol; keys carry their unit."""
    test = protocol.test
    return {
        "scan": protocol.name,
        "artefact": test.name,
        "certificate": test.certificate,
        "decision": protocol.decision.value,
        "verdict": protocol.verdict,
        "open_questions": protocol.open_questions,
        "limits": {f"{name}_m": limit for name, limit in asdict(test.limits).items()},
        "results": [_result(one) for one in protocol.findings],
        "scanned": dict(protocol.scanned),
        "seen": protocol.seen,
        "unstated": list(protocol.unstated),
    }


def _result(one: Finding) -> dict[str, Any]:
    half = one.half_width
    return {
        "what": one.what,
        "artefact": one.artefact,
        "calibrated_m": one.calibrated,
        "calibrated_sigma_m": one.sigma_calibrated,
        "measured_m": one.measured.value,
        "error_m": one.error,
        "error_interval_95_m": [one.error - half, one.error + half],
        "sigma_independent_m": one.measured.sigma_independent,
        "sigma_common_m": one.measured.sigma_common,
        "stated_half_width_95_m": one.stated_half_width,
        "limit_m": one.limit,
        "decision": one.decision.value,
    }
