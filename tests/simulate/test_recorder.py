"""What happens to pictures after the sensor: speckle before it, processing and recording behind."""

from dataclasses import replace

import numpy as np
import pytest

import murkscan as ms
from murkscan.errors import InputError
from murkscan.io.video import writing_video
from murkscan.simulate import Light, Processing, Recorder, Simulator
from murkscan.simulate.speckle import draw_speckle

from ..scenes import QUIET, standing, wall

SIZE = (360, 288)


@pytest.mark.parametrize("contrast", [0.3, 0.5, 0.7, 1.0])
def test_speckle_has_its_contrast_and_leaves_the_light_as_strong(contrast):
    factor = draw_speckle(SIZE, contrast, spot=1.0, place=np.zeros(3), seed=0)
    # Some ten thousand spots: mean to 1 % of the contrast, standard deviation to 2 %.
    assert factor.mean() == pytest.approx(1.0, abs=0.03 * contrast)
    assert factor.std() == pytest.approx(contrast, rel=0.05)
    assert factor.min() >= 0


def test_speckle_stays_with_the_camera_and_moves_with_it():
    first, same, moved = (
        draw_speckle(SIZE, 0.5, spot=1.0, place=np.array([0.0, y, 0.0]), seed=0)
        for y in (0.1, 0.1, 0.1025)
    )
    np.testing.assert_array_equal(first, same)
    assert abs(np.corrcoef(first.ravel(), moved.ravel())[0, 1]) < 0.02


def test_speckle_is_as_wide_as_the_lens_s_spot():
    factor = draw_speckle(SIZE, 0.3, spot=2.0, place=np.zeros(3), seed=0) - 1
    beside = np.mean(factor[:, :-2] * factor[:, 2:]) / np.mean(factor**2)
    # A Gaussian of 2 px, 2 px away; the gamma distribution bends it a little.
    assert beside == pytest.approx(np.exp(-0.5), abs=0.05)


def test_speckle_is_noise_of_the_stripe_not_its_truth():
    scene = standing(wall(0.6), sensor=replace(QUIET, peak_grey=8e3))  # no pixel is white
    clean, speckled = (
        Simulator.of(replace(scene, light=Light(speckle=speckle))) for speckle in (0.0, 0.5)
    )
    first, second = clean.draw_frame(0), speckled.draw_frame(0)
    np.testing.assert_array_equal(first.stripe.crlb, second.stripe.crlb)
    rows, columns = np.nonzero(
        first.light.lasers[0].stripe > 0.5 * first.light.lasers[0].stripe.max()
    )
    ratio = second.light.total[rows, columns] / first.light.total[rows, columns]
    assert ratio.std() == pytest.approx(0.5, rel=0.1)


def test_gamma_keeps_black_and_white_and_lifts_what_is_between():
    image = np.array([[0, 16, 64, 255]], np.uint8)
    lifted = Processing(gamma=0.45).process(image, 255)
    assert lifted[0, 0] == 0
    assert lifted[0, -1] == 255
    np.testing.assert_allclose(lifted[0, 1:3], 255 * (image[0, 1:3] / 255) ** 0.45, atol=0.5)
    np.testing.assert_array_equal(Processing().process(image, 255), image)


def test_sharpening_lowers_what_lies_beside_a_line():
    image = np.full((64, 64), 100, np.uint8)
    image[31:33] = 180
    sharp = Processing(sharpening=1.0).process(image, 255)
    assert sharp[31, 30] > 200
    assert sharp[29, 30] < 97
    assert sharp[10, 30] == 100


def test_denoising_lowers_noise_and_keeps_what_moves():
    random = np.random.default_rng(0)
    recorder = Recorder(denoise=0.8)
    kept = None
    for step in range(12):
        picture = np.full((64, 64), 100.0) + random.normal(0, 2.0, (64, 64))
        picture[10 + step] = 200
        kept = recorder.smooth(np.rint(picture).astype(np.uint8), kept, 255)
    # A recursive filter that keeps 0.8 leaves a third of white noise; changes weaken it.
    assert kept[40:].std() < 0.6 * 2.0
    assert kept[21].mean() == pytest.approx(200, abs=1)
    np.testing.assert_array_equal(
        Recorder().smooth(picture.astype(np.uint8), kept, 255), picture.astype(np.uint8)
    )


@pytest.mark.parametrize(
    "settings",
    [
        {"codec": "h264", "crf": 12},
        {"codec": "h264", "bitrate": 4e6},
        {"codec": "h265", "crf": 12},
        {"codec": "h265", "bitrate": 4e6},
        {"codec": "h264", "crf": 12, "streamed": True},
        {"codec": "mjpeg", "quality": 2},
    ],
)
def test_every_codec_keeps_grey_levels_and_times(settings, tmp_path):
    rows = np.arange(64)[:, None] + np.zeros(96)
    pictures = [np.rint(40 + 2 * rows + 3 * k).astype(np.uint8) for k in range(8)]
    with writing_video(tmp_path / "a.mkv", (96, 64), rate=25.0, **settings) as write:
        for number, picture in enumerate(pictures):
            write(picture, number / 25)
    frames = list(ms.open_recording(tmp_path / "a.mkv", fields="progressive").frames())
    assert [frame.time for frame in frames] == pytest.approx([k / 25 for k in range(8)], abs=1e-3)
    for frame, picture in zip(frames, pictures, strict=True):
        assert np.abs(frame.image.astype(float) - picture).mean() < 2


def test_a_lower_rate_makes_a_smaller_file(tmp_path):
    random = np.random.default_rng(0)
    pictures = random.integers(0, 255, (25, 144, 176), np.uint8)
    sizes = []
    for number, bitrate in enumerate((3e5, 3e6)):
        path = tmp_path / f"{number}.mkv"
        with writing_video(path, (176, 144), rate=25.0, codec="h264", bitrate=bitrate) as write:
            for k, picture in enumerate(pictures):
                write(picture, k / 25)
        sizes.append(8 * path.stat().st_size)
    # One second; the buffer lets the start take as much again.
    assert sizes[0] < sizes[1] / 3
    assert sizes[1] < 2 * 3e6


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Recorder("mjpeg", quality=0), "sensor.quality"),
        (lambda: Recorder("ffv1", bitrate=1e6), "goes with h264"),
        (lambda: Recorder("mjpeg", streamed=True), "sensor.streamed goes with h264"),
        (lambda: Recorder("h264", bitrate=1.0), "sensor.bitrate_mbit_s must lie"),
        (lambda: Recorder(denoise=1.0), "sensor.denoise"),
        (lambda: Processing(gamma=0.0), "sensor.gamma"),
        (lambda: Processing(sharpening=-1.0), "sensor.sharpening"),
        (lambda: Light(speckle=1.5), "light.speckle"),
    ],
)
def test_what_no_camera_does_is_refused(make, words):
    with pytest.raises(InputError, match=words):
        make()
