"""A scan's folder: its record, its stages, and who may write into it."""

from collections.abc import Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from ..errors import InputError, MissingResult
from ..io.values import from_plain, load_value, save_value
from .files import StageFiles
from .kinds import STAGES, Kind
from .lock import hold
from .scan_record import ScanRecord
from .stage import Finished, Key, Stage, read_record, record_of

R = TypeVar("R")
_OF_A_DIVE = ("capture", "live")
"""What `murkscan live` leaves in the folder before it scans into it."""


@dataclass(frozen=True)
class ScanFolder:
    """The folder OUT of a scan, whatever lies in it."""

    root: Path
    command: Sequence[str] = ()
    """The words that were typed after `murkscan`; each stage that is made keeps them."""

    def __post_init__(self) -> None:
        """Take a text for a path."""
        object.__setattr__(self, "root", Path(self.root))

    def hold(self) -> AbstractContextManager[None]:
        """Keep the folder for one's own while something is made in it; see `lock.hold`."""
        return hold(self.root, self.command)

    def save_scan(self, record: ScanRecord) -> None:
        """Write scan.json."""
        save_value(self.root / "scan.json", record)

    def load_scan(self) -> ScanRecord:
        """Read scan.json.

        Raises:
            MissingResult: The folder holds no scan.
            FormatError: It is damaged.
        """
        if not (self.root / "scan.json").exists():
            raise MissingResult(
                f"{self.root} holds no scan; run `murkscan scan` or `murkscan extract` into it "
                "first."
            )
        return load_value(self.root / "scan.json", ScanRecord)

    def check_writable(self) -> None:
        """Refuse a folder that holds something other than a scan, so that nothing is mixed.

        Raises:
            InputError: It is a file, or a folder with other things in it.
        """
        if self.root.is_file():
            raise InputError(f"{self.root} is a file; give a folder with --out.")
        is_scan = (self.root / "scan.json").exists()
        # A hidden file is what a run left that was killed while it wrote its first one.
        names = [file.name for file in self.root.glob("*") if not file.name.startswith(".")]
        others = [name for name in names if name not in _OF_A_DIVE]
        if others and not is_scan:
            raise InputError(f"{self.root} holds other files; give a new folder with --out.")

    def stage(
        self,
        kind: Kind[R],
        *,
        settings: Mapping[str, Any],
        inputs: Mapping[str, Any],
        label: str = "",
    ) -> Stage[R]:
        """Give a stage's folder, to be made with these settings and inputs."""
        key = Key(kind.meaning, settings, inputs)
        return Stage(self.root / kind.word, kind, key, tuple(self.command), label)

    def finished(self, kind: Kind[R], label: str = "") -> Finished[R]:
        """Give a stage as it was finished last; of those that share a folder the one of a label.

        Raises:
            MissingResult: It has not been run, not to its end, or a stage before it has been run
                anew since.
            FormatError: What it said is damaged.
        """
        folder, word = self.root / kind.word, kind.word
        file = record_of(folder, label)
        record = read_record(file)
        if record is None or record.result is None:
            raise MissingResult(
                f"{self.root} holds nothing that `murkscan {word}` has finished; run it, or "
                "`murkscan scan`, first."
            )
        for source in STAGES:
            digest = record.key.inputs.get(source.word)
            if digest is not None and self.finished(source).digest != digest:
                raise MissingResult(
                    f"The {word} stage of {self.root} is older than its {source.word} stage; run "
                    f"`murkscan {word}` or `murkscan scan` again."
                )
        result = from_plain(kind.result, record.result, name=str(file))
        return Finished(folder, result, record)

    def _files(self, kind: Kind[Any]) -> StageFiles:
        return StageFiles(self.root / kind.word)
