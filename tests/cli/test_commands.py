"""Every command in order on one small project, and what a wrong one says."""

import io
import os
import shutil
import subprocess
import sys

import pytest
from rich.console import Console

from murkscan.cli.main import app, run

COMMANDS = [
    "demo", "simulate", "calibrate", "capture", "dive", "live", "scan", "extract", "triangulate",
    "motion", "cloud", "merge", "georeference", "mesh", "measure", "accept", "view", "report",
    "check", "turntable", "plan", "studio",
]  # fmt: skip


@pytest.fixture(scope="module")
def short(hull, tmp_path_factory):
    """Give the first frames that show the hull: a recording of a second."""
    folder = tmp_path_factory.mktemp("short")
    (folder / "frames").mkdir()
    for i in range(40, 60):
        shutil.copy(hull / "frames" / f"{i:06d}.png", folder / "frames")
    shutil.copy(hull / "rig.toml", folder)
    return folder


def _arguments(folder, *more):
    return [str(folder / "frames"), "--rig", str(folder / "rig.toml"), *more]


def test_each_stage_alone_makes_what_scan_makes(short, tmp_path, capsys):
    whole, alone = tmp_path / "whole", tmp_path / "alone"
    step = ("--step-mm", "7.7")
    assert run(["scan", *_arguments(short, *step, "--out", str(whole))]) == 0
    assert run(["extract", *_arguments(short, "--out", str(alone))]) == 0
    assert run(["triangulate", str(alone)]) == 0
    assert run(["motion", str(alone), *step]) == 0
    for stage in ("cloud", "mesh", "view", "report"):
        assert run([stage, str(alone)]) == 0
    for name in ("cloud/cloud.ply", "mesh/mesh.ply", "view/isometric.png"):
        assert (alone / name).read_bytes() == (whole / name).read_bytes()
    said = capsys.readouterr().out
    assert "in 20 frames read, 0 skipped" in said
    assert "mesh.glb" in said
    assert "nothing had changed" not in said
    assert run(["scan", *_arguments(short, *step, "--out", str(whole))]) == 0
    assert "nothing had changed" in capsys.readouterr().out


def test_the_paper_as_printed_runs_too(short, tmp_path):
    paper = ("--extractor", "threshold-skeleton", "--method", "equation-4", "--step-mm", "7.7")
    assert run(["scan", *_arguments(short, *paper, "--out", str(tmp_path / "out"))]) == 0


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(command, capsys):
    assert run([command, "--help"]) == 0
    said = capsys.readouterr().out
    assert "Usage: murkscan" in said
    assert "[default: False]" not in said
    assert "()" not in said


def test_help_of_a_measure_is_found_in_the_order_of_the_call(capsys):
    assert run(["measure", "section", "--help"]) == 0
    said = capsys.readouterr().out
    assert "--normal" in said
    assert run(["measure", "OUT", "section", "--help"]) == 0
    assert capsys.readouterr().out == said


def test_a_flag_without_its_value_is_told_so(tmp_path, capfd):
    assert run(["view", str(tmp_path), "--film"]) == 2
    assert "--film needs something behind it" in capfd.readouterr().err


def test_help_is_wrapped_by_the_terminal_alone():
    """A sentence of two lines in our source is one, however wide the terminal."""
    said = io.StringIO()
    app.help_print(["scan"], console=Console(file=said, width=300))
    assert "two corners X,Y,Z,X,Y,Z in the world [m]." in said.getvalue()


@pytest.mark.parametrize(
    ("more", "says"),
    [
        ((), "exactly one of --speed-mm-s, --step-mm and --poses"),
        (("--step-mm", "1", "--speed-mm-s", "1"), "exactly one of"),
        (("--step-mm", "0"), "other than 0"),
        (("--speed-mm-s", "0"), "other than 0"),
        (("--speed-mm-s", "100"), "--fps"),
        (("--poses", "nowhere.csv"), "nowhere.csv"),
        (("--step-mm", "1", "--laser", "3"), "no laser 3"),
        (("--step-mm", "1", "--set", "colour=3"), "is no setting of Murk"),
        (("--step-mm", "1", "--extractor", "magic"), "magic"),
        (("--step-mm", "1", "--start-time", "noon", "--poses", "."), "exactly one of"),
        (("--step-mm", "1", "--start-time", "5"), "goes with --poses"),
        (("--step-mm", "1", "--set", "birth=nan"), "birth"),
    ],
)
def test_a_wrong_scan_is_one_sentence_and_status_2(short, tmp_path, capfd, more, says):
    assert run(["scan", *_arguments(short, *more, "--out", str(tmp_path / "out"))]) == 2
    said = capfd.readouterr().err
    assert says in said
    assert "Traceback" not in said
    assert said.splitlines()[-1].startswith("murkscan: ")


@pytest.mark.parametrize("words", [["mesh", ""], ["measure", "", "area"], ["view", "a", "--with="]])
def test_a_word_without_letters_is_not_taken_for_the_folder_one_is_in(words, capfd):
    assert run(words) == 2
    assert "is empty; say what is meant" in capfd.readouterr().err


def test_a_whole_number_is_asked_for_where_one_is_wanted(tmp_path, capfd):
    (tmp_path / "scan.json").write_text("{}")
    assert run(["mesh", str(tmp_path), "--mesher", "poisson", "--set", "depth=8.5"]) == 2
    assert "'8.5' is not a whole number" in capfd.readouterr().err


