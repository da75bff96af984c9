"""Scan two paints of known albedo at several ranges, slopes and waters, and compare them."""

import tempfile
from pathlib import Path

import numpy as np
from harness import Figure, tell

from murkscan.cli.main import run
from murkscan.project import Project

ALBEDOS, WIDTH = (0.1, 0.4), 0.08
NOTE = """
A wall with upright bands of two paints, albedo 0.1 and 0.4, scanned by `murkscan scan` in water of
beam attenuation c (given with `--attenuation-per-m`), from three distances, and once turned by 30°
about the way. `ratio` is that of the medians of the reflectance on the two paints, which should
be 4; `against` is the median on the brighter paint as a share of that in the first row. The
exposure is the same in all rows. Points nearer than a fifth of a band to its edge are left out.
The water scatters in the simulator by the formula by which the correction undoes it.
"""
ROWS = (
    (0.6, 0.05, 0),
    (0.9, 0.05, 0),
    (0.6, 0.05, 30),
    (0.6, 0.5, 0),
    (0.9, 0.5, 0),
    (0.6, 1.5, 0),
)
"""Distance [m], attenuation [1/m] and turn [degrees]."""
SCENE = """
format = 1
[object]
mesh = "plane"
width_mm = 4000.0
height_mm = 4000.0
position_mm = [0.0, 0.0, {distance}]
rotation_deg = [{turn}, 0.0, 0.0]
[surface]
texture = "bands"
albedos = [0.1, 0.4]
widths_mm = [80.0, 80.0]
axis = "x"
[water]
attenuation_per_m = {attenuation}
[sensor]
exposure_ms = {exposure}
bits = 12
[motion]
frames = 12
frame_rate_hz = 25.0
speed_mm_s = 50.0
[rig]
format = 1
wavelength_nm = 532
[rig.camera]
size = [360, 288]
focal_length = [277.0, 277.0]
principal_point = [179.5, 143.5]
distortion = [0, 0, 0, 0, 0]
[[rig.laser]]
kind = "fan"
origin_mm = [0.0, -250.0, 0.0]
direction = [0.0, 0.31622776601683794, 0.9486832980505139]
tangent = [1.0, 0.0, 0.0]
half_angle_deg = 40.0
axis = "y"
[rig.water]
temperature_c = 20.0
salinity_psu = 35.0
"""


def find_reflectance(folder: Path, distance: float, attenuation: float, turn: float) -> np.ndarray:
    """Give the median reflectance of both paints."""
    folder.mkdir()
    text = SCENE.format(
        distance=1e3 * distance, attenuation=attenuation, turn=turn, exposure=EXPOSURE
    )
    (folder / "scene.toml").write_text(text, "utf-8")
    made, out = folder / "made", folder / "out"
    done = run(["simulate", str(folder / "scene.toml"), str(made)])
    rig = ("--rig", str(made / "rig.toml"), "--poses", str(made / "poses.csv"))
    water = ("--attenuation-per-m", str(attenuation))
    done += run(["scan", str(made / "frames"), *rig, "--out", str(out), *water])
    assert done == 0
    cloud = Project(out).load_cloud()
    along = cloud.points[:, 0] / WIDTH
    sure = (np.abs(along - np.round(along)) > 0.2) & (cloud.reflectance > 0)
    return np.array(
        [np.median(cloud.reflectance[sure & (np.floor(along) % 2 == k)]) for k in (0, 1)]
    )


EXPOSURE = 4.0
"""Of all rows [ms]."""


def main() -> None:
    """Scan all rows and tell the figures."""
    figures, first = [], 0.0
    with tempfile.TemporaryDirectory() as folder:
        for number, (distance, attenuation, turn) in enumerate(ROWS):
            dark, light = find_reflectance(Path(folder) / str(number), distance, attenuation, turn)
            first = first or light
            name = f"{distance:g} m, c {attenuation:g}, turned {turn}°"
            figures += [
                Figure(f"ratio: {name}", light / dark, at_least=3.6, at_most=4.2),
                Figure(f"against: {name}", light / first, at_least=0.9, at_most=1.1),
            ]
    tell("reflectance", "Reflectance of two paints", figures, note=NOTE)


if __name__ == "__main__":
    main()
