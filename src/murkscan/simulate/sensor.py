"""From light to grey levels: lens, electrons, noise, rounding."""

import math
from dataclasses import dataclass
from typing import Literal, get_args

import cv2
import numpy as np
from jaxtyping import Float32

from ..errors import InputError
from ..types.arrays import Image
from ..types.camera import Camera

Picture = Float32[np.ndarray, "h w"]
Colour = Literal["mono", "rggb", "bggr", "grbg", "gbrg"]

_BOUNDS = (
    ("full_well", 10, 1e7),
    ("read_noise", 0, 1e4),
    ("bits", 8, 16),
    ("black_level", 0, 1e4),
    ("psf", 0.3, 20),
    ("composite", 0, 20),
    ("exposure", 1e-6, 10),
    ("f_number", 0.5, 64),
    ("pixel_size", 1e-6, 1e-4),
    ("quantum_efficiency", 0.001, 1),
    ("gain", 1e-3, 1e3),
    ("response", 0, 0.5),
    ("hot_pixels", 0, 0.5),
    ("row_noise", 0, 1e4),
)
"""What cameras there are; a blur below 0.3 px would be sharper than its own pixels."""
KEYS = {
    "full_well": "full_well_e",
    "read_noise": "read_noise_e",
    "psf": "psf_px",
    "composite": "composite_px",
    "exposure": "exposure_ms",
    "pixel_size": "pixel_size_um",
    "response": "response_percent",
    "hot_pixels": "hot_pixels_percent",
    "row_noise": "row_noise_grey",
}
"""Names in scene.toml, where they differ."""
FACTORS = {"exposure": 1e3, "pixel_size": 1e6, "response": 100.0, "hot_pixels": 100.0}
"""From SI to the unit of that name."""
_OVEREXPOSED = 100.0
"""How many times too bright a stripe may be."""
_RESPONSE = {"r": 0.12, "g": 1.0, "b": 0.25}
"""What a colour filter passes of green laser light, as a share of the green one's."""
_PHOTON = 6.62607015e-34 * 299792458.0
"""Planck's constant times the speed of light [J·m]."""


