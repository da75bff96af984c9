"""Whoever does the work, it is the same to the byte."""

import filecmp
import shutil

import numpy as np
import pytest

import murkscan as ms
from murkscan.cli.main import run
from murkscan.distribute import Dask, Processes, Serial, Threads
from murkscan.io.images import write_image
from murkscan.project import TRIANGULATE
from murkscan.survey.cloud import build_cloud
from murkscan.survey.export import export_cloud
from murkscan.survey.extract import extract_recording
from murkscan.survey.mesh import build_mesh
from murkscan.survey.motion import follow_motion
from murkscan.survey.sample import load_sample
from murkscan.survey.scan import begin_scan
from murkscan.survey.triangulate import triangulate_stripes
from murkscan.triangulate import undo_paint_pull

from ..mutants import RIG
from ..projects import scanned
from ..scans import plane, scan
from ..scenes import air_rig

NUM = 1200
PULL = 0.5
"""Of paint, which joins parts [px]."""
LOST = [*range(3), *range(505, 600), *range(1100, 1200)]
"""At the beginning, over the border of two runs of parts, and at the end, over several parts."""


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    folder = tmp_path_factory.mktemp("recorded")
    (folder / "rig.toml").write_text(RIG)
    rows, columns = np.arange(64)[:, None], np.arange(96)
    for number in range(NUM):
        phase = number / 3 + columns / 7
        paint, change = np.exp(0.3 * np.sin(phase) - 0.3), 0.1 * np.cos(phase)
        centre = 30 + 8 * np.sin(number / 50) + PULL * change
        picture = 20 + 180 * paint * np.exp(-0.5 * ((rows - centre) / 1.5) ** 2)
        write_image(folder / "frames" / f"{number}.pgm", picture.astype(np.uint8))
    for number in LOST:
        (folder / "frames" / f"{number}.pgm").write_bytes(b"lost")
    return folder


def extract(recorded, out, executor):
    rig = ms.load_rig(recorded / "rig.toml")
    recording = ms.open_recording(recorded / "frames", fps=25.0)
    project = ms.Project(out)
    begin_scan(project, recording, rig, settings={})
    result = extract_recording(project, recording, rig, ms.GrayGravity(), executor=executor)
    triangulate_stripes(project, rig, ms.RaySheet(), executor=executor)
    return result


@pytest.fixture(scope="module")
def serial(recorded, tmp_path_factory):
    out = tmp_path_factory.mktemp("serial") / "out"
    result = extract(recorded, out, Serial())
    assert (result.frames, result.skipped) == (NUM - len(LOST), len(LOST))
    (pull,) = ms.Project(out).finished(TRIANGULATE).result.paint_pulls
    assert pull.shift == pytest.approx(PULL, rel=0.1)
    return out


@pytest.fixture(scope="module")
def cluster():
    """Give the address of a cluster that begins once for all stages."""
    distributed = pytest.importorskip("distributed", reason="the extra [cluster] is not installed")
    settings = {"threads_per_worker": 1, "dashboard_address": None, "silence_logs": 50}
    with distributed.LocalCluster(n_workers=2, **settings) as cluster:
        yield cluster.scheduler_address


@pytest.fixture(params=["threads", "processes", "dask"])
def executor(request):
    """Give each that is not serial; how many processes there are makes no difference to a task."""
    if request.param == "dask":
        return Dask(request.getfixturevalue("cluster"))
    return Threads(2) if request.param == "threads" else Processes(1)


def test_the_parts_are_the_same_to_the_byte(recorded, serial, tmp_path, executor):
    extract(recorded, tmp_path / "out", executor)
    made = [file.relative_to(serial) for file in sorted(serial.rglob("*")) if file.is_file()]
    made = [name for name in made if name.suffix in (".parquet", ".png") or "frames" in name.parts]
    assert len(made) > 2 * NUM // 64
    _, *different = filecmp.cmpfiles(serial, tmp_path / "out", made, shallow=False)
    assert different == [[], []]
    there = sorted(file.name for file in (tmp_path / "out").rglob("*") if file.is_file())
    assert there == sorted(file.name for file in serial.rglob("*") if file.is_file())


def test_paint_is_taken_back_across_borders_of_parts(recorded, serial):
    project = ms.Project(serial)
    found, rig = project.load_stripe(), ms.load_rig(recorded / "rig.toml")
    pulls = project.finished(TRIANGULATE).result.paint_pulls
    whole = undo_paint_pull(found, pulls, rig)
    assert not np.array_equal(whole.pixels, found.pixels)
    np.testing.assert_array_equal(project.load_profile().pixels, whole.pixels)


def test_measures_know_that_paint_was_taken_back(recorded, serial, tmp_path):
    project = ms.Project(shutil.copytree(serial, tmp_path / "out"))
    follow_motion(project, ms.ConstantSpeed(0.1, "y"))
    build_cloud(project, ms.load_rig(recorded / "rig.toml"))
    sight = load_sample(project).sight
    assert sight is not None
    assert sight.pulled_back is not None
    assert sight.pulled_back.all()


@pytest.mark.parametrize(
    "flags",
    [
        ["--dask-address", "tcp://127.0.0.1:1"],
        ["--executor", "serial", "--workers", "2"],
        ["--workers", "0"],
        ["--executor", "dask", "--dask-address", "tcp://a:1", "--workers", "2"],
    ],
)
def test_flags_that_mean_nothing_together_are_refused_at_once(recorded, tmp_path, flags):
    words = ["scan", str(recorded / "frames"), "--rig", str(recorded / "rig.toml")]
    assert run([*words, "--step-mm", "1", *flags, "--out", str(tmp_path / "out")]) == 2
    assert not (tmp_path / "out").exists()


def made_by(root, executor):
    """A cloud, its surface and an export, in four blocks."""
    profile, trajectory = scan(plane)
    project = scanned(root / "out", profile, trajectory, parts=12)
    build_cloud(project, air_rig(axis="x"), block=6000, executor=executor)
    build_mesh(project, ms.GridMesh(), block=6000, executor=executor)
    export_cloud(project, root / "dive.csv", executor=executor)
    return root


@pytest.fixture(scope="module")
def by_one(tmp_path_factory):
    return made_by(tmp_path_factory.mktemp("one"), Serial())


def test_cloud_surface_and_export_are_the_same_to_the_byte(by_one, tmp_path, executor):
    made_by(tmp_path, executor)
    made = [file.relative_to(by_one) for file in sorted(by_one.rglob("*")) if file.is_file()]
    made = [name for name in made if name.name != "stage.json"]
    assert sum(name.parts[:2] == ("out", "mesh") for name in made) == 4
    _, *different = filecmp.cmpfiles(by_one, tmp_path, made, shallow=False)
    assert different == [[], []]
