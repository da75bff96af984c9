"""The calibrate page: the boards in a folder's photos, and what they are worth so far."""

import re
from collections import OrderedDict
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..calibrate.board.chessboard import Chessboard
from ..errors import FormatError, InputError
from ..io.json_files import load_json
from ..survey.board_folder import BoardFolder, LookedAt
from ..survey.photograph import SIGHT
from .sandbox import Sandbox

_KEPT = 4
"""Folders whose photos are remembered."""
_BOARD = re.compile(r"(\d{1,3})x(\d{1,3})")


class Boards:
    """The folders of photos that pages have asked about last."""

    def __init__(self, sandbox: Sandbox) -> None:
        self._sandbox = sandbox
        self._folders: OrderedDict[tuple[Path, str], BoardFolder] = OrderedDict()

    def tell(self, name: str, board: str) -> dict[str, Any]:
        """Say which photos show the board, and what is missing.

        Raises:
            InputError: The folder is none, or the board is none.
        """
        path, match = self._sandbox.existing(name), _BOARD.fullmatch(board)
        if match is None:
            raise InputError(f"{board[:20]!r} is no board; give its inner corners, such as 9x6.")
        if not path.is_dir():
            return {"is_folder": False, "photos": [], "count": 0, "so_far": None}
        # Of what size the squares are changes nothing here.
        chessboard = Chessboard(int(match[1]), int(match[2]), 1e-2)
        folder = self._folders.setdefault((path, board), BoardFolder(path, chessboard))
        self._folders.move_to_end((path, board))
        if len(self._folders) > _KEPT:
            self._folders.popitem(last=False)
        photos, count, so_far = folder.look()
        return {
            "is_folder": True,
            "count": count,
            "photos": [_photo(self._sandbox, path, one) for one in photos],
            "so_far": None
            if so_far is None
            else {
                "found": so_far.num_found,
                "share": so_far.coverage.share if so_far.coverage else 0.0,
                "cells": so_far.coverage.cells.tolist() if so_far.coverage else [],
                "verdict": so_far.verdict,
                "is_good": so_far.is_good,
                "missing": list(so_far.missing),
                "focal_sigma": so_far.focal_sigma,
                "rms_px": so_far.rms,
            },
        }


def tell_sight(sandbox: Sandbox, name: str) -> dict[str, Any]:
    """Say what the camera sees while photos are taken into a folder.

    Raises:
        InputError: It would not lie in the studio's folder.
    """
    sight = sandbox.resolve(name) / SIGHT
    told: dict[str, Any] = {"status": None, "picture": ""}
    # A file that is just being renamed into place is asked for again by the page.
    with suppress(FormatError, OSError):
        told["status"] = load_json(sight / "status.json")
        picture = sight / "picture.jpg"
        told["picture"] = f"{sandbox.name(picture)}?{picture.stat().st_mtime_ns}"
    return told


def ask_for_photo(sandbox: Sandbox, name: str) -> dict[str, Any]:
    """Ask for a photo of the next picture.

    Raises:
        InputError: No photos are being taken into that folder.
    """
    sight = sandbox.resolve(name) / SIGHT
    if not sight.is_dir():
        raise InputError(f"No photos are being taken into {name!r}.")
    (sight / "take").touch()
    return {"asked": True}


def _photo(sandbox: Sandbox, folder: Path, one: LookedAt) -> dict[str, Any]:
    return {
        "name": one.view.name,
        "file": f"{sandbox.name(folder / one.view.name)}?{one.stamp}",
        "size": one.size,
        "corners": [[round(u, 1), round(v, 1)] for u, v in one.view.corners.tolist()],
        "reason": "" if one.view.is_found else one.view.reason,
    }
