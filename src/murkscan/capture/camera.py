"""Pictures from a camera at this machine."""

import re
import time
from collections.abc import Generator

import cv2
import numpy as np

from ..errors import StreamLost


def is_camera(source: str) -> bool:
    """Tell whether a source is a local camera: its number, or /dev/video and its number."""
    return re.fullmatch(r"[0-9]{1,3}|/dev/video[0-9]+", source) is not None


def camera_images(source: str) -> Generator[tuple[np.ndarray, float], None, None]:
    """Take pictures from a camera as they arrive.

    Args:
        source: Number of the camera, or its device file.

    Yields:
        Each picture (h w, or h w 3 red, green, blue) and the time of its arrival [s], from any
        beginning.

    Raises:
        StreamLost: There is no such camera, it is in use, or it stops.
    """
    camera = cv2.VideoCapture(int(source) if source.isdigit() else source)
    try:
        if not camera.isOpened():
            raise StreamLost(
                f"Camera {source} cannot be opened; check that it is plugged in, that no other "
                "program uses it, and that you may use video devices."
            )
        while True:
            arrived, image = camera.read()
            now = time.monotonic()
            if not arrived:
                raise StreamLost(f"Camera {source} stopped sending; check its cable.")
            yield (image if image.ndim == 2 else image[:, :, ::-1]), now
    finally:
        camera.release()
