"""The way every calibration goes: look for boards, adjust, judge, save, draw, write the page."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ..calibrate.board.charuco import Markers
from ..calibrate.board.chessboard import Chessboard
from ..calibrate.board.stripe import StripeOnBoard
from ..calibrate.board.view import BoardView
from ..calibrate.calibration import Calibration
from ..calibrate.page import write_page
from ..calibrate.record import record_step
from ..calibrate.state import snapshot
from ..calibrate.verdict import CalibrationVerdict, judge
from ..capture.photos import BoardPhotos
from ..errors import EstimationError, InputError
from ..io.atomic import replacing
from ..io.rig_records import keep_rig_file
from ..io.rig_toml import parse_rig, read_tables, save_calibration
from .board_views import find_boards
from .calibrate_drawing import SUFFIX, draw_photos
from .progress import Progress

_SQUARES = 0.002
"""Difference of two sizes of squares, over them, from which they are not the same: a ruler's."""


@dataclass(frozen=True, eq=False)
class CalibrationResult:
    """What a calibration gave."""

    calibration: Calibration
    """What was found and how sure it is."""
    verdict: CalibrationVerdict
    """The same in plain words."""
    num_photos: int
    """Photos that could be read."""
    unused: Mapping[str, str]
    """Photos that were not used, and why."""
    pictures: Path
    """Folder of the photos with what was found drawn over them."""
    page: Path
    """The page that shows all of it."""
    record: Path
    """The rig file as this step left it; see `io.rig_records`."""
    remarks: tuple[str, ...] = ()
    """What else is to be said, such as what must be calibrated again."""


@dataclass(eq=False)
class BoardSession:
    """The photos of one calibration, and what was found in them so far."""

    photos: BoardPhotos
    board: Chessboard
    rig_path: Path
    folder: Path
    """Where the drawings and the page go."""
    tables: dict[str, Any]
    """The rig file as it was before."""
    progress: Progress
    views: list[BoardView] = field(default_factory=list)
    size: tuple[int, int] = (0, 0)
    """Width and height of the photos [px]."""
    stripes: Sequence[StripeOnBoard] = ()
    unused: dict[str, str] = field(default_factory=dict)
    """Photos that are not used, and why."""
    remarks: tuple[str, ...] = ()
    """What is odd about the photos, which may explain an error."""

    @classmethod
    def open(
        cls, path: Path, board: Chessboard, rig_path: Path, name: str,
        *, tables: dict[str, Any], progress: Progress,
    ) -> "BoardSession":  # fmt: skip
        """Open the photos; `name` is the folder beside the rig file that the drawings go to.

        Raises:
            InputError: There are no photos, or they lie where the drawings go.
        """
        folder = rig_path.parent / "calibrate" / name
        if path.resolve().is_relative_to(folder.resolve()):
            raise InputError(
                f"The photos {path} lie in {folder}, where the drawings of this calibration go; "
                "move them to another folder."
            )
        return cls(BoardPhotos.open(path), board, rig_path, folder, tables, progress)

    def find_boards(
        self, *, size: tuple[int, int] | None = None, markers: Markers | None = None
    ) -> list[BoardView]:
        """Look for the board in every photo; of `size` [px], where the rig has one."""
        self.views, self.size = find_boards(
            self.photos, self.board, self.progress, size=size, markers=markers
        )
        self.unused |= self.photos.skipped
        self.unused |= {view.name: view.reason for view in self.views if not view.is_found}
        return self.views

    def solve(self, fit: "Fit") -> Calibration:
        """Fit; where there is no answer, the photos are drawn, and the error says where."""
        try:
            return fit(self)
        except EstimationError as error:
            self._draw(None)
            told = " ".join([str(error), *self.remarks])
            raise type(error)(
                f"{told} The photos with what was found in them lie in {self.folder}."
            ) from error

    def finish(
        self, calibration: Calibration, step: Sequence[str], *, title: str, keep_water: bool = True
    ) -> CalibrationResult:
        """Judge, write the rig file, draw the photos and write the page.

        Args:
            calibration: What was found.
            step: Where in [calibration] its record goes, such as ("laser", "0").
            title: What the page is called.
            keep_water: Whether [water] stays as it is.
        """
        self.unused |= dict.fromkeys(calibration.left_out, "fits far worse than the others")
        verdict, remarks = judge(calibration), self._say_what_lost_its_covariance(calibration)
        other = tuple(doubt_square(self.board, self.tables, step[0]))
        verdict = replace(verdict, advice=(*other, *verdict.advice))
        record = record_step(calibration, verdict, self.board, len(self.views), self.tables)
        record["unused"] = self.unused
        if calibration.step in ("port", "laser"):
            record["before"] = snapshot(self.tables, lasers=calibration.lasers)
        if self.rig_path.exists():
            keep_rig_file(self.rig_path, f"before-{self.folder.name}")
        save_calibration(self.rig_path, calibration.rig, step, record=record,
                         lasers=_moved(calibration), keep_water=keep_water)  # fmt: skip
        kept = keep_rig_file(self.rig_path, self.folder.name)
        self._draw(calibration)
        page = self.folder / "index.html"
        with replacing(page) as aside:
            text = write_page(calibration, verdict, self.unused, title=title, suffix=SUFFIX)
            aside.write_text(text, "utf-8")
        return CalibrationResult(
            calibration, verdict, len(self.views), self.unused, self.folder, page, kept,
            (*self.remarks, *remarks),
        )  # fmt: skip

    def _say_what_lost_its_covariance(self, calibration: Calibration) -> tuple[str, ...]:
        """Name the parts of the rig that were calibrated with the camera as it was before."""
        if "camera" not in self.tables:
            return ()
        before = parse_rig(read_tables(self.rig_path), name=str(self.rig_path)).covariance
        after = calibration.rig.covariance.names
        lost = [part for part in parts_of(before.names) if part not in parts_of(after)]
        return tuple(
            f"The {part} was calibrated with the camera as it was; calibrate it again."
            for part in lost
        )

    def _draw(self, calibration: Calibration | None) -> None:
        draw_photos(
            self.photos, self.views, self.folder, board=self.board, stripes=self.stripes,
            calibration=calibration, unused=self.unused, progress=self.progress,
        )  # fmt: skip


