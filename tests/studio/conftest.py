"""A studio over a folder, asked without a network."""

import pytest

pytest.importorskip("starlette", reason="the extra [studio] is not installed")
from starlette.testclient import TestClient

from murkscan.studio import make_app

TOKEN = "abcDEF123-_"
HERE = "http://127.0.0.1:8000"
RIG = """format = 1
wavelength_nm = 532

[camera]
size = [720, 576]
focal_length = [554.0, 554.8]
principal_point = [359.5, 287.5]
distortion = [0, 0, 0, 0, 0]

[[laser]]
kind = "baseline_angle"
baseline_mm = 300.0
angle_deg = 65.0
axis = "x"

[water]
temperature_c = 20.0
salinity_psu = 35.0
"""


@pytest.fixture
def folder(tmp_path):
    """Give a folder with a rig, beside which lies what is nobody's business."""
    (tmp_path / "secret.txt").write_text("secret")
    folder = tmp_path / "work"
    folder.mkdir()
    (folder / "rig.toml").write_text(RIG)
    return folder


@pytest.fixture
def ask(folder):
    """Give a client that has the token in its address, and asks as the studio's own page does."""
    app = make_app(folder, TOKEN, largest_upload=200_000)
    with TestClient(app, base_url=f"{HERE}/{TOKEN}/", headers={"origin": HERE}) as client:
        yield client
