"""A video file that grows while a recording runs, and survives its end."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import av

from ..errors import DeviceError, InputError

TICKS = 1000
"""Ticks a second of a Matroska file's times."""


@dataclass(frozen=True)
class RecordingProgress:
    """What a running recording has written so far."""

    frames: int
    """Pictures written."""
    seconds: float
    """Time of the last of them [s]; the first is at 0."""
    bytes: int
    """Size of what was written."""


@contextmanager
def growing_video(out: Path) -> Iterator[Any]:
    """Write a Matroska file aside and put it in place when the recording ends, however it ends.

    Each second goes to the disk as it comes, so that even after a power cut the part beside it
    plays up to its last second.

    Args:
        out: Where the file shall be; nothing may stand there.

    Yields:
        PyAV's container to write to.

    Raises:
        InputError: It does not end in .mkv, or a file stands there or beside it.
        DeviceError: The disk is full or cannot be written; what came before is in the part.
    """
    part = out.with_name(f"{out.stem}.part{out.suffix}")
    _check(out, part)
    try:
        part.parent.mkdir(parents=True, exist_ok=True)
        with av.open(
            str(part),
            "w",
            format="matroska",
            options={"cluster_time_limit": "1000", "flush_packets": "1"},
        ) as container:
            yield container
    except DeviceError:
        _put_in_place(part, out)
        raise
    except (av.error.FFmpegError, OSError) as error:
        raise DeviceError(
            f"Cannot write {part}: {error.strerror}. Make room; what came so far is in that file "
            "and plays."
        ) from error
    except BaseException:
        _put_in_place(part, out)
        raise
    _put_in_place(part, out)


def _check(out: Path, part: Path) -> None:
    if out.suffix.lower() != ".mkv":
        raise InputError(f"A recording is kept as Matroska; call it {out.with_suffix('.mkv')}.")
    if out.exists():
        raise InputError(f"{out} exists already; give another name, or move it away.")
    if part.exists():
        raise InputError(
            f"{part} is left from a recording that was cut short and plays; rename it, or remove "
            "it."
        )


def _put_in_place(part: Path, out: Path) -> None:
    """Give the finished file its name; an empty one goes."""
    if part.exists() and part.stat().st_size == 0:
        part.unlink()
    if part.exists():
        part.rename(out)
