"""A scan's folder: what is removed, what is noticed, and who may work in it."""

import json
import subprocess
import sys
import threading

import numpy as np
import pytest

from murkscan.cli.main import run
from murkscan.errors import Cancelled, FormatError, InputError, MissingResult
from murkscan.project import (
    CLOUD,
    EXTRACT,
    MESH,
    MOTION,
    CloudResult,
    ExtractResult,
    MeshResult,
    MotionResult,
    Project,
    describe,
    hold,
)
from murkscan.survey.progress import Stoppable
from murkscan.survey.stage_runner import run_stage
from murkscan.types.trajectory import Trajectory

from ..projects import SCAN, finish, save_cloud
from ..scans import plane, scan_cloud

WAY = Trajectory(np.arange(3.0), np.zeros((3, 3)), np.tile([1.0, 0, 0, 0], (3, 1)))


@pytest.fixture
def project(tmp_path):
    """A scan with a motion and a cloud of a few thousand points."""
    project = Project(tmp_path / "out")
    project.save_scan(SCAN)
    finish(project, MOTION, MotionResult(3), make=lambda: project.save_trajectory(WAY))
    cloud = scan_cloud(plane, spacing=4e-3)
    finish(project, CLOUD, CloudResult(len(cloud), 0), make=lambda: save_cloud(project, cloud))
    return project


def test_only_what_a_stage_has_made_is_removed_with_it(project):
    folder = project.root / "cloud"
    (folder / "notes.txt").write_text("mine")
    (folder / "frames").mkdir()
    (folder / "frames/frame_notes.ply").write_text("mine, too")
    other = project.stage(CLOUD, settings={"another": True}, inputs={})
    other.begin()
    assert not (folder / "cloud.ply").exists()
    assert (folder / "notes.txt").read_text() == "mine"
    assert (folder / "frames/frame_notes.ply").exists()


@pytest.mark.parametrize("left", ["nothing", "an aside", "a torn ledger", "a file of others"])
def test_a_folder_that_a_kill_left_without_a_record_is_taken_up(tmp_path, left):
    project = Project(tmp_path)
    (tmp_path / "mesh").mkdir()
    if left == "an aside":
        (tmp_path / "mesh/.stage.part.json").write_text('{"ke')
    if left == "a torn ledger":
        (tmp_path / "mesh/.ledger.jsonl").write_text('{"file": "mesh.p')
    if left == "a file of others":
        (tmp_path / "mesh/mine.txt").write_text("mine")
    finish(project, MESH, MeshResult(0, 0))
    assert project.finished(MESH).result == MeshResult(0, 0)
    assert (tmp_path / "mesh/mine.txt").exists() == (left == "a file of others")


def test_the_ledger_that_a_kill_left_beside_a_finished_stage_is_removed(project):
    stage = project.stage(CLOUD, settings={}, inputs={})
    ledger = project.root / "cloud/.ledger.jsonl"
    ledger.write_text('{"file": "cloud.ply"}\n')
    done = run_stage(project, stage, lambda _: None, prepare=lambda: None, progress=Stoppable())
    assert done.points > 0
    assert not ledger.exists()
    assert len(project.load_cloud()) == done.points


def test_a_ledger_that_was_tampered_with_removes_nothing_outside(tmp_path):
    (tmp_path / "precious.txt").write_text("mine")
    project = Project(tmp_path / "out")
    (tmp_path / "out/mesh").mkdir(parents=True)
    lines = [{"file": "../../precious.txt"}, {"file": str(tmp_path / "precious.txt")}]
    text = "\n".join(json.dumps(line) for line in lines)
    (tmp_path / "out/mesh/.ledger.jsonl").write_text(text)
    finish(project, MESH, MeshResult(0, 0))
    assert (tmp_path / "precious.txt").exists()


@pytest.mark.parametrize("place", [0.1, 0.5, 0.99])
@pytest.mark.parametrize("name", ["cloud/points/000000.parquet", "motion/trajectory.csv"])
def test_one_flipped_bit_is_noticed_when_the_file_is_read(project, name, place):
    file = project.root / name
    data = bytearray(file.read_bytes())
    data[int(place * len(data))] ^= 1
    file.write_bytes(data)
    load = project.load_cloud if name.startswith("cloud") else project.load_trajectory
    with pytest.raises(FormatError, match="not as it was written"):
        load()
    file.unlink()
    with pytest.raises(MissingResult, match="is missing"):
        load()


