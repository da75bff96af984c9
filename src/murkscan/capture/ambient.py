"""Whether a recording shows more than the laser's light, and what that other light looks like."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float, Shaped

from ..types.arrays import Vector
from .base import AbstractRecording
from .colour import EachColour, LaserColour, filter_response

_PICTURES = 8
"""Pictures that are looked at: they cost a tenth of a second at PAL size."""
_APART = 8
"""Distance between the two pixels of a difference [px]: more than a line is wide, mostly."""
_PIXELS = 20_000
"""Pixels of each picture that are looked at, about."""
_TEXTURE, _LINE = 0.95, 0.998
"""Shares of differences: up to the first it is mostly texture; beyond the second a line, if any."""
_TRIMMED, _ROUNDS = 0.97, 5
"""Share of differences by which other light is learnt, without the line; and how often anew."""
_ROUNDING = 1.0
"""Variance of a difference that rounding and compression leave at least [grey levels squared]."""
_BETTER = 2.0
"""How much further a line must stand out from texture for its colour to be trusted: the mean's
signal is larger, and its noise smaller. On real recordings in full light it stands out 2.5 to 6.8
times as far, in dark ones 0.3 to 1.2 times (benchmarks/real_sets.py)."""
_ROUNDED = 1.0
"""Difference that rounding makes of nothing [grey levels]: no texture is less."""
_SIGMAS = 3.0
"""Pedestal in standard deviations of the contrast's noise."""


def see_by_colour(recording: AbstractRecording, wavelength: float) -> AbstractRecording:
    """Let a recording show the laser's colour alone, where that tells the line from what is lit.

    The laser is of one colour, daylight and lamps of many. The weights of red, green and blue are
    those under which differences between pixels near one another, with the line left out, are
    smallest against the laser's light: a matched filter over colours.

    Args:
        recording: As `open_recording` opens it.
        wavelength: Of the laser in air [m].

    Returns:
        The recording, with a remark, or the same where it is dark or without colours.

    References:
        Manolakis, Shaw, Detection algorithms for hyperspectral imaging applications, IEEE Signal
        Processing Magazine 19, 2002 (the filter).
    """
    pictures = _sample_colours(recording)
    if pictures is None:
        return recording
    mean = LaserColour.mean(wavelength)
    contrast = _match(pictures, wavelength)
    if _stands_out(pictures, contrast) < _BETTER * _stands_out(pictures, mean):
        return recording
    said = (
        "more than the laser lights it: its grey levels show how much more of the laser's colour "
        "there is than the other light explains"
    )
    return recording.in_colour(contrast, said)


def _sample_colours(recording: AbstractRecording) -> list[Shaped[np.ndarray, "h w 3"]] | None:
    """Read some pictures in colour; None where red and blue are the same."""
    seen = recording.in_colour(EachColour())

    def see(count: int) -> list[Shaped[np.ndarray, "h w 3"]]:
        return [one.image.reshape(len(one.image), -1, 3) for one in seen.sample(count)]

    if all(np.array_equal(one[..., 0], one[..., 2]) for one in see(1)):
        return None
    return see(_PICTURES)


def _differences(image: Shaped[np.ndarray, "*picture"]) -> Float[np.ndarray, "*many"]:
    """Give differences between pixels some way apart, along both axes, of one in so many pixels."""
    step = max(round(np.sqrt(image.shape[0] * image.shape[1] / _PIXELS)), 1)
    rows, columns = image[::step].astype(np.float64), image[:, ::step].astype(np.float64)
    right = (rows[:, _APART:] - rows[:, :-_APART])[:, ::step]
    down = (columns[_APART:] - columns[:-_APART])[::step]
    rest = image.shape[2:]
    return np.concatenate([right.reshape(-1, *rest), down.reshape(-1, *rest)])


def _match(pictures: Sequence[Shaped[np.ndarray, "h w 3"]], wavelength: float) -> LaserColour:
    """Find the weights under which the laser's light is 1 and other light varies least."""
    differences = np.concatenate([_differences(image) for image in pictures])
    response = filter_response(wavelength)
    rest = differences
    for _ in range(_ROUNDS):
        spread = rest.T @ rest / len(rest) + _ROUNDING * np.eye(3)
        weights: Vector = np.linalg.solve(spread, response)
        weights /= response @ weights
        off = np.abs(differences @ weights)
        rest = differences[off <= np.quantile(off, _TRIMMED)]
    noise = 1.4826 * np.median(off) / np.sqrt(2)  # of one pixel, by the median of differences
    red, green, blue = weights.tolist()
    top = np.iinfo(pictures[0].dtype).max
    return LaserColour(wavelength, (red, green, blue), float(_SIGMAS * noise / top))


def _stands_out(pictures: Sequence[Shaped[np.ndarray, "h w 3"]], colour: LaserColour) -> float:
    """Compare the largest differences of grey levels, a line's, with those of texture."""
    off = np.abs(np.concatenate([_differences(colour.grey(image)) for image in pictures]))
    texture, line = np.quantile(off, (_TEXTURE, _LINE))
    return float(line / max(texture, _ROUNDED))
