"""Dents and deviations on surfaces whose truth is written down."""

from dataclasses import replace

import numpy as np
import pytest

from murkscan.errors import InputError, NotEnoughData
from murkscan.measure import (
    Sample,
    deviation_from_mesh,
    deviation_from_smooth,
    draw_histogram,
    find_dents,
    measure_departure,
    require_dent_sizes,
)
from murkscan.types.mesh import Mesh

from .. import scans

DEPTH, WIDTH = 2e-3, 0.04


def bowl(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A hull's side, curved in both directions."""
    return 0.5 + x * x / 2 + y * y / 1.0


def dented(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The same with a round dent, half a wave of a cosine, whose middle is at 0.01 and 0.005 m."""
    away = np.hypot(x - 0.01, y - 0.005) / (WIDTH / 2)
    return bowl(x, y) + np.where(away < 1, DEPTH * (1 + np.cos(np.pi * away)) / 2, 0.0)


def grid_mesh(surface, half: float = 0.1, count: int = 81) -> Mesh:
    """Give a surface as triangles."""
    x, y = (part.ravel() for part in np.meshgrid(*[np.linspace(-half, half, count)] * 2))
    first = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    a, b, c, d = first, first + 1, first + count, first + count + 1
    faces = np.concatenate([np.stack([a, c, b], 1), np.stack([b, c, d], 1)])
    return Mesh(np.stack([x, y, surface(x, y)], axis=1), faces)


@pytest.fixture(scope="module")
def dented_scan() -> Sample:
    return Sample.from_cloud(scans.scan_cloud(dented, noise=1e-4, spacing=2e-3))


def references(sample):
    return {
        "smooth": deviation_from_smooth(sample, largest=0.08),
        "mesh": deviation_from_mesh(sample, grid_mesh(bowl), within=0.01),
    }


@pytest.mark.parametrize("kind", ["smooth", "mesh"])
def test_a_dent_is_found_placed_and_measured(dented_scan, kind):
    search = find_dents(dented_scan, references(dented_scan)[kind], smallest=0.015)
    (dent,) = search.dents
    assert dent.place[:2] == pytest.approx([0.01, 0.005], abs=1e-3)
    # 10 % is the promise; noise of 0.1 mm over hundreds of points leaves less.
    assert dent.depth.value == pytest.approx(DEPTH, rel=0.1)
    # A tenth of its depth is left at 0.795 of its width; averaging widens it by a millimetre or so.
    assert dent.diameter.value == pytest.approx(0.795 * WIDTH, abs=4e-3)
    # Volume of half a cosine's wave turned about its axis: π R² d (1/2 - 2/π²).
    full = np.pi * (WIDTH / 2) ** 2 * DEPTH * (0.5 - 2 / np.pi**2)
    assert dent.volume.value == pytest.approx(full, rel=0.12)  # a tenth of the depth is cut off


@pytest.mark.parametrize("kind", ["smooth", "mesh"])
def test_an_intact_hull_has_no_dent(kind):
    sample = Sample.from_cloud(scans.scan_cloud(bowl, noise=1e-4, spacing=2e-3))
    assert find_dents(sample, references(sample)[kind], smallest=0.015).dents == ()


def test_a_bump_is_a_dent_of_negative_depth():
    bump = scans.scan_cloud(lambda x, y: 2 * bowl(x, y) - dented(x, y), noise=1e-4, spacing=2e-3)
    sample = Sample.from_cloud(bump)
    (found,) = find_dents(sample, references(sample)["smooth"], smallest=0.015).dents
    assert found.depth.value == pytest.approx(-DEPTH, rel=0.1)
    assert found.volume.value < 0


def test_the_sign_of_a_deviation_does_not_depend_on_how_the_mesh_is_turned(dented_scan):
    mesh = grid_mesh(bowl)
    turned = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    one, other = (deviation_from_mesh(dented_scan, m, within=0.01).values for m in (mesh, turned))
    # Rounding only: 1e-12 m.
    assert np.allclose(one, other, rtol=0, atol=1e-12, equal_nan=True)
    # 0.1 mm of noise and facets of 2.5 mm on this curve leave nothing near half the depth.
    assert np.nanmin(one) < -0.8 * DEPTH
    assert np.nanmax(one) < 0.5 * DEPTH


def test_points_beside_the_reference_are_left_out(dented_scan):
    small = grid_mesh(bowl, half=0.03)
    deviation = deviation_from_mesh(dented_scan, small, within=0.05)
    outside = np.abs(dented_scan.cloud.points[:, :2]).max(axis=1) > 0.032
    assert np.isnan(deviation.values[outside]).all()
    assert np.isfinite(deviation.values).any()


def test_a_reference_out_of_reach_is_refused(dented_scan):
    with pytest.raises(NotEnoughData, match="unit"):
        deviation_from_mesh(dented_scan, grid_mesh(lambda x, y: bowl(x, y) * 1000), within=0.01)


def test_the_departure_of_a_shifted_scan_is_the_shift():
    sample = Sample.from_cloud(scans.scan_cloud(lambda x, y: bowl(x, y) - 3e-4, noise=1e-4))
    found = measure_departure(sample, deviation_from_mesh(sample, grid_mesh(bowl), within=0.01))
    # The rays are not upright on the surface everywhere: the shift along z is shorter across it.
    assert found["mean"].value == pytest.approx(3e-4, rel=0.05)
    assert found["rms"].value > found["mean"].value


def test_a_dent_wider_than_the_scan_is_refused(dented_scan):
    with pytest.raises(NotEnoughData, match="smaller"):
        find_dents(dented_scan, references(dented_scan)["mesh"], smallest=1.0)
    with pytest.raises(InputError, match="smallest"):
        find_dents(dented_scan, references(dented_scan)["mesh"], smallest=0.0)


def test_a_histogram_is_a_picture(dented_scan):
    picture = draw_histogram(references(dented_scan)["mesh"].values, title="dent")
    assert picture.shape == (800, 1280, 3)
    assert picture.std() > 10


def test_a_dent_that_the_scan_cuts_through_is_counted_and_not_told():
    # The scan ends 1 mm beside the dent's middle: a polynomial would have to guess one side.
    whole = scans.scan_cloud(dented, noise=1e-4, spacing=2e-3)
    part = Sample.from_cloud(whole[whole.points[:, 0] < 0.011])
    deviation = deviation_from_mesh(part, grid_mesh(bowl), within=0.01)
    search = find_dents(part, deviation, smallest=0.015)
    assert search.dents == ()
    assert search.num_unsure == 1


def test_what_is_told_of_an_intact_surface_is_beyond_its_own_interval():
    for seed in range(4):
        random = np.random.default_rng(seed)
        cloud = scans.scan_cloud(bowl, noise=1e-4, spacing=2e-3)
        # Errors in common of 8 mm patches, as stripes have them, and a rim full of bays.
        cells = np.floor(cloud.points[:, :2] / 0.008).astype(int) + 20
        off = 1e-4 * random.standard_normal((60, 60))[cells[:, 0], cells[:, 1]]
        gone = random.random((60, 60))[cells[:, 0], cells[:, 1]] < 0.2
        cloud = replace(cloud, points=cloud.points + off[:, None] * [0.0, 0.0, 1.0])[~gone]
        sample = Sample.from_cloud(cloud)
        deviation = deviation_from_mesh(sample, grid_mesh(bowl), within=0.01)
        for dent in find_dents(sample, deviation, smallest=0.015).dents:
            low, high = dent.depth.interval
            assert low > 0 or high < 0
            assert abs(dent.depth.value) < 5e-4


@pytest.mark.parametrize("largest", [np.nan, 0.0, -5.0, np.inf, 1e-12])
def test_sizes_that_no_dent_has_are_refused(dented_scan, largest):
    with pytest.raises(InputError, match="largest"):
        require_dent_sizes(smallest=0.01, largest=largest)
    with pytest.raises(InputError, match=r"largest-mm|larger things"):
        deviation_from_smooth(dented_scan, largest=largest)


@pytest.mark.parametrize("length", [np.nan, 0.0, -5.0, np.inf])
def test_a_reach_that_is_none_is_refused(dented_scan, length):
    with pytest.raises(InputError, match="reach"):
        deviation_from_mesh(dented_scan, grid_mesh(bowl), within=length)
    with pytest.raises(InputError, match="smallest"):
        find_dents(dented_scan, references(dented_scan)["mesh"], smallest=length)
    if length != 0:
        with pytest.raises(InputError, match="least-depth"):
            require_dent_sizes(smallest=0.01, least_depth=length)


@pytest.mark.parametrize("smallest", [1e-12, 1e-300, 5e-324])
def test_a_map_without_end_is_refused(dented_scan, smallest):
    with pytest.raises(InputError, match="too large"):
        find_dents(dented_scan, references(dented_scan)["mesh"], smallest=smallest)
