"""From electrons to pictures: lens, noise, rounding, colour filters."""

import math
from collections.abc import Mapping

import cv2
import numpy as np

from ..optics.beam import Light
from ..optics.sensor import Colour, Picture, Sensor, vignetting
from ..types.arrays import Image
from ..types.camera import Camera

_RESPONSE = {"r": 0.12, "g": 1.0, "b": 0.25}
"""What a colour filter passes of green laser light, as a share of the green one's."""


def sensitivity(sensor: Sensor, camera: Camera) -> Picture:
    """Give the share of light that each pixel keeps: vignetting and colour filters."""
    width, height = camera.size
    share = np.ones((height, width))
    if sensor.vignetting:
        u, v = np.meshgrid(np.arange(width), np.arange(height))
        pixels = np.stack([u.ravel(), v.ravel()], axis=1).astype(float)
        share = vignetting(camera, pixels).reshape(height, width)
    if sensor.colour != "mono":
        share *= _through_filters(sensor.colour, _RESPONSE, camera.size)
    return share.astype(np.float32)


def compare_colours(sensor: Sensor, light: Light, camera: Camera) -> Picture | float:
    """Give how much more of daylight and lamps each pixel sees than of the laser's light."""
    if sensor.colour == "mono" or light.colour is None:
        return 1.0
    green = light.colour[1]
    seen = {letter: part / green for letter, part in zip("rgb", light.colour, strict=True)}
    ratio = {letter: seen[letter] / _RESPONSE[letter] for letter in "rgb"}
    return _through_filters(sensor.colour, ratio, camera.size).astype(np.float32)


def _through_filters(
    colour: Colour, passed: Mapping[str, float], size: tuple[int, int]
) -> np.ndarray:
    width, height = size
    tile = np.array([passed[letter] for letter in colour]).reshape(2, 2)
    return np.tile(tile, (height // 2 + 1, width // 2 + 1))[:height, :width]


def blur_lens(picture: Picture, sigma_u: float, sigma_v: float) -> Picture:
    """Blur along u and along v [px], 1σ; what lies beyond the picture is as its edge."""
    return cv2.GaussianBlur(
        picture,
        (_kernel_size(sigma_u), _kernel_size(sigma_v)),
        max(sigma_u, 1e-3),
        sigmaY=max(sigma_v, 1e-3),
        borderType=cv2.BORDER_REPLICATE,
    )


def expose(sensor: Sensor, electrons: Picture, noise: np.random.Generator) -> Image:
    """Add the noise and count in grey levels.

    Shot noise is drawn from a Gaussian: below ten electrons, where it would be skewed, the noise of
    reading is the larger.
    """
    if sensor.read_noise > 0 or sensor.shot_noise:
        spread = np.sqrt(sensor.own_variance(electrons))
        electrons = electrons + spread * noise.standard_normal(electrons.shape, np.float32)
    electrons = np.minimum(electrons, np.float32(sensor.full_well))
    grey = electrons * np.float32(sensor.grey_per_electron) + np.float32(sensor.black_level)
    if sensor.row_noise > 0:
        common = noise.standard_normal((len(grey), 1), np.float32)
        grey += np.float32(sensor.row_noise) * common
    grey = np.rint(grey)
    depth = np.uint8 if sensor.bits == 8 else np.uint16
    return np.clip(grey, 0, sensor.white).astype(depth)


def as_colour(picture: Image, colour: Colour) -> np.ndarray:
    """Fill in the colours between the pixels of a mosaic, as cameras do."""
    codes = {  # OpenCV names a pattern by its second row, from the second pixel
        "rggb": cv2.COLOR_BayerBG2RGB,
        "bggr": cv2.COLOR_BayerRG2RGB,
        "grbg": cv2.COLOR_BayerGB2RGB,
        "gbrg": cv2.COLOR_BayerGR2RGB,
    }
    return cv2.cvtColor(picture, codes[colour])


def _kernel_size(sigma: float) -> int:
    return 2 * math.ceil(4 * sigma) + 1 if sigma > 1e-3 else 1
