"""The demo: what it says of the model by murk and of the one by the paper."""

from dataclasses import replace

import numpy as np

from murkscan.simulate import parse_scene
from murkscan.survey.demo import Errors, run_demo


def test_the_demo_s_model_lies_on_the_true_hull_where_the_paper_s_does_not(tmp_path, monkeypatch):
    """The first quarter of the demo's recording stands for the whole."""

    def parse_quarter(*source):
        scene = parse_scene(*source)
        return replace(scene, times=scene.times[: len(scene.times) // 4])

    monkeypatch.setattr("murkscan.survey.demo.parse_scene", parse_quarter)
    ours, paper = run_demo(tmp_path)
    assert ours.errors.count > 6_000
    # A pixel is 2.5 mm of depth there, and the rows of a field lie two pixels apart.
    assert ours.errors.rms < 0.5e-3
    assert ours.errors.false < 0.005 * ours.errors.count
    # Most of what the threshold takes for the stripe is taken out of its cloud as outliers.
    assert paper.errors.false > 0.01 * paper.errors.count
    assert paper.errors.rms > 3 * ours.errors.rms
    assert "the paper" in (tmp_path / "index.html").read_text("utf-8")


def test_no_points_have_no_errors():
    assert Errors.from_distances(np.zeros(0)).count == 0
