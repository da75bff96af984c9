"""A scan of waves, of which only the cloud is there."""

import pytest

from ..projects import as_project
from ..scans import scan_cloud, waves


@pytest.fixture(scope="session")
def cloud():
    return scan_cloud(waves, noise=1e-4)


@pytest.fixture
def project(tmp_path, cloud):
    return as_project(tmp_path / "scan", cloud)
