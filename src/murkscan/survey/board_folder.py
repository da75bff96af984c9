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
from ..calibrate.so_far import CameraSoFar, judge_so_far
from ..capture.folder import list_pictures
from ..capture.photos import Photo
from ..errors import FormatError
from ..io.images import read_colour

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
    """The photos of one folder with one board, looked at by a thread of its own."""

    def __init__(self, folder: Path, board: Chessboard) -> None:
        self.folder, self.board = folder, board
        self._known: dict[str, LookedAt] = {}
        self._judged: tuple[int, CameraSoFar | None] = (-1, None)
        self._lock = threading.Lock()
        self._worker: threading.Thread | None = None

    def look(self) -> tuple[list[LookedAt], int, CameraSoFar | None]:
        """Say what is known by now, and go on looking in the background.

        Returns:
            The photos that were looked at in order, how many there are, and what they are worth;
            None until the first judgement.
        """
        names = list_pictures(self.folder)[:_MOST]
        with self._lock:
            if self._worker is None or not self._worker.is_alive():
                self._worker = threading.Thread(target=self._work, args=(names,), daemon=True)
                self._worker.start()
            known = [self._known[name] for name in names if name in self._known]
            return known, len(names), self._judged[1]

    def _work(self, names: Sequence[str]) -> None:
        for name in names:
            path = self.folder / name
            try:
                stamp = path.stat().st_mtime_ns
            except OSError:
                continue
            if name not in self._known or self._known[name].stamp != stamp:
                seen = _look_at(path, self.board, stamp)
                with self._lock:
                    self._known[name] = seen
        self._judge([self._known[name] for name in names if name in self._known])

    def _judge(self, seen: Sequence[LookedAt]) -> None:
        key = hash(tuple((one.view.name, one.stamp) for one in seen))
        sizes = Counter(one.size for one in seen if one.view.is_found)
        if key == self._judged[0] or not sizes:
            return
        size = sizes.most_common(1)[0][0]
        views = [one.view for one in seen if one.size == size]
        judged = judge_so_far(views, self.board, size)
        with self._lock:
            self._judged = (key, judged)


def _look_at(path: Path, board: Chessboard, stamp: int) -> LookedAt:
    try:
        photo = Photo(path.name, read_colour(path))
    except (FormatError, OSError):
        view = BoardView(path.name, np.zeros((0, 2)), reason="cannot be read")
        return LookedAt(view, (0, 0), stamp)
    return LookedAt(find_board(photo.as_grey(), board, name=path.name), photo.size, stamp)
