"""What a merged cloud says of its passes' places, and how far off they are."""

import numpy as np
import pytest

from murkscan.io.ply import save_cloud
from murkscan.project import Project
from murkscan.survey.merge import merge_passes
from murkscan.survey.merged_errors import trace_alignment

from ..geometry.test_alignment import sample, waves

SEEDS = 30


@pytest.fixture(scope="module")
def merged(tmp_path_factory):
    """Merge three strips in a chain, in place but for noise, which alignment takes for errors."""
    errors, sigmas, shares = [], [], []
    for seed in range(SEEDS):
        folder = tmp_path_factory.mktemp("chain")
        random = np.random.default_rng(seed)
        # Each is 0.6 m long; 0.15 m of it lies on the one before.
        strips = [sample(waves, random, aside=aside, count=5000) for aside in (0.0, 0.45, 0.9)]
        paths = [folder / f"{number}.ply" for number in range(3)]
        for path, strip in zip(paths, strips, strict=True):
            save_cloud(path, strip)
        told = merge_passes(paths, folder / "out").passes
        project = Project(folder / "out")
        cloud = project.load_cloud()
        shifts = trace_alignment(project, cloud)
        assert shifts is not None
        ends = [5000 * n + int(np.argmax(strip.points[:, 0])) for n, strip in enumerate(strips)]
        truth = [strip.points[end % 5000] for strip, end in zip(strips, ends, strict=True)]
        errors.append(cloud.points[ends] - truth)
        sigmas.append(np.linalg.norm(shifts(np.array(ends)), axis=2))
        shares.append([one.laid_on for one in told])
    return np.array(errors), np.array(sigmas), shares


def test_each_strip_of_a_chain_is_laid_on_the_one_before(merged):
    for first, second, third in merged[2]:
        assert first == ()
        assert second == (1.0,)
        assert third == pytest.approx([0.0, 1.0], abs=0.01)


@pytest.mark.parametrize("strip", [1, 2])
def test_the_stated_place_of_a_strip_s_far_end_holds_its_error(merged, strip):
    errors, sigmas = (part[:, strip] for part in merged[:2])
    # 90 coordinates, of which those of a strip hang together; without the error of the strip before
    # the third holds 81 %.
    assert np.mean(np.abs(errors) < 1.96 * sigmas) >= 0.85
    # Nor by stating too much: alignment states a fifth more than it errs here, and the root mean
    # square of 30 errors is good to 13 %.
    assert np.sqrt(np.mean(sigmas**2) / np.mean(errors**2)) < 1.2 * (1 + 2 * 0.13)


def test_the_first_strip_has_no_error(merged):
    errors, sigmas, _ = merged
    assert np.abs(errors[:, 0]).max() < 1e-9
    assert sigmas[:, 0].max() == 0
