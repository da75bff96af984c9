"""A camera's sensor: from light to electrons, their noise, and grey levels."""

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from jaxtyping import Float32

from ..errors import InputError
from ..types.arrays import Pixels, Scalars
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


def vignetting(camera: Camera, pixels: Pixels) -> Scalars:
    """Give the share of light that pixels keep: the fourth power of the cosine to the axis.

    Args:
        camera: The camera; its distortion is left out.
        pixels: Where in the picture [px].
    """
    flat = (pixels - camera.principal_point) / camera.focal_length
    return (1 + (flat**2).sum(axis=1)) ** -2
