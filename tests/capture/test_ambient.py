"""A recording that more than the laser lights: its line is told by colour, where that helps."""

import cv2
import numpy as np
import pytest

from murkscan import Camera, Laser, Murk, Rig, open_recording
from murkscan.capture import LaserColour

HEIGHT, WIDTH, COUNT = 120, 320, 12
GREEN = np.array([0.3, 1.0, 0.15])
"""What a camera's channels see of a green laser, about: not the response that is assumed."""


def line_at(frame):
    """Place the stripe's centres of one frame, one a row."""
    return 90.0 + 9 * frame + 0.15 * np.arange(HEIGHT)


def lit_room(frame, *, ambient, noise, seed=3):
    """Draw a picture: paper, print, wood and skin moving behind a thin green line."""
    rng = np.random.default_rng(seed)
    paint = np.array([[200, 205, 210], [30, 30, 32], [150, 95, 50], [190, 150, 130]])
    texture = paint[rng.integers(0, 4, (12, 60))].astype(float)
    scene = np.repeat(np.repeat(texture, 10, axis=0), 10, axis=1)[:, 7 * frame :][:, :WIDTH]
    scene = cv2.GaussianBlur(ambient * scene, (0, 0), 0.8)
    across = np.arange(WIDTH) - line_at(frame)[:, None]
    light = 70 * np.exp(-(across**2) / (2 * 1.5**2))[..., None] * GREEN
    shot = np.random.default_rng([seed, frame]).normal(0, noise, scene.shape)
    return np.clip(np.rint(scene + light + shot), 0, 255).astype(np.uint8)


def opened(tmp_path, write_folder, **light):
    pictures = [lit_room(frame, **light) for frame in range(COUNT)]
    return open_recording(write_folder(tmp_path / "frames", pictures), wavelength=532e-9)


def test_in_daylight_the_line_is_found_by_its_colour(tmp_path, write_folder):
    recording = opened(tmp_path, write_folder, ambient=0.8, noise=1.5)
    assert recording.colour.is_contrast
    assert any("more than the laser lights it" in remark for remark in recording.remarks)
    frames = list(recording.frames())
    camera = Camera((WIDTH, HEIGHT), (400.0, 400.0), (WIDTH / 2, HEIGHT / 2))
    rig = Rig(camera, (Laser.from_baseline_angle(0.1, 1.1, "x"),))
    background = Murk().learn(frames, rig)
    found = list(Murk().extract(frames, rig, background))
    off = np.concatenate(
        [one.pixels[:, 0] - line_at(k)[one.pixels[:, 1].astype(int)] for k, one in enumerate(found)]
    )
    is_right = np.abs(off) < 1.5
    assert is_right.mean() > 0.97
    assert is_right.sum() > 0.97 * COUNT * HEIGHT


@pytest.mark.parametrize("ambient", [0.0, 0.02])
def test_in_the_dark_all_of_the_light_is_collected(tmp_path, write_folder, ambient):
    recording = opened(tmp_path, write_folder, ambient=ambient, noise=1.5)
    assert recording.colour == LaserColour.mean(532e-9)
    assert not recording.remarks


def test_grey_pictures_in_colour_files_stay_as_they_are(tmp_path, write_folder):
    pictures = [lit_room(frame, ambient=0.8, noise=1.5)[..., 1] for frame in range(COUNT)]
    path = write_folder(tmp_path / "frames", [np.dstack([one] * 3) for one in pictures])
    recording = open_recording(path, wavelength=532e-9)
    assert not recording.colour.is_contrast
    np.testing.assert_array_equal(next(recording.frames()).image, pictures[0])


def test_the_grey_levels_are_part_of_what_a_recording_is(tmp_path, write_folder):
    recording = opened(tmp_path, write_folder, ambient=0.8, noise=1.5)
    other = recording.in_colour(LaserColour.mean(532e-9))
    assert other.fingerprint() != recording.fingerprint()
    assert opened(tmp_path, write_folder, ambient=0.8, noise=1.5).colour == recording.colour


@pytest.mark.parametrize(("codec", "kept"), [("ffv1", "bgr0"), ("libx264", "yuv420p")])
def test_a_video_and_its_chapters_are_seen_in_one_colour(tmp_path, write_video, codec, kept):
    pictures = [lit_room(frame, ambient=0.8, noise=1.5) for frame in range(COUNT)]
    whole = [
        write_video(tmp_path / f"dive-{k}.mkv", pictures, codec=codec, given="rgb24", kept=kept)
        for k in (1, 2)
    ]
    assert open_recording(whole[0]).colour.is_contrast
    (colour,) = {part.colour for part in open_recording(whole).parts}
    assert colour.is_contrast
