"""Two balls, a plate and a step in one picture, and what an acceptance test says of them."""

from dataclasses import dataclass

import numpy as np
from measure_scene import as_plain, build_scene, crop, scan

from murkscan.measure import (
    Ball,
    Sample,
    find_ball,
    measure_flatness,
    measure_spacing,
    measure_step,
    trust_plane,
)
from murkscan.optics import equivalent_plane, refractive_index
from murkscan.simulate import Scene, simulate_frames
from murkscan.types.rig import Rig

RADIUS, APART, STEP, TREAD = 40.0, 400.0, 20.0, 45.0
"""Sizes of the artefacts [mm]."""
DEPTH, ACROSS = 880.0, 110.0
"""Distance of the middle of all, and the camera's travel [mm]."""
RATE_HZ = {"PAL": 25.0, "1920 × 1200": 50.0}
"""Pictures a second: fields of PAL and pictures of the other then come equally often."""
BIN, HALF = 2e-3, 2.0
"""Width of a bin of distances, and how far bins reach [mm]."""


@dataclass(frozen=True)
class Case:
    """One scan."""

    rig: str
    attenuation: float
    speed: float
    """[mm/s]."""
    seed: int

    @property
    def name(self) -> str:
        """A word for a file."""
        kind = "pal" if self.rig == "PAL" else "hd"
        return f"{kind} c{self.attenuation:g} v{self.speed:g} s{self.seed}"


@dataclass(frozen=True)
class Layout:
    """Where things are in a seed's scene [mm]."""

    shift: np.ndarray
    turn: np.ndarray

    @classmethod
    def of(cls, seed: int) -> "Layout":
        """Shift all by up to 4 mm, so that the stripe lies elsewhere in its pixels, and tilt."""
        random = np.random.default_rng(seed)
        return cls(random.uniform(-4, 4, 3) + np.array([0, 200, DEPTH]), random.uniform(-3, 3, 3))

    @property
    def balls(self) -> list[np.ndarray]:
        """The centres."""
        return [self.shift + np.array([x, 0, 0]) for x in (-APART / 2, APART / 2)]

    @property
    def plate(self) -> np.ndarray:
        """Its middle."""
        return self.shift + np.array([-75, 0, 0])

    @property
    def stairs(self) -> np.ndarray:
        """The middle of the first tread's outer edge."""
        return self.shift + np.array([75, -TREAD, 0])

    def as_tables(self) -> list[dict[str, object]]:
        """Write all of it as a scene file has it."""
        ball = {"mesh": "sphere", "radius_mm": RADIUS}
        return [
            *({**ball, "position_mm": at.tolist()} for at in self.balls),
            {
                "mesh": "plane", "width_mm": 130.0, "height_mm": 90.0,
                "position_mm": self.plate.tolist(), "rotation_deg": self.turn.tolist(),
            },
            {
                "mesh": "stairs", "width_mm": 130.0, "tread_mm": TREAD, "heights_mm": [0.0, STEP],
                "position_mm": self.stairs.tolist(),
            },
        ]  # fmt: skip


def make_scene(case: Case) -> Scene:
    """Make the scene, of whose pictures only the rows about the stripe are drawn."""
    suffix = "" if case.rig == "PAL" else "-hd"
    layout, rate = Layout.of(case.seed), RATE_HZ[case.rig]
    motion = {
        "frames": round(ACROSS / case.speed * rate),
        "frame_rate_hz": rate,
        "speed_mm_s": case.speed,
    }
    base = f"sphere-c{case.attenuation:g}{suffix}"
    scene = build_scene(base, seed=case.seed, objects=layout.as_tables(), motion=motion)
    start = [0.0, 200.0 - ACROSS / 2 - 1e3 * sheet_crosses(scene.rig), 0.0]
    motion |= {"start_mm": start}
    return crop(build_scene(base, seed=case.seed, objects=layout.as_tables(), motion=motion))


def sheet_crosses(rig: Rig) -> float:
    """Give y of the sheet below the camera, at the artefacts' distance [m]."""
    plane = equivalent_plane(rig.lasers[0], refractive_index(rig.water, rig.wavelength))
    return float(-(plane.distance + plane.normal[2] * DEPTH / 1e3) / plane.normal[1])


def scan_case(case: Case) -> Sample:
    """Scan it."""
    scene = make_scene(case)
    frames = [simulated.frame for simulated in simulate_frames(scene, 0, len(scene))]
    return scan(scene, "murk", frames)


def measure_case(case: Case, sample: Sample) -> dict[str, dict[str, object]]:
    """Give of each number of a scan: error, half width, and how distances are spread [mm]."""
    layout = Layout.of(case.seed)
    balls = [find_ball(sample, at / 1e3 + [2e-3, 3e-3, -0.03], RADIUS / 1e3) for at in layout.balls]
    found = {
        "probing size": as_plain(balls[0].diameter, 2 * RADIUS),
        "sphere spacing": as_plain(measure_spacing(*balls), APART),
        "probing form": as_plain(balls[0].form, 0.0) | spread(balls[0].distances),
    }
    plate = around(sample, layout.plate, 40)
    fit, _ = trust_plane(plate)
    found["flatness"] = as_plain(measure_flatness(plate), 0.0) | spread(fit.residuals)
    faces = [
        around(sample, layout.stairs + np.array([0, (n + 0.5) * TREAD, -n * STEP]), 17)
        for n in range(2)
    ]
    found["length"] = as_plain(measure_step(*faces)["step"], STEP)
    return found


def around(sample: Sample, middle: np.ndarray, within: float) -> Sample:
    """Take the points within so many millimetres of a place."""
    x, y, z = (middle / 1e3).tolist()
    return sample[Ball((x, y, z), within / 1e3).contains(sample.cloud.points)]


def spread(distances: np.ndarray) -> dict[str, object]:
    """Count distances in bins."""
    counts, _ = np.histogram(1e3 * distances, np.arange(-HALF, HALF + BIN, BIN))
    which = np.flatnonzero(counts)
    return {"bins": which.tolist(), "counts": counts[which].tolist()}
