"""A cloud of random columns, and how the tests save it."""

import numpy as np

from murkscan.io.cloud_files import writing_cloud_file
from murkscan.types.cloud import PointCloud


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