@dataclass(frozen=True)
class Sensor:
    """A camera's sensor and lens.

    References:
        EMVA Standard 1288, release 4.0 (linear camera model: photons, electrons, grey levels).
    """

    full_well: float = 9000.0
    """Electrons at which a pixel is full, and white."""
    read_noise: float = 9.0
    """Noise of reading a pixel, 1σ [electrons]."""
    bits: int = 8
    """Depth of the picture; more than 8 are kept in 16."""
    black_level: float = 4.0
    """Grey level of black, so that noise below it is kept."""
    shot_noise: bool = True
    """Whether light comes in photons."""
    psf: float = 0.7
    """Blur of the lens [px], 1σ."""
    composite: float = 0.0
    """Blur along rows by an analogue video line [px], 1σ."""
    vignetting: bool = True
    """Whether the picture darkens towards its corners, by the fourth power of the cosine."""
    exposure: float = 10e-3
    """Time that a frame is exposed [s]."""
    f_number: float = 2.0
    """Focal length by the lens's aperture."""
    pixel_size: float = 5e-6
    """Edge of a pixel [m]."""
    quantum_efficiency: float = 0.6
    """Electrons a photon."""
    gain: float = 1.0
    """Multiplies the grey levels, not the full well."""
    response: float = 0.0
    """How much pixels differ in what they make of light, 1σ, as a share."""
    hot_pixels: float = 0.0
    """Share of pixels that are bright in the dark."""
    row_noise: float = 0.0
    """Noise that all pixels of a row have in common, 1σ [grey levels]."""
    peak_grey: float | None = None
    """Grey level above black that the brightest 3 % of the noise-free stripe shall reach, over nine
    frames of the recording; it takes the place of exposure and f-number."""
    interlaced: bool = False
    """Whether odd and even rows are exposed half a picture apart."""
    colour: Colour = "mono"
    """One grey level a pixel, or a colour filter array by its first four pixels."""

    def __post_init__(self) -> None:
        """Refuse a sensor that cannot be."""
        for name, low, high in _BOUNDS:
            if not low <= getattr(self, name) <= high:
                factor = FACTORS.get(name, 1.0)
                raise InputError(
                    f"sensor.{KEYS.get(name, name)} must lie between {low * factor:g} and "
                    f"{high * factor:g}, got {getattr(self, name) * factor:g}."
                )
        if not self.black_level < self.white:
            raise InputError(
                f"sensor.black_level must lie below white, {self.white}, got {self.black_level:g}."
            )
        room = self.white - self.black_level
        if self.peak_grey is not None and not 0 < self.peak_grey <= _OVEREXPOSED * room:
            raise InputError(
                f"sensor.peak_grey must lie above 0 and not above {_OVEREXPOSED:g} times the grey "
                f"levels above black, {room:g}, got {self.peak_grey:g}."
            )
        if self.colour not in get_args(Colour):
            raise InputError(f"sensor.colour must be one of {', '.join(get_args(Colour))}.")
        if self.interlaced and self.colour != "mono":
            raise InputError(
                "sensor.interlaced goes with sensor.colour mono: a mosaic has no fields."
            )

    @property
    def white(self) -> int:
        """The highest grey level."""
        return 2**self.bits - 1

    @property
    def field_blur(self) -> float:
        """Blur along columns because a field's pixels are two rows high [px], 1σ.

        References:
            Sony ICX039DLA data sheet: in field readout two rows of a PAL sensor are added.
        """
        return 0.5 if self.interlaced else 0.0  # variance of a box of two rows less that of one

    @property
    def grey_per_electron(self) -> float:
        """How much a grey level grows with an electron."""
        return self.gain * (self.white - self.black_level) / self.full_well

    def electrons_per_radiance(self, wavelength: float) -> float:
        """Give the electrons that 1 W/m²/sr on the optical axis makes in a pixel.

        Args:
            wavelength: Of the light [m].
        """
        irradiance = math.pi / 4 / self.f_number**2
        photons = irradiance * self.pixel_size**2 * self.exposure * wavelength / _PHOTON
        return photons * self.quantum_efficiency

    def variance(self, electrons: Picture) -> Picture:
        """Give the variance of pixels that hold this many electrons on average [electrons²].

        A row's common noise is in it, as of pixels of a column, which have each their own.
        """
        common = (self.row_noise / self.grey_per_electron) ** 2
        return self.own_variance(electrons) + np.float32(self.rounding + common)

    def own_variance(self, electrons: Picture) -> Picture:
        """Give the variance that each pixel has for itself, before rounding [electrons²]."""
        shot = electrons if self.shot_noise else np.zeros_like(electrons)
        return shot + np.float32(self.read_noise**2)

    @property
    def rounding(self) -> float:
        """Variance of rounding to grey levels [electrons²]."""
        return 1 / (12 * self.grey_per_electron**2)

    def is_full(self, electrons: Picture) -> np.ndarray:
        """Tell which pixels show white whatever more light falls on them."""
        room = (self.white - self.black_level) / self.grey_per_electron
        return electrons >= min(self.full_well, room)


def sensitivity(sensor: Sensor, camera: Camera) -> Picture:
    """Give the share of light that each pixel keeps: vignetting and colour filters."""
    width, height = camera.size
    (cu, cv), (fu, fv) = camera.principal_point, camera.focal_length
    u, v = np.meshgrid((np.arange(width) - cu) / fu, (np.arange(height) - cv) / fv)
    share = np.ones((height, width))
    if sensor.vignetting:
        share = (1 + u**2 + v**2) ** -2
    if sensor.colour != "mono":
        tile = np.array([_RESPONSE[letter] for letter in sensor.colour]).reshape(2, 2)
        share *= np.tile(tile, (height // 2 + 1, width // 2 + 1))[:height, :width]
    return share.astype(np.float32)


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
