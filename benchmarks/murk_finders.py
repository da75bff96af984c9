"""The finders that are judged: every extractor of the package, and what a user would write."""

import inspect
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.signal import find_peaks

from murkscan import extract
from murkscan.extract import AbstractExtractor
from murkscan.extract.assemble import assemble_stripe
from murkscan.types.background import Background
from murkscan.types.frame import Frame
from murkscan.types.rig import Rig
from murkscan.types.stripe import Stripe

_HALF = 4
"""Pixels on each side of a peak that a centroid takes in."""
_RISE, _CONTRAST = 10.0, 5.0
"""Grey levels, and standard deviations of the noise, by which a peak must stand out: those of the
package's own extractors."""
_WIDTH = (1, 30)
"""Least and largest width of a peak at half its prominence [px]; water widens it."""
_PIXEL = 0.29
"""Standard deviation of a centre that may lie anywhere in its pixel [px]; these tell none."""


@final
@dataclass(frozen=True)
class Maximum(AbstractExtractor):
    """The brightest pixel of each column, and the centroid around it above the column's median."""

    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe in each frame; see `AbstractExtractor.extract`."""
        for frame in frames:
            light = frame.image.astype(float) - np.median(frame.image, axis=0)
            rows = light.argmax(axis=0)
            lines = np.flatnonzero(light.max(axis=0) > _least(background))
            yield _assemble(frame, lines, rows[lines], light)


@final
@dataclass(frozen=True)
class FindPeaks(AbstractExtractor):
    """`scipy.signal.find_peaks` in each column, by prominence and width, and their centroids."""

    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe in each frame; see `AbstractExtractor.extract`."""
        for frame in frames:
            columns = np.ascontiguousarray(frame.image.T.astype(float))
            peaks = [
                find_peaks(column, prominence=_least(background), width=_WIDTH)[0]
                for column in columns
            ]
            lines = np.repeat(np.arange(len(peaks)), [len(one) for one in peaks])
            light = columns.T - np.median(columns.T, axis=0)
            yield _assemble(frame, lines, np.concatenate(peaks), light)


def _least(background: Background) -> float:
    return max(_RISE, _CONTRAST * background.noise)


def _assemble(frame: Frame, lines: np.ndarray, rows: np.ndarray, light: np.ndarray) -> Stripe:
    """Take the centroid around each peak, of what is above its window's foot."""
    at = np.clip(rows[:, None] + np.arange(-_HALF, _HALF + 1), 0, len(light) - 1)
    window = light[at, lines[:, None]]
    weight = window - window.min(axis=1, keepdims=True)
    centres = (weight * at).sum(axis=1) / np.maximum(weight.sum(axis=1), 1e-9)
    return assemble_stripe(
        frame,
        "y",
        0,
        lines=lines,
        centres=centres,
        sigma=np.full(len(lines), _PIXEL),
        signal=light[rows, lines],
    )


def own_finders() -> dict[str, AbstractExtractor]:
    """Give every extractor that the package exports, with its default settings."""
    kinds = [
        kind
        for _, kind in inspect.getmembers(extract, inspect.isclass)
        if issubclass(kind, AbstractExtractor) and kind is not AbstractExtractor
    ]
    return {kind.__name__: kind() for kind in kinds}


PEERS: dict[str, AbstractExtractor] = {"Maximum": Maximum(), "FindPeaks": FindPeaks()}
"""What a user would write; Otsu and thinning are the package's ThresholdSkeleton."""
