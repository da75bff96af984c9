"""Lasers' stripes on a board, in photos of both."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..calibrate.adjust.observations import index_of
from ..calibrate.board.chessboard import Chessboard, Margin
from ..calibrate.board.contrast import is_colourless, laser_contrast, white_of_board
from ..calibrate.board.lines import assign_lines
from ..calibrate.board.pose import locate_seen_board
from ..calibrate.board.stripe import (
    StripeOnBoard,
    blank_line,
    count_lit_lines,
    keep_on_board,
    mask_to_sheet,
)
from ..calibrate.board.view import BoardView
from ..capture.photos import BoardPhotos, Photo
from ..extract import AbstractExtractor
from ..types.arrays import Image, Pixels
from ..types.frame import Frame
from ..types.laser import Laser
from ..types.pose import Pose
from ..types.rig import Rig
from .progress import Progress

_COLOURS = {"red": 650e-9, "green": 532e-9, "blue": 450e-9}
"""A wavelength of each channel of a colour camera [m]."""
_OTHER = 2.0
"""How many times stronger a line is in another colour before it is said to have that."""
_FAINT = 15.0
"""Contrast below which no line is seen at all [grey levels]."""
_SECONDS = 1 / 3
"""Share of the photos with a second line from which there is a second laser, not glare."""


@dataclass(eq=False)
class StripeFinder:
    """Finds the stripes on the board in each photo that shows some."""

    photos: BoardPhotos
    views: Sequence[BoardView]
    board: Chessboard
    margin: Margin
    rig: Rig
    extractor: AbstractExtractor
    reasons: dict[str, str] = field(default_factory=dict)
    """Photos with a board but without a stripe, and why; filled by `find`."""
    remarks: tuple[str, ...] = ()
    """What is odd about the lines; filled by `find`."""
    _whole: dict[str, Image] = field(default_factory=dict)
    """Contrast of each photo with all of its lines."""

    def find(self, numbers: Sequence[int], progress: Progress) -> list[StripeOnBoard]:
        """Find the stripes of some lasers; where they are on no paper, they are of length 0."""
        by_name = {view.name: view for view in self.views if view.is_found}
        poses = {name: self._locate(view) for name, view in by_name.items()}
        contrasts, strengths = dict[str, Image](), list[tuple[float, ...]]()
        for photo in self.photos:
            if photo.name in by_name:
                view, pose = by_name[photo.name], poses[photo.name]
                contrasts[photo.name] = self._contrast(photo, view, pose, self.rig.wavelength)
                if not is_colourless(photo.image):
                    strengths.append(self._strengths(photo, view, pose))
        others = {n: laser for n, laser in enumerate(self.rig.lasers) if n not in numbers}
        self._whole = dict(contrasts)
        lines = list[StripeOnBoard]()
        for number in range(max(2, len(others) + len(numbers))):
            found = self._find_one_each(contrasts, by_name, poses, progress)
            if number >= len(numbers) and len(found) < _SECONDS * len(contrasts):
                break
            lines = self._apart(lines, found, contrasts, by_name, poses, progress)
        if len(lines) > len({line.name for line in lines}) or others:
            points = [line.points(self.rig.camera, index_of(self.rig)) for line in lines]
            found = assign_lines(lines, points, numbers, others, index_of(self.rig))
            if len(numbers) + len(others) == 1:
                self.remarks += (
                    "The photos show a second line: calibrate its laser with --laser 0,1 or "
                    "--laser 1, on the same photos.",
                )
            lines = found
        else:
            lines = [replace(line, laser=numbers[0]) for line in lines]
        used = {line.name for line in lines}
        self.reasons = {
            name: "shows the board, but no line on its blank paper; --margin-mm says how far that "
            "runs on beyond the squares"
            for name in by_name
            if name not in used
        }
        self._compare_colours(strengths)
        return lines or [
            StripeOnBoard(name, np.zeros((0, 2)), pose, numbers[0]) for name, pose in poses.items()
        ]

    def _locate(self, view: BoardView) -> Pose:
        points = view.places(self.board.points())
        return locate_seen_board(view.corners, points, self.rig.camera, index_of(self.rig))

    def _contrast(self, photo: Photo, view: BoardView, pose: Pose, wavelength: float) -> Image:
        white = white_of_board(photo.image, view, self.board)
        return mask_to_sheet(
            laser_contrast(photo.image, wavelength, white=white),
            self.board, self.margin,
            camera=self.rig.camera, camera_from_board=pose, index=index_of(self.rig),
        )  # fmt: skip

    def _strengths(self, photo: Photo, view: BoardView, pose: Pose) -> tuple[float, ...]:
        """Measure how strong a line is in red, green and blue [grey levels]."""
        return tuple(
            float(np.percentile(self._contrast(photo, view, pose, wavelength), 99.8))
            for wavelength in _COLOURS.values()
        )

    def _compare_colours(self, strengths: Sequence[tuple[float, ...]]) -> None:
        """Say so where the lines have another colour than the rig's wavelength."""
        if not strengths:
            return
        typical = dict(zip(_COLOURS, np.median(strengths, axis=0).tolist(), strict=True))
        own = min(_COLOURS, key=lambda colour: abs(_COLOURS[colour] - self.rig.wavelength))
        best = max(typical, key=lambda colour: typical[colour])
        if best != own and typical[best] > max(_OTHER * typical[own], _FAINT):
            self.remarks += (
                f"The line looks {best}, the rig says {self.rig.wavelength * 1e9:.0f} nm: write "
                "the laser's true wavelength_nm into the rig file, or give `calibrate camera` "
                "--wavelength-nm.",
            )

    def _find_one_each(
        self,
        contrasts: dict[str, Image],
        views: dict[str, BoardView],
        poses: dict[str, Pose],
        progress: Progress,
    ) -> list[StripeOnBoard]:
        """Find the strongest line of each photo that has one."""
        if not contrasts:
            return []
        rows, columns = np.sum([count_lit_lines(image) for image in contrasts.values()], axis=0)
        laser = Laser.from_baseline_angle(1.0, 1.0, "x" if rows > columns else "y")
        rig = replace(self.rig, lasers=(laser,))
        lines = []
        for number, (name, image) in enumerate(contrasts.items()):
            line = keep_on_board(
                self._extract(image, number, rig), views[name], self.board, self.margin,
                camera=rig.camera, camera_from_board=poses[name], index=index_of(rig),
            )  # fmt: skip
            if len(line.pixels):
                lines.append(line)
            progress("find stripes", number + 1, len(contrasts))
        return lines

    def _apart(
        self,
        lines: list[StripeOnBoard],
        found: list[StripeOnBoard],
        contrasts: dict[str, Image],
        views: dict[str, BoardView],
        poses: dict[str, Pose],
        progress: Progress,
    ) -> list[StripeOnBoard]:
        """Add lines to those found before, and find these once more without the new ones.

        Where two lines are equally bright, a finder that gives one centre a scan line leaps from
        one to the other.
        """
        new = {line.name: line for line in found}
        cleared = {
            line.name: blank_line(self._whole[line.name], new[line.name].pixels)
            for line in lines
            if line.name in new
        }
        again = {line.name: line for line in self._find_one_each(cleared, views, poses, progress)}
        for name, line in new.items():
            contrasts[name] = blank_line(contrasts[name], line.pixels)
        return [*(again.get(line.name, line) for line in lines), *found]

    def _extract(self, image: Image, number: int, rig: Rig) -> Pixels:
        """Find the stripe in one photo. Photos differ in light, so each is learnt by itself."""
        frame = Frame(image, number, float(number))
        background = self.extractor.learn([frame], rig)
        (stripe,) = self.extractor.extract([frame], rig, background)
        return stripe.pixels
