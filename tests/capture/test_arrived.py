"""Pictures of a stream become frames while they come, as the recording has them."""

from fractions import Fraction

import av
import numpy as np

from murkscan.capture import ArrivedPicture, FrameSplitter, LaserColour, StreamDecoder
from murkscan.capture.coded import CodedPicture, PictureCodec

from ..streams import HEIGHT, WIDTH, picture


def coded_pictures(count):
    context = av.CodecContext.create("libx264", "w")
    context.width, context.height, context.pix_fmt = WIDTH, HEIGHT, "yuv420p"
    context.time_base = Fraction(1, 25)
    context.options = {"g": "10", "tune": "zerolatency", "preset": "ultrafast"}
    found = []
    for number in range(count):
        frame = av.VideoFrame.from_ndarray(picture(number), "gray").reformat(format="yuv420p")
        frame.pts = number
        for packet in context.encode(frame):
            codec = PictureCodec("h264", None)
            data = bytes(packet)
            found.append(CodedPicture(codec, data, number / 25, packet.is_keyframe, float(number)))
    return found


def test_each_picture_comes_out_at_once_with_its_time_and_arrival():
    decoder = StreamDecoder(LaserColour.mean(532e-9))
    for number, coded in enumerate(coded_pictures(12)):
        (out,) = decoder.decode(number, coded)
        assert (out.number, out.time, out.arrived) == (number, number / 25, float(number))
        assert out.image.shape == (HEIGHT, WIDTH)
        assert abs(int(out.image[100].argmax()) - int(picture(number)[100].argmax())) <= 3


def test_after_a_gap_it_waits_for_a_keyframe():
    coded, decoder = coded_pictures(25), StreamDecoder(LaserColour.mean(532e-9))
    assert decoder.decode(0, coded[0])
    shown = [n for n in range(5, 25) if decoder.decode(n, coded[n])]
    assert shown == list(range(10, 25))


def test_fields_are_told_from_the_first_second_and_nothing_of_it_is_lost():
    def woven(number):
        image = np.full((HEIGHT, WIDTH), 20, np.uint8)
        for field in (0, 1):
            at = 20 + 8 * number + 4 * field
            image[field::2, at : at + 6] = 200
        return image

    splitter = FrameSplitter()
    frames = [
        frame
        for number in range(30)
        for frame in splitter.split(ArrivedPicture(woven(number), number, number / 25, 0.0))
    ]
    assert splitter.order == "top-first"
    assert [one.frame.index for one in frames] == list(range(60))
    assert np.allclose(np.diff([one.frame.time for one in frames]), 0.02)
    assert [frames[k].frame.first_row for k in (0, 1)] == [0, 1]
