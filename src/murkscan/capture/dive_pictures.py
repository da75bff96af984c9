"""Decode the pictures of a dive's file, from any of them on."""

from collections.abc import Generator, Iterator
from contextlib import closing
from typing import Any

import av
import cv2
import numpy as np

from ..errors import FormatError
from ..io.dive.contents import PictureIndex
from ..io.dive.decode import decode
from ..io.dive.open import DiveFile
from ..io.dive.pictures import RAW, VIDEO, PictureMessage, read_picture
from ..types.arrays import Image
from .colour import AbstractColour
from .decode import grey_from_video

_NEAR = 12
"""Pictures behind a keyframe up to which a sample is decoded on."""


def pictures_near(
    file: DiveFile, index: PictureIndex, colour: AbstractColour, number: int, count: int
) -> Iterator[tuple[int, Image | None]]:
    """Decode some pictures in a row at a number, or before it, near a keyframe.

    What cannot be decoded is None; there is always at least one.
    """
    keys = np.flatnonzero(index.is_key[: number + 1])
    if len(keys):
        number = min(number, int(keys[-1]) + _NEAR)
    given = 0
    with closing(decode_from_keyframe(file, index, colour, number)) as items:
        for found, image, _ in items:
            if found >= number:
                yield found, image
                given += 1
                if given == count:
                    return
    if not given:
        yield number, None


def decode_from_keyframe(
    file: DiveFile, index: PictureIndex, colour: AbstractColour, first: int
) -> Generator[tuple[int, Image | None, str], None, None]:
    """Decode from the keyframe before a picture on: number, image or None, and why there is none.

    Numbers increase; those that are missing were given up by the decoder.
    """
    keys = np.flatnonzero(index.is_key[: first + 1])
    begin = int(keys[-1]) if len(keys) else 0
    decoder: Any = None
    empty: list[tuple[int, Image | None, str]] = []
    for number, picture in _messages(file, index, begin):
        if picture is None or not picture.data:
            empty.append((number, None, "came without data: the recorder dropped it"))
            continue
        if picture.codec in VIDEO:
            decoder = decoder or av.CodecContext.create(VIDEO[picture.codec], "r")
            items = list(_feed(decoder, number, picture.data, colour))
        else:
            items = [_read_still(number, picture, colour)]
        for item in items:
            # A decoder may hold pictures back, so what came without data waits for its turn.
            while empty and empty[0][0] < item[0]:
                yield empty.pop(0)
            yield item
    last = [] if decoder is None else _feed(decoder, 0, b"", colour)
    yield from sorted([*last, *empty], key=lambda item: item[0])


def _messages(
    file: DiveFile, index: PictureIndex, begin: int
) -> Iterator[tuple[int, PictureMessage | None]]:
    """Give the pictures from one on, each with its number."""
    if begin >= len(index.places):
        return
    number = begin
    for message in file.messages(int(index.places[begin, 0])):
        # Found by its place: what was left out when the file was looked through has no number.
        if (message.place, message.number) != tuple(index.places[number].tolist()):
            continue
        try:
            yield number, read_picture(message.topic, decode(message))
        except FormatError:
            yield number, None
        number += 1
        if number == len(index.places):
            return


def _feed(
    decoder: Any, number: int, data: bytes, colour: AbstractColour
) -> Iterator[tuple[int, Image | None, str]]:
    """Give the decoder a packet, or with no data the end, and take what comes out."""
    packet = None
    if data:
        packet = av.Packet(data)
        packet.pts = packet.dts = number
    try:
        decoded = decoder.decode(packet)
    except av.error.FFmpegError:
        return
    for one in decoded:
        if one.pts is not None and not one.is_corrupt:
            yield one.pts, grey_from_video(one, colour), ""


def _read_still(
    number: int, picture: PictureMessage, colour: AbstractColour
) -> tuple[int, Image | None, str]:
    try:
        image = picture.as_array() if picture.codec in RAW else _decode_still(picture.data)
    except (FormatError, cv2.error):
        image = None
    if image is None:
        return number, None, "cannot be decoded"
    return number, colour.grey(image), ""


def _decode_still(data: bytes) -> np.ndarray | None:
    image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
    if image is None or image.dtype not in (np.uint8, np.uint16):
        return None
    return np.ascontiguousarray(image[:, :, 2::-1]) if image.ndim == 3 else image