def test_every_door_tells_of_an_interruption_in_the_same_words():
    """An app that is called by another is asked on its own what it does then."""
    from murkscan.cli import calibrate, main, measure

    doors = [main.app, measure.app, calibrate.app]
    assert not any(door.suppress_keyboard_interrupt for door in doors)


def test_a_rig_without_a_laser_says_what_to_run(short, tmp_path, capfd):
    rig = (short / "rig.toml").read_text()
    bare = tmp_path / "bare.toml"
    bare.write_text(rig[: rig.index("[[laser]]")])
    frames, out = str(short / "frames"), str(tmp_path / "out")
    assert run(["scan", frames, "--rig", str(bare), "--step-mm", "1", "--out", out]) == 2
    assert "murkscan calibrate laser" in capfd.readouterr().err


def test_a_stage_without_the_one_before_names_it(short, tmp_path, capfd):
    out = tmp_path / "out"
    assert run(["triangulate", str(out)]) == 2
    assert f"no folder {out}" in capfd.readouterr().err
    assert run(["extract", *_arguments(short, "--out", str(out))]) == 0
    assert run(["cloud", str(out)]) == 2
    assert "`murkscan triangulate`" in capfd.readouterr().err


def test_a_missing_rig_and_an_empty_folder_are_named(short, tmp_path, capfd):
    frames, out = str(short / "frames"), str(tmp_path / "out")
    rest = ["--step-mm", "1", "--out", out]
    assert run(["scan", frames, "--rig", str(tmp_path / "no.toml"), *rest]) == 2
    assert "no.toml" in capfd.readouterr().err
    (tmp_path / "empty").mkdir()
    rig = str(short / "rig.toml")
    assert run(["scan", str(tmp_path / "empty"), "--rig", rig, *rest]) == 2
    assert "empty" in capfd.readouterr().err


def test_help_loads_nothing_heavy():
    """What makes --help slow is imports, so these are counted; its time is a benchmark."""
    code = (
        "import sys; from murkscan.cli.main import run; run(['scan', '--help']);"
        "print([m for m in ('numpy', 'numba', 'cv2', 'av', 'pyarrow') if m in sys.modules])"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.splitlines()[-1] == "[]"


def test_matrix_products_leave_the_cores_to_the_stages_unless_the_user_says_otherwise():
    code = (
        "import os, sys; from murkscan.cli import main; sys.argv = ['murkscan', '--version']\n"
        "try: main()\n"
        "finally: print(os.environ['OPENBLAS_NUM_THREADS'], 'numpy' in sys.modules)"
    )
    for given, taken in (({}, "1 False"), ({"OPENBLAS_NUM_THREADS": "2"}, "2 False")):
        bare = {name: value for name, value in os.environ.items() if not name.endswith("_THREADS")}
        said = subprocess.run(
            [sys.executable, "-c", code],
            env=bare | given,
            capture_output=True,
            text=True,
            check=True,
        )
        assert said.stdout.splitlines()[-1] == taken


def test_simulate_lists_its_scenes(capsys):
    assert run(["simulate", "--list"]) == 0
    listed = capsys.readouterr().out
    assert all(name in listed for name in ("hull", "sphere", "chessboard-laser", "-hd"))


def test_simulate_says_what_it_wants(capsys, tmp_path):
    assert run(["simulate"]) == 2
    assert run(["simulate", "teapot", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert "murkscan simulate SCENE OUT" in said
    assert "no scene teapot" in said
    assert not (tmp_path / "out").exists()


REFUSED = [
    ["scan", "nothing", "--rig", "no.toml", "--step-mm", "1", "--out", "x"],
    ["scan", ".", "--rig", "no.toml", "--step-mm", "1", "--out", "x"],
    ["scan", ".", "--rig", ".", "--out", "x"],
    ["extract", ".", "--rig", ".", "--out", "x", "--set", "birth"],
    ["calibrate", "camera", "nothing", "--board", "9x6", "--square-mm", "30", "--rig", "x"],
    ["measure", "nothing", "area"],
    ["view", "nothing"],
    ["mesh", "nothing", "--faces", "2"],
    ["report"],
    ["frobnicate"],
]


def test_a_wrong_call_is_refused_before_anything_heavy_is_loaded():
    """What makes an answer slow is imports, so these are counted; its time is a benchmark."""
    code = (
        "import sys; from murkscan.cli.main import run\n"
        f"for words in {REFUSED}:\n"
        "    status = run(words)\n"
        "    heavy = [m for m in ('numpy', 'numba', 'cv2', 'scipy') if m in sys.modules]\n"
        "    print('answered', words[:2], status, heavy)\n"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    answers = [line for line in said.stdout.splitlines() if line.startswith("answered")]
    assert answers == [f"answered {words[:2]} 2 []" for words in REFUSED]


def test_a_scan_that_begins_loads_no_statistics_and_no_plots():
    code = (
        "import sys, murkscan.survey.scan;"
        "heavy = ('scipy.stats', 'scipy.interpolate', 'scipy.ndimage', 'matplotlib', 'trimesh');"
        "print([m for m in heavy if m in sys.modules])"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.splitlines()[-1] == "[]"
