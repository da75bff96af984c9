"""What is said of an alignment."""

import numpy as np

from murkscan.geometry.alignment import Alignment
from murkscan.geometry.alignment_words import describe_alignment
from murkscan.types.pose import Pose


def test_the_digits_show_how_well_a_shift_is_known():
    sigma = np.array([0.9e-3, 0.1e-3, 2.2e-3, 4.1e-6, 3.0e-6, 0.6e-6])
    sigma[:3] = np.radians(sigma[:3])
    pose = Pose(np.eye(3), np.array([2.1e-5, -4.3e-5, -2e-7]))
    alignment = Alignment(
        pose, np.zeros(3), np.diag(sigma**2), (), overlap=0.95, num_matches=1000, rms=2e-5
    )
    assert describe_alignment(alignment).startswith(
        "moved (0.0210, -0.0430, -0.0002) ± (0.0041, 0.0030, 0.0006) mm along x, y, z and turned "
        "(0.0000, 0.0000, 0.0000) ± (0.0009, 0.0001, 0.0022) deg about them; 95% of it overlaps"
    )
