"""One run at a time in a folder: who is at work there is told to whoever comes second."""

import os
import socket
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from filelock import FileLock, Timeout

from ..errors import DeviceError, FormatError, InputError
from ..io.values import load_value, save_value

_LOCK, _OWNER = ".lock", ".lock.json"


@dataclass(frozen=True)
class _Owner:
    """The process that works in a folder."""

    process: int
    host: str
    since: datetime
    command: tuple[str, ...]

    def __str__(self) -> str:
        typed = f" (murkscan {' '.join(self.command)})" if self.command else ""
        since = f"{self.since:%Y-%m-%d %H:%M:%S} UTC"
        return f"process {self.process} on {self.host}{typed}, since {since}"


@contextmanager
def hold(root: Path, command: Sequence[str] = ()) -> Iterator[None]:
    """Keep a folder for one's own; a thread that holds it may hold it again.

    The operating system lets go of it when a process ends, however it ends, so that nothing stale
    has to be told from what is not.

    Raises:
        InputError: Another run is at work in it.
        DeviceError: The folder cannot be written.
    """
    lock = FileLock(root / _LOCK, timeout=0, is_singleton=True)
    try:
        root.mkdir(parents=True, exist_ok=True)
        lock.acquire()
    except Timeout as error:
        raise InputError(
            f"{root} is in use by {_owner(root)}. Wait until it is done, or stop it; two runs "
            "into one folder would spoil each other's work."
        ) from error
    except OSError as error:
        raise DeviceError(
            f"Cannot write into {root}: {error.strerror or error}. Give another folder."
        ) from error
    try:
        if lock.lock_counter == 1:
            save_value(root / _OWNER, _me(command))
        yield
    finally:
        if lock.lock_counter == 1:
            with suppress(OSError):
                (root / _OWNER).unlink()
        lock.release()


def _me(command: Sequence[str]) -> _Owner:
    return _Owner(os.getpid(), socket.gethostname(), datetime.now(UTC), tuple(command))


def _owner(root: Path) -> str:
    try:
        return str(load_value(root / _OWNER, _Owner))
    except (FormatError, DeviceError):  # it has only just begun
        return "another run"
