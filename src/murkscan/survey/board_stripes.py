"""The laser's stripe on a board, in photos of both."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..calibrate.board import Chessboard, Margin
from ..calibrate.contrast import laser_contrast, white_of_board
from ..calibrate.seen_board import locate_seen_board
from ..calibrate.sheet import StripeOnBoard
from ..calibrate.stripe_on_board import count_lit_lines, keep_on_board, mask_to_sheet
from ..calibrate.view import BoardView
from ..extract import AbstractExtractor
from ..optics import refractive_index
from ..types.arrays import Image, Pixels
from ..types.frame import Frame
from ..types.laser import Laser
from ..types.pose import Pose
from ..types.rig import Rig
from .board_photos import BoardPhotos, Photo
from .progress import Progress


@dataclass(frozen=True, eq=False)
class StripeFinder:
    """Finds the stripe on the board in each photo that shows one."""

    photos: BoardPhotos
    views: Sequence[BoardView]
    board: Chessboard
    margin: Margin
    rig: Rig
    extractor: AbstractExtractor

    def find(self, progress: Progress) -> list[StripeOnBoard]:
        """Give the stripe of each photo with a board; of length 0 where there is none."""
        by_name = {view.name: view for view in self.views if view.is_found}
        poses = {
            name: locate_seen_board(view.corners, self.board, self.rig.camera, self._index)
            for name, view in by_name.items()
        }
        shown = (photo for photo in self.photos if photo.name in by_name)
        contrasts = [
            self._contrast(photo, by_name[photo.name], poses[photo.name]) for photo in shown
        ]
        rows, columns = np.sum([count_lit_lines(image) for image in contrasts], axis=0)
        rig = replace(
            self.rig, lasers=(Laser.from_baseline_angle(1.0, 1.0, "x" if rows > columns else "y"),)
        )
        stripes = []
        for number, (name, image) in enumerate(zip(by_name, contrasts, strict=True)):
            pixels = self._extract(image, number, rig)
            stripes.append(
                keep_on_board(
                    pixels, by_name[name], self.board, self.margin,
                    camera=rig.camera, camera_from_board=poses[name], index=self._index,
                )
            )  # fmt: skip
            progress("find stripes", number + 1, len(by_name))
        return stripes

    @property
    def _index(self) -> float:
        return refractive_index(self.rig.water, self.rig.wavelength)

    def _contrast(self, photo: Photo, view: BoardView, camera_from_board: Pose) -> Image:
        white = white_of_board(photo.image, view, self.board)
        return mask_to_sheet(
            laser_contrast(photo.image, self.rig.wavelength, white=white),
            self.board, self.margin,
            camera=self.rig.camera, camera_from_board=camera_from_board, index=self._index,
        )  # fmt: skip

    def _extract(self, image: Image, number: int, rig: Rig) -> Pixels:
        """Find the stripe in one photo. Photos differ in light, so each is learnt by itself."""
        frame = Frame(image, number, float(number))
        background = self.extractor.learn([frame], rig)
        (stripe,) = self.extractor.extract([frame], rig, background)
        return stripe.pixels
