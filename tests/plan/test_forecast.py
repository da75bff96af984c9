"""A plan against the simulator, and what must hold for any rig."""

import math

import numpy as np
import pytest

from murkscan.cli.main import run
from murkscan.errors import InputError, NotEnoughData
from murkscan.io.rig_toml import save_rig
from murkscan.optics.beam import Light
from murkscan.optics.medium import Medium
from murkscan.optics.sensor import Sensor
from murkscan.plan import (
    VISIBLE,
    Conditions,
    attenuation_from_secchi,
    attenuation_from_visibility,
    forecast,
    place_laser,
)
from murkscan.simulate.frames import simulate_frames
from murkscan.triangulate import RaySheet

from ..scenes import air_rig, standing, wall

DIM = Sensor(exposure=2e-3, f_number=4.0)


def conditions(attenuation=1.5, **settings):
    return Conditions(Medium(attenuation), Light(power=0.02), DIM, **settings)


@pytest.mark.parametrize(("axis", "attenuation"), [("y", 0.3), ("x", 2.0)])
def test_a_plan_says_what_the_simulator_draws(axis, attenuation):
    rig, distance = air_rig(axis=axis), 0.62
    around = conditions(attenuation, albedo=0.1)
    scene = standing(
        wall(distance, albedo=0.1),
        rig=rig,
        medium=around.medium,
        light=around.light,
        sensor=around.sensor,
    )
    truth = next(iter(simulate_frames(scene))).stripe
    planned = forecast(rig, around, depths=np.array([distance]))
    # Both add up the same light; the plan takes the skirt as that of an endless line.
    assert np.nanmedian(planned.bound) == pytest.approx(np.median(truth.crlb), rel=0.05)
    step = 0.25 * np.eye(2)["xy".index(axis)]
    near, far = (
        np.linalg.norm(RaySheet().locate(truth.pixels + sign * step, rig, 0), axis=1)
        for sign in (-1, 1)
    )
    per_pixel = np.abs(far - near) / 0.5
    sigma = planned.median(planned.sigma_along)[0]
    assert sigma == pytest.approx(np.median(truth.crlb * per_pixel), rel=0.05)


def test_murkier_water_darker_paint_and_less_power_are_never_better():
    rig, depths = air_rig(), np.linspace(0.4, 1.2, 9)
    usual = forecast(rig, conditions(1.0), depths=depths).bound
    worse = [
        forecast(rig, conditions(2.0), depths=depths).bound,
        forecast(rig, conditions(1.0, albedo=0.05), depths=depths).bound,
        forecast(rig, Conditions(Medium(1.0), Light(power=0.01), DIM), depths=depths).bound,
    ]
    for other in worse:
        assert (np.nan_to_num(other, nan=np.inf) >= np.nan_to_num(usual, nan=np.inf)).all()


def test_the_range_limit_is_where_half_of_the_points_are_visible():
    rig = air_rig()
    whole = forecast(rig, conditions(2.0))
    _, far = whole.reach
    at = forecast(rig, conditions(2.0), depths=np.array([0.99 * far, 1.01 * far]))
    before, after = np.nanmedian(at.bound, axis=1)
    assert before < VISIBLE < after


def test_speckle_is_as_large_as_was_measured():
    """0.1 to 0.3 mm at 1 m for an aperture of 1 mm radius seen at 14 to 30 degrees, in air."""
    sensor = Sensor(f_number=554 * 5e-6 / 2e-3)
    rig = air_rig(baseline=1.0 * math.tan(math.radians(14)), distance=1.0)
    seen = forecast(
        rig, Conditions(Medium(0.0), Light(), sensor), depths=np.array([1.0]), num_lines=1
    )
    expected = 532e-9 / (2 * math.pi * 1e-3 * math.sin(math.radians(14)))
    assert seen.sigma_speckle[0, 0] == pytest.approx(expected, rel=0.01)


def test_where_nothing_will_be_seen_the_plan_says_what_to_change():
    blind = forecast(air_rig(), Conditions(Medium(50.0), Light(power=1e-6), DIM))
    with pytest.raises(NotEnoughData, match="more power"):
        _ = blind.reach


def test_the_best_place_is_no_worse_than_the_present_one():
    rig, around = air_rig(baseline=0.08, distance=3.0), conditions(0.5)
    best = place_laser(rig, around, near=0.5, far=0.8, longest=0.4)
    now = forecast(rig, around, depths=np.linspace(0.5, 0.8, 9), num_lines=3)
    assert best.share_found >= float((now.share_found * now.share_in_view).mean())
    assert best.baseline > 0.1


def test_water_is_known_from_what_a_diver_sees():
    assert attenuation_from_visibility(1.6) == pytest.approx(3.0)
    # Clear enough to see a disc 10 m down: c is about 0.7 per metre (Tyler 1968).
    assert attenuation_from_secchi(10.0) == pytest.approx(0.695, abs=0.001)
    with pytest.raises(InputError, match="above 0"):
        attenuation_from_secchi(0.0)


def test_the_command_prints_a_table_and_writes_a_page(tmp_path, capsys):
    save_rig(tmp_path / "rig.toml", air_rig())
    words = ["plan", "--rig", str(tmp_path / "rig.toml"), "--out", str(tmp_path / "plan")]
    assert run([*words, "--visibility-m", "4"]) == 0
    said = capsys.readouterr().out
    assert "go no faster than" in said
    assert (tmp_path / "plan" / "index.html").stat().st_size > 0
    assert (tmp_path / "plan" / "plan.json").stat().st_size > 0
    assert run(words) == 2
    assert "how far a diver sees is enough" in capsys.readouterr().err
