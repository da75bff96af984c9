"""Pictures of a stream for who cannot look at each, while all are recorded."""

import time
from contextlib import closing

import pytest

from murkscan.capture import open_recording
from murkscan.errors import InputError, StreamLost
from murkscan.survey.newest_pictures import NewestPictures

from ..streams import FIRST, HEIGHT, WIDTH, Sender, free_port


def test_the_newest_picture_is_given_and_all_are_recorded(tmp_path):
    port = free_port()
    sender, where = Sender(port), []
    pictures = NewestPictures(
        f"udp://127.0.0.1:{port}", tmp_path / "video", wavelength=532e-9, timeout=20.0
    )
    try:
        with closing(iter(pictures)) as coming:
            for image, moment in coming:
                assert image.shape == (HEIGHT, WIDTH)
                where.append((int(image[100].argmax()) - FIRST, moment))
                if len(where) == 4:
                    break
                time.sleep(0.3)  # as somebody who looks for a board
    finally:
        sender.stop()
    (first, since), (last, until) = where[0], where[-1]
    # A pixel a picture, 25 a second; of the line's four columns any may be the brightest.
    assert last - first == pytest.approx(25 * (until - since), abs=6)
    frames = list(open_recording(tmp_path / "video" / "dive-1.mkv").frames())
    assert len(frames) >= last - first - 3


def test_what_is_no_source_is_told(tmp_path):
    for source, error in (("nothing.txt", InputError), ("99", StreamLost)):
        with pytest.raises(error):
            next(iter(NewestPictures(source, tmp_path / "v", wavelength=532e-9, timeout=1.0)))
