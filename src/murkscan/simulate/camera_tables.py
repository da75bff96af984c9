"""The tables of scene.toml from the light to the picture, with their units."""

import math

from pydantic import FiniteFloat

from ..optics.beam import Light
from ..optics.lamp import Lamp
from ..optics.sensor import FACTORS, KEYS, Colour, Sensor
from .overlay import Overlay
from .processing import Processing
from .recorder import Codec, Recorder
from .table import Table
from .window import Window

_OF_OTHERS = {
    "gamma", "sharpening", "sharpening_px", "denoise", "codec", "crf", "bitrate_mbit_s", "quality",
    "streamed",
}  # fmt: skip
"""Keys of [sensor] that are no sensor's but its camera's and recorder's."""


class LampTable(Table):
    """[light.lamp]: a lamp on the vehicle."""

    power_w: FiniteFloat = 0.0
    position_mm: tuple[FiniteFloat, FiniteFloat, FiniteFloat] = (250.0, -100.0, 0.0)
    half_angle_deg: FiniteFloat = 35.0

    def as_lamp(self) -> Lamp:
        """Give the lamp."""
        x, y, z = self.position_mm
        return Lamp(self.power_w, (x / 1e3, y / 1e3, z / 1e3), math.radians(self.half_angle_deg))


class LightTable(Table):
    """[light]."""

    power_mw: FiniteFloat = 30.0
    divergence_mrad: FiniteFloat = 1.4
    waist_mm: FiniteFloat = 1.0
    ambient_w_m2: FiniteFloat = 0.0
    lamp: LampTable = LampTable()
    streaks_percent: FiniteFloat = 0.0
    speckle: FiniteFloat = 0.0
    laser_on: bool = True
    colour: tuple[FiniteFloat, FiniteFloat, FiniteFloat] | None = None

    def as_light(self) -> Light:
        """Give the light."""
        return Light(
            self.power_mw / 1e3,
            self.divergence_mrad / 1e3,
            self.waist_mm / 1e3,
            self.ambient_w_m2,
            self.lamp.as_lamp(),
            self.streaks_percent / 100,
            self.speckle,
            self.laser_on,
            self.colour,
        )


class WindowTable(Table):
    """[window]: what stands still in the camera's window."""

    dirt_percent: FiniteFloat = 0.0
    scratches: int = 0
    ghost_grey: FiniteFloat = 0.0
    blur_px: FiniteFloat = 1.0

    def as_window(self) -> Window:
        """Give the window's flaws."""
        return Window(self.dirt_percent / 100, self.scratches, self.ghost_grey, self.blur_px)


class OverlayTable(Table):
    """[overlay]: what is written over the pictures."""

    text: tuple[str, ...] = ()
    text_height_px: FiniteFloat = 14.0
    border_grey: FiniteFloat | None = None

    def as_overlay(self) -> Overlay:
        """Give the overlay."""
        return Overlay(self.text, self.text_height_px, self.border_grey)


class SensorTable(Table):
    """[sensor]."""

    full_well_e: FiniteFloat = 9000.0
    read_noise_e: FiniteFloat = 9.0
    shot_noise: bool = True
    bits: int = 8
    black_level: FiniteFloat = 4.0
    psf_px: FiniteFloat = 0.7
    composite_px: FiniteFloat = 0.0
    vignetting: bool = True
    exposure_ms: FiniteFloat = 10.0
    f_number: FiniteFloat = 2.0
    pixel_size_um: FiniteFloat = 5.0
    quantum_efficiency: FiniteFloat = 0.6
    gain: FiniteFloat = 1.0
    response_percent: FiniteFloat = 0.0
    hot_pixels_percent: FiniteFloat = 0.0
    row_noise_grey: FiniteFloat = 0.0
    peak_grey: FiniteFloat | None = None
    interlaced: bool = False
    colour: Colour = "mono"
    gamma: FiniteFloat = 1.0
    sharpening: FiniteFloat = 0.0
    sharpening_px: FiniteFloat = 1.0
    denoise: FiniteFloat = 0.0
    codec: Codec = "png"
    crf: int = 23
    bitrate_mbit_s: FiniteFloat | None = None
    quality: int = 5
    streamed: bool = False

    def as_processing(self) -> Processing:
        """Give what the camera's processor does."""
        return Processing(self.gamma, self.sharpening, self.sharpening_px)

    def as_recorder(self) -> Recorder:
        """Give what the recorder does."""
        bitrate = None if self.bitrate_mbit_s is None else 1e6 * self.bitrate_mbit_s
        return Recorder(self.codec, self.crf, bitrate, self.quality, self.streamed, self.denoise)

    def as_sensor(self) -> Sensor:
        """Give the sensor."""
        values = self.model_dump(exclude=_OF_OTHERS)
        for field, key in KEYS.items():
            values[field] = values.pop(key) / FACTORS.get(field, 1.0)
        return Sensor(**values)
