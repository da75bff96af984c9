"""Pieces of a long benchmark: kept in a folder, so that it can be stopped and gone on with."""

import argparse
import glob
import hashlib
import json
import os
import pickle
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

SOURCE = Path(__file__).resolve().parents[1] / "src"

Made = TypeVar("Made")


@dataclass(frozen=True)
class Kept:
    """The folder, until when there is time for more, and by which code."""

    folder: Path
    until: float
    code: str = ""
    """Digest of the code that makes scans: those that other code has made are made anew."""

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
        file = self.folder / f"{name} {self.code}.pickle"
        if not file.exists():
            self._require_time()
            whole = pickle.dumps(make())
            self._forget_stale(name)
            aside = file.with_suffix(".part")
            aside.write_bytes(whole)
            os.replace(aside, file)
        made: Made = pickle.loads(file.read_bytes())
        return made

    def take_folder(self, name: str, fill: Callable[[Path], object]) -> Path:
        """Give the folder of a name, filled; one that was left half filled is filled anew.

        Raises:
            TimeoutError: It is not there, and the time is over.
        """
        folder = self.folder / f"{name} {self.code}"
        if not (folder / "whole").exists():
            self._require_time()
            self._forget_stale(name)
            folder.mkdir(parents=True)
            fill(folder)
            (folder / "whole").touch()
        return folder

    def _require_time(self) -> None:
        if time.monotonic() > self.until:
            raise TimeoutError

    def _forget_stale(self, name: str) -> None:
        for old in self.folder.glob(f"{glob.escape(name)} *"):
            shutil.rmtree(old) if old.is_dir() else old.unlink()


def digest_code(modules: Sequence[str], files: Sequence[str]) -> str:
    """Give a digest of modules of murkscan, of all that they import, and of benchmarks' files."""
    import grimp

    graph = grimp.build_graph("murkscan", cache_dir=None)
    parts = set(modules).union(*(graph.find_descendants(name) for name in modules))
    used = parts.union(*(graph.find_upstream_modules(part) for part in parts))
    paths = [Path(__file__).with_name(file) for file in files]
    for name in sorted(used):
        stem = SOURCE.joinpath(*name.split("."))
        tables = [one for one in sorted(stem.glob("*")) if one.suffix in (".toml", ".npz", ".csv")]
        paths += [stem / "__init__.py", *tables] if stem.is_dir() else [stem.with_suffix(".py")]
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()[:8]


def make_in_pieces(work: Callable[[Kept], Made], *, code: str = "") -> Made:
    """Do the work with the flags --keep and --seconds; end the program where the time is over.

    Args:
        work: Does it.
        code: Digest of the code that makes the scans that are kept.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument("--keep", type=Path, help="folder that keeps finished pieces")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="stop after so long")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as aside:
        folder = given.keep or Path(aside)
        folder.mkdir(parents=True, exist_ok=True)
        try:
            return work(Kept(folder, time.monotonic() + given.seconds, code))
        except TimeoutError:
            print("stopped; run the same command again to go on")
            sys.exit(0)
