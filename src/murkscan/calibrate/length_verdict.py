"""What a measured length says of a rig, in plain words."""

from .verdict import CalibrationVerdict

_AGREES = 2.0
"""Standard deviations within which a measured length agrees with the known one."""


def judge_length(
    measured: float, known: float, sigma: float, *, is_common_known: bool
) -> CalibrationVerdict:
    """Judge a measured length beside the known one.

    Args:
        measured: The length as measured [m].
        known: The length as known [m].
        sigma: Standard deviation of the difference [m].
        is_common_known: Whether the rig's own part is in the deviation.
    """
    off = measured - known
    size = f"{measured * 1e3:.3f} ± {sigma * 1e3:.3f} mm (1σ) for {known * 1e3:.3f} mm"
    advice = []
    if abs(off) > _AGREES * sigma:
        longer = "long" if off > 0 else "short"
        advice.append(
            f"Lengths come out {abs(off / known):.2%} too {longer}: {size}, "
            f"{abs(off) / sigma:.1f} standard deviations."
        )
        advice.append(
            "Check that [water] is the water that this was seen in, then the port, then the "
            "calibration; a wrong square or a wrong ruler looks the same."
            if is_common_known
            else "The rig file states no covariance, so what the rig's own errors explain of it is "
            "not known; calibrate again to have one."
        )
    return CalibrationVerdict(tuple(advice), f"Good: lengths agree, {size}.")
