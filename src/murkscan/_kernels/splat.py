"""Draw light into a picture with sub-pixel accuracy: each pixel integrates over its own area."""

import math
from typing import NamedTuple

import numpy as np

from .compiled import loop, part

_REACH = 5.0
"""Standard deviations beyond which nothing is drawn: 6e-7 of the light lies there."""


class LineSplats(NamedTuple):
    """Bits of light on scan lines, one a row."""

    lines: np.ndarray
    """Scan line of each, i64."""
    positions: np.ndarray
    """Coordinate along it [px], f8."""
    amounts: np.ndarray
    """Light times pixels, f8."""


@loop()
def splat_on_lines(splats: LineSplats, sigma: float, image: np.ndarray, slope: np.ndarray) -> None:
    """Add bits of light to an image whose rows are scan lines, and their derivative to another.

    Args:
        splats: The light.
        sigma: Standard deviation of the blur along the scan line [px].
        image: Rows are scan lines, f4; the light is added here.
        slope: As the image; the derivative by the light's position is added here.
    """
    num_lines, length = image.shape
    scale = 1.0 / (math.sqrt(2.0) * sigma)
    peak = 1.0 / (math.sqrt(2.0 * math.pi) * sigma)
    reach = math.ceil(_REACH * sigma + 0.5)
    for i in range(len(splats.lines)):
        line, at, amount = splats.lines[i], splats.positions[i], splats.amounts[i]
        if not (0 <= line < num_lines) or not (amount > 0.0) or not abs(at) < 1e6:
            continue
        middle = round(at)
        first, last = max(middle - reach, 0), min(middle + reach, length - 1)
        edge = (first - 0.5 - at) * scale
        share, height = math.erf(edge), peak * math.exp(-edge * edge)
        for k in range(first, last + 1):
            edge = (k + 0.5 - at) * scale
            next_share, next_height = math.erf(edge), peak * math.exp(-edge * edge)
            image[line, k] += amount * 0.5 * (next_share - share)
            slope[line, k] += amount * (height - next_height)
            share, height = next_share, next_height


@loop()
def splat_discs(
    pixels: np.ndarray, sigmas: np.ndarray, amounts: np.ndarray, image: np.ndarray
) -> None:
    """Add round bits of light, Gaussian, each integrated over the pixels.

    Args:
        pixels: Column and row of each [px], f8, n 2.
        sigmas: Standard deviation of each [px].
        amounts: Light times pixel areas of each.
        image: f4; the light is added here.
    """
    height, width = image.shape
    across, down = np.empty(width), np.empty(height)
    for i in range(len(amounts)):
        u, v, scale = pixels[i, 0], pixels[i, 1], 1.0 / (math.sqrt(2.0) * sigmas[i])
        if not (abs(u) < 1e6 and abs(v) < 1e6):
            continue
        reach = math.ceil(_REACH * sigmas[i] + 0.5)
        first, last = _share_out(u, reach, scale, across)
        top, bottom = _share_out(v, reach, scale, down)
        for row in range(top, bottom + 1):
            amount = amounts[i] * down[row]
            for column in range(first, last + 1):
                image[row, column] += amount * across[column]


@part()
def _share_out(at: float, reach: int, scale: float, shares: np.ndarray) -> tuple[int, int]:
    """Write which share of a Gaussian falls on each pixel of a line; give the first and the last.

    A round Gaussian is the product of two, so that a disc costs its width and not its area.
    """
    first, last = max(round(at) - reach, 0), min(round(at) + reach, len(shares) - 1)
    left = math.erf((first - 0.5 - at) * scale)
    for k in range(first, last + 1):
        right = math.erf((k + 0.5 - at) * scale)
        shares[k] = 0.5 * (right - left)
        left = right
    return first, last
