"""Draw the frames of a scene, one after another, each with its truth."""

from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np

from ..errors import InputError
from ..optics.sensor import Picture
from ..types.arrays import Mask, Scalars, SmallNumbers
from ..types.frame import Frame
from ..types.true_stripe import TrueStripe
from .ambient import draw_ambient
from .camera_view import CameraView
from .information import measure_information
from .laser_view import LaserView, view_laser
from .line_image import LineImage, draw_laser
from .lit_line import LitLine, cast_fan, find_lit_line
from .scene import Scene
from .sensor import sensitivity
from .snow_image import density_for

_BRIGHTEST = 0.97
"""Quantile of the stripe's peaks by which the exposure is set."""
_SHOWN = 0.1
"""Share of the brightest pixel above which a pixel of a photo shows the object."""
_LOOKED_AT = 9
"""Frames, spread over the recording, by which the exposure is set."""
_TRIED = 300
"""Frames that are tried before a sheet is said never to meet the object."""
_FAINTEST = 1e-25
"""Radiance below which no exposure shows anything [W/m²/sr]."""
_SIGHT = 4.8
"""Attenuation lengths within which an empty sea's particles are counted: there a black disc
disappears (Hou, Lee and Weidemann, Optics Express 15(6), 2007)."""


@dataclass(frozen=True, eq=False)
class LightImage:
    """All light of one frame, noise-free, after all blur; rows are v of the full frame."""

    lasers: tuple[LineImage, ...]
    """What each laser lights [W/m²/sr]."""
    ambient: Picture
    """What would be seen without lasers [W/m²/sr]."""

    @property
    def total(self) -> Picture:
        """The sum [W/m²/sr]."""
        return sum((laser.total for laser in self.lasers), self.ambient)


@dataclass(frozen=True, eq=False)
class SimulatedFrame:
    """A frame, and what is true about it."""

    frame: Frame
    stripe: TrueStripe
    light: LightImage


