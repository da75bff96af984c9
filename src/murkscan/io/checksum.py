"""Checksums of files: how a flipped bit is noticed."""

import hashlib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

_BYTES = 16
"""Length of a checksum: two files in 2⁶⁴ have the same."""


@dataclass(frozen=True)
class Mark:
    """What tells whether a file is still as it was written."""

    size: int
    """Its length [bytes]."""
    blake2b: str
    """Its BLAKE2b checksum of 16 bytes, in hexadecimal digits (RFC 7693)."""


def mark_file(path: Path) -> Mark:
    """Compute a file's mark; a file that has not changed since it was asked for is not read again.

    Raises:
        OSError: There is no such file, or it cannot be read.
    """
    about = path.stat()
    return _mark(path, about.st_ino, about.st_size, about.st_mtime_ns)


@lru_cache(maxsize=1 << 16)
def _mark(path: Path, inode: int, size: int, modified: int) -> Mark:
    with path.open("rb") as file:
        digest = hashlib.file_digest(file, lambda: hashlib.blake2b(digest_size=_BYTES))
    return Mark(size, digest.hexdigest())
