"""The folder OUT/live of a running dive: the one place that knows its files.

====================  =============================================================================
status.json           `LiveStatus`: state, gauges, counts, warnings; replaced several times a second
picture.jpg           the newest picture as it came, at most 960 px wide
stripe.jpg            the newest picture in which the stripe was looked for, with its centres
points/000000.parquet a part of the preview about every second, never changed afterwards:
                      x_m, y_m, z_m (world frame), signal float32, frame uint32
cells.parquet         the sums that the map is drawn up from, for a later run of the same dive
gaps.png, gaps.json   the map of gaps: a cell a pixel, row 0 the smallest place across, column 0 the
                      smallest along; 255 nothing known, 0 covered, k missing by causes[k - 1]
====================  =============================================================================

Every file appears whole. They are a preview and no part of the scan.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float32

from ..errors import FormatError
from ..io.atomic import aside_of
from ..io.images import read_image, write_image
from ..io.json_files import load_json, save_json
from ..io.parquet import load_columns, save_columns
from ..io.values import load_value, save_value
from ..types.arrays import FrameNumbers, Ratios
from .gap_map import GapMap
from .status import LiveStatus


@dataclass(frozen=True, eq=False)
class LivePoints:
    """Points of the preview, one a row."""

    points: Float32[np.ndarray, "n 3"]
    """In the world frame [m]."""
    signal: Ratios
    """Height of the stripe above its surroundings [grey levels]."""
    frame: FrameNumbers
    """Index of the frame in the recording."""

    def __len__(self) -> int:
        """Count the points."""
        return len(self.signal)


@dataclass(frozen=True)
class LiveFolder:
    """OUT/live: each value of a dive is saved and loaded here, and nowhere else."""

    root: Path

    @property
    def picture(self) -> Path:
        """The newest picture as it came."""
        return self.root / "picture.jpg"

    @property
    def stripe(self) -> Path:
        """The newest picture in which the stripe was looked for."""
        return self.root / "stripe.jpg"

    def save_status(self, status: LiveStatus) -> None:
        """Write status.json."""
        save_value(self.root / "status.json", status)

    def load_status(self) -> LiveStatus:
        """Read status.json.

        Raises:
            FormatError: It is missing or damaged.
        """
        return load_value(self.root / "status.json", LiveStatus)

    def save_points(self, part: int, points: LivePoints) -> None:
        """Write one part of the preview."""
        x, y, z = points.points.T
        columns = {"x_m": x, "y_m": y, "z_m": z, "signal": points.signal, "frame": points.frame}
        save_columns(self._part(part), columns)

    def find_points(self) -> list[int]:
        """Number the parts that are there, in order."""
        files = (self.root / "points").glob("[0-9]*.parquet")
        return sorted(int(file.stem) for file in files)

    def load_points(self, part: int) -> LivePoints:
        """Read one part.

        Raises:
            FormatError: It is missing or damaged.
        """
        columns = load_columns(self._part(part))
        points = np.stack([columns[name] for name in ("x_m", "y_m", "z_m")], axis=1)
        return LivePoints(points, columns["signal"], columns["frame"])

    def save_gaps(self, gaps: GapMap) -> None:
        """Write gaps.png, and then gaps.json that says where it lies."""
        write_image(self.root / "gaps.png", np.ascontiguousarray(gaps.state))
        told = {
            "shape": list(gaps.state.shape),
            "cell_m": gaps.cell,
            "corner_along_m": gaps.corner[0],
            "corner_across_m": gaps.corner[1],
            "along": gaps.along.tolist(),
            "across": gaps.across.tolist(),
            "causes": list(gaps.causes),
            "covered_m2": gaps.covered,
            "missing_m2": gaps.missing,
            "share": gaps.share,
        }
        save_json(self.root / "gaps.json", told)

    def load_gaps(self) -> GapMap | None:
        """Read the map; None where there is none yet, or just a new one being written.

        Raises:
            FormatError: It is damaged.
        """
        file = self.root / "gaps.json"
        if not file.exists():
            return None
        told, state = load_json(file), read_image(self.root / "gaps.png")
        if list(state.shape) != told.get("shape"):
            return None
        try:
            return GapMap(
                state,
                tuple(told["causes"]),
                told["cell_m"],
                (told["corner_along_m"], told["corner_across_m"]),
                np.array(told["along"], float),
                np.array(told["across"], float),
                told["covered_m2"],
                told["missing_m2"],
            )
        except (KeyError, TypeError, ValueError) as error:
            raise FormatError(
                f"{file} is damaged: it lacks {error}; run `murkscan live` again."
            ) from error

    def save_cells(self, columns: Mapping[str, np.ndarray]) -> None:
        """Write what the map is drawn up from."""
        save_columns(self.root / "cells.parquet", columns)

    def load_cells(self) -> Mapping[str, np.ndarray] | None:
        """Read it; None where there is nothing yet.

        Raises:
            FormatError: It is damaged.
        """
        file = self.root / "cells.parquet"
        if not file.exists():
            return None
        columns = load_columns(file)
        return {name: columns[name] for name in columns}

    def clear(self) -> None:
        """Take away what an earlier dive left here; files of others stay."""
        names = (
            "status.json",
            "picture.jpg",
            "stripe.jpg",
            "gaps.png",
            "gaps.json",
            "cells.parquet",
        )
        files = [self.root / name for name in names]
        for file in (*files, *map(self._part, self.find_points())):
            file.unlink(missing_ok=True)
            aside_of(file).unlink(missing_ok=True)

    def _part(self, part: int) -> Path:
        return self.root / "points" / f"{part:06d}.parquet"