@dataclass(frozen=True, eq=False)
class Simulator:
    """A scene made ready: what stays the same from frame to frame."""

    scene: Scene
    lasers: tuple[LaserView, ...]
    camera: CameraView
    snow_density: tuple[float, ...]
    """Particles that each laser's sheet may cut [1/m³]."""

    @classmethod
    def of(cls, scene: Scene) -> "Simulator":
        """Make a scene ready.

        Raises:
            InputError: The sheet never meets the object where the camera sees it.
        """
        lasers = tuple(view_laser(scene, number) for number in range(len(scene.rig.lasers)))
        shown = _lit_frames(scene, lasers) if lasers and scene.bodies else [0]
        if scene.sensor.peak_grey is None:  # only the density of particles is asked for
            shown = [shown[len(shown) // 2]]
        lights = [[draw_laser(scene, laser, number) for laser in lasers] for number in shown]
        densities = tuple(
            density_for(scene.particles, laser, light.mask, _reach(scene, light))
            for laser, light in zip(lasers, lights[len(lights) // 2], strict=True)
        )
        camera = CameraView.of(scene, _electrons(scene, lasers, lights))
        return cls(scene, lasers, camera, densities)

    def draw_light(self, number: int) -> LightImage:
        """Draw all light of a frame, before the window."""
        shining = self.lasers if self.scene.light.is_on else ()
        lasers = tuple(
            draw_laser(self.scene, laser, number, snow_density=density)
            for laser, density in zip(shining, self.snow_density, strict=False)
        )
        ambient = np.zeros_like(self.camera.electrons)
        if self.scene.light.shows_objects:
            ambient = draw_ambient(self.scene, number)
        return LightImage(lasers, ambient)

    def draw_frame(self, number: int) -> SimulatedFrame:
        """Draw a frame, with its noise and its truth; it depends on no other frame."""
        scene, light = self.scene, self.draw_light(number)
        taken = self.camera.take(light.total, number)
        frame = Frame(
            taken.image,
            number,
            float(scene.times[number]),
            scene.first_row(number),
            scene.row_step,
        )
        return SimulatedFrame(frame, self._tell_truth(light, taken.variance, number), light)

    def _tell_truth(self, light: LightImage, variance: Picture, number: int) -> TrueStripe:
        parts = [
            self._truth_of(laser, light.lasers[laser], variance, number)
            for laser in range(len(light.lasers))
        ]
        return TrueStripe.concatenate(parts)

    def _truth_of(self, laser: int, light: LineImage, variance: Picture, number: int) -> TrueStripe:
        """Give the true centres of one laser, in a frame's scan lines, with what is known."""
        first, step = self.scene.first_row(number), self.scene.row_step
        line, widths, reflected = _join(light)
        length = self.scene.rig.camera.size["xy".index(self.lasers[laser].scan_lines.laser.axis)]
        inside = (line.positions > -0.5) & (line.positions < length - 0.5)
        line, widths, reflected = line[inside], widths[inside], reflected[inside]
        response = self.camera.response
        pictures = [light.stripe * response, light.slope * response, variance]
        told = np.ones(self.scene.rig.camera.size[0], bool)
        if self.lasers[laser].scan_lines.laser.axis == "y":
            pictures = [picture.T for picture in pictures]
            told = np.arange(self.scene.rig.camera.size[1]) % step == first
        else:
            kept = line.lines % step == first
            line, widths, reflected = line[kept], widths[kept], reflected[kept]
        stripe, slope, variance = pictures
        known = measure_information(
            line, widths, stripe=stripe, slope=slope, variance=variance, told=told
        )
        return TrueStripe(
            frame=np.full(len(line), number, np.uint32),
            laser=np.full(len(line), laser, np.uint8),
            branch=_number_branches(line),
            is_reflected=reflected,
            pixels=self.lasers[laser].scan_lines.as_pixels(line.lines, line.positions),
            points=self.scene.pose(number) @ line.points,
            signal=(known.peak * self.scene.sensor.grey_per_electron).astype(np.float32),
            snr=known.snr,
            crlb=known.crlb,
        )


def simulate_frames(
    scene: Scene, start: int = 0, stop: int | None = None
) -> Iterator[SimulatedFrame]:
    """Draw the frames of a scene in order, each when it is asked for.

    Args:
        scene: What is recorded, and how.
        start: Index of the first frame wanted; it looks the same whatever the start is.
        stop: Index behind the last frame wanted; None: all.

    Raises:
        InputError: The sheet never meets the object where the camera sees it.
    """
    simulator = Simulator.of(scene)
    for number in range(start, len(scene) if stop is None else min(stop, len(scene))):
        yield simulator.draw_frame(number)


def _lit_frames(scene: Scene, lasers: tuple[LaserView, ...]) -> list[int]:
    """Find some frames, spread over the recording, in which the camera sees a stripe."""
    spread = np.unique(np.linspace(0, len(scene) - 1, _LOOKED_AT).astype(int)).tolist()
    shown = [number for number in spread if _is_lit(scene, lasers, number)]
    if shown:
        return shown
    tried = np.unique(np.linspace(0, len(scene) - 1, _TRIED).astype(int)).tolist()
    for number in tried:
        if _is_lit(scene, lasers, number):
            return [number]
    raise InputError(
        f"The laser's sheet never meets the object where the camera sees it, in {len(scene)} "
        "frames: move object.position_mm, turn rig.laser, or change motion."
    )


def _is_lit(scene: Scene, lasers: tuple[LaserView, ...], number: int) -> bool:
    """Tell whether the camera sees the stripe of any laser in a frame."""
    caster, pose = scene.surroundings.caster, scene.pose(number)
    for laser in lasers:
        fall = cast_fan(laser.beam, laser.scan_lines, caster, pose)
        if len(find_lit_line(laser.beam, laser.scan_lines, caster, pose, fall)):
            return True
    return False


def _reach(scene: Scene, light: LineImage) -> float:
    """Give how far away the farthest true centre is [m]; in an empty sea, how far one sees."""
    if not scene.bodies:
        return _SIGHT / max(scene.attenuation, 1e-3)
    return float(np.linalg.norm(light.line.points, axis=1).max(initial=0.0))


def _electrons(
    scene: Scene, lasers: tuple[LaserView, ...], lights: list[list[LineImage]]
) -> Picture:
    """Give the electrons that 1 W/m²/sr makes in each pixel."""
    camera, sensor = scene.rig.camera, scene.sensor
    share = sensitivity(sensor, camera)
    if sensor.peak_grey is None:
        # Radiance falls by the square of the index where light leaves the water for the lens.
        in_air = sensor.electrons_per_radiance(scene.rig.wavelength) / scene.index**2
        return share * np.float32(in_air)
    if lasers:
        peaks = [
            (light.stripe * share).max(axis="yx".index(laser.scan_lines.laser.axis))[
                light.line.lines
            ]
            for frame in lights
            for laser, light in zip(lasers, frame, strict=True)
        ]
    else:
        photo = draw_ambient(scene, 0) * share
        peaks = [photo[photo > _SHOWN * photo.max()]]
    brightest = float(np.quantile(np.concatenate(peaks), _BRIGHTEST))
    if not brightest > _FAINTEST:
        raise InputError(
            "No light of the laser comes back through this water: lower water.attenuation_per_m, "
            "or bring object.position_mm nearer."
        )
    return share * np.float32(sensor.peak_grey / sensor.grey_per_electron / brightest)


def _join(light: LineImage) -> tuple[LitLine, Scalars, Mask]:
    """Put the true centres of the second line behind those of the first, sorted by scan line."""
    line = LitLine(
        *(
            np.concatenate([getattr(light.line, column.name), getattr(light.second, column.name)])
            for column in fields(LitLine)
        )
    )
    usual = float(np.median(light.widths)) if len(light.widths) else 1.0
    widths = np.concatenate([light.widths, np.full(len(light.second), usual)])
    reflected = np.arange(len(line)) >= len(light.line)
    order = np.lexsort([reflected, line.lines])
    return line[order], widths[order], reflected[order]


def _number_branches(line: LitLine) -> SmallNumbers:
    """Number the centres of each scan line, which lie one after another."""
    starts = np.flatnonzero(np.concatenate([[True], np.diff(line.lines) != 0])[: len(line)])
    counts = np.diff(np.concatenate([starts, [len(line)]]))
    number = np.arange(len(line)) - np.repeat(starts, counts)
    return np.minimum(number, 255).astype(np.uint8)
