"""Clouds that are damaged or hostile, in every format: each is refused in a sentence."""

import struct
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from murkscan.errors import FormatError
from murkscan.io.cloud_files import (
    load_cloud_file,
)

from .clouds import save, some_cloud


def sealed(page):
    """Give a page of an E57 file with its checksum, Castagnoli's (ASTM E2807, section 8.3)."""
    crc = 0xFFFFFFFF
    for byte in page:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return page + struct.pack(">I", crc ^ 0xFFFFFFFF)


@pytest.mark.parametrize("told", [b"99", b"-5"])
def test_an_e57_file_that_does_not_hold_the_points_it_declares_is_refused(tmp_path, told):
    path = tmp_path / "cloud.e57"
    save(path, some_cloud(50))
    data = path.read_bytes().replace(b'recordCount="50"', b'recordCount="' + told + b'"')
    assert data != path.read_bytes()
    path.write_bytes(b"".join(sealed(data[k : k + 1020]) for k in range(0, len(data), 1024)))
    with pytest.raises(FormatError, match=f"declares {told.decode()} points .* but holds"):
        load_cloud_file(path)


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("a.xyz", b"1 2\n3 4\n", "2 numbers where 3 are expected"),
        ("a.xyz", b"1 2 3\n1 2\n", "cannot be read as columns of numbers"),
        ("a.xyz", b"\x00\xff" * 50, "cannot be read as columns of numbers"),
        ("a.xyz", b"1 " * 9000, "a line longer than"),
        ("a.xyz", b"//x y signal\n1 2 3\n", "no columns x, y and z"),
        ("a.ply", b"ply\nformat ascii 1.0\nend_header\n", "no element vertex"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 3\nend_header\n", "no columns"),
        ("a.ply", b"plastic", "is not a PLY file"),
        ("a.las", b"LASF", "is not a LAS file"),
        ("a.laz", b"", "is not a LAS file"),
        ("a.e57", b"ASTM-E57" + bytes(40), "declares 0 bytes of XML"),
        ("a.e57", b"", "is not an E57 file"),
        ("a.las", b"LASF" + bytes(400), "declares a header"),
    ],
)  # fmt: skip
def test_a_malformed_file_is_refused_with_its_name(tmp_path, name, content, says):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(FormatError, match=says) as refusal:
        load_cloud_file(tmp_path / name)
    assert str(tmp_path / name) in str(refusal.value)
    assert "\n" not in str(refusal.value)


def _lie(data, suffix):
    """Say that a file holds 900 million points or more, wherever it says how many it holds."""
    if suffix == ".ply":
        return data.replace(b"element vertex 50", b"element vertex 900000000")
    if suffix == ".e57":
        return data.replace(b'recordCount="50"', b'recordCount="900000000"')
    lied = bytearray(data)
    lied[247:255] = struct.pack("<Q", 900_000_000)
    return bytes(lied)


@pytest.mark.parametrize("suffix", [".ply", ".las", ".laz", ".e57"])
def test_sizes_that_lie_cost_no_memory(tmp_path, suffix):
    path = tmp_path / f"cloud{suffix}"
    save(path, some_cloud(50))
    lied = _lie(path.read_bytes(), suffix)
    assert lied != path.read_bytes()
    path.write_bytes(lied)
    code = (
        "import sys; from pathlib import Path\n"
        "sys.path.insert(0, sys.argv[2])\n"
        "from tests.memory import peak_kib\n"
        "from murkscan.errors import FormatError\n"
        "from murkscan.io.cloud_files import load_cloud_file\n"
        "before = peak_kib()\n"
        "try: load_cloud_file(Path(sys.argv[1])); print('read')\n"
        "except FormatError as error: print(error)\n"
        "print(peak_kib() - before)\n"
    )
    command = [sys.executable, "-c", code, str(path), str(Path(__file__).parents[2])]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines()
    assert str(path) in said[0]
    # Buffers of one block, half a million rows of about 100 bytes, may be there: 50 MB, twice.
    assert int(said[1]) < 200_000


@pytest.mark.parametrize("suffix", [".ply", ".xyz", ".las", ".e57"])
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_no_bytes_are_a_fault_of_ours(tmp_path, suffix, data):
    path = tmp_path / f"cloud{suffix}"
    save(path, some_cloud(20))
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 6))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(bytes(content[: data.draw(st.integers(0, len(content)))]))
    try:
        load_cloud_file(path)
    except FormatError as refusal:
        assert str(path) in str(refusal)  # noqa: PT017  both outcomes are right


@pytest.mark.parametrize(
    ("name", "says"),
    [("entities.e57", "has a document type"), ("point_size_zero.las", "it is damaged")],
)
def test_files_that_users_were_sent_are_refused_in_one_sentence(fault, name, says):
    path = fault(f"clouds/{name}")
    with pytest.raises(FormatError, match=says) as refusal:
        load_cloud_file(path)
    assert str(path) in str(refusal.value)


XML = {
    "a document type": (b"<e57Root ", b"<!DOCTYPE e [<!ENTITY a SYSTEM 'file:///etc/hostname'>]>"),
    "a document type in capitals": (b"<e57Root ", b"<!doctype e>"),
    "a schema": (b' type="Structure"', b' x:schemaLocation="http://127.0.0.1/"'),
    "another encoding": (b'encoding="UTF-8"', b'encoding="UTF-7"'),
}


@pytest.mark.parametrize("kind", XML)
def test_an_e57_file_that_makes_a_parser_read_more_is_refused(tmp_path, kind):
    path = tmp_path / "cloud.e57"
    write_e57_xml(path, *XML[kind])
    with pytest.raises(FormatError, match=r"is refused: its XML|is no text in UTF-8"):
        load_cloud_file(path)


def test_an_e57_file_with_a_node_of_the_wrong_kind_is_refused(tmp_path):
    path = tmp_path / "cloud.e57"
    write_e57_xml(path, b'<points type="CompressedVector"', b'<points type="String"', replace=True)
    with pytest.raises(FormatError, match="cannot be read as E57"):
        load_cloud_file(path)


def write_e57_xml(path, where, what, *, replace=False):
    """Write a small E57 file whose XML is changed, with checksums that fit: pages of 1024."""
    save(path, some_cloud(20))
    data = path.read_bytes()
    place, length = struct.unpack_from("<QQ", data, 24)
    stripped = b"".join(data[k : k + 1020] for k in range(0, len(data), 1024))
    start = place // 1024 * 1020 + place % 1024
    xml = stripped[start : start + length]
    assert where in xml
    changed = what if replace or b"encoding" in what else where + what
    changed = what + where if what.startswith(b"<!") else changed
    xml = xml.replace(where, changed, 1)
    body = bytearray(stripped[:start] + xml)
    body += bytes(-len(body) % 1020)
    struct.pack_into("<QQQ", body, 16, len(body) // 1020 * 1024, place, len(xml))
    pages = (bytes(body[k : k + 1020]) for k in range(0, len(body), 1020))
    path.write_bytes(b"".join(map(sealed, pages)))
