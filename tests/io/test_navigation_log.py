"""What instruments measured becomes poses and measurements, by the conventions that are told."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from murkscan.errors import FormatError, InputError
from murkscan.io.navigation_log import read_navigation_log
from murkscan.io.nmea import read_nmea

COUNT = 20
TIMES = 1_777_627_800.0 + np.arange(COUNT) / 5


def write(path, head, *columns):
    rows = np.column_stack(columns).tolist()
    path.write_text("\n".join([head, *(",".join(map(repr, row)) for row in rows)]) + "\n")
    return path


def sentence(body: str) -> str:
    total = 0
    for byte in body.encode():
        total ^= byte
    return f"${body}*{total:02X}\r\n"


def degrees(value: float, digits: int) -> str:
    whole = int(abs(value))
    return f"{whole:0{digits}d}{60 * (abs(value) - whole):010.7f}"


def test_an_empty_cell_is_no_reading(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("time_s,roll_deg,pitch_deg,heading_deg,depth_m\n0,1,2,3,\n1,,,,5\n2,2,3,4,6\n")
    navigation = read_navigation_log(path).navigation
    np.testing.assert_allclose(navigation.attitude.times, [0, 2])
    np.testing.assert_allclose(navigation.attitude.values[0], np.radians([1, 2, 3]))
    np.testing.assert_allclose(navigation.depth.values[:, 0], [5, 6])


def test_places_on_the_globe_become_metres_and_heading_turns_with_the_grid(tmp_path):
    pyproj = pytest.importorskip("pyproj", reason="the extra [dive] is not installed")
    # 2 degrees east of the middle of UTM zone 32, on the ground 1 m apart along true north.
    east, north = np.full(COUNT, 11.0), 54.0 + np.arange(COUNT) / 111_300
    path = write(
        tmp_path / "a.csv",
        "time_s,roll_deg,pitch_deg,heading_deg,latitude_deg,longitude_deg,depth_m",
        TIMES, np.zeros(COUNT), np.zeros(COUNT), np.zeros(COUNT), north, east, np.full(COUNT, 3.0),
    )  # fmt: skip
    log = read_navigation_log(path, crs="EPSG:32632")
    x, y = pyproj.Transformer.from_crs(4326, 32632, always_xy=True).transform(east, north)
    np.testing.assert_allclose(log.poses.positions, np.stack([y, x, np.full(COUNT, 3.0)], axis=1))
    # The vehicle heads along its own way: true north, which the grid sees turned.
    forward = Rotation.from_quat(log.poses.quaternions[0], scalar_first=True).apply([1.0, 0, 0])
    way = log.poses.positions[-1] - log.poses.positions[0]
    assert np.degrees(np.arccos(forward @ way / np.linalg.norm(way))) < 0.01
    assert "EPSG:32632" in log.understood
    assert read_navigation_log(path).understood == log.understood  # UTM's zone by itself


@pytest.mark.parametrize("crs", ["EPSG:999999", "EPSG:4326", "EPSG:2263", "nonsense"])
def test_a_system_that_is_no_plane_in_metres_is_refused(crs, tmp_path):
    pytest.importorskip("pyproj", reason="the extra [dive] is not installed")
    path = write(tmp_path / "a.csv", "time_s,latitude_deg,longitude_deg", TIMES, TIMES * 0 + 54,
                 TIMES * 0 + 10)  # fmt: skip
    with pytest.raises(InputError, match="EPSG:32632"):
        read_navigation_log(path, crs=crs)


def test_nmea_is_read_over_midnight_and_without_spoilt_sentences(tmp_path):
    lines = [sentence("GPZDA,235958.00,30,04,2026,00,00")]
    for k in range(4):
        clock = f"{('235959', '000000', '000001', '000002')[k]}.00"
        place = f"{degrees(54.5 + k * 1e-6, 2)},N,{degrees(10.25, 3)},W"
        lines.append(sentence(f"GNGGA,{clock},{place},1,08,0.9,2.5,M,40.0,M,,"))
        lines.append(sentence(f"PASHR,{clock},{10 + k}.0,T,1.0,-2.0,0.0,0.1,0.1,0.1,1"))
    lines.append(lines[-2].replace("W", "E"))  # its checksum is wrong now
    (tmp_path / "a.nmea").write_text("".join(lines))
    series = {one.kind: one for one in read_nmea(tmp_path / "a.nmea")}
    np.testing.assert_allclose(np.diff(series["geodetic"].times), 1)
    np.testing.assert_allclose(series["geodetic"].values[:, 1], -10.25)
    np.testing.assert_allclose(series["geodetic"].values[2, 0], 54.500002, atol=1e-9)
    np.testing.assert_allclose(series["attitude"].values[3, :3], np.radians([1, -2, 13]))


def test_a_log_without_measurements_is_one_sentence(tmp_path):
    path = write(tmp_path / "a.csv", "time_s,voltage", TIMES, TIMES * 0)
    with pytest.raises(FormatError, match="no measurements"):
        read_navigation_log(path)


def test_positions_are_not_bridged_over_a_hole(tmp_path):
    kept = np.abs(np.arange(COUNT) - 10) > 4
    zeros = np.zeros(COUNT)
    empty = np.where(kept, np.arange(COUNT) * 0.1, np.nan)
    head = "time_s,roll_deg,pitch_deg,heading_deg,north_m,east_m,depth_m"
    path = write(tmp_path / "a.csv", head, TIMES, zeros, zeros, zeros, empty, empty, empty)
    path.write_text(path.read_text().replace("nan", ""))
    assert np.diff(read_navigation_log(path).poses.times).max() == pytest.approx(2.0)
