"""The refractive index of water."""

import pytest

from murkscan.errors import InputError
from murkscan.optics import refractive_index
from murkscan.types.water import Water

GREEN = 532e-9


@pytest.mark.parametrize(
    ("temperature", "salinity", "index"),
    [(20, 0, 1.335035), (20, 35, 1.341510), (10, 35, 1.342395), (28, 35, 1.340592),
     (0, 35, 1.342988)],
)  # fmt: skip
def test_quan_and_fry_at_532_nm(temperature, salinity, index):
    water = Water(float(temperature), float(salinity))
    # The figures are given to six decimals.
    assert refractive_index(water, GREEN) == pytest.approx(index, abs=6e-7)


def test_red_light_is_bent_less():
    # Sodium light in pure water at 20 °C: 1.33299 against air, a standard of refractometry.
    assert refractive_index(Water(20.0, 0.0), 589.3e-9) == pytest.approx(1.33299, abs=3e-5)


def test_depth_presses():
    surface, deep = Water(10.0, 35.0), Water(10.0, 35.0, depth=1000.0)
    grown = refractive_index(deep, GREEN) - refractive_index(surface, GREEN)
    assert grown == pytest.approx(1.45e-3, rel=1e-6)


def test_warm_and_fresh_water_bends_less():
    def index(temperature, salinity):
        return refractive_index(Water(temperature, salinity), GREEN)

    # Slopes by differences over a degree and a unit; given to two figures.
    assert index(20.5, 35.0) - index(19.5, 35.0) == pytest.approx(-1.0e-4, rel=0.05)
    assert index(10.5, 0.0) - index(9.5, 0.0) == pytest.approx(-4.8e-5, rel=0.05)
    assert index(20.0, 35.0) - index(20.0, 34.0) == pytest.approx(1.85e-4, rel=0.01)


def test_a_measured_index_is_taken_as_it_is():
    assert refractive_index(Water(index=1.3377), GREEN) == 1.3377


def test_without_water_there_is_air():
    assert refractive_index(None, GREEN) == 1.0


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"salinity_psu": 350.0}, "salinity_psu .* 350"),
        ({"temperature_c": 68.0}, "temperature_c .* 68"),
        ({"temperature_c": float("nan")}, "temperature_c"),
        ({"depth": -1.0}, "depth"),
        ({"index": 0.75}, "index"),
    ],
)
def test_what_is_no_water_is_refused(settings, says):
    with pytest.raises(InputError, match=says):
        Water(**settings)
