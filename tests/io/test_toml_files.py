"""What is said of TOML that is none."""

import pytest

from murkscan.errors import FormatError
from murkscan.io.rig_toml import load_rig
from murkscan.io.toml_files import parse_toml


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("a = 1\na = 2\n", "line 2: the key a stands twice"),
        ("a = 1\na = 2", "line 2: the key a stands twice"),
        ("[a]\nb = 1\n[a]\n", r"line 3: the key \[a\] stands twice"),
        ("a.b = 1\na = 2\n", "line 2: the key a stands twice"),
        ("a = \n", "is not a TOML file"),
        ("x = " + "[" * 5000, "is not a TOML file"),
        ("day = 1979-77-01\n", "is not a TOML file"),
    ],
)
def test_the_file_and_what_is_wrong_are_named(text, says):
    with pytest.raises(FormatError, match=says) as refusal:
        parse_toml(text, "rig.toml")
    assert str(refusal.value).startswith("rig.toml")
    assert "\n" not in str(refusal.value)


def test_a_rig_with_a_key_twice_names_the_key_and_the_line(fault):
    with pytest.raises(FormatError, match="line 12: the key kind stands twice"):
        load_rig(fault("rig/duplicate_key.toml"))
