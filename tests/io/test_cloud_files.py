"""Clouds in every format: what comes back, what others wrote, what is refused."""

import resource
import struct
import subprocess
import sys
import warnings
from pathlib import Path

import laspy
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from murkscan.errors import DeviceError, FormatError, InputError
from murkscan.io.cloud_files import (
    CLOUD_SUFFIXES,
    iterate_cloud_file,
    load_cloud_file,
    writing_cloud_file,
)
from murkscan.types.cloud import PointCloud

SCALARS = ("signal", "posterior", "sigma", "sigma_common", "frame", "scan_line", "laser", "branch")


def some_cloud(count=1000, seed=0):
    random = np.random.default_rng(seed)
    normals = random.normal(size=(count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return PointCloud(
        random.normal([100, -20, 3], size=(count, 3)),
        normals.astype(np.float32),
        *(random.random(count).astype(np.float32) * scale for scale in (250, 1, 3e-4, 2e-4)),
        random.integers(0, 100_000, count).astype(np.int32),
        random.integers(0, 2000, count).astype(np.int32),
        *random.integers(0, 3, (2, count)).astype(np.uint8),
    )


def save(path, *clouds):
    with writing_cloud_file(path) as write:
        for cloud in clouds:
            write(cloud)


@pytest.mark.parametrize("suffix", CLOUD_SUFFIXES)
def test_every_column_that_a_format_has_comes_back(tmp_path, suffix):
    first, second = some_cloud(1000, 0), some_cloud(700, 1)
    save(tmp_path / f"cloud{suffix}", first, second)
    back = load_cloud_file(tmp_path / f"cloud{suffix}")
    whole = PointCloud.concatenate([first, second])
    # Text and LAS have steps: a rounded number is off by half of one, and by 1e-3 of it at most in
    # the product; in single precision a normal of 1e-6 has 1e-7 more.
    step = {".las": 1e-5, ".laz": 1e-5, ".xyz": 1e-7}.get(suffix, 0)
    np.testing.assert_allclose(back.points, whole.points, rtol=0, atol=step / 2 * 1.001)
    off = 6e-7 if suffix == ".xyz" else 0
    np.testing.assert_allclose(back.normals, whole.normals, rtol=0, atol=off, strict=True)
    for name in SCALARS if suffix != ".xyz" else ():
        np.testing.assert_array_equal(getattr(back, name), getattr(whole, name), strict=True)


@pytest.mark.parametrize("suffix", CLOUD_SUFFIXES)
@pytest.mark.parametrize("block", [1, 7, 64])
def test_a_file_read_in_blocks_is_the_whole_file(tmp_path, suffix, block):
    path = tmp_path / f"cloud{suffix}"
    save(path, some_cloud(64))
    blocks = list(iterate_cloud_file(path, block=block))
    assert max(map(len, blocks)) <= block
    np.testing.assert_array_equal(
        PointCloud.concatenate(blocks).points, load_cloud_file(path).points
    )


@pytest.mark.parametrize("suffix", CLOUD_SUFFIXES)
def test_a_cloud_without_points_comes_back(tmp_path, suffix):
    save(tmp_path / f"cloud{suffix}")
    assert len(load_cloud_file(tmp_path / f"cloud{suffix}")) == 0


@pytest.mark.parametrize("suffix", CLOUD_SUFFIXES)
def test_a_failed_export_leaves_nothing(tmp_path, suffix):
    def fail():
        with writing_cloud_file(tmp_path / f"cloud{suffix}") as write:
            write(some_cloud(10))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("suffix", [".las", ".laz"])
def test_what_las_cannot_hold_is_refused(tmp_path, suffix):
    far, broken = some_cloud(10), some_cloud(10)
    far.points[3] += 1e6
    broken.points[3] = np.nan
    with pytest.raises(InputError, match="steps"):
        save(tmp_path / f"cloud{suffix}", some_cloud(10), far)
    with pytest.raises(InputError, match="1 points that are not finite"):
        save(tmp_path / f"cloud{suffix}", broken)
    assert list(tmp_path.iterdir()) == []


def test_another_suffix_is_refused_with_those_that_there_are(tmp_path):
    with pytest.raises(InputError, match=r"cloud\.pcd .* \.ply, \.las, \.laz, \.e57, \.xyz, \.csv"):
        load_cloud_file(tmp_path / "cloud.pcd")


HEADERS = {
    "text": "format ascii 1.0",
    "big": "format binary_big_endian 1.0",
    "little": "format binary_little_endian 1.0",
}


@pytest.mark.parametrize("kind", HEADERS)
def test_a_ply_file_of_another_program_is_read(tmp_path, kind):
    """With single precision, colours, MeshLab's and CloudCompare's names, and faces behind."""
    header = (
        f"ply\n{HEADERS[kind]}\ncomment by others\nelement vertex 2\nproperty float x\n"
        "property float y\nproperty float z\nproperty uchar red\nproperty float scalar_sigma\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = [(1.5, 2.5, -3.25, 7, 0.125), (4.0, 5.0, 6.0, 8, 0.25)]
    order = ">" if kind == "big" else "<"
    body = (
        "".join(" ".join(map(str, row)) + "\n" for row in rows).encode() + b"3 0 1 0\n"
        if kind == "text"
        else b"".join(struct.pack(order + "fffBf", *row) for row in rows) + b"\x03" + bytes(12)
    )
    (tmp_path / "other.ply").write_bytes(header.encode() + body)
    cloud = load_cloud_file(tmp_path / "other.ply")
    np.testing.assert_array_equal(cloud.points, [[1.5, 2.5, -3.25], [4, 5, 6]])
    np.testing.assert_array_equal(cloud.sigma, np.float32([0.125, 0.25]))
    # What the file does not say: no normals, certain, of no frame.
    assert not cloud.normals.any()
    assert cloud.posterior.tolist() == [1, 1]


@pytest.mark.parametrize(
    ("text", "points", "normals"),
    [
        ("1 2 3\n4 5 6\n", [[1, 2, 3], [4, 5, 6]], 0),
        ("1,2,3\n4,5,6", [[1, 2, 3], [4, 5, 6]], 0),
        ("# made by hand\n1\t2  3\n\n4 5 6\n", [[1, 2, 3], [4, 5, 6]], 0),
        ("x,y,z,nx,ny,nz,sigma\n1,2,3,0,0,1,0.5\n", [[1, 2, 3]], 1),
        ("1 2 3 0 0 1\n", [[1, 2, 3]], 1),
        ("1 2 3 255 128 0\n", [[1, 2, 3]], 0),
        ("//Z Y X\n3 2 1\n", [[1, 2, 3]], 0),
        ("\ufeffx,y,z\n1,2,3\n", [[1, 2, 3]], 0),
        ("# by hand\n# in metres\n1 2 3\n", [[1, 2, 3]], 0),
    ],
)
def test_text_of_another_program_is_read(tmp_path, text, points, normals):
    (tmp_path / "other.xyz").write_text(text, "utf-8")
    cloud = load_cloud_file(tmp_path / "other.xyz")
    np.testing.assert_array_equal(cloud.points, points)
    assert np.linalg.norm(cloud.normals, axis=1).sum() == normals


def test_text_of_nothing_but_remarks_has_no_points(tmp_path):
    (tmp_path / "a.xyz").write_text("# a\n# b\n// c\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(load_cloud_file(tmp_path / "a.xyz")) == 0


@pytest.mark.parametrize("name", ["A.LAZ", "a.laz"])
def test_laz_is_packed_however_it_is_spelt(tmp_path, name):
    save(tmp_path / name, some_cloud())
    save(tmp_path / "a.las", some_cloud())
    assert (tmp_path / name).stat().st_size < 0.9 * (tmp_path / "a.las").stat().st_size


def _wide(path, rows):
    """Write points with 900 other columns, 7.2 kB each."""
    if path.suffix in (".las", ".laz"):
        header = laspy.LasHeader(point_format=6, version="1.4")
        header.add_extra_dims([laspy.ExtraBytesParams(f"e{k}", "3f8") for k in range(300)])
        laspy.LasData(header, laspy.ScaleAwarePointRecord.zeros(rows, header=header)).write(path)
        return
    if path.suffix == ".xyz":
        path.write_text(("1 2 3 " + "0 " * 900 + "\n") * rows)
        return
    names = ["x", "y", "z", *(f"c{k}" for k in range(900))]
    kind = "ascii" if path.stem == "text" else "binary_little_endian"
    columns = "".join(f"property double {name}\n" for name in names)
    header = f"ply\nformat {kind} 1.0\nelement vertex {rows}\n{columns}end_header\n"
    row = b"0 " * 903 + b"\n" if kind == "ascii" else bytes(8 * 903)
    path.write_bytes(header.encode() + row * rows)


@pytest.mark.parametrize("name", ["wide.laz", "wide.las", "wide.ply", "text.ply", "wide.xyz"])
def test_points_of_many_columns_come_in_blocks_that_are_as_large_in_memory(tmp_path, name):
    _wide(tmp_path / name, 6000)
    blocks = [len(block) for block in iterate_cloud_file(tmp_path / name)]
    assert sum(blocks) == 6000
    # A block of ours is 500,000 points of 61 bytes: 31 MB.
    assert 2000 < max(blocks) <= 36e6 / 7200


def _sealed(page):
    """Give a page of an E57 file with its checksum, CRC-32C."""
    check = 0xFFFFFFFF
    for byte in page[:1020]:
        check ^= byte
        for _ in range(8):
            check = check >> 1 ^ (0x82F63B78 if check & 1 else 0)
    return page[:1020] + struct.pack(">I", check ^ 0xFFFFFFFF)


@pytest.mark.parametrize("told", [b"99", b"-5"])
def test_an_e57_file_that_does_not_hold_the_points_it_declares_is_refused(tmp_path, told):
    path = tmp_path / "cloud.e57"
    save(path, some_cloud(50))
    data = path.read_bytes().replace(b'recordCount="50"', b'recordCount="' + told + b'"')
    assert data != path.read_bytes()
    path.write_bytes(b"".join(_sealed(data[k : k + 1024]) for k in range(0, len(data), 1024)))
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


IMPOSSIBLE = [
    *(("points", value) for value in (np.nan, np.inf, 1e300, -1e12)),
    *(("normals", value) for value in (np.nan, -np.inf)),
    *((column, value) for column in ("sigma", "sigma_common") for value in (np.nan, -1e-6)),
]


@pytest.mark.parametrize(("column", "value"), IMPOSSIBLE)
def test_points_that_cannot_be_are_left_out_with_a_word(tmp_path, column, value):
    cloud = some_cloud(10)
    getattr(cloud, column)[3] = value
    save(tmp_path / "cloud.ply", cloud)
    with pytest.warns(UserWarning, match=r"cloud.ply: 1 of 10 points were left out"):
        back = load_cloud_file(tmp_path / "cloud.ply")
    np.testing.assert_array_equal(back.frame, np.delete(cloud.frame, 3))


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
    path.write_bytes(b"".join(page + struct.pack(">I", crc32c(page)) for page in pages))


def crc32c(data):
    """Castagnoli's checksum, as E57 has it (ASTM E2807, section 8.3)."""
    crc = 0xFFFFFFFF
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x82F63B78 if crc & 1 else 0)
    return crc ^ 0xFFFFFFFF


@pytest.mark.skipif(sys.platform != "linux", reason="file-size limits are POSIX")
@pytest.mark.parametrize("suffix", CLOUD_SUFFIXES)
def test_a_full_disk_is_one_sentence_and_leaves_what_stood_there(tmp_path, suffix):
    """A limit on the size of files stands for the disk."""
    path = tmp_path / f"cloud{suffix}"
    save(path, some_cloud(100))
    before = path.read_bytes()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 17, hard))
    try:
        with pytest.raises(DeviceError, match=f"Cannot write .*cloud{suffix}"):
            save(path, some_cloud(100_000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert path.read_bytes() == before
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize(
    ("name", "head", "form", "comma"),
    [
        ("count.xyz", "3\n", "{} {} {}", "."),
        ("cloudcompare.xyz", "//X Y Z Original cloud index\n3\n", "{} {} {} 7", "."),
        ("names.csv", "Coord. X,Coord. Y,Coord. Z,Scalar field\n", "{},{},{},7", "."),
        ("cloudcompare.txt", "//X Y Z\n3\n", "{} {} {}", "."),
        ("scanner.pts", "3\n", "{} {} {} -1203 90 88 81", "."),
        ("german.asc", "Punkt Nr.;X;Y;Z\n", "7;{};{};{}", ","),
        ("german.csv", "X;Y;Z\n", "{};{};{}", ","),
        ("german.xyz", "", "{} {} {}", ","),
        ("german_tabs.xyz", "x\ty\tz\n", "{}\t{}\t{}", ","),
    ],
)
def test_text_of_other_programs_is_read_as_they_write_it(tmp_path, name, head, form, comma):
    points = np.array([[0.5, -1.25, 2.0], [1.5, 0.25, 3.5], [10.0, 1e-3, -0.75]])
    lines = [form.format(*(repr(x).replace(".", comma) for x in row)) for row in points.tolist()]
    (tmp_path / name).write_text(head + "\n".join(lines) + "\n", "utf-8")
    np.testing.assert_array_equal(load_cloud_file(tmp_path / name).points, points)
