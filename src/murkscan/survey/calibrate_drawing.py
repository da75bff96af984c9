"""The photos of a calibration with what was found drawn over them."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from ..calibrate.board import Chessboard, Margin
from ..calibrate.drawing import draw_board, draw_stripe_on_board, project_outline
from ..calibrate.sheet import SheetFit, StripeOnBoard
from ..calibrate.story import Story, write_story
from ..calibrate.view import BoardView
from ..io.atomic import replacing
from ..io.images import write_image
from ..optics import refractive_index
from ..types.arrays import Pixels
from ..types.rig import Rig
from .board_photos import BoardPhotos
from .progress import Progress

SUFFIX = ".found.jpg"
"""Ends the names of our drawings, so that nothing else is ever taken for one."""
_SHEET_TOLERANCE = 2e-3
"""Distance from the sheet at which a stripe point is drawn red [m], where the RMS is lower."""


def draw_boards(
    photos: BoardPhotos,
    views: Sequence[BoardView],
    folder: Path,
    *,
    board: Chessboard,
    residuals: Mapping[str, Pixels],
    left_out: Sequence[str] = (),
    progress: Progress,
) -> None:
    """Draw the corners of every photo, with residuals [px] where its name has some."""
    _clear(folder)
    none = np.zeros((0, 2))
    for number, (photo, view) in enumerate(zip(photos, views, strict=True)):
        off, note = residuals.get(view.name, none), f"{view.name}: no {board} board found"
        if view.is_found:
            note = f"{view.name}: {board} board"
        if view.name in left_out:
            note += ", LEFT OUT: fits far worse than the others"
        if len(off):
            note += f", RMS {np.sqrt(np.mean(np.sum(off**2, axis=1))):.2f} px"
        picture = draw_board(photo.image, view, board, off, note)
        write_image(folder / f"{view.name}{SUFFIX}", picture)
        progress("draw", number + 1, len(views))


def draw_stripes(
    photos: BoardPhotos,
    stripes: Sequence[StripeOnBoard],
    folder: Path,
    *,
    board: Chessboard,
    margin: Margin,
    rig: Rig,
    fit: SheetFit | None,
    progress: Progress,
) -> None:
    """Draw the stripe points of every photo with a board, coloured by residual."""
    _clear(folder)
    found = {stripe.name: stripe for stripe in stripes}
    used = {} if fit is None else _number(fit.stripes)
    index = refractive_index(rig.water, rig.wavelength)
    done = 0
    for photo in photos:
        if photo.name not in found:
            continue
        stripe = found[photo.name]
        note = (
            f"{stripe.name}: {len(stripe.pixels)} points"
            if len(stripe.pixels)
            else (f"{stripe.name}: no stripe on the board's paper")
        )
        residuals = np.zeros(len(stripe.pixels))
        if fit is not None and stripe.name in used:
            residuals = fit.residuals[used[stripe.name]]
            note += f", RMS {fit.view_rms[used[stripe.name]] * 1e3:.2f} mm"
        picture = draw_stripe_on_board(
            photo.image,
            stripe.pixels,
            residuals,
            note,
            outline=project_outline(board, margin, rig.camera, stripe.camera_from_board, index),
            tolerance=_SHEET_TOLERANCE,
        )
        write_image(folder / f"{stripe.name}{SUFFIX}", picture)
        done += 1
        progress("draw", done, len(stripes))


def write_page(folder: Path, story: Story) -> Path:
    """Write the page of a calibration beside its drawings; give where it is."""
    path = folder / "index.html"
    with replacing(path) as aside:
        aside.write_text(write_story(story, suffix=SUFFIX), "utf-8")
    return path


def _number(items: Sequence[StripeOnBoard]) -> dict[str, int]:
    return {item.name: number for number, item in enumerate(items)}


def _clear(folder: Path) -> None:
    """Remove what an earlier calibration drew: it would be taken for this one's."""
    for file in folder.glob(f"*{SUFFIX}"):
        file.unlink()
