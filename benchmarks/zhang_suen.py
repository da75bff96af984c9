"""Thinning against OpenCV contrib's: the same pixels, and how much sooner."""

import cv2
import numpy as np
from harness import Figure, best_time, tell

from murkscan._kernels.thinning import thin_zhang_suen


def opencv(binary: np.ndarray) -> np.ndarray:
    """Thin with OpenCV contrib."""
    kind = cv2.ximgproc.THINNING_ZHANGSUEN
    return cv2.ximgproc.thinning(binary.view(np.uint8) * np.uint8(255), thinningType=kind) > 0


def draw_stripe(height: int, width: int) -> np.ndarray:
    """Draw a stripe 13 px thick with some snow, as a threshold leaves it."""
    row = height / 2 + height / 6 * np.sin(np.arange(width) / 200)
    binary = np.abs(np.arange(height)[:, None] - row) < 6.5
    return binary | (np.random.default_rng(0).random(binary.shape) < 0.001)


def draw_blobs(height: int, width: int) -> np.ndarray:
    """Draw what a threshold leaves of a picture that is no stripe at all: half of it."""
    noise = np.random.default_rng(0).random((height, width))
    return cv2.GaussianBlur(noise, (0, 0), 12) > 0.5


def main() -> None:
    figures = []
    pictures = {
        "stripe, 1920 × 1200": (draw_stripe(1200, 1920), 10),
        "stripe, 720 × 576": (draw_stripe(576, 720), 10),
        "half-white picture, 720 × 576": (draw_blobs(576, 720), None),
    }
    for name, (binary, bar) in pictures.items():
        differ = int(np.sum(thin_zhang_suen(binary) != opencv(binary)))
        ours = best_time(lambda binary=binary: thin_zhang_suen(binary))
        theirs = best_time(lambda binary=binary: opencv(binary))
        figures += [
            Figure(f"{name}: pixels that differ", differ, at_most=0),
            Figure(f"{name}: OpenCV contrib / ours", theirs / ours, ": 1", at_least=bar),
            Figure(f"{name}: ours", ours * 1e3, "ms"),
        ]
    tell("zhang_suen", "Zhang-Suen thinning", figures, note="Shortest of seven runs of each.")


if __name__ == "__main__":
    main()
