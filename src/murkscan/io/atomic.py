"""Files that appear whole or not at all."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import DeviceError


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Write a file aside and put it in place when it is finished.

    Args:
        path: Where the file shall be; its folder is made where it is missing.

    Yields:
        A path beside it to write to, with the same suffix.

    Raises:
        DeviceError: The disk is full or cannot be written; what stood at the path is untouched.
    """
    aside = aside_of(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield aside
        aside.replace(path)
    except OSError as error:
        if isinstance(error, DeviceError):
            raise
        raise DeviceError(
            f"Cannot write {path}: {error.strerror or error}. Make room or give another folder and "
            "run the same command again; what is finished is kept."
        ) from error
    finally:
        with suppress(OSError):
            aside.unlink()


def aside_of(path: Path) -> Path:
    """Name the file that stands in for one that is being written."""
    return path.with_name(f".{path.stem}.part{path.suffix}")
