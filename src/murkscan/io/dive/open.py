"""From a path to the messages of a dive's file, or of a bag's several ones."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from ...errors import FormatError, InputError
from .mcap_file import read_mcap
from .messages import Message, Tell, Topic
from .names import KINDS, METADATA, DiveKind
from .ros1_bag import read_ros1
from .ros2_database import read_ros2
from .tlog import read_tlog

_READERS = {
    "MCAP": read_mcap,
    "bag of ROS 1": read_ros1,
    "bag of ROS 2": read_ros2,
    "tlog": read_tlog,
}
_FILE = 1 << 48
"""Places of the second file of a bag begin here: larger than any file."""


@dataclass(frozen=True)
class DiveFile:
    """A file of messages, or the files of a bag in their order."""

    path: Path
    kind: DiveKind
    files: tuple[Path, ...]
    topics: tuple[dict[int, Topic], ...] = field(compare=False)
    """Of each file the topics that were met, by their numbers there."""

    def messages(self, start: int = 0, *, tell: Tell = lambda words: None) -> Iterator[Message]:
        """Read the messages in the order in which they were written.

        Args:
            start: Place of the message to start with; 0 for the beginning. A later one takes the
                topics that a reading from the beginning has met.
            tell: Is told, in sentences, of what cannot be read.

        Raises:
            FormatError: A file is not what its name says.
            MissingDependency: What reads it is not installed.
        """
        first, place = divmod(start, _FILE)
        for number in range(first, len(self.files)):
            read = _READERS[self.kind](self.files[number], place, self.topics[number], tell)
            for message in read:
                yield message._replace(place=message.place + number * _FILE) if number else message
            place = 0


def open_dive(path: Path) -> DiveFile:
    """Find out what a dive's recording is; nothing of it is read yet.

    Raises:
        InputError: There is nothing at the path.
        FormatError: It is none, or one that is compressed as a whole.
    """
    if not path.exists():
        raise InputError(f"There is no recording at {path}; check the spelling of the path.")
    if not path.is_dir():
        kind = KINDS.get(path.suffix.lower())
        if kind is None:
            raise FormatError(
                f"{path} is no recording of a dive: those end in {', '.join(KINDS)}, or are a "
                f"folder with {METADATA}."
            )
        return DiveFile(path, kind, (path,), ({},))
    files = sorted(
        (file for file in path.iterdir() if file.suffix in (".mcap", ".db3")), key=_order
    )
    if not files:
        packed = [file.name for file in path.iterdir() if file.suffix == ".zstd"]
        raise FormatError(
            f"{path} holds no .mcap and no .db3"
            + (f", only {packed[0]}: unpack it with `zstd -d`." if packed else ".")
        )
    kinds = {KINDS[file.suffix] for file in files}
    if len(kinds) > 1:
        raise FormatError(f"{path} holds .mcap and .db3; sort the two recordings apart.")
    return DiveFile(path, kinds.pop(), tuple(files), tuple({} for _ in files))


def _order(file: Path) -> tuple[int, str]:
    """Sort a bag's files by the number that ends their names: name_2 before name_10."""
    digits = file.stem.rsplit("_", 1)[-1]
    return (int(digits) if digits.isdecimal() else 0, file.name)
