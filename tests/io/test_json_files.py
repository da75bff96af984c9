"""Small files of a scan, whatever has become of them."""

import pytest

from murkscan.errors import FormatError
from murkscan.io.json_files import load_json
from murkscan.project import Project


@pytest.mark.parametrize("text", ["", "[]", "null", "[" * 100_000, '{"a":' * 100_000, "\x00\xff"])
def test_what_is_no_dictionary_is_refused_with_its_name(tmp_path, text):
    (tmp_path / "a.json").write_text(text, "latin-1")
    with pytest.raises(FormatError, match=r"a\.json .*delete it and run again"):
        load_json(tmp_path / "a.json")


@pytest.mark.parametrize("key", ["recording", "rig", "versions"])
@pytest.mark.parametrize("value", [None, [], "lost"])
def test_a_scan_whose_record_was_damaged_names_what_is_lost(tmp_path, key, value):
    record = {"recording": {}, "rig": {}, "versions": {}}
    Project(tmp_path).save_scan(record)
    assert Project(tmp_path).load_scan() == record
    Project(tmp_path).save_scan(record | {key: value})
    with pytest.raises(FormatError, match=rf"scan\.json has lost its key {key}"):
        Project(tmp_path).load_scan()
