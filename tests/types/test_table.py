"""Columns that come in another type, and values that fit into a line."""

from dataclasses import MISSING, field, fields, make_dataclass

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.types.cloud import PointCloud
from murkscan.types.profile import Profile
from murkscan.types.stripe import Stripe
from murkscan.types.table import Table
from murkscan.types.true_stripe import TrueStripe

from ..scans import plane, scan, scan_cloud
from ..scenes import air_rig


def _as_declared(column):
    """Give a column's name and type, and what stands for it where it may be left out."""
    if column.default_factory is MISSING:
        return column.name, column.type
    default = field(default_factory=column.default_factory, metadata=column.metadata)
    return column.name, column.type, default


BARE = make_dataclass(
    "Stripe",
    [_as_declared(column) for column in fields(Stripe)],
    bases=(Table,),
    frozen=True,
    eq=False,
    repr=False,
)
"""As a user makes one: the tests' own check of types refuses what a stripe is to coerce."""
COLUMNS = {
    "frame": [0, 0, 7],
    "time": [0, 0, 1],
    "pixels": [[1, 2], [3, 4], [5, 6]],
    "sigma": [0.1, 0.2, 0.3],
    "signal": [5, 6, 7],
    "posterior": np.ones(3),
    "laser": np.zeros(3),
    "branch": [False, True, False],
}


def test_columns_are_made_to_be_of_their_type():
    stripe = BARE(**COLUMNS)
    for name, column in vars(Stripe.empty()).items():
        made = getattr(stripe, name)
        assert (made.dtype, made.shape[1:]) == (column.dtype, column.shape[1:])
        np.testing.assert_allclose(made, COLUMNS.get(name, np.zeros(3)), rtol=1e-7)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        ({"frame": [-1, 0, 1]}, "frame must be of the type uint32, which its int64 do not fit"),
        ({"laser": [0, 300, 0]}, "laser must be of the type uint8"),
        ({"branch": [0.5, 0, 0]}, "branch must be of the type uint8"),
        ({"time": ["a", "b", "c"]}, "time must be of the type float64"),
        ({"pixels": np.zeros((2, 3))}, r"pixels must be an array of n × 2, got one of \(2, 3\)"),
        ({"sigma": 0.1}, r"sigma must be an array of n, got one of \(\)"),
        ({"signal": [1.0]}, "signal has 1 rows beside others with 3"),
    ],
)
def test_columns_that_are_none_are_refused_where_the_stripe_is_made(wrong, says):
    with pytest.raises(InputError, match=f"Stripe: {says}"):
        BARE(**COLUMNS | wrong)


@pytest.mark.parametrize("kind", [Stripe, Profile, PointCloud, TrueStripe])
def test_none_together_are_an_empty_one(kind):
    assert len(kind.concatenate([])) == 0


def test_a_value_is_printed_in_a_line():
    profile, trajectory = scan(plane, spacing=0.01, num_rows=20)
    cloud = scan_cloud(plane, spacing=0.01, num_rows=20)
    for value in (profile, trajectory, cloud, air_rig(), BARE(**COLUMNS), air_rig().camera):
        said = str(value)
        assert said.startswith(type(value).__name__)
        assert len(said) < 100
        assert "\n" not in said
    assert str(cloud).startswith("PointCloud(240 rows of points, normals, signal")
    assert str(trajectory) == "Trajectory(times=[0, 0.48], positions=2×3, quaternions=2×4)"
