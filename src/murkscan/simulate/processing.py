"""What a camera's own processor makes of the sensor's grey levels: gamma and sharpening."""

from dataclasses import dataclass

import numpy as np

from ..errors import InputError
from ..types.arrays import Image
from .sensor import blur_lens


@dataclass(frozen=True)
class Processing:
    """A camera's processing of each picture by itself.

    References:
        ITU-R BT.709 (a camera's gamma of 0.45); Poynton, Digital Video and HD, 2012, on aperture
        correction.
    """

    gamma: float = 1.0
    """Exponent of the grey levels, as a share of white."""
    sharpening: float = 0.0
    """How many times the difference from the blurred picture is added."""
    sharpening_width: float = 1.0
    """Width of that blur [px], 1σ."""

    def __post_init__(self) -> None:
        """Refuse what no camera does."""
        if not 0.2 <= self.gamma <= 5:
            raise InputError(f"sensor.gamma must lie between 0.2 and 5, got {self.gamma:g}.")
        if not (0 <= self.sharpening <= 10 and 0.3 <= self.sharpening_width <= 20):
            raise InputError(
                "sensor.sharpening must lie between 0 and 10, and sensor.sharpening_px between 0.3 "
                f"and 20, got {self.sharpening:g} and {self.sharpening_width:g}."
            )

    def process(self, image: Image, white: int) -> Image:
        """Process a picture or field whose highest grey level is given."""
        if self == Processing(sharpening_width=self.sharpening_width):
            return image
        light = (image / np.float32(white)) ** np.float32(self.gamma)
        light += np.float32(self.sharpening) * (
            light - blur_lens(light, self.sharpening_width, self.sharpening_width)
        )
        return np.rint(np.clip(light, 0, 1) * white).astype(image.dtype)
