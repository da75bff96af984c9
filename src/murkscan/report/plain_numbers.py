"""Numbers as a file has them: plain, None for what is not, and no more digits than they mean."""

import math

import numpy as np

from .quantiles import Quantiles


def as_plain(spread: Quantiles, scale: float) -> dict[str, float | None]:
    """Give the five figures of a spread in another unit: `scale` of it are one."""
    return {
        name: None if value is None else round_off(scale * value)
        for name, value in (
            ("smallest", spread.smallest),
            ("percent_5", spread.low),
            ("median", spread.median),
            ("percent_95", spread.high),
            ("largest", spread.largest),
        )
    }


def as_list(values: np.ndarray) -> list[float | None]:
    """Give numbers as a list, None where they are not finite."""
    return [round_off(value) if math.isfinite(value) else None for value in values.tolist()]


def round_off(value: float) -> float:
    """Keep seven digits: more than any of these numbers means."""
    return float(f"{value:.7g}")
