"""Clouds in every format: what comes back, and what others wrote."""

import resource
import struct
import sys
import warnings

import laspy
import numpy as np
import pytest

from murkscan.errors import DeviceError, InputError
from murkscan.io.cloud_files import (
    CLOUD_SUFFIXES,
    iterate_cloud_file,
    load_cloud_file,
    writing_cloud_file,
)
from murkscan.types.cloud import PointCloud

from .clouds import save, some_cloud

SCALARS = ("signal", "posterior", "sigma", "sigma_common", "frame", "scan_line", "laser", "branch")


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
