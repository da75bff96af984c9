"""The newest picture of a stream or a camera, for who cannot look at each; all are recorded."""

import threading
from collections.abc import Generator
from contextlib import closing
from pathlib import Path

import numpy as np

from ..capture import CodedPicture, DiveFolder, LaserColour, StreamDecoder, record_dive
from ..errors import MurkscanError, StreamLost
from ..live import Mailbox
from ..types.arrays import Image

_CODED = 250
"""Pictures that wait to be decoded, at most."""
_WAIT = 0.25
"""Longest wait for a picture before it is looked whether the stream has ended [s]."""


class NewestPictures:
    """Records a source in a thread of its own, and gives the newest picture to who asks."""

    def __init__(self, source: str, folder: Path, *, wavelength: float, timeout: float) -> None:
        """Take what `record_dive` takes.

        Args:
            source: A stream or a camera.
            folder: Where the recording goes.
            wavelength: For which colours are weighted [m].
            timeout: Longest wait for the stream and for its next picture [s].
        """
        self._recording = (source, DiveFolder(folder), timeout)
        self._colour = LaserColour.mean(wavelength)
        self._coded = Mailbox[tuple[int, CodedPicture]](_CODED)
        self._newest = Mailbox[tuple[Image, float]](1)
        self._stopping, self._count = threading.Event(), 0
        self._failure: MurkscanError | None = None

    def __iter__(self) -> Generator[tuple[Image, float], None, None]:
        """Give pictures with their times [s], until the stream ends; closing ends the recording.

        Raises:
            MurkscanError: The source gives nothing, or the disk is full.
        """
        threads = [
            threading.Thread(target=task, daemon=True) for task in (self._record, self._decode)
        ]
        for thread in threads:
            thread.start()
        try:
            while not self._newest.is_done:
                newest = self._newest.get(_WAIT)
                if newest is not None:
                    yield newest
        finally:
            self._stopping.set()
            for thread in threads:
                thread.join()
        if self._failure is not None:
            raise self._failure

    def _record(self) -> None:
        source, folder, timeout = self._recording
        recording = record_dive(
            source, folder, timeout=timeout, patience=0.0, tap=self._tap, image_tap=self._see
        )
        try:
            with closing(recording):
                for _ in recording:
                    if self._stopping.is_set():
                        return
        except MurkscanError as error:
            self._failure = error
        finally:
            self._coded.close()

    def _tap(self, coded: CodedPicture) -> None:
        self._coded.put((self._count, coded))
        self._count += 1

    def _see(self, image: np.ndarray, time: float) -> None:
        self._newest.put((self._colour.grey(image), time))

    def _decode(self) -> None:
        decoder = StreamDecoder(self._colour)
        try:
            while not self._coded.is_done:
                item = self._coded.get(_WAIT)
                if item is not None:
                    for picture in decoder.decode(*item):
                        self._newest.put((picture.image, picture.time))
        except ValueError as error:
            self._failure = StreamLost(f"The pictures cannot be decoded: {error}.")
        finally:
            self._newest.close()
