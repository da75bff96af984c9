"""murkscan accept, from the file to the page."""

import json
import re

import numpy as np
import pytest

from murkscan.cli.main import run
from murkscan.io.ply import save_cloud
from murkscan.types.cloud import PointCloud

from .. import scans

TEST = """
format = 1
name = "Bar 7"
certificate = "of <today>"
[[ball]]
name = "A"
near_m = [0.0, 0.0, 0.455]
diameter_mm = 100.0
diameter_sigma_mm = 0.002
[[ball]]
name = "B"
near_m = [0.3, 0.0, 0.455]
diameter_mm = 100.0
[[bar]]
balls = ["A", "B"]
length_mm = 300.0
[[plate]]
name = "plate"
near_m = [1.0, 0.0, 0.8]
within_mm = 50.0
[limits]
probing_size_mm = 0.3
probing_form_mm = 1.0
sphere_spacing_mm = 0.001
"""


@pytest.fixture(scope="module")
def scanned(tmp_path_factory):
    """Give a cloud of another program as a folder: two balls of a bar, and a plate."""
    from dataclasses import replace

    folder = tmp_path_factory.mktemp("bar")
    ball, plate = (
        scans.scan_cloud(shape, spacing=3e-3, noise=1e-4) for shape in (scans.sphere, scans.plane)
    )
    ball = ball[np.hypot(*ball.points[:, :2].T) < 0.04]
    frames = (0, 2000, 4000)
    parts = [
        replace(part, points=part.points + shift, frame=part.frame + np.int32(frame))
        for part, shift, frame in zip(
            (ball, ball, plate), ([0, 0, 0], [0.3, 0, 0], [1.0, 0, 0.3]), frames, strict=True
        )
    ]
    save_cloud(folder / "cloud.ply", PointCloud.concatenate(parts))
    assert run(["merge", str(folder / "cloud.ply"), "--out", str(folder / "out")]) == 0
    return folder / "out"


def accept(scanned, tmp_path, *, old="", new="") -> int:
    assert old in TEST
    (tmp_path / "acceptance.toml").write_text(TEST.replace(old, new, 1), "utf-8")
    return run(["accept", str(scanned), "--test", str(tmp_path / "acceptance.toml")])


def test_a_bar_is_decided_on_a_page_to_sign_and_in_numbers(scanned, tmp_path, capsys):
    assert accept(scanned, tmp_path) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "Undecided: 1 of 5 errors" in said
    assert "Sphere spacing of balls A and B:" in said
    found = json.loads((scanned / "accept" / "accept.json").read_text("utf-8"))
    assert found["decision"] == "undecided"
    decided = {(one["what"], one["artefact"]): one["decision"] for one in found["results"]}
    assert decided["probing size", "ball A"] == "passed"
    assert decided["flatness", "plate plate"] == "no limit stated"
    spacing = next(one for one in found["results"] if one["what"] == "sphere spacing")
    low, high = spacing["error_interval_95_m"]
    assert low < 0 < high
    page = (scanned / "accept" / "index.html").read_text("utf-8")
    assert "of &lt;today&gt;" in page
    for word in ("tested by", "for the client", "place and date", "sphere spacing", "undecided"):
        assert word in page
    assert not re.search(r"(src|href)=.https?:", page)


def test_it_belongs_to_the_folder(scanned, tmp_path, capsys):
    assert accept(scanned, tmp_path) == 0
    capsys.readouterr()
    assert run(["check", str(scanned)]) == 0
    assert re.search(r"accept +2 files as they were written", capsys.readouterr().out)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("0.3, 0.0, 0.455", "0.6, 0.0, 0.455", "ball B: no ball of 100 mm lies near 0.6,0,0.455"),
        ("[1.0, 0.0, 0.8]", "[2.0, 0.0, 0.8]", "plate plate: it shows 0 points"),
        ("diameter_mm = 100.0", "diameter_mm = 140.0", "ball A: what lies near"),
        ('balls = ["A", "B"]', 'balls = ["A", "Z"]', "names 'Z'"),
    ],
)
def test_what_is_not_there_is_one_sentence_that_names_it(scanned, tmp_path, capfd, old, new, says):
    before = sorted((scanned / "accept").glob("*"))
    assert accept(scanned, tmp_path, old=old, new=new) == 2
    said = capfd.readouterr().err
    assert f"{tmp_path / 'acceptance.toml'}: " in said
    assert says in said
    assert said.count("\n") == 1
    assert sorted((scanned / "accept").glob("*")) == before
