"""One stage's folder: what it was made from, what it holds, and how it is made anew."""

import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Generic, TypeVar

from ..errors import FormatError
from ..io.checksum import Mark
from ..io.json_files import load_json
from ..io.values import as_plain, from_plain, save_value
from .describe import digest
from .kinds import Kind
from .ledger import close_ledger, is_whole, ledger_of, read_ledger, remove_files, write_ledger

R = TypeVar("R")


@dataclass(frozen=True)
class Key:
    """What a stage was made from; another key is another result."""

    meaning: int = 0
    """The number of `Kind.meaning`."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    inputs: Mapping[str, Any] = field(default_factory=dict)
    """The digests of the stages before it, and of what came from outside."""

    @property
    def digest(self) -> str:
        """A short text that changes with the key; later stages name it as their input."""
        return digest(as_plain(self))


@dataclass(frozen=True)
class Record:
    """What stage.json says."""

    key: Key
    seconds: float = 0.0
    """How long the run took that finished the stage [s]."""
    command: tuple[str, ...] = ()
    """The words that were typed after `murkscan`; none from Python."""
    result: Mapping[str, Any] | None = None
    """None before it is finished."""
    files: Mapping[str, Mark] = field(default_factory=dict)
    """All that it has made, relative to its folder."""


def record_of(folder: Path, label: str = "") -> Path:
    """Name the record of a stage; in a folder that several share, each has its label."""
    return folder / (f"{label}.stage.json" if label else "stage.json")


def read_record(file: Path) -> Record | None:
    """Read a stage.json; None where there is none, and one that is damaged counts as none."""
    try:
        about = file.stat()
        return _parse(file, about.st_ino, about.st_size, about.st_mtime_ns)
    except (OSError, FormatError):
        return None


@lru_cache(maxsize=64)
def _parse(path: Path, inode: int, size: int, modified: int) -> Record:
    return from_plain(Record, load_json(path), name=str(path))


@dataclass(frozen=True)
class Stage(Generic[R]):
    """One stage's folder, and what it is to be made from."""

    folder: Path
    kind: Kind[R]
    key: Key
    command: tuple[str, ...] = ()
    """The words that were typed after `murkscan`, for the record."""
    label: str = ""
    """What tells it from others in its folder, such as a measurement's name."""

    @property
    def digest(self) -> str:
        """A short text that changes with the key; later stages name it as their input."""
        return self.key.digest

    def result(self) -> R | None:
        """Read what the stage said when it was finished with this very key.

        None before that, and where a file that it made is missing or cut off since.
        """
        record = read_record(self._record)
        if record is None or record.result is None or record.key.digest != self.digest:
            return None
        # What others put beside it, such as a file browser's notes, is no reason to begin again.
        if not all(is_whole(self.folder / name, mark) for name, mark in record.files.items()):
            return None
        with suppress(FormatError):
            return from_plain(self.kind.result, record.result, name=str(self._record))
        return None

    def begin(self) -> None:
        """Make the folder ready: what was made with this very key stays, what else is listed goes.

        A kill at any moment leaves a folder with which this can be done again.
        """
        record, ledger = read_record(self._record), read_ledger(self._ledger)
        marks = {**(record.files if record else {}), **ledger}
        if record is not None and record.key.digest == self.digest:
            begun = {name: mark for name, mark in marks.items() if not self._is_sound(name, mark)}
            remove_files(self.folder, begun)
            write_ledger(self._ledger, {n: mark for n, mark in marks.items() if n not in begun})
        else:
            remove_files(self.folder, marks)
            close_ledger(self._ledger)
        save_value(self._record, Record(self.key))

    def finish(self, result: R, *, since: float) -> None:
        """Say that the stage is done, and with what; it began `since` [s, monotonic clock]."""
        files = {
            name: mark
            for name, mark in sorted(read_ledger(self._ledger).items())
            if mark is not None and is_whole(self.folder / name, mark)
        }
        seconds = round(time.monotonic() - since, 3)
        record = Record(self.key, seconds, self.command, as_plain(result), files)
        save_value(self._record, record)
        close_ledger(self._ledger)

    def settle(self) -> None:
        """Remove what a kill has left of a stage that is finished: its ledger."""
        close_ledger(self._ledger)

    @property
    def _record(self) -> Path:
        return record_of(self.folder, self.label)

    @property
    def _ledger(self) -> Path:
        return ledger_of(self.folder, self.label)

    def _is_sound(self, name: str, mark: Mark | None) -> bool:
        return mark is not None and is_whole(self.folder / name, mark)


@dataclass(frozen=True)
class Finished(Generic[R]):
    """A stage as it was finished last."""

    folder: Path
    result: R
    record: Record

    @property
    def digest(self) -> str:
        """A short text that changes with what it was made from."""
        return self.record.key.digest
