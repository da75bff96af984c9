"""Interlaced recordings are known from the picture; the truth: when the rows were drawn."""

import functools

import cv2
import numpy as np
import pytest

from murkscan.capture import open_recording
from murkscan.capture.fields import find_field_order
from murkscan.simulate import parse_scene, simulate_frames

ROWS, COLUMNS = 576, 720
ORDERS = ["progressive", "top-first", "bottom-first"]
FLAGS = {"none": "", "top": "interlaced=1:tff=1", "bottom": "interlaced=1:bff=1"}


def draw(time, *, along, speed, peak):
    """Draw a stripe over relief that passes; `time` in pictures, `speed` at most [px/picture]."""
    across, down = (ROWS, COLUMNS) if along == "rows" else (COLUMNS, ROWS)
    centre = across / 2 + 20 * speed * np.sin(np.arange(down) / 90 + time / 20)
    off = np.arange(across)[:, None] - centre
    # Beyond 12 px the stripe is less than a millionth of its peak.
    stripe = np.full(off.shape, 20.0, np.float32)
    near = np.abs(off) < 12
    stripe[near] += peak * np.exp(-(off[near] ** 2) / 8)
    return stripe if along == "rows" else stripe.T


@functools.lru_cache(4)  # all would be hundreds of megabytes
def film(order, num_pictures=12, *, along="columns", speed=3.0, peak=120, noise=4):
    """Film as a camera of that field order does: the second field half a picture later."""
    random = np.random.default_rng(7)
    scene = {"along": along, "speed": speed, "peak": peak}
    pictures = []
    for time in range(num_pictures):
        picture = draw(time, **scene)
        if order != "progressive":
            late = 1 if order == "top-first" else 0
            picture[late::2] = draw(time + 0.5, **scene)[late::2]
        picture += noise * random.standard_normal(picture.shape, np.float32)
        pictures.append(np.clip(np.rint(picture), 0, 255).astype(np.uint8))
    return tuple(pictures)


def snowing(order, *, rows, **scene):
    """Film in snow that is gone in the next picture; flakes of so many rows."""
    random = np.random.default_rng(2)
    pictures = [picture.copy() for picture in film(order, **scene)]
    for picture in pictures:
        for row, column in random.integers(0, 560, (200, 2)):
            picture[row : row + rows.stop : rows.step, column : column + 4] = 255
    return pictures


def runs(pictures):
    return [pictures[:6], pictures[6:]]


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("along", ["rows", "columns"])
@pytest.mark.parametrize("speed", [0.5, 3.0, 30.0])
def test_the_order_is_found_whichever_way_the_stripe_runs_and_however_fast(order, along, speed):
    assert find_field_order(runs(film(order, along=along, speed=speed))) == order


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("along", ["rows", "columns"])
def test_the_order_is_found_in_low_light(order, along):
    # The stripe is but twice the noise of a pixel: four runs or more have to agree.
    pictures = film(order, 25, along=along, peak=25, noise=12)
    fives = [pictures[start : start + 5] for start in range(0, 25, 5)]
    assert find_field_order(fives) == order


@pytest.mark.parametrize("noise", [0, 2, 12])
def test_where_nothing_moves_there_is_no_telling(noise):
    assert find_field_order(runs(film("progressive", speed=0, noise=noise))) == "undecided"


def test_snow_that_is_gone_in_the_next_picture_is_not_taken_for_fields():
    pictures = snowing("progressive", rows=slice(0, 4, 1))
    assert find_field_order(runs(pictures)) == "progressive"


def test_snow_of_each_field_tells_that_fields_are_apart_but_not_their_order():
    pictures = snowing("progressive", speed=0, rows=slice(0, 8, 2))
    assert find_field_order(runs(pictures)) == "interlaced"


def test_single_pictures_tell_nothing():
    pictures = film("top-first", 3)
    assert find_field_order([[picture] for picture in pictures]) == "undecided"
    assert find_field_order([]) == "undecided"


@pytest.mark.parametrize("flag", FLAGS)
@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("along", ["rows", "columns"])
def test_the_flag_of_a_video_does_not_matter(tmp_path, write_video, order, along, flag):
    path = write_video(
        tmp_path / "dive.mkv",
        film(order, 14, along=along),
        codec="libx264",
        kept="yuv420p",
        options={"preset": "veryfast", "crf": "23", "x264-params": FLAGS[flag]},
    )
    assert open_recording(path).order == order


