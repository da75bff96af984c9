"""Pictures, in any format that OpenCV knows."""

from pathlib import Path

import cv2
import numpy as np

from ..errors import FormatError
from ..types.arrays import ColourImage
from .atomic import replacing


def read_image(path: Path) -> np.ndarray:
    """Read a picture as it is stored: h w, or h w 3 in the order red, green, blue; 8 or 16 bit.

    Raises:
        FormatError: The file is no picture, or a broken one.
    """
    # Through memory, since OpenCV cannot open every name on every system.
    data = np.fromfile(path, np.uint8)
    try:
        image = cv2.imdecode(data, cv2.IMREAD_UNCHANGED) if data.size else None
    except (cv2.error, MemoryError):  # a header that claims more pixels than a camera has
        image = None
    if image is None or image.dtype not in (np.uint8, np.uint16):
        raise FormatError(f"{path} is not a picture that can be read; replace or remove it.")
    if image.ndim == 3:
        image = image[:, :, 0] if image.shape[2] == 1 else image[:, :, 2::-1]
    return np.ascontiguousarray(image)


def read_colour(path: Path) -> ColourImage:
    """Read a picture as 8-bit red, green, blue; a grey one has three equal channels.

    Raises:
        FormatError: The file is no picture, or a broken one.
    """
    image = read_image(path)
    if image.dtype == np.uint16:
        image = (image >> 8).astype(np.uint8)
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
