"""Small files of a scan, whatever has become of them."""

import json

import pytest

from murkscan.errors import FormatError
from murkscan.io.json_files import load_json
from murkscan.project import Project

from ..projects import SCAN


@pytest.mark.parametrize("text", ["", "[]", "null", "[" * 100_000, '{"a":' * 100_000, "\x00\xff"])
def test_what_is_no_dictionary_is_refused_with_its_name(tmp_path, text):
    (tmp_path / "a.json").write_text(text, "latin-1")
    with pytest.raises(FormatError, match=r"a\.json .*delete it and run again"):
        load_json(tmp_path / "a.json")


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("recording", []),
        ("recording", "lost"),
        ("rig", None),
        ("versions", "lost"),
        ("started", "2026-77-01T00:00:00"),
        ("format", True),
    ],
)
def test_a_scan_whose_record_was_damaged_names_what_is_odd(tmp_path, key, value):
    project = Project(tmp_path)
    project.save_scan(SCAN)
    assert project.load_scan() == SCAN
    content = json.loads((tmp_path / "scan.json").read_text()) | {key: value}
    (tmp_path / "scan.json").write_text(json.dumps(content))
    with pytest.raises(FormatError, match=r"scan\.json is damaged: it has .* Delete it and run"):
        project.load_scan()
    del content[key]
    (tmp_path / "scan.json").write_text(json.dumps(content))
    if key in ("recording", "rig", "versions"):
        with pytest.raises(FormatError, match=rf"scan\.json is damaged: it has no {key}"):
            project.load_scan()
