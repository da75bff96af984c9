"""The board in the photos of a folder as they come: each is looked at once."""

import threading
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..calibrate.board.chessboard import Chessboard
from ..calibrate.board.corners import find_board
from ..calibrate.board.view import BoardView
from ..calibrate.so_far import SoFar
from ..capture.folder import list_pictures
from ..capture.photos import Photo
from ..errors import FormatError, MurkscanError
from ..io.images import read_colour
from .calibrate_so_far import AbstractStep

_MOST = 300
"""Photos that are looked at; a calibration wants fifteen to fifty."""


@dataclass(frozen=True, eq=False)
class LookedAt:
    """One photo, and the board in it."""

    view: BoardView
    size: tuple[int, int]
    """Width and height [px]; 0 of one that cannot be read."""
    stamp: int
    """When the file changed last [ns]."""


class BoardFolder:
    """The photos of one folder with one kind of board, looked at by a thread of its own."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._known: dict[str, LookedAt] = {}
        self._judged: tuple[str, SoFar | str] = ("", "")
        self._lock = threading.Lock()
        self._worker: threading.Thread | None = None

    def look(
        self, board: Chessboard, step: AbstractStep
    ) -> tuple[list[LookedAt], int, SoFar | str]:
        """Say what is known by now, and go on looking in the background.

        Args:
            board: The board; with as many corners each time.
            step: What the photos are taken for.

        Returns:
            The photos that were looked at in order, how many there are, and what they are worth, or
            in a sentence why that cannot be said; nothing until the first judgement.
        """
        names = list_pictures(self.folder)[:_MOST]
        with self._lock:
            if self._worker is None or not self._worker.is_alive():
                self._worker = threading.Thread(
                    target=self._work, args=(names, board, step), daemon=True
                )
                self._worker.start()
            known = [self._known[name] for name in names if name in self._known]
            # What was judged for another step, or another square, says nothing of this one.
            is_same = self._judged[0].startswith(repr((board, step)))
            return known, len(names), self._judged[1] if is_same else ""

    def _work(self, names: Sequence[str], board: Chessboard, step: AbstractStep) -> None:
        for name in names:
            path = self.folder / name
            try:
                stamp = path.stat().st_mtime_ns
            except OSError:
                continue
            if name not in self._known or self._known[name].stamp != stamp:
                seen = _look_at(path, board, stamp)
                with self._lock:
                    self._known[name] = seen
        self._judge([self._known[name] for name in names if name in self._known], board, step)

    def _judge(self, seen: Sequence[LookedAt], board: Chessboard, step: AbstractStep) -> None:
        names = tuple((one.view.name, one.stamp) for one in seen)
        changed = [file.stat().st_mtime_ns for file in step.files]
        key = repr((board, step)) + repr((names, changed))
        sizes = Counter(one.size for one in seen if one.view.is_found)
        if key == self._judged[0] or not sizes:
            return
        size = sizes.most_common(1)[0][0]
        views = [one.view for one in seen if one.size == size]
        judged: SoFar | str
        try:
            judged = step.judge(self.folder, views, board, size)
        except MurkscanError as error:
            judged = str(error)
        with self._lock:
            self._judged = (key, judged)


def _look_at(path: Path, board: Chessboard, stamp: int) -> LookedAt:
    try:
        photo = Photo(path.name, read_colour(path))
    except (FormatError, OSError):
        view = BoardView(path.name, np.zeros((0, 2)), reason="cannot be read")
        return LookedAt(view, (0, 0), stamp)
    return LookedAt(find_board(photo.as_grey(), board, name=path.name), photo.size, stamp)
