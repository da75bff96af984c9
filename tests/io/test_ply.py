import resource
import sys

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from murkscan.errors import DeviceError, FormatError
from murkscan.io.ply import load_cloud, save_cloud
from murkscan.types.cloud import PointCloud

CONTRACT = [
    *("double x", "double y", "double z", "float nx", "float ny", "float nz", "float signal"),
    *("float posterior", "float sigma", "float sigma_common", "int frame"),
    *("int scan_line", "uchar laser", "uchar branch", "float reflectance"),
]


@st.composite
def clouds(draw):
    n = draw(st.integers(0, 20))

    def column(dtype, shape=(n,)):
        return draw(hnp.arrays(dtype, shape))

    return PointCloud(
        column(np.float64, (n, 3)),
        column(np.float32, (n, 3)),
        *(column(np.float32) for _ in range(4)),
        column(np.int32),
        column(np.int32),
        column(np.uint8),
        column(np.uint8),
    )


def some_cloud(n=50):
    ones = np.ones(n, np.float32)
    points = np.random.default_rng(0).normal(size=(n, 3))
    frame = np.repeat(np.arange(n // 10, dtype=np.int32), 10)
    normals = np.tile(np.float32([0, 0, -1]), (n, 1))
    line = np.tile(np.arange(10, dtype=np.int32), n // 10)
    return PointCloud(points, normals, *[ones] * 4, frame, line, *np.zeros((2, n), np.uint8))


@given(clouds())
def test_a_cloud_comes_back_as_it_was(tmp_path_factory, cloud):
    path = tmp_path_factory.mktemp("ply") / "cloud.ply"
    save_cloud(path, cloud)
    back = load_cloud(path)
    for name in cloud.__dataclass_fields__:
        np.testing.assert_array_equal(getattr(back, name), getattr(cloud, name), strict=True)


def test_the_columns_are_the_contracts(tmp_path):
    save_cloud(tmp_path / "cloud.ply", some_cloud())
    header = (tmp_path / "cloud.ply").read_bytes().split(b"end_header")[0].decode().splitlines()
    assert header[1] == "format binary_little_endian 1.0"
    assert [line[9:] for line in header if line.startswith("property")] == CONTRACT


def test_another_reader_sees_the_same_points(tmp_path):
    cloud = some_cloud()
    save_cloud(tmp_path / "cloud.ply", cloud)
    np.testing.assert_array_equal(trimesh.load(tmp_path / "cloud.ply").vertices, cloud.points)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (b"ply\n", b"plx\n", "is not a PLY file"),
        (b"binary_little_endian", b"ascii", "'format ascii 1.0'"),
        (b"vertex 50", b"vertex 900000000000", "declares 900000000000 points"),
        (b"vertex 50", b"vertex 51", "declares 51 points"),
        (b"vertex 50", b"vertex -1", "'element vertex -1'"),
        (b"property float sigma\n", b"property float sigmoid\n", "unknown column 'float sigmoid'"),
        (b"property int frame\n", b"property float frame\n", "unknown column 'float frame'"),
        (b"property float sigma\n", b"", "lacks the column 'sigma'"),
        (b"float ny", b"float nx", "lacks the column 'ny'"),
        (b"end_header\n", b"comment\n" * 200, "without an end to its header"),
        (b"uchar laser\n", b"uchar laser\nelement face 3\n", "'element face 3'"),
    ],
)
def test_a_malformed_file_is_refused_with_its_name(tmp_path, old, new, message):
    save_cloud(tmp_path / "cloud.ply", some_cloud())
    data = (tmp_path / "cloud.ply").read_bytes()
    assert old in data
    (tmp_path / "cloud.ply").write_bytes(data.replace(old, new))
    with pytest.raises(FormatError, match=message) as refusal:
        load_cloud(tmp_path / "cloud.ply")
    assert str(tmp_path / "cloud.ply") in str(refusal.value)


@given(st.binary(max_size=400), st.integers(0, 400))
def test_no_bytes_are_a_fault_of_ours(tmp_path_factory, noise, keep):
    path = tmp_path_factory.mktemp("ply") / "cloud.ply"
    save_cloud(path, some_cloud())
    path.write_bytes(path.read_bytes()[:keep] + noise)
    with pytest.raises(FormatError):
        load_cloud(path)


def test_a_file_cut_short_is_refused(tmp_path):
    save_cloud(tmp_path / "cloud.ply", some_cloud())
    whole = (tmp_path / "cloud.ply").read_bytes()
    (tmp_path / "cloud.ply").write_bytes(whole[:-1])
    with pytest.raises(FormatError, match="cut off or damaged"):
        load_cloud(tmp_path / "cloud.ply")


@pytest.mark.skipif(sys.platform != "linux", reason="/dev/full is Linux's")
def test_a_failed_write_leaves_what_stood_there(tmp_path):
    save_cloud(tmp_path / "cloud.ply", some_cloud())
    before = (tmp_path / "cloud.ply").read_bytes()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 16, hard))
    try:
        with pytest.raises(DeviceError, match=r"cloud\.ply"):
            save_cloud(tmp_path / "cloud.ply", some_cloud(100_000))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert (tmp_path / "cloud.ply").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["cloud.ply"]