Fit = Callable[[BoardSession], Calibration]
"""Calibrates one step on the boards that a session found, and writes nothing."""


def doubt_square(board: Chessboard, tables: Mapping[str, Any], step: str) -> Iterator[str]:
    """Say where another step was calibrated on such a board with squares of another size.

    The scale of a laser or a port comes from the squares, and nothing in the photos tells them.

    Args:
        board: The board of this step.
        tables: The rig file as it was.
        step: Which step this is.
    """
    steps = tables.get("calibration", {})
    for name, record in steps.items():
        if name == step or not isinstance(record, Mapping) or record.get("board") != str(board):
            continue
        square, other = board.square * 1e3, float(record.get("square_mm", board.square * 1e3))
        if abs(square - other) > _SQUARES * square:
            yield (
                f"The squares are {square:g} mm here and were {other:g} mm when the {name} was "
                "calibrated on such a board: one of the two is wrong unless these are two boards, "
                "and all lengths are wrong with it. Measure ten squares with a ruler."
            )


def parts_of(names: Sequence[str]) -> list[str]:
    """Name the parts of a rig whose parameters these are: port, laser 0, mount."""
    words = {"camera.port": "port", "mount": "mount"}
    words |= {f"laser[{number}]": f"laser {number}" for number in range(len(names))}
    return [
        part for key, part in words.items() if any(name.startswith(f"{key}.") for name in names)
    ]


def _moved(calibration: Calibration) -> dict[int, Any]:
    """List the lasers that are new, or moved along because their errors go together."""
    rig = calibration.rig
    return {
        number: laser
        for number, laser in enumerate(rig.lasers)
        if any(name.startswith(f"laser[{number}]") for name in rig.covariance.names)
    }


def size_in(tables: Mapping[str, Any]) -> tuple[int, int]:
    """Give width and height of a rig's pictures [px], of the tables of its file."""
    width, height = tables["camera"]["size"]
    return int(width), int(height)
