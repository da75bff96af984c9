"""A rig of two lasers, scanned at once."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import murkscan as ms
from murkscan.errors import InputError
from murkscan.extract.lasers import join_remarks
from murkscan.geometry.mesh_distance import distance_to_mesh
from murkscan.io.mesh_files import load_mesh
from murkscan.project import EXTRACT, MOTION
from murkscan.simulate import Scene, Sensor, drive
from murkscan.simulate.shapes import Plane, Sphere
from murkscan.simulate.textures import Plain
from murkscan.simulate.vehicle import Unrest
from murkscan.survey.simulate import simulate_recording
from murkscan.types.laser import Laser

from ..scenes import air_rig, body, smaller

SPEED, NUM, RATE = 0.15, 20, 25.0


def two_lasers():
    """Two sheets 14° apart, which meet a wall half a metre away 57 mm from one another."""
    one = air_rig(0.2, 0.5)
    angle = math.atan2(0.5, 0.2) + math.radians(14.0)
    return replace(one, lasers=(*one.lasers, Laser.from_baseline_angle(0.125, angle, "y")))


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    way = drive(Unrest(), np.array([0.0, SPEED, 0.0]), np.zeros(3), NUM / RATE, seed=0)
    wall = body(Plane(2.0, 2.0), (0.0, 0.0, 0.5), texture=Plain(0.2))
    ball = body(Sphere(0.08), (0.02, 0.0, 0.52), texture=Plain(0.2))
    scene = Scene((wall, ball), two_lasers(), way, np.arange(NUM) / RATE,
                  sensor=Sensor(peak_grey=200.0, read_noise=2.0))  # fmt: skip
    folder = tmp_path_factory.mktemp("two") / "recorded"
    simulate_recording(smaller(scene), folder)
    return folder


@pytest.fixture(scope="module")
def scanned(recorded):
    rig = ms.load_rig(recorded / "rig.toml")
    motion = ms.ConstantSpeed(SPEED, "y", sigma=0.0)
    recording = ms.open_recording(recorded / "frames")
    return ms.scan(recording, rig, motion, out=recorded.parent / "out")


def test_every_point_of_both_lasers_lies_on_the_surface(recorded, scanned):
    cloud = scanned.load_cloud()
    off = distance_to_mesh(cloud.points, load_mesh(recorded / "truth" / "mesh.ply"), within=0.02)
    for laser in (0, 1):
        own = np.abs(off[cloud.laser == laser])
        # 240 scan lines in each of 20 frames, but for the shade behind the ball.
        assert len(own) > 0.8 * 240 * NUM
        # The first laser's line taken for the second's would lie centimetres off.
        assert np.nanquantile(own, 0.95) < 1e-3
        assert np.isfinite(own).all()


def test_a_point_has_its_laser_in_every_stage(scanned):
    profile, cloud = scanned.load_profile(), scanned.load_cloud()
    of = scanned.finished(EXTRACT).result.points_of
    assert of == tuple(np.bincount(scanned.load_stripe().laser))
    assert {*np.unique(profile.laser)} == {*np.unique(cloud.laser)} == {0, 1}
    report = json.loads((scanned.root / "report" / "report.json").read_text())
    assert report["lasers"] == [0, 1]
    page = (scanned.root / "view" / "index.html").read_text()
    assert '"laser"' in page


def test_what_both_lasers_passed_is_surface_once(scanned):
    mesh, cloud = scanned.load_mesh(), scanned.load_cloud()
    a, b, c = (mesh.vertices[corner] for corner in mesh.faces.T)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
    # The camera goes 114 mm and the sheets are 57 mm apart: counted twice, it would be a third more
    # The ball adds what it stands out.
    report = json.loads((scanned.root / "report" / "report.json").read_text())
    mapped = report["coverage"]["area_m2"]["all"]
    span = np.ptp(cloud.points[:, :2], axis=0)
    assert area < 1.1 * span.prod()
    assert mapped < 1.15 * span.prod()


def test_an_exact_speed_is_left_and_how_far_the_sheets_lie_apart_is_told(scanned):
    moved = scanned.finished(MOTION).result
    assert moved.corrected is None
    (words,) = moved.correction
    apart = float(words.split("surfaces lie ")[1].split(" mm")[0])
    # Only noise, of some hundredths of a millimetre, and the ball's edges.
    assert apart < 0.5
    np.testing.assert_allclose(scanned.load_trajectory().positions[-1, 1], SPEED * (NUM - 1) / RATE)


def test_a_finder_that_cannot_tell_lasers_apart_follows_one_of_them(recorded, tmp_path):
    rig = ms.load_rig(recorded / "rig.toml")
    recording, motion = ms.open_recording(recorded / "frames"), ms.ConstantSpeed(SPEED, "y")
    with pytest.raises(InputError, match="cannot tell the lines of 2 lasers apart"):
        ms.scan(recording, rig, motion, out=tmp_path / "out", extractor=ms.GrayGravity())
    assert not (tmp_path / "out").exists()


def test_lasers_that_the_rig_has_not_are_refused():
    with pytest.raises(InputError, match="there is no laser 2"):
        two_lasers().choose_lasers((0, 2))
    assert two_lasers().choose_lasers((1, 1, 0)) == two_lasers().choose_lasers() == (0, 1)


def test_what_is_odd_is_said_once_or_with_the_number_of_its_laser():
    said = join_remarks({0: ("lamp",), 1: ("lamp", "no stripe")}, (9, 0))
    assert said[:2] == ("lamp", "laser 1: no stripe")
    assert said[2].startswith("No frame shows the line of laser 1")
    assert join_remarks({0: ("no stripe",)}, (0,)) == ("no stripe",)
