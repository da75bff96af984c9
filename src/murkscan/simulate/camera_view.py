"""The way of light from the water to a grey level: window, sensor, processing, overlay."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Shaped

from ..optics.sensor import Picture
from .fixed_pattern import draw_fixed_pattern
from .overlay import write_over
from .scene import Scene
from .sensor import expose
from .window import WindowView, view_window


@dataclass(frozen=True, eq=False)
class Taken:
    """A picture, or a field of one."""

    image: Shaped[np.ndarray, "rows w"]
    """Grey levels of the rows that the frame has."""
    variance: Picture
    """Of each pixel of the full frame [electrons²]; infinite where it tells nothing of light."""


@dataclass(frozen=True, eq=False)
class CameraView:
    """A scene's camera made ready: what it does to every frame alike."""

    scene: Scene
    window: WindowView
    electrons: Picture
    """Electrons that 1 W/m²/sr behind the window makes in each pixel."""
    dark: Picture
    """Electrons that are in each pixel without any light from the scene."""

    @classmethod
    def of(cls, scene: Scene, electrons: Picture) -> "CameraView":
        """Make a camera ready.

        Args:
            scene: Its scene.
            electrons: That 1 W/m²/sr makes in each pixel of a sensor without flaws.
        """
        camera, sensor, lasers = scene.rig.camera, scene.sensor, scene.rig.lasers
        window = view_window(
            scene.window,
            camera.size,
            focal_length=camera.focal_length[0],
            axis=lasers[0].axis if lasers else "y",
            seed=scene.seed,
        )
        pattern = draw_fixed_pattern(sensor, camera.size, seed=scene.seed)
        dark = pattern.dark + window.ghost / np.float32(sensor.grey_per_electron)
        return cls(scene, window, electrons * pattern.response, dark)

    @property
    def response(self) -> Picture:
        """Electrons that 1 W/m²/sr before the window makes in each pixel."""
        return self.electrons * self.window.transmission

    def take(self, light: Picture, number: int) -> Taken:
        """Take the picture of a frame: of this light [W/m²/sr], with this frame's own noise."""
        scene, sensor = self.scene, self.scene.sensor
        electrons = self.window.pass_light(light) * self.electrons + self.dark
        noise = np.random.default_rng([scene.seed, 0, number])
        image = expose(sensor, scene.as_field(electrons, number), noise)
        image = scene.processing.process(image, sensor.white)
        time = float(scene.times[number] - scene.times[0])
        over = scene.overlay.draw(scene.rig.camera.size, time, sensor.white)
        lost = sensor.is_full(electrons) | ~np.isnan(over)
        variance = np.where(lost, np.inf, sensor.variance(electrons))
        return Taken(write_over(image, scene.as_field(over, number)), variance)
