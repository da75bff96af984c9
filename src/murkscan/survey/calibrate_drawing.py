"""The photos of a calibration with what was found drawn over them."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ..calibrate.adjust.solve import rms_of
from ..calibrate.board.chessboard import Chessboard
from ..calibrate.board.drawing import draw_photo
from ..calibrate.board.stripe import StripeOnBoard
from ..calibrate.board.view import BoardView
from ..calibrate.calibration import Calibration
from ..calibrate.laser import sheet_of
from ..calibrate.mount import circles_of
from ..capture.photos import BoardPhotos
from ..io.images import write_image
from ..types.arrays import Pixels, Scalars
from .progress import Progress

SUFFIX = ".found.jpg"
"""Ends the names of our drawings, so that nothing else is ever taken for one."""


def draw_photos(
    photos: BoardPhotos,
    views: Sequence[BoardView],
    folder: Path,
    *,
    board: Chessboard,
    stripes: Sequence[StripeOnBoard],
    calibration: Calibration | None,
    unused: Mapping[str, str],
    progress: Progress,
) -> None:
    """Draw every photo: its corners and stripes, what is left over, and why it is not used."""
    for file in folder.glob(f"*{SUFFIX}"):
        file.unlink()  # what an earlier calibration drew would be taken for this one's
    residuals, notes = _residuals(calibration)
    distances = _distances(calibration)
    nothing = np.zeros(0)
    for number, (photo, view) in enumerate(zip(photos, views, strict=True)):
        note = f"{view.name}: {notes.get(view.name, '')}"
        if view.name in unused:
            note = f"{view.name} NOT USED: {unused[view.name]}"
        mine = [stripe for stripe in stripes if stripe.name == view.name and len(stripe.pixels)]
        off = [distances.get((s.name, s.laser), np.zeros(len(s.pixels))) for s in mine]
        picture = draw_photo(
            photo.image, view, board, note,
            residuals=residuals.get(view.name, np.zeros((0, 2))),
            stripe=np.concatenate([np.zeros((0, 2)), *(s.pixels for s in mine)]),
            distances=np.concatenate([nothing, *off]),
        )  # fmt: skip
        write_image(folder / f"{view.name}{SUFFIX}", picture)
        progress("draw", number + 1, len(views))


def _residuals(calibration: Calibration | None) -> tuple[dict[str, Pixels], dict[str, str]]:
    """Take each used photo's residuals [px], and say in words how well it fits."""
    if calibration is None:
        return {}, {}
    names = [sighting.name for sighting in calibration.sightings]
    residuals = calibration.adjustment.corner_residuals
    words = [f"RMS {rms_of(off):.2f} px" for off in residuals]
    if calibration.logged is not None:
        circles = circles_of(calibration)
        residuals = circles.residuals
        words = [f"closes to {closure * 1e3:.2f} mm" for closure in circles.closures.tolist()]
    return dict(zip(names, residuals, strict=True)), dict(zip(names, words, strict=True))


def _distances(calibration: Calibration | None) -> dict[tuple[str, int], Scalars]:
    """Take how far each photo's stripe points are from their laser's sheet [m]."""
    if calibration is None:
        return {}
    return {
        (stripe.name, stripe.laser): distances
        for number in calibration.lasers
        for fit in [sheet_of(calibration, number)]
        for stripe, distances in zip(fit.stripes, fit.residuals, strict=True)
    }
