"""The one folder that the studio shows: nothing outside of it is read or written."""

import os
from dataclasses import dataclass
from pathlib import Path

from ..errors import InputError

OWN = ".studio"
"""Where the studio keeps its lock and what its jobs said; hidden, as all that starts with a dot."""


@dataclass(frozen=True)
class Sandbox:
    """A folder, and the paths in it as pages write them: relative, with forward slashes."""

    root: Path

    @classmethod
    def open(cls, folder: Path) -> "Sandbox":
        """Take a folder; made where it is missing.

        Raises:
            InputError: It is a file, or cannot be made.
        """
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(
                f"{folder} cannot be the studio's folder: {error.strerror or error}. Give another."
            ) from error
        return cls(folder.resolve())

    def resolve(self, text: str) -> Path:
        """Give the path that a page means; links are followed before it is judged.

        Raises:
            InputError: It leads out of the folder, or to something hidden.
        """
        parts = text.replace("\\", "/").split("/")
        is_plain = text and "\0" not in text and not text.startswith("/") and ":" not in parts[0]
        if not is_plain or any(part.startswith(".") and part != "." for part in parts):
            raise InputError(f"{text!r} is no path within the studio's folder.")
        try:
            path = (self.root / text).resolve()
        except (OSError, RuntimeError, ValueError) as error:
            raise InputError(f"{text!r} is no path within the studio's folder.") from error
        if not path.is_relative_to(self.root):
            raise InputError(f"{text!r} leads out of the studio's folder.")
        return path

    def existing(self, text: str) -> Path:
        """Give the path of something that is there.

        Raises:
            InputError: It is not, or leads out of the folder.
        """
        path = self.resolve(text)
        if not path.exists():
            raise InputError(f"There is no {text!r} in the studio's folder.")
        return path

    def name(self, path: Path) -> str:
        """Write a path within the folder as pages do; the folder itself is a dot."""
        return path.relative_to(self.root).as_posix()

    def own(self, *names: str) -> Path:
        """Give a path of the studio's own."""
        return Path(os.path.join(self.root, OWN, *names))
