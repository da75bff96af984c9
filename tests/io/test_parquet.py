"""Tables of stripes and profiles, and files that appear whole."""

from dataclasses import fields

import numpy as np
import pyarrow.parquet as pq
import pytest

from murkscan.errors import DeviceError, FormatError
from murkscan.io.atomic import replacing
from murkscan.io.parquet import load_profile, load_stripe, save_profile, save_stripe
from murkscan.types.profile import Profile
from murkscan.types.stripe import Stripe


def _fill(kind, n):
    rng = np.random.default_rng(n)
    empty = Stripe.empty() if kind is Stripe else Profile.empty()
    columns = (getattr(empty, field.name) for field in fields(kind))
    return kind(
        *((rng.random((n, *column.shape[1:])) * 200).astype(column.dtype) for column in columns)
    )


@pytest.mark.parametrize("n", [0, 1, 1000])
@pytest.mark.parametrize(
    ("kind", "save", "load"),
    [(Stripe, save_stripe, load_stripe), (Profile, save_profile, load_profile)],
)
def test_a_table_there_and_back_is_the_same_to_the_last_bit(tmp_path, kind, save, load, n):
    value = _fill(kind, n)
    save(tmp_path / "part.parquet", value)
    again = load(tmp_path / "part.parquet")
    for field in fields(kind):
        before, after = getattr(value, field.name), getattr(again, field.name)
        assert before.dtype == after.dtype
        np.testing.assert_array_equal(before, after)


def test_the_columns_are_those_of_the_contract(tmp_path):
    save_stripe(tmp_path / "s.parquet", _fill(Stripe, 3))
    save_profile(tmp_path / "p.parquet", _fill(Profile, 3))
    stripe = pq.read_schema(tmp_path / "s.parquet")
    assert {name: str(stripe.field(name).type) for name in stripe.names} == {
        "frame": "uint32", "time_s": "double", "u": "double", "v": "double", "sigma": "float",
        "signal": "float", "posterior": "float", "laser": "uint8", "branch": "uint8",
        "blur_shift_px": "float", "width_px": "float",
    }  # fmt: skip
    profile = pq.read_schema(tmp_path / "p.parquet")
    assert profile.names == [
        "frame", "time_s", "laser", "u", "v", "x_m", "y_m", "z_m", "sigma_m", "signal", "posterior",
        "branch", "blur_shift_m", "width_px",
    ]  # fmt: skip


def test_a_broken_table_is_named(tmp_path):
    path = tmp_path / "part.parquet"
    path.write_bytes(b"PAR1 nonsense")
    with pytest.raises(FormatError, match=r"part\.parquet"):
        load_stripe(path)


def test_a_table_without_a_column_is_named(tmp_path):
    path = tmp_path / "part.parquet"
    save_profile(path, _fill(Profile, 3))
    with pytest.raises(FormatError, match="no column sigma"):
        load_stripe(path)


def test_a_file_that_fails_half_way_leaves_what_was_there(tmp_path):
    path = tmp_path / "result.txt"
    path.write_text("the old one")
    with pytest.raises(KeyboardInterrupt), replacing(path) as aside:
        aside.write_text("half of the new")
        raise KeyboardInterrupt
    assert path.read_text() == "the old one"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_that_is_a_file_is_told_with_its_name(tmp_path):
    (tmp_path / "out").write_text("in the way")
    with (
        pytest.raises(DeviceError, match=r"Cannot write .*result\.txt"),
        replacing(tmp_path / "out" / "result.txt"),
    ):
        pass
