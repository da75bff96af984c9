"""How murky the water was, told from the glow; the truth is the light that was drawn."""

import numpy as np
import pytest

from murkscan.extract import Murk
from murkscan.extract.attenuation import estimate_attenuation, nearer_side
from murkscan.extract.glow import Glow
from murkscan.optics import as_fan, back_project, intersect_rays_with_sheet, refractive_index
from murkscan.optics.glow import sheet_glow
from murkscan.optics.medium import Medium
from murkscan.types.camera import Camera
from murkscan.types.frame import Frame
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig
from murkscan.types.water import Water

pytestmark = pytest.mark.without_types

SIZE = (240, 200)


def _rig(baseline=0.3, *, water=True):
    camera = Camera(SIZE, (190.0, 190.0), (119.5, 99.5))
    laser = Laser.from_baseline_angle(baseline, np.copysign(1.2, baseline) % np.pi, "y")
    return Rig(camera, (laser,), water=Water(20.0, 35.0) if water else None)


def _draw_glow(rig, attenuation, *, peak=2000.0):
    """Give what each pixel would see of the glow [grey levels], with the lens's own vignetting."""
    v, u = np.mgrid[: SIZE[1], : SIZE[0]].reshape(2, -1).astype(float)
    pixels = np.stack([u, v], axis=1)
    index = refractive_index(rig.water, rig.wavelength)
    rays = back_project(rig.camera, pixels, index)
    points = intersect_rays_with_sheet(rays, rig.lasers[0], index)
    fan = as_fan(rig.lasers[0])
    way = points - fan.origin
    away = np.linalg.norm(way, axis=1)
    glow = sheet_glow(
        way / away[:, None],
        rays.directions,
        np.broadcast_to(np.cross(fan.direction, fan.tangent), way.shape),
        laser_range=away,
        camera_range=np.linalg.norm(points - rays.origins, axis=1),
        line_power=1 / away,
        medium=Medium(attenuation),
    )
    off = ((pixels - rig.camera.principal_point) / rig.camera.focal_length) ** 2
    glow = np.nan_to_num(glow / (1 + off.sum(axis=1)) ** 2)
    return np.minimum(peak * glow, 200.0).reshape(SIZE[1], SIZE[0])


@pytest.mark.parametrize("attenuation", [1.0, 3.0, 6.0])
@pytest.mark.parametrize("baseline", [0.3, -0.3])
def test_the_glow_s_decay_is_the_attenuation(attenuation, baseline):
    """Drawn without noise: what is left are 8 scan lines a block, some 0.1 %."""
    rig = _rig(baseline)
    light = _draw_glow(rig, attenuation)
    rows, columns = np.mgrid[0 : SIZE[1] : 3, 4 : SIZE[0] : 8]
    level = 5.0 + light[rows, columns].ravel()
    pixels = np.stack([columns.ravel(), rows.ravel()], axis=1).astype(float)
    glow = Glow(pixels, columns.ravel() // 8, level, np.full(len(level), 0.01))
    found = estimate_attenuation(glow[(light > 0.05)[rows, columns].ravel()], rig)
    assert found is not None
    assert found.effective == pytest.approx(attenuation, rel=0.01)
    assert found.low <= attenuation <= found.high


def test_nearer_surfaces_lie_on_the_side_away_from_the_laser():
    """The paper's figure: with the laser at -b, a nearer surface moves the stripe towards -y."""
    assert nearer_side(_rig(0.3)) == -1
    assert nearer_side(_rig(-0.3)) == 1


def test_a_rig_whose_sheet_is_out_of_view_has_no_nearer_side():
    camera = Camera(SIZE, (5000.0, 5000.0), (119.5, 99.5))
    assert nearer_side(Rig(camera, (Laser.from_baseline_angle(0.3, 1.7, "y"),))) == 0


def test_a_recording_tells_how_murky_the_water_was():
    """Shot noise and rounding at 1 to 60 grey levels leave some per cent."""
    rig = _rig()
    rng = np.random.default_rng(5)
    light = 60.0 / 200.0 * _draw_glow(rig, 3.0, peak=3000.0)
    frames = []
    for index in range(12):
        end = 120.0 + 3 * np.sin(np.arange(SIZE[0]) / 40) + index
        rows = np.arange(SIZE[1])[:, None]
        stripe = 80.0 * np.exp(-0.5 * ((rows - end) / 1.2) ** 2)
        level = 4.0 + light * (rows < end) + stripe
        noisy = level + np.sqrt(0.04 + 0.03 * level) * rng.standard_normal(level.shape)
        image = np.clip(np.rint(noisy), 0, 255).astype(np.uint8)
        frames.append(Frame(image, 20 * index, 0.8 * index))
    learnt = Murk().learn(frames, rig)
    assert learnt.attenuation is not None
    assert learnt.attenuation.effective == pytest.approx(3.0, rel=0.1)
    # So noisy a glow may be that of nearly any water, and nobody is told a number.
    assert learnt.attenuation.low < 0.1 * learnt.attenuation.high
    assert learnt.water is None
    assert Murk().learn(frames, _rig(water=False)).attenuation is None


def test_too_little_glow_tells_nothing():
    glow = Glow(np.zeros((3, 2)), np.zeros(3, int), np.ones(3), np.ones(3))
    assert estimate_attenuation(glow, _rig()) is None