def test_check_names_what_changed_and_counts_what_is_of_others(project, capsys):
    assert run(["check", str(project.root)]) == 0
    assert "1 file as it was written" in capsys.readouterr().out
    (project.root / "cloud/mine.txt").write_text("mine")
    with (project.root / "cloud/cloud.ply").open("r+b") as file:
        file.seek(1000)
        file.write(b"?")
    (project.root / "motion/trajectory.csv").unlink()
    assert run(["check", str(project.root)]) == 2
    said = capsys.readouterr()
    assert "changed: cloud/cloud.ply" in said.out
    assert "missing: motion/trajectory.csv" in said.out
    assert "1 that are not murkscan's" in said.out
    assert "2 files" in said.err
    assert run(["check", str(project.root / "cloud")]) == 2
    assert "holds no scan" in capsys.readouterr().err


@pytest.mark.parametrize(
    "damage",
    [
        lambda note: "",
        lambda note: note | {"key": 7},
        lambda note: note | {"key": {"inputs": []}},
        lambda note: note | {"result": {"points": "many"}},
        lambda note: note | {"files": {"cloud.ply": 12}},
        lambda note: note | {"seconds": None},
    ],
)
def test_a_damaged_record_counts_as_not_done(project, damage):
    file = project.root / "cloud/stage.json"
    file.write_text(json.dumps(damage(json.loads(file.read_text()))))
    stage = project.stage(CLOUD, settings={}, inputs={})
    assert stage.result() is None
    with pytest.raises((MissingResult, FormatError)):
        project.finished(CLOUD)


def test_another_meaning_of_the_data_is_another_key(project):
    from dataclasses import replace

    assert project.stage(CLOUD, settings={}, inputs={}).result() is not None
    later = replace(CLOUD, meaning=CLOUD.meaning + 1)
    assert project.stage(later, settings={}, inputs={}).result() is None


@pytest.mark.parametrize(
    "other",
    [
        np.zeros(4, np.float64).view(np.int64),
        np.zeros((2, 2)),
        np.zeros(8, np.float32),
        np.zeros((1, 4)),
    ],
)
def test_arrays_of_other_type_or_shape_are_described_otherwise(other):
    assert describe(np.zeros(4)) != describe(other)


def test_a_second_run_into_a_folder_is_told_of_the_first(tmp_path):
    code = (
        "import sys, time; from pathlib import Path; from murkscan.project import hold\n"
        "with hold(Path(sys.argv[1]), ('scan', 'dive.mkv')):\n"
        "    print('held', flush=True); time.sleep(60)\n"
    )
    command = [sys.executable, "-c", code, str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == "held\n"
        says = rf"in use by process {other.pid} on .*\(murkscan scan dive\.mkv\), since"
        with pytest.raises(InputError, match=says), hold(tmp_path):
            pass
        other.kill()
    # The lock of a process that was killed is none.
    with hold(tmp_path), hold(tmp_path):
        pass
    assert [file.name for file in tmp_path.iterdir()] == [".lock"]


def test_another_thread_of_the_same_process_is_another_run(tmp_path):
    refused = []

    def enter():
        try:
            with hold(tmp_path):
                pass
        except InputError:
            refused.append(True)

    with hold(tmp_path):
        thread = threading.Thread(target=enter)
        thread.start()
        thread.join()
    assert refused


def test_a_job_stops_at_its_next_step_and_goes_on_later(tmp_path):
    project = Project(tmp_path)
    stage = project.stage(EXTRACT, settings={}, inputs={})
    seen = []
    watch = Stoppable(lambda *step: seen.append(step))

    def make(_):
        watch("extract", 1, 3)
        watch.stop()
        watch("extract", 2, 3)
        raise AssertionError("it went on")

    with pytest.raises(Cancelled, match="stopped in extract"):
        run_stage(project, stage, make, prepare=lambda: None, progress=watch)
    assert seen == [("extract", 0, None), ("extract", 1, 3)]
    result = ExtractResult((0,), 1, 0, 0, 1)
    done = run_stage(project, stage, lambda _: result, prepare=lambda: None, progress=Stoppable())
    assert done == result
    assert stage.result() == result


def test_what_can_not_be_prepared_leaves_what_was_there(project):
    stage = project.stage(CLOUD, settings={"another": True}, inputs={})

    def fail():
        raise InputError("no")

    with pytest.raises(InputError):
        run_stage(project, stage, lambda _: None, prepare=fail, progress=Stoppable())
    assert len(project.load_cloud()) > 0
