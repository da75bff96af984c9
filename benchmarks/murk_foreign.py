"""Finders of other packages, which need an environment of their own."""

import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import final

import numpy as np

from murkscan.extract import AbstractExtractor
from murkscan.extract.assemble import assemble_stripe
from murkscan.types.background import Background
from murkscan.types.frame import Frame
from murkscan.types.rig import Rig
from murkscan.types.stripe import Stripe

_PACKAGES = ("oplab-pipeline", "ridge-detector")
"""Both bring an OpenCV that would overwrite the package's own."""
_WORKER = Path(__file__).with_name("murk_foreign_worker.py")
_PIXEL = 0.29
STEP = 9
"""Frames from one that they are given to the next: they are slow. Odd: both kinds of field."""


@final
@dataclass(frozen=True)
class Foreign(AbstractExtractor):
    """A finder that another Python runs, on all frames at once."""

    python: Path
    """The interpreter of the environment that it lives in."""
    name: str
    """Which: oplab or ridge."""

    def extract(
        self, frames: Iterable[Frame], rig: Rig, background: Background, *, laser: int = 0
    ) -> Iterator[Stripe]:
        """Find the stripe in each frame; see `AbstractExtractor.extract`."""
        frames = list(frames)
        with tempfile.TemporaryDirectory() as folder:
            asked, told = Path(folder) / "frames.npy", Path(folder) / "found.npy"
            np.save(asked, np.stack([frame.image for frame in frames]))
            command = [self.python, _WORKER, self.name, asked, told]
            subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
            found = np.load(told)
        for number, frame in enumerate(frames):
            lines, centres, signal = found[found[:, 0] == number, 1:].T
            sigma = np.full(len(lines), _PIXEL)
            yield assemble_stripe(
                frame, "y", 0, lines=lines.astype(int), centres=centres, sigma=sigma, signal=signal
            )


def foreign_finders(folder: Path) -> dict[str, AbstractExtractor]:
    """Give the finders of an environment, which is made where there is none yet."""
    python = folder / "bin" / "python"
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", *_PACKAGES], check=True)
    return {"Oplab": Foreign(python, "oplab"), "RidgeDetector": Foreign(python, "ridge")}
