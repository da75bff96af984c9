"""Passes that lie far from one another are merged from about where they are said to be."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.cli.main import run
from murkscan.project import Project

from ..scans import scan_cloud


def bumpy(x, y):
    return 0.5 + 0.01 * np.sin(60 * x) * np.cos(45 * y) + 0.006 * np.sin(35 * (x + 2 * y))


@pytest.fixture(scope="module")
def apart(tmp_path_factory):
    """Give one surface, and the same turned by a right angle and six metres away, as files."""
    folder = tmp_path_factory.mktemp("apart")
    points = scan_cloud(bumpy, spacing=4e-3).points
    turn = Rotation.from_euler("z", 90, degrees=True)
    first, second = points + np.array([6.0, 0.5, 0.2]), turn.inv().apply(points)
    for name, places in (("first", first), ("second", second)):
        np.savetxt(folder / f"{name}.xyz", places, "%.7f")
    return first, [str(folder / f"{name}.xyz") for name in ("first", "second")], folder


def quaternion(degrees):
    half = np.radians(degrees) / 2
    return f"{np.cos(half):.6f},0,0,{np.sin(half):.6f}"


def test_a_pass_far_away_is_laid_on_from_its_start(apart):
    points, files, folder = apart
    out = str(folder / "out")
    start = f"6.004,0.497,0.203,{quaternion(91)}"
    assert run(["merge", *files, "--out", out, "--start", start]) == 0
    found = Project(folder / "out").load_cloud().points
    second = found[len(points) :]
    # The surfaces are the same points; the start is 5 mm and a degree off.
    assert np.linalg.norm(second - points, axis=1).max() < 2e-4
    assert np.linalg.norm(found[: len(points)] - points, axis=1).max() < 2e-7  # seven digits


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--start", "0,0,0", "--start", "0,0,0"), "2 starts for 2 passes"),
        (("--start", "6,0"), "neither X,Y,Z"),
        (("--start", "6,0,0", "--as-logged"), "aligns nothing"),
    ],
)
def test_a_start_that_is_none_is_one_sentence(apart, capsys, words, said):
    _, files, folder = apart
    assert run(["merge", *files, "--out", str(folder / "bad"), *words]) == 2
    text = capsys.readouterr().err
    assert said in text
    assert text.splitlines()[-1].startswith("murkscan: ")
