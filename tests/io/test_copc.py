"""COPC files, as another program opens them."""

import numpy as np
import pytest

from murkscan.errors import InputError
from murkscan.io.cloud_files import load_cloud_file, writing_cloud_file
from murkscan.types.cloud import PointCloud

laspy = pytest.importorskip("laspy")


def wall(count=120_000):
    random = np.random.default_rng(0)
    points = np.array([432100.0, 5412345.0, -12.0]) + random.uniform(0, [6, 3, 0.1], (count, 3))
    ratios = random.uniform(0, 1, (4, count)).astype(np.float32)
    whole = np.arange(count, dtype=np.int32)
    small = np.zeros(count, np.uint8)
    normals = np.tile(np.array([0, 0, 1], np.float32), (count, 1))
    return PointCloud(points, normals, *ratios, whole, whole % 1000, small, small)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    path, cloud = tmp_path_factory.mktemp("copc") / "wall.copc.laz", wall()
    with writing_cloud_file(path) as write:
        for start in range(0, len(cloud), 50_000):
            write(cloud[start : start + 50_000])
    assert [file.name for file in path.parent.iterdir()] == ["wall.copc.laz"]
    return path, cloud


def test_every_point_comes_back_with_all_that_is_known_of_it(written):
    path, cloud = written
    back = load_cloud_file(path)
    back = back[np.argsort(back.frame)]
    assert np.abs(back.points - cloud.points).max() <= 0.5001e-5
    for name in ("signal", "posterior", "sigma", "sigma_common", "scan_line"):
        np.testing.assert_array_equal(getattr(back, name), getattr(cloud, name))


def test_another_reader_finds_points_by_level_and_by_place(written):
    path, cloud = written
    with laspy.CopcReader.open(path) as reader:
        assert len(reader.query()) == len(cloud)
        coarse = reader.query(level=0)
        assert 45_000 < len(coarse) < 55_000
        box = laspy.copc.Bounds(cloud.points.min(axis=0), cloud.points.min(axis=0) + 1.0)
        inside = ((cloud.points[:, :2] - cloud.points.min(axis=0)[:2]) < 1).all(axis=1).sum()
        assert abs(len(reader.query(bounds=box)) - inside) <= 2
        np.testing.assert_allclose(reader.header.mins, cloud.points.min(axis=0), atol=1e-5)
        low = reader.copc_info.center - reader.copc_info.halfsize
        assert (low <= reader.header.mins + 1e-9).all()


def test_a_cloud_that_fails_leaves_nothing(tmp_path):
    with (
        pytest.raises(InputError, match="30000"),
        writing_cloud_file(tmp_path / "far.copc.laz") as write,
    ):
        cloud = wall(1000)
        write(cloud)
        cloud.points[0] += 30_000.0
        write(cloud)
    assert not list(tmp_path.iterdir())
    with (
        pytest.raises(InputError, match="no points"),
        writing_cloud_file(tmp_path / "none.copc.laz"),
    ):
        pass
    assert not list(tmp_path.iterdir())
