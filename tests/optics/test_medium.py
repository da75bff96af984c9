"""Waters by number and by name."""

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.optics.medium import Medium
from murkscan.optics.phase_henyey_greenstein import HenyeyGreenstein
from murkscan.optics.phase_petzold import PetzoldHarbour
from murkscan.optics.turbidity import KNOWN_WATERS, medium_of


def test_what_is_not_scattered_is_absorbed():
    water = Medium(1.5, 0.8)
    assert water.scattering == pytest.approx(1.2)
    assert water.absorption == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("attenuation", "albedo", "says"),
    [
        (-0.1, 0.8, "attenuation .* got -0.1"),
        (np.nan, 0.8, "attenuation"),
        (1.0, 1.2, "albedo .* got 1.2"),
        (1.0, -0.2, "albedo"),
    ],
)
def test_what_no_water_does_is_refused(attenuation, albedo, says):
    with pytest.raises(InputError, match=says):
        Medium(attenuation, albedo)


@pytest.mark.parametrize("name", KNOWN_WATERS)
def test_every_known_water_absorbs_and_scatters(name):
    water = medium_of(name)
    assert 0 < water.scattering < water.attenuation
    # Clear sea water alone absorbs 0.045 /m at 532 nm (Pope and Fry 1997).
    assert water.absorption > 0.045


def test_a_harbour_is_found_by_its_name_in_any_case():
    water = medium_of("petzold nuc 2040", HenyeyGreenstein(0.9))
    assert water.attenuation == 2.19
    assert water.scattering == pytest.approx(1.824)
    assert water.phase == HenyeyGreenstein(0.9)
    assert medium_of("Jerlov 5C").phase == PetzoldHarbour()


def test_jerlovs_waters_come_murkier_and_murkier():
    values = [c for name, (c, _) in KNOWN_WATERS.items() if name.startswith("Jerlov")]
    assert values == sorted(values)


def test_an_unknown_water_is_told_the_known_ones():
    with pytest.raises(InputError, match=r"'Jerlov X'.*Jerlov IB.*NUC 2040"):
        medium_of("Jerlov X")
