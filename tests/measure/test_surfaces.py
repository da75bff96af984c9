"""Sections, areas, volumes, steps and distances of known surfaces."""

import math

import numpy as np
import pytest

from murkscan.errors import InputError, NotEnoughData
from murkscan.measure import (
    Ball,
    Box,
    Sample,
    cut_out,
    cut_section,
    measure_area,
    measure_distance,
    measure_enclosed,
    measure_section,
    measure_step,
    measure_volume,
)
from murkscan.mesh import GridMesh
from murkscan.types.mesh import Mesh
from murkscan.types.plane import Plane

from .. import scans

TETRAHEDRON = Mesh(
    np.array([[0.0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]),
    np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
)


@pytest.fixture(scope="module")
def plane_scan() -> tuple[Sample, Mesh]:
    cloud = scans.scan_cloud(scans.plane, noise=1e-4)
    return Sample.from_cloud(cloud), GridMesh().mesh(cloud)


def test_a_section_of_a_closed_surface_is_one_closed_line():
    section = cut_section(TETRAHEDRON, Plane.through(np.array([0.0, 0, 0.05]), np.eye(3)[2]))
    (line,) = section.lines
    assert np.array_equal(line[0], line[-1])
    (drawing,) = section.as_drawing()
    assert np.ptp(drawing, axis=0) == pytest.approx([0.05, 0.05])


def test_a_section_keeps_lengths_and_lies_on_its_plane(plane_scan):
    sample, mesh = plane_scan
    plane = Plane.through(np.array([0.0, 0.0, 0.5]), np.array([0.2, 1.0, 0.1]))
    section = cut_section(mesh, plane)
    for line, drawing in zip(section.lines, section.as_drawing(), strict=True):
        assert plane.distance_to(line) == pytest.approx(0.0, abs=1e-12)
        steps = [np.linalg.norm(np.diff(part, axis=0), axis=1) for part in (line, drawing)]
        assert steps[0] == pytest.approx(steps[1])
    found, sigmas = measure_section(section, sample)
    # The extent of its corners along the drawing's x, which lies in the plane.
    flat = np.concatenate(section.as_drawing())
    assert found["width"].value == np.ptp(flat[:, 0])
    assert found["width"].half_width < 2e-3
    assert [len(s) for s in sigmas] == [len(line) for line in section.lines]


def test_a_plane_that_meets_nothing_is_refused(plane_scan):
    with pytest.raises(NotEnoughData, match="does not meet"):
        cut_section(plane_scan[1], Plane.through(np.array([0.0, 0.0, 5.0]), np.eye(3)[2]))


def test_noise_does_not_swell_an_area(plane_scan):
    sample, mesh = plane_scan
    clean = GridMesh().mesh(scans.scan_cloud(scans.plane))
    truth = measure_area(clean, sample)["area"].value
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    crooked = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    found = measure_area(mesh, sample)["area"]
    assert found.value == pytest.approx(truth, rel=3e-3)
    assert crooked > 1.005 * truth


def test_the_volume_over_a_parallel_plane_is_area_times_height(plane_scan):
    sample, mesh = plane_scan
    normal = np.array([0.3, -0.2, -1.0])
    behind = Plane.through(np.array([0.0, 0.0, 0.52]), normal)
    found = measure_volume(mesh, sample, behind)
    height = 0.02 / math.sqrt(1.13)
    assert abs(found["mean_height"].value - height) < 2 * found["mean_height"].half_width
    assert found["mean_height"].half_width < 1e-4
    turned = Plane(-behind.normal, -behind.distance)
    assert measure_volume(mesh, sample, turned)["volume"].value == pytest.approx(
        -found["volume"].value
    )


def test_a_closed_surface_encloses_its_volume_and_an_open_one_none(plane_scan):
    sample, mesh = plane_scan
    found = measure_enclosed(TETRAHEDRON, sample)
    assert found["enclosed_volume"].value == pytest.approx(1e-3 / 6)
    with pytest.raises(InputError, match="is open"):
        measure_enclosed(mesh, sample)


def test_a_step_is_measured_within_twice_its_interval():
    cloud = scans.scan_cloud(scans.step, noise=2e-4)
    sample = Sample.from_cloud(cloud)
    y = cloud.points[:, 1]
    found = measure_step(sample[y > 0.005], sample[y < -0.005])
    assert abs(found["step"].value - 0.03) < 2 * found["step"].half_width
    assert found["step"].half_width < 1e-4
    assert found["angle_between"].value < 5 * found["angle_between"].sigma


def test_a_distance_is_taken_between_the_nearest_points(plane_scan):
    sample, _ = plane_scan
    ends = sample.cloud.points[[100, -100]]
    found = measure_distance(sample, ends + 1e-6)
    assert found["distance"].value == pytest.approx(np.linalg.norm(ends[1] - ends[0]))
    assert found["distance"].sigma_common is None
    with pytest.raises(InputError, match="within 10 mm"):
        measure_distance(sample, ends + 0.5)


def test_a_rig_that_stretches_everything_stretches_area_and_volume(plane_scan):
    sample, mesh = plane_scan
    points = sample.cloud.points
    long = Sample.from_cloud(sample.cloud, shifts=lambda some: 0.01 * points[some][:, :, None])
    area = measure_area(mesh, long)["area"]
    assert area.sigma_common == pytest.approx(0.02 * area.value, rel=1e-3)
    plane = Plane.through(np.zeros(3), np.array([0.3, -0.2, -1.0]))  # through what stays
    volume = measure_volume(mesh, long, plane)["volume"]
    assert volume.sigma_common == pytest.approx(0.0303 * abs(volume.value), rel=1e-2)


def test_an_empty_selection_of_a_surface_is_refused(plane_scan):
    with pytest.raises(NotEnoughData, match="None of the"):
        cut_out(plane_scan[1], Box((5.0, 5.0, 5.0), (6.0, 6.0, 6.0)))
    with pytest.raises(InputError, match="first corner"):
        Box((1.0, 0.0, 0.0), (0.0, 1.0, 1.0))


@pytest.mark.parametrize(
    ("part", "area"),
    [
        (Ball((0.1, 0.1, 0.0), 0.05), np.pi * 0.05**2),
        (Box((0.1, 0.2, -1.0), (0.13, 0.9, 1.0)), 0.03 * 0.7),
    ],
)
def test_a_part_between_the_corners_of_large_triangles_is_cut_out_of_them(part, area):
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    wall = Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    cut = cut_out(wall, part)
    sides = [cut.vertices[cut.faces[:, k]] - cut.vertices[cut.faces[:, 0]] for k in (1, 2)]
    found = np.linalg.norm(np.cross(*sides), axis=1).sum() / 2
    # A ball's border is followed to an eighth of a quarter of its radius.
    assert found == pytest.approx(area, rel=0.01)
