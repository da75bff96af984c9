"""Pieces of a long benchmark: kept in a folder, so that it can be stopped and gone on with."""

import argparse
import json
import pickle
import shutil
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

Made = TypeVar("Made")


@dataclass(frozen=True)
class Kept:
    """The folder, and until when there is time for more."""

    folder: Path
    until: float

    def take(self, name: str, make: Callable[[], Any]) -> Any:
        """Give what is kept under a name; otherwise make it, of plain values, and keep it.

        Raises:
            TimeoutError: The time is over.
        """
        file = self.folder / f"{name}.json"
        if not file.exists():
            self._require_time()
            file.write_text(json.dumps(make()), "utf-8")
        return json.loads(file.read_text("utf-8"))

    def take_scan(self, name: str, make: Callable[[], Made]) -> Made:
        """Give the scan that is kept under a name, as it is, so that it can be measured anew.

        Raises:
            TimeoutError: It is not there, and the time is over.
        """
        file = self.folder / f"{name}.pickle"
        if not file.exists():
            self._require_time()
            file.write_bytes(pickle.dumps(make()))
        made: Made = pickle.loads(file.read_bytes())
        return made

    def take_folder(self, name: str, fill: Callable[[Path], object]) -> Path:
        """Give the folder of a name, filled; one that was left half filled is filled anew.

        Raises:
            TimeoutError: It is not there, and the time is over.
        """
        folder = self.folder / name
        if not (folder / "whole").exists():
            self._require_time()
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir(parents=True)
            fill(folder)
            (folder / "whole").touch()
        return folder

    def _require_time(self) -> None:
        if time.monotonic() > self.until:
            raise TimeoutError


def make_in_pieces(work: Callable[[Kept], Made]) -> Made:
    """Do the work with the flags --keep and --seconds; end the program where the time is over."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--keep", type=Path, help="folder that keeps finished pieces")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="stop after so long")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as aside:
        folder = given.keep or Path(aside)
        folder.mkdir(parents=True, exist_ok=True)
        try:
            return work(Kept(folder, time.monotonic() + given.seconds))
        except TimeoutError:
            print("stopped; run the same command again to go on")
            sys.exit(0)
