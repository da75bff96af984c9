"""What is no recording, though FFmpeg would follow it: refused, at once, with nothing read."""

import os
import socket
import threading
import time

import numpy as np
import pytest

from murkscan.capture import open_recording
from murkscan.errors import FormatError, InputError

SDP = """v=0
o=- 0 0 IN IP4 127.0.0.1
s=x
c=IN IP4 127.0.0.1
t=0 0
m=video 5004 RTP/AVP 96
"""
DASH = '<MPD xmlns="urn:mpeg:dash:schema:mpd:2011" profiles="urn:mpeg:dash:profile:isoff"></MPD>\n'
DOORS = {
    "list.m3u8": "#EXTM3U\n#EXT-X-TARGETDURATION:10\n#EXTINF:9,\n{there}\n#EXT-X-ENDLIST\n",
    "list.mkv": "#EXTM3U\n#EXTINF:9,\n{address}\n",
    "list.ffconcat": "ffconcat version 1.0\nfile '{there}'\n",
    "list.txt": "\n\nffconcat version 1.0\nfile '{there}'\n",
    "stream.sdp": SDP,
    "stream.mp4": SDP.replace("\n", "\r\n"),
    "dash.mpd": '<?xml version="1.0"?>\n' + DASH,
    "dash.avi": "<!-- a dive -->\n" + DASH,
    "winamp.pls": "[playlist]\nFile1={address}\n",
}


@pytest.fixture
def there(tmp_path, write_video):
    """A file that a playlist may name."""
    pictures = [np.full((64, 64), 10 * k, np.uint8) for k in range(5)]
    return write_video(tmp_path / "real.mkv", pictures)


@pytest.fixture
def address():
    """An address that notes who calls."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(0.1)
        calls = []

        def listen():
            try:
                calls.append(server.accept())
            except OSError:
                return

        listener = threading.Thread(target=listen)
        listener.start()
        yield f"http://127.0.0.1:{server.getsockname()[1]}/a.ts"
        listener.join()
        assert not calls


@pytest.mark.parametrize("name", DOORS)
def test_what_only_says_where_pictures_are_is_refused_at_once(tmp_path, there, address, name):
    path = tmp_path / name
    path.write_text(DOORS[name].format(there=there, address=address))
    began, read = time.monotonic(), there.stat().st_atime_ns
    with pytest.raises((FormatError, InputError), match="record") as refusal:
        open_recording(path)
    assert str(path) in str(refusal.value)
    assert time.monotonic() - began < 5  # SDP waits for half a minute, a live playlist for ever
    assert there.stat().st_atime_ns == read


def test_a_name_with_a_number_in_it_opens_no_other_picture(tmp_path, write_video, there):
    """FFmpeg reads picture%d.png as a pattern for the files beside it."""
    del there
    (tmp_path / "picture%d.jpx").write_bytes(b"no picture")
    with pytest.raises(FormatError, match="cannot be read as a video"):
        open_recording(tmp_path / "picture%d.jpx")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes are POSIX")
def test_a_pipe_is_refused_rather_than_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.mkv")
    with pytest.raises(InputError, match="neither a file nor a folder"):
        open_recording(tmp_path / "pipe.mkv")


def test_metadata_in_another_alphabet_is_no_obstacle(fault):
    assert len(list(open_recording(fault("video/latin.mp4")).frames())) == 30


def test_metadata_in_latin_1_is_no_obstacle_in_avi_and_matroska_either(tmp_path, write_video):
    pictures = [np.full((64, 64), 10 * k, np.uint8) for k in range(5)]
    for suffix in (".avi", ".mkv", ".mp4"):
        path = write_video(
            tmp_path / f"x{suffix}", pictures, codec="mpeg4", kept="yuv420p", title="Suedsee"
        )
        data = path.read_bytes()
        assert b"Suedsee" in data
        path.write_bytes(data.replace(b"Suedsee", b"S\xfcd\xdfee "))
        assert len(list(open_recording(path).frames())) == 5
