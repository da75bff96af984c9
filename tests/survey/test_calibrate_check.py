"""A known length between two points of a real scan."""

from dataclasses import replace

import numpy as np
import pytest

import murkscan as ms
from murkscan.errors import InputError
from murkscan.survey.calibrate_check import check_in_scan
from murkscan.survey.extract import extract_recording
from murkscan.survey.motion import follow_motion
from murkscan.survey.scan import begin_scan
from murkscan.survey.triangulate import triangulate_stripes
from murkscan.triangulate import RaySheet
from murkscan.types.camera import Camera
from murkscan.types.laser import Laser
from murkscan.types.rig import Rig
from murkscan.types.rig_covariance import RigCovariance

BARE = Rig(
    Camera((640, 480), (850.4, 850.4), (328.0, 239.5)),
    (Laser.from_baseline_angle(0.0373, np.radians(65.0), "x"),),
    wavelength=640e-9,
)
FOCAL = RigCovariance(("camera.focal_length[1]",), np.array([[8.504**2]]))
"""1 % of the focal length along the stripe: so much longer or shorter are lengths along it."""


@pytest.fixture(scope="module")
def scanned(data, tmp_path_factory):
    rig = replace(BARE, covariance=FOCAL)
    recording = ms.open_recording(data("stage_stairs") / "scan")
    motion = ms.ConstantStep(0.001, "x")
    project = ms.Project(tmp_path_factory.mktemp("out"))
    begin_scan(project, recording, rig, settings={})
    extract_recording(project, recording, rig, ms.GrayGravity())
    triangulate_stripes(project, rig, RaySheet())
    follow_motion(project, motion)
    return project


def ends_of(scanned):
    """Give two points of the bed in the first frame, far apart along the stripe."""
    profile = scanned.load_profile()
    first = profile.points[profile.frame == 0]
    return first[[np.argmin(first[:, 1]), np.argmax(first[:, 1])]]


def test_a_length_along_the_stripe_is_as_unsure_as_the_focal_length(scanned):
    ends = ends_of(scanned)
    apart = np.linalg.norm(ends[1] - ends[0])
    found = check_in_scan(scanned, ends + 1e-6, apart)
    assert found.length.value == pytest.approx(apart, abs=1e-9)
    # The two ends differ in depth a little, which the focal length does not change.
    assert found.length.sigma_common == pytest.approx(0.01 * apart, rel=0.02)
    assert found.length.sigma_independent < 1e-4
    assert found.verdict.is_good


def test_a_wrong_length_is_found_out(scanned):
    ends = ends_of(scanned)
    apart = np.linalg.norm(ends[1] - ends[0])
    found = check_in_scan(scanned, ends, apart / 1.05)
    assert "too long" in str(found.verdict)
    assert check_in_scan(scanned, ends, apart / 1.05, known_sigma=0.05).verdict.is_good


def test_an_end_off_the_scan_is_refused(scanned):
    ends = ends_of(scanned)
    with pytest.raises(InputError, match=r"No point of the scan lies within 10 mm .* metres"):
        check_in_scan(scanned, ends * 1000, 0.05)


def test_a_known_length_of_zero_is_refused(scanned):
    with pytest.raises(InputError, match="above 0"):
        check_in_scan(scanned, ends_of(scanned), 0.0)
