"""Scene files: what ships, and what is refused with which words."""

import numpy as np
import pytest

from murkscan.errors import FormatError, InputError
from murkscan.io.acceptance_toml import parse_acceptance
from murkscan.optics.sensor import Sensor
from murkscan.simulate import Simulator, list_scenes, load_scene, parse_scene, read_scene

from ..scenes import smaller

NAMES = [
    "plane", "plane-c3", "plane-hd", "plane-c3-hd", "hull", "hull-c3", "hull-hd", "hull-c3-hd",
    "sphere-c6", "ballbar-c1.5", "plate-c0.3-hd", "step", "stairs-c0.3-hd", "chessboard",
    "chessboard-laser", "demo",
]  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_scenes_ship_by_name(name):
    scene = load_scene(name)
    assert len(scene) > 20
    assert scene.rig.camera.size == ((1920, 1200) if name.endswith("-hd") else (720, 576))
    assert (scene.medium is not None) == ("-c" in name or name == "demo")


def test_the_list_names_each_scene_with_a_line():
    scenes = list_scenes()
    assert {"plane", "sphere", "stairs", "hull", "chessboard", "chessboard-laser"} <= set(scenes)
    assert all(len(line) > 20 for line in scenes.values())


def test_artefacts_are_as_the_acceptance_test_is_told():
    test = parse_acceptance(load_scene("ballbar").acceptance, "ballbar")
    places = [body.world_from_object.translation for body in load_scene("ballbar").bodies[:2]]
    for ball, place in zip(test.balls, places, strict=True):
        assert np.linalg.norm(np.array(ball.near) - place) == pytest.approx(ball.diameter / 2)
    assert np.linalg.norm(places[1] - places[0]) == pytest.approx(test.bars[0].length)
    step = parse_acceptance(load_scene("step").acceptance, "step").steps[0]
    assert step.first[2] - step.second[2] == pytest.approx(step.height)
    plate = parse_acceptance(load_scene("plate").acceptance, "plate").plates[0]
    middle = load_scene("plate").bodies[0].world_from_object.translation
    assert np.linalg.norm(np.array(plate.near) - middle) < 1e-6


BAD = [
    ("format = 1", 'format = 1\nacceptance = "none.toml"', "no file .*none.toml"),
    ("attenuation_per_m = 1.5", "attenuation_per_m = -0.5", "water.attenuation_per_m must not"),
    ("attenuation_per_m = 1.5", "attenuation_per_m = 900", "lower water.attenuation_per_m"),
    ("attenuation_per_m = 1.5", "attenuation_per_m = 1.5\nmean_cosine = 0.9", "water.mean_cosine"),
    ("attenuation_per_m = 1.5", "single_scattering_albedo = 0.9", "needs water.attenuation_per_m"),
    ("albedo = 0.1", 'albedo = "dark"', "surface.albedo: input should be a valid number"),
    ("width_mm = 3000.0", "width_mm = [1.0, 2.0]", "object.width_mm: input should be"),
    ("width_mm = 3000.0", 'width_mm = 3000.0\nunit = "mm"', "object.unit is for meshes"),
    ("peak_grey = 200", "peak_grey = -5", "sensor.peak_grey"),
    ("peak_grey = 200", "peak_grey = 200\nblack_level = 300", "sensor.black_level"),
    ("attenuation_per_m = 1.5", "attenuation_per_cm = 1.5", "water.attenuation_per_cm is unknown"),
    ("attenuation_per_m = 1.5", 'attenuation_per_m = 1.5\ntype = "Jerlov II"', "water.type"),
    ("albedo = 0.1", "albedo = 1.7", "surface.texture plain.*albedo = 1.7"),
    ("albedo = 0.1", 'texture = "velvet"', "surface.texture must be one of plain, bands"),
    ('mesh = "plane"', 'mesh = "teapot.ply"', "neither a file"),
    ("width_mm = 3000.0", "wide_mm = 3000.0", "object.wide_mm is no key of the plane"),
    ("0.0, 900.0]", "0.0, -900.0]", "never meets the object"),
    ("speed_mm_s = 100.0", "speed_mm_s = 90000.0", "motion.speed_mm_s"),
    ("peak_grey = 200", "peak_grey = 200\nbits = 32", "sensor.bits"),
    ("interlaced = true", 'bits = 12\ncodec = "ffv1"', "keeps 8 bits"),
    ("peak_grey = 200", "peak_grey = 200\npower = 1", "sensor.power is unknown"),
    ("frames = 100", "frames = 0", "motion.frames"),
    ("speed_mm_s = 100.0", 'poses = "nowhere.csv"', "nowhere.csv"),
    ('file = "rigs/pal.toml"', 'file = "rigs/none.toml"', "rig.file: there is no file"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "words"), BAD)
