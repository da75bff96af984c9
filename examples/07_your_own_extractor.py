"""An extractor of your own
========================

A way to find the stripe is a frozen dataclass with one method; a scan takes it as it takes ours.

This one takes the brightest pixel of each scan line, and a parabola through its neighbours. What an
extractor gives is looked at before it is believed: nonsense is refused with its name.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from importlib import import_module
from typing import final

import numpy as np

import murkscan as ms
from murkscan.extract import AbstractExtractor
from murkscan.survey.extract import extract_recording
from murkscan.types.background import Background


@final
@dataclass(frozen=True)
class Brightest(AbstractExtractor):
    """The brightest pixel of each column; its fields are the settings, kept with the scan."""

    least: float = 20.0
    """Grey level from which it counts."""

    def extract(
        self, frames: Iterable[ms.Frame], rig: ms.Rig, background: Background, *, laser: int = 0
    ) -> Iterator[ms.Stripe]:
        """Yield one stripe a frame; ``background.noise`` is what ``learn`` has found."""
        for frame in frames:
            image = frame.image.astype(float)
            row = image[1:-1].argmax(axis=0) + 1
            column = np.flatnonzero(image.max(axis=0) >= self.least)
            row = row[column]
            below, peak, above = (image[row + step, column] for step in (-1, 0, 1))
            bend = np.minimum(below - 2 * peak + above, -1.0)
            centre = row - np.clip((above - below) / (2 * bend), -0.5, 0.5)
            v = frame.as_full_rows(centre)  # a field has every second row of the full frame
            one = np.ones(len(column))
            yield ms.Stripe(
                frame=frame.index * one,
                time=frame.time * one,
                pixels=np.stack([column.astype(float), v], axis=1),
                sigma=0.3 * one,
                signal=peak,
                posterior=one,
                laser=laser * one,
                branch=0 * one,
            )


@final
@dataclass(frozen=True)
class Nonsense(AbstractExtractor):
    """An extractor with a fault: its centres lie far below the picture."""

    def extract(
        self, frames: Iterable[ms.Frame], rig: ms.Rig, background: Background, *, laser: int = 0
    ) -> Iterator[ms.Stripe]:
        """Shift what the other one gives."""
        for stripe in Brightest().extract(frames, rig, background, laser=laser):
            yield replace(stripe, pixels=stripe.pixels + np.array([0, 5000]))


if __name__ == "__main__":
    first = import_module("01_scan_a_recording")
    folder, pictures = first.folder, (first.recording, first.rig)
    # As a whole scan takes it: ms.scan(recording, rig, motion, out="dive", extractor=Brightest())
    own = extract_recording(ms.Project(folder / "own"), *pictures, Brightest(least=30))
    print(f"{own.points} centres; {len(first.project.load_stripe())} by murk")
    try:
        extract_recording(ms.Project(folder / "nonsense"), *pictures, Nonsense())
    except ms.InputError as error:
        print(f"refused: {error}")
