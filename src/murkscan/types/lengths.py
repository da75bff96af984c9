"""Lengths as people read them."""


def in_mm(length: float, *, digits: int = 2) -> str:
    """Write a length in millimetres with so many digits that count, and never as a power of ten.

    Args:
        length: The length [m].
        digits: Those that are told; a longer number keeps all of its whole millimetres.
    """
    value = float(f"{1e3 * length:.{digits}g}")
    return f"{1e3 * length:.0f}" if abs(value) >= 10**digits else f"{value:.{digits}g}"
