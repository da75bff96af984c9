"""Text files, such as pages."""

from pathlib import Path

from .atomic import replacing


def save_text(path: Path, text: str) -> None:
    """Write a text as UTF-8.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with replacing(path) as aside:
        aside.write_text(text, "utf-8", errors="backslashreplace")