def test_bad_scenes_are_one_sentence_that_names_the_key(old, new, words):
    text, name, folder = read_scene("plane-c1.5")
    assert old in text
    with pytest.raises((FormatError, InputError), match=words):
        # What only shows once the light is drawn shows in a small picture, too.
        Simulator.of(smaller(parse_scene(text.replace(old, new), name, folder), 4))


def test_a_port_inside_the_lens_is_refused(tmp_path):
    text, name, folder = read_scene("plane")
    rig = (folder / "rigs/pal.toml").read_text().replace("distance_mm = 30.0", "distance_mm = -3.0")
    (tmp_path / "rigs").mkdir()
    (tmp_path / "rigs/pal.toml").write_text(rig)
    with pytest.raises(FormatError, match=r"camera\.port.*inside the lens"):
        parse_scene(text, name, tmp_path)


def test_a_mesh_without_faces_is_refused(tmp_path):
    (tmp_path / "empty.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n"
    )
    text, name, folder = read_scene("plane")
    text = text.replace('"plane"', '"empty.ply"').replace(
        "width_mm = 3000.0\nheight_mm = 3000.0\n", ""
    )
    (tmp_path / "rigs").mkdir()
    (tmp_path / "rigs/pal.toml").write_text((folder / "rigs/pal.toml").read_text())
    with pytest.raises(FormatError, match=r"empty\.ply has no triangles"):
        parse_scene(text, name, tmp_path)


def test_a_mesh_file_of_one_s_own_is_scanned(tmp_path):
    from murkscan.io.mesh_files import save_mesh
    from murkscan.simulate.shapes import Plane
    from murkscan.types.mesh import Mesh

    plate = Plane(3.0, 3.0).mesh()
    save_mesh(tmp_path / "plate.stl", Mesh(plate.vertices * 1000, plate.faces))
    text, name, folder = read_scene("plane")
    text = text.replace('"plane"', '"plate.stl"\nunit = "mm"')
    text = text.replace("width_mm = 3000.0\nheight_mm = 3000.0\n", "")
    (tmp_path / "rigs").mkdir()
    (tmp_path / "rigs/pal.toml").write_text((folder / "rigs/pal.toml").read_text())
    own, ours = parse_scene(text, name, tmp_path), load_scene("plane")
    mine, theirs = (Simulator.of(smaller(scene)).draw_frame(3) for scene in (own, ours))
    # STL keeps single precision.
    np.testing.assert_allclose(mine.stripe.points, theirs.stripe.points, atol=1e-5)


def test_a_sensor_refuses_what_cannot_be():
    for settings, words in (
        ({"psf": 0.0}, "psf_px"),
        ({"exposure": 100.0}, "exposure_ms must lie between 0.001 and 10000"),
        ({"interlaced": True, "colour": "rggb"}, "no fields"),
    ):
        with pytest.raises(InputError, match=words):
            Sensor(**settings)


@pytest.mark.parametrize("name", ["hull-c.", "hull-c1.2.3", "chessboard-hd", "teapot"])
def test_a_name_that_is_none_is_told(name):
    with pytest.raises((FormatError, InputError), match=r"no scene|no -hd"):
        load_scene(name)


@pytest.mark.parametrize("name", ["chessboard", "chessboard-laser", "stairs", "sphere-c6"])
def test_shipped_scenes_show_something_and_are_finite(name):
    simulator = Simulator.of(smaller(load_scene(name)))
    frame = simulator.draw_frame(len(simulator.scene) // 2)
    assert np.isfinite(frame.light.total).all()
    assert np.isfinite(frame.stripe.snr).all()
    assert frame.frame.image.max() > 20


def test_the_chessboard_s_photos_show_the_board():
    from murkscan.calibrate import Chessboard, find_board

    frame = Simulator.of(load_scene("chessboard")).draw_frame(3)
    assert find_board(frame.frame.image, Chessboard(9, 6, 0.03)) is not None
