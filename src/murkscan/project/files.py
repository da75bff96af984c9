"""The files of one stage: entered while they are made, and checked when they are read."""

from collections.abc import Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

from ..errors import FormatError, MissingResult
from ..io.checksum import Mark, mark_file
from .ledger import Marks, entering, is_whole, ledger_of, read_ledger, strike
from .stage import read_record, record_of


@dataclass(frozen=True)
class StageFiles:
    """What a stage has made in its folder, whether it is finished or not."""

    folder: Path
    label: str = ""
    """What tells the stage from others in its folder."""

    def making(self, name: str) -> AbstractContextManager[Path]:
        """Enter a file into the ledger of a stage that has begun; gives the path to make it at."""
        return entering(ledger_of(self.folder, self.label), name)

    def remove(self, name: str) -> None:
        """Remove a file that is not to stay."""
        strike(ledger_of(self.folder, self.label), name)

    def made(self, below: str = "") -> Mapping[str, Mark]:
        """Give the files in a subfolder by name: of a finished stage all, so that one is missed.

        Of a stage that is being made those that are whole, as far as their size tells.
        """
        marks, is_done = self._marks()
        return {
            name: mark
            for name, mark in sorted(marks.items())
            if name.startswith(below)
            and mark is not None
            and (is_done or is_whole(self.folder / name, mark))
        }

    def checked(self, name: str) -> Path:
        """Give the path of a file, after comparing it with its checksum.

        Raises:
            MissingResult: It is not there.
            FormatError: It is not as it was written.
        """
        mark, path = self._marks()[0].get(name), self.folder / name
        if mark is None or not path.is_file():
            raise MissingResult(f"{path} is missing; run `{self._maker}` again, which makes it.")
        if mark_file(path) != mark:
            raise FormatError(
                f"{path} is not as it was written: its checksum is another. Delete it and run "
                f"`{self._maker}` again, which makes it anew."
            )
        return path

    @property
    def _maker(self) -> str:
        return "murkscan measure" if self.label else "murkscan scan"

    def _marks(self) -> tuple[Marks, bool]:
        """Give the marks of what has been made, and whether the stage is finished."""
        record = read_record(record_of(self.folder, self.label))
        if record is not None and record.result is not None:
            return record.files, True
        return read_ledger(ledger_of(self.folder, self.label)), False