@pytest.mark.parametrize("order", ORDERS)
def test_grabbed_pictures_in_a_folder_are_told_as_well(tmp_path, write_folder, order):
    recording = open_recording(write_folder(tmp_path, film(order)))
    assert recording.order == order


def test_where_nothing_moves_the_flag_decides(tmp_path, write_video):
    still = film("progressive", 6, speed=0, noise=0)
    for flag, order in (("none", "progressive"), ("top", "top-first")):
        path = write_video(
            tmp_path / f"{flag}.mkv",
            still,
            codec="libx264",
            kept="yuv420p",
            options={"preset": "veryfast", "x264-params": FLAGS[flag]},
        )
        assert open_recording(path).order == order


@pytest.mark.parametrize("order", ORDERS[1:])
def test_fields_follow_the_motion_at_their_own_times(tmp_path, write_video, order):
    """The centre of the stripe, read from each field at its time, lies on the drawn curve."""
    path = write_video(tmp_path / "dive.mkv", film(order, noise=0))
    recording = open_recording(path)
    frames = list(recording.frames())
    assert (recording.fields_per_picture, recording.num_frames) == (2, 24)
    assert [frame.time for frame in frames[:3]] == pytest.approx([0, 0.02, 0.04])
    for frame in frames:
        row = 100
        weights = frame.image[row].astype(float) - 20
        centre = (weights * np.arange(COLUMNS)).sum() / weights.sum()
        v = frame.as_full_rows(np.array([float(row)]))[0]
        drawn = COLUMNS / 2 + 60 * np.sin(v / 90 + frame.time * 25 / 20)
        # Rounding to whole grey levels moves a centre by some hundredths of a pixel; half a
        # picture's motion is up to 1.5 px.
        assert centre == pytest.approx(drawn, abs=0.1)


def test_what_the_user_says_of_the_fields_holds(tmp_path, write_folder):
    folder = write_folder(tmp_path, film("top-first", 6))
    for order in ORDERS:
        assert open_recording(folder, fields=order).order == order


@pytest.mark.parametrize(
    "name", ["stage_stairs/grey_step_8.94mm.mp4", "stage_stairs/scan", "arm_poses"]
)
def test_real_progressive_recordings_are_known_as_such(data, name):
    first, *rest = name.split("/")
    recording = open_recording(data(first).joinpath(*rest), wavelength=650e-9)
    assert recording.order == "progressive"


@pytest.mark.parametrize("name", ["plane_gop12.mp4", "stairs_bf2_crf10.mp4"])
def test_a_stripe_that_creeps_by_a_part_of_a_row_stays_progressive(fault, name):
    assert open_recording(fault(f"video/{name}")).order == "progressive"


def test_a_chapter_in_which_the_stripe_jumps_once_stays_progressive(fault, tmp_path, write_video):
    files = sorted((fault("recording") / "frames").glob("*.png"))[:30]
    chapter = [cv2.imread(str(file), cv2.IMREAD_GRAYSCALE) for file in files]
    path = write_video(
        tmp_path / "GH010042.mp4", chapter, codec="libx264", kept="yuv420p", options={"crf": "10"}
    )
    assert open_recording(path).order == "progressive"


SLOW = """
format = 1
seed = 9
[[object]]
mesh = "plane"
width_mm = 900
height_mm = 900
position_mm = [0, 230, 850]
[[object]]
mesh = "sphere"
radius_mm = 40
position_mm = [-120, 210, 800]
[[object]]
mesh = "cylinder"
radius_mm = 30
length_mm = 150
position_mm = [120, 210, 800]
[rig]
format = 1
wavelength_nm = 532.0
[rig.camera]
size = [720, 576]
focal_length = [554.0, 554.8]
principal_point = [359.5, 287.5]
[[rig.laser]]
kind = "plane"
normal = [0.0, 0.8941542368393681, -0.4477590878387697]
distance_mm = 223.53855920984202
axis = "y"
[sensor]
peak_grey = 200
[water]
attenuation_per_m = 1.0
[motion]
frames = 14
frame_rate_hz = 25
speed_mm_s = 50
"""


def test_a_short_progressive_film_of_a_stripe_that_hardly_moves_is_not_taken_for_fields(tmp_path):
    """All its pictures miss the same part of the narrow stripe: they lean to one side."""
    scene = parse_scene(SLOW, "slow", tmp_path)
    for number, simulated in enumerate(simulate_frames(scene, 0, 14)):
        cv2.imwrite(str(tmp_path / f"{number:03}.png"), simulated.frame.image)
    assert open_recording(tmp_path).fields_per_picture == 1
