"""The calibrate page: the boards in a folder's photos, and what they are worth so far."""

import math
import re
from collections import OrderedDict
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..calibrate.board.chessboard import Chessboard
from ..calibrate.so_far import SoFar
from ..errors import FormatError, InputError
from ..io.json_files import load_json
from ..survey.board_folder import BoardFolder, LookedAt
from ..survey.calibrate_laser import FanKnowledge, LaserPlan
from ..survey.calibrate_mount import PhotoClock
from ..survey.calibrate_port import PortKnowledge
from ..survey.calibrate_so_far import (
    AbstractStep,
    CameraStep,
    CheckStep,
    LaserStep,
    MountStep,
    PortStep,
)
from ..survey.photograph import SIGHT
from ..ui.calibration_values import read_lasers, read_margin, read_measured
from .sandbox import Sandbox

_KEPT = 4
"""Folders whose photos are remembered."""
_BOARD = re.compile(r"(\d{1,3})x(\d{1,3})")
_UNSAID = "10"
"""Side of a square where it is not said yet [mm]; nothing that is written depends on it."""


class Boards:
    """The folders of photos that pages have asked about last."""

    def __init__(self, sandbox: Sandbox) -> None:
        self._sandbox = sandbox
        self._folders: OrderedDict[tuple[Path, int, int], BoardFolder] = OrderedDict()

    def tell(self, given: Mapping[str, str]) -> dict[str, Any]:
        """Say which photos show the board, what they are worth so far, and what is missing.

        Args:
            given: `folder`, `step`, `board`, and the flags of the step's command by name.

        Raises:
            InputError: The folder is none, or the board is none, or a value is none.
        """
        path = self._sandbox.existing(given.get("folder", ""))
        board, step = _read_board(given), read_step(self._sandbox, given)
        if not path.is_dir():
            return {"is_folder": False, "photos": [], "count": 0, "so_far": None, "fault": ""}
        key = (path, board.columns, board.rows)
        folder = self._folders.setdefault(key, BoardFolder(path))
        self._folders.move_to_end(key)
        if len(self._folders) > _KEPT:
            self._folders.popitem(last=False)
        photos, count, so_far = folder.look(board, step)
        return {
            "is_folder": True,
            "count": count,
            "photos": [_photo(self._sandbox, path, one) for one in photos],
            "fault": so_far if isinstance(so_far, str) else "",
            "so_far": None if isinstance(so_far, str) else _so_far(so_far),
        }


def read_step(sandbox: Sandbox, given: Mapping[str, str]) -> AbstractStep:
    """Read what a step's command would be given.

    Raises:
        InputError: A value is none, or a file is not in the folder.
    """
    step = given.get("step", "camera")
    if step == "camera":
        return CameraStep()
    if not given.get("rig"):
        raise InputError("Calibrate the camera first: this step needs its rig file.")
    rig = sandbox.existing(given.get("rig", ""))
    margin = read_margin(given["margin-mm"]) if given.get("margin-mm") else None
    if step == "port":
        distance = given.get("distance-mm", "")
        return PortStep(rig, PortKnowledge(read_measured(distance) if distance else None))
    lasers = read_lasers(given.get("laser") or "0")
    if step == "laser":
        fan = FanKnowledge() if given.get("kind") == "fan" else None
        return LaserStep(rig, LaserPlan(lasers, margin, fan))
    if step == "check":
        return CheckStep(rig, margin, lasers[0])
    clock = PhotoClock(
        _number("fps", given["fps"]) if given.get("fps") else None,
        time_offset=_number("time-offset-s", given.get("time-offset-s") or "0"),
    )
    if not given.get("poses"):
        raise InputError("The mount needs the log of poses: put it into the folder.")
    return MountStep(rig, sandbox.existing(given["poses"]), clock)


def _read_board(given: Mapping[str, str]) -> Chessboard:
    match = _BOARD.fullmatch(given.get("board", ""))
    if match is None:
        text = given.get("board", "")[:20]
        raise InputError(f"{text!r} is no board; give its inner corners, such as 9x6.")
    square = _number("square-mm", given.get("square-mm") or _UNSAID)
    return Chessboard(int(match[1]), int(match[2]), square / 1e3)


def _number(key: str, text: str) -> float:
    with suppress(ValueError):
        if math.isfinite(number := float(text)):
            return number
    raise InputError(f"{key} must be a number, got {text[:40]!r}.")


def _so_far(told: SoFar) -> dict[str, Any]:
    return {
        "found": told.num_found,
        "share": told.coverage.share if told.coverage else 0.0,
        "cells": told.coverage.cells.tolist() if told.coverage else [],
        "verdict": told.verdict,
        "is_good": told.is_good,
        "missing": list(told.missing),
        "precisions": [
            {"what": one.what, "said": one.said, "share": one.limit and one.sigma / one.limit}
            for one in told.precisions
            if math.isfinite(one.sigma)
        ],
        "rms_px": told.rms,
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
