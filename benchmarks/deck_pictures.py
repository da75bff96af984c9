"""The streams and the photographs of `deck_faults.py`."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import av
import cv2
import numpy as np
from live import halved

from murkscan.calibrate import Chessboard
from murkscan.io.images import read_image
from murkscan.simulate import Recorder, Scene, load_scene
from murkscan.survey.simulate import simulate_recording
from murkscan.types.arrays import Image

SQUARE = 0.03
"""Side of the board's squares [m]."""
BOARD = Chessboard(9, 6, SQUARE)
PICTURES, LINES = 20, 15
"""Pictures of a dive that are simulated, and photographs of the laser's line."""


def make_dive(folder: Path, attenuation: float) -> tuple[Path, list[Image]]:
    """Give the middle of a hull's dive through a small camera: its rig, and its pictures.

    It is simulated once for a folder.
    """
    folder = folder / f"dive-{attenuation:g}"
    if not (folder / "recording.mkv").exists():
        simulate_recording(_make_scene(attenuation), folder)
    with av.open(str(folder / "recording.mkv")) as source:
        pictures = [frame.to_ndarray(format="gray") for frame in source.decode(video=0)]
    return folder / "rig.toml", pictures


def _make_scene(attenuation: float) -> Scene:
    scene = halved(load_scene("hull-c1.5"))
    first = len(scene) // 2
    return replace(
        scene,
        medium=replace(scene.medium, attenuation=attenuation),
        sensor=replace(scene.sensor, interlaced=False),
        times=scene.times[first : first + 2 * PICTURES : 2],
        recorder=Recorder("ffv1"),
    )


def encode(path: Path, pictures: Sequence[Image], rate: int) -> None:
    """Write pictures without loss, with their times."""
    with av.open(str(path), "w") as container:
        stream = container.add_stream("ffv1", rate=rate)
        stream.height, stream.width = pictures[0].shape
        stream.pix_fmt = "gray"
        for number, picture in enumerate(pictures):
            frame = av.VideoFrame.from_ndarray(picture, "gray")
            frame.pts, frame.time_base = number, Fraction(1, rate)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))


def make_boards(folder: Path) -> tuple[list[Image], list[Image]]:
    """Simulate photographs of a board, and of the laser's line on it; once for a folder."""
    made = []
    for name, count in (("chessboard", 25), ("chessboard-laser", LINES)):
        out = folder / name
        if not out.exists():
            scene = load_scene(name)
            simulate_recording(replace(scene, times=scene.times[:count]), out)
        made.append([read_image(path) for path in sorted((out / "frames").glob("*.png"))])
    return made[0], made[1]


def draw_flat_board(number: int) -> Image:
    """Draw a board that faces the camera, at a place of its own."""
    random = np.random.default_rng(number)
    pitch = random.uniform(34, 50)
    left, top = random.uniform(60, 150), random.uniform(60, 120)
    v, u = np.mgrid[:1152, :1440] / 2
    column, row = np.floor((u - left) / pitch), np.floor((v - top) / pitch)
    inside = (column >= 0) & (column <= BOARD.columns) & (row >= 0) & (row <= BOARD.rows)
    dark = inside & ((column + row) % 2 == 0)
    drawn = cv2.resize(np.where(dark, 40.0, 190.0), (720, 576), interpolation=cv2.INTER_AREA)
    soft = cv2.GaussianBlur(drawn, (0, 0), 0.7) + random.normal(0, 1.5, drawn.shape)
    return np.clip(soft, 0, 255).astype(np.uint8)


def cut_off(picture: Image, share: float = 0.35) -> Image:
    """Move a picture to the left until its edge cuts the board; what comes in is plain."""
    shift = round(share * picture.shape[1])
    moved = np.full_like(picture, int(np.median(picture)))
    moved[:, :-shift] = picture[:, shift:]
    return moved


def light(image: Image, since: float) -> Image:
    """Switch a lamp on."""
    random = np.random.default_rng(round(1e3 * since))
    return np.clip(image + random.normal(95.0, 4.0, image.shape), 0, 255).astype(np.uint8)


def darken(image: Image, since: float) -> Image:
    """Switch the laser off."""
    random = np.random.default_rng(round(1e3 * since))
    level = float(np.percentile(image, 1))
    return np.clip(random.normal(level, 1.5, image.shape), 0, 255).astype(np.uint8)


def fog_up(image: Image, since: float) -> Image:
    """Fog the window within a second: most of the light goes astray by some pixels."""
    share = 0.85 * min(since, 1.0)
    blurred = cv2.GaussianBlur(image, (0, 0), 4.0)
    return cv2.addWeighted(image, 1 - share, blurred, 0.9 * share, 4.0 * share)


WAYS: dict[str, Callable[[Image], Image]] = {
    "as they come": lambda image: image,
    "darker": lambda image: (0.6 * image).astype(np.uint8),
    "noisier": lambda image: np.clip(
        image + np.random.default_rng(0).normal(0, 4, image.shape), 0, 255
    ).astype(np.uint8),
    "softer": lambda image: cv2.GaussianBlur(image, (0, 0), 0.8),
    "mirrored": lambda image: np.ascontiguousarray(image[:, ::-1]),
}  # fmt: skip
"""Photographs that are good as well."""
