"""The glow of the laser's sheet against the integral through a thick one."""

import numpy as np
import pytest
from scipy.integrate import quad

from murkscan.optics.glow import sheet_glow
from murkscan.optics.medium import Medium
from murkscan.optics.phase_henyey_greenstein import HenyeyGreenstein
from murkscan.optics.phase_petzold import PetzoldHarbour

LASER = np.array([0.0, -0.3, 0.0])
NORMAL = np.array([0.0, 0.8, -0.3]) / np.hypot(0.8, 0.3)
"""The sheet crosses the camera's axis at 0.8 m."""
POWER = 0.05
"""Of the fan per angle [W/rad]."""


def glow_on(ray, medium):
    """Give the glow that a camera in the origin sees along one ray."""
    reach = (LASER @ NORMAL) / (ray @ NORMAL)
    beam = reach * ray - LASER
    distance = np.linalg.norm(beam)
    return sheet_glow(
        (beam / distance)[None],
        ray[None],
        NORMAL[None],
        laser_range=np.array([distance]),
        camera_range=np.array([reach]),
        line_power=np.array([POWER / distance]),
        medium=medium,
    )[0]


def glow_through(ray, medium, thickness):
    """Add up, point by point along the ray, what a Gaussian sheet scatters towards the camera."""

    def rate(way):
        beam = way * ray - LASER
        off = beam @ NORMAL
        distance = np.linalg.norm(beam)
        cosine = np.array([-(beam @ ray) / distance])
        bell = np.exp(-0.5 * (off / thickness) ** 2) / (thickness * np.sqrt(2 * np.pi))
        scattered = medium.scattering * medium.phase.at_cosine(cosine)[0]
        left = np.exp(-medium.attenuation * (distance + way))
        return scattered * POWER / distance * bell * left

    middle = (LASER @ NORMAL) / (ray @ NORMAL)
    half = 8 * thickness / abs(ray @ NORMAL)
    return quad(rate, middle - half, middle + half, points=[middle], epsrel=1e-8)[0]


@pytest.mark.parametrize("attenuation", [0.3, 1.5, 6.0])
@pytest.mark.parametrize("phase", [PetzoldHarbour(), HenyeyGreenstein(0.9)], ids=repr)
@pytest.mark.parametrize("tangents", [(0.0, 0.0), (0.4, -0.35), (-0.2, 0.3), (0.0, -1.0)])
def test_a_thin_sheet_glows_as_the_integral_through_a_thick_one(attenuation, phase, tangents):
    medium = Medium(attenuation, 0.83, phase)
    ray = np.array([*tangents, 1.0])
    ray /= np.linalg.norm(ray)
    # The bar is 1 %; the sheet of 1 mm, 1σ, is a hundredth of the ranges thick where it is cut.
    expected = glow_through(ray, medium, 1e-3)
    assert glow_on(ray, medium) == pytest.approx(expected, rel=0.01)


def test_water_that_only_absorbs_does_not_glow():
    assert glow_on(np.array([0.0, 0.0, 1.0]), Medium(1.0, 0.0)) == 0.0
