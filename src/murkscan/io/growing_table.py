"""A text table to which another program adds lines."""

from pathlib import Path

from ..errors import FormatError
from .text_table import TextTable, parse_text_table


class GrowingTable:
    """Reads the lines that have come since the last look; what is half written waits."""

    def __init__(self, path: Path, what: str) -> None:
        """Begin at the file's begin.

        Args:
            path: The file, in UTF-8.
            what: What errors call it, such as "pose log".
        """
        self.path, self._what = path, what
        self._names: str | None = None
        self.rewind()

    def rewind(self) -> None:
        """Read from the file's begin again."""
        self._offset, self._lines = 0, 0

    def read_new(self) -> TextTable | None:
        """Read the whole lines that are new, behind the names of the columns; None without any.

        Raises:
            FormatError: The file cannot be read.
        """
        try:
            with self.path.open("rb") as file:
                file.seek(self._offset)
                data = file.read()
        except OSError as error:
            raise FormatError(
                f"The {self._what} {self.path} cannot be read: {error.strerror}."
            ) from error
        whole = data[: data.rfind(b"\n") + 1]
        if not whole:
            return None
        lines = whole.decode("utf-8-sig", "replace").splitlines()
        begin = self._lines
        self._offset, self._lines = self._offset + len(whole), begin + len(lines)
        if begin == 0:
            table = parse_text_table(lines)
            self._names = lines[0] if table.names else None
            return table
        names = [] if self._names is None else [self._names]
        return parse_text_table([*names, *lines], first=begin + 1 - len(names))
