"""Pictures, in any format that OpenCV knows."""

from pathlib import Path

import cv2
import numpy as np

from ..errors import FormatError
from ..types.arrays import ColourImage
from .atomic import replacing

_WHITE = 65535.0
NOT_READ = frozenset(
    [
        *(".heic", ".heif", ".avif", ".jxl", ".gif", ".exr", ".hdr", ".psd", ".insp", ".gpr"),
        *(".cr2", ".cr3", ".crw", ".nef", ".nrw", ".arw", ".sr2", ".dng", ".orf", ".raf"),
        *(".rw2", ".pef", ".srw", ".x3f", ".raw", ".iiq", ".3fr", ".fff"),
    ]
)
"""Suffixes of pictures that cameras write and that are not read here."""


def read_image(path: Path, page: int = 0) -> np.ndarray:
    """Read a picture as it is stored: h w, or h w 3 in the order red, green, blue; 8 or 16 bit.

    Real numbers become 16 bit: those from 0 to 1 are stretched to all of them, larger ones are
    rounded. Notes that ask for a turn are passed over.

    Args:
        path: The file.
        page: Number of the page, of a TIFF that has several.

    Raises:
        FormatError: The file is no picture, or a broken one, or of a kind that is not read.
    """
    if path.suffix.lower() in NOT_READ:
        raise FormatError(
            f"{path} is a picture of a kind that is not read; convert it to PNG or TIFF, without "
            "another size or other tones."
        )
    image = _decode(path, page)
    if image is not None and image.dtype in (np.float32, np.float64):
        image = _as_whole(image)
    if image is None or image.dtype not in (np.uint8, np.uint16):
        raise FormatError(f"{path} is not a picture that can be read; replace or remove it.")
    if image.ndim == 3:
        image = image[:, :, 0] if image.shape[2] == 1 else image[:, :, 2::-1]
    return np.ascontiguousarray(image)


def _decode(path: Path, page: int) -> np.ndarray | None:
    try:
        if page:
            _, pages = cv2.imreadmulti(str(path), page, 1, flags=cv2.IMREAD_UNCHANGED)
            return pages[0] if pages else None
        # Through memory, since OpenCV cannot open every name on every system.
        data = np.fromfile(path, np.uint8)
        return cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if data.size else None
    except (cv2.error, MemoryError):  # a header that claims more pixels than a camera has
        return None


def _as_whole(image: np.ndarray) -> np.ndarray:
    """Give real numbers in 16 bit; what is no number is 0."""
    known = np.nan_to_num(image, nan=0.0, posinf=_WHITE, neginf=0.0)
    scale = _WHITE if known.max(initial=0.0) <= 1 else 1.0
    return np.rint(np.clip(known * scale, 0, _WHITE)).astype(np.uint16)


def read_colour(path: Path) -> ColourImage:
    """Read a picture as 8-bit red, green, blue; a grey one has three equal channels.

    Of more than 8 bits the upper 8 of those that it uses are kept: 12 bits in 16 are common.

    Raises:
        FormatError: The file is no picture, or a broken one.
    """
    image = read_image(path)
    if image.dtype == np.uint16:
        bits = max(int(image.max(initial=0)).bit_length(), 8)
        image = (image >> (bits - 8)).astype(np.uint8)
    return image if image.ndim == 3 else np.repeat(image[:, :, None], 3, axis=2)


def write_image(path: Path, image: np.ndarray) -> None:
    """Write a picture (h w, or h w 3 in the order red, green, blue) in the format of its suffix.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    stored = image if image.ndim == 2 else image[:, :, ::-1]
    _, data = cv2.imencode(path.suffix, np.ascontiguousarray(stored))
    with replacing(path) as aside:
        aside.write_bytes(data.tobytes())
