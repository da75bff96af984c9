"""MAVLink as it comes over the network: written down as a .tlog, and read at once."""

import threading
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import DeviceError, InputError
from .messages import Topic, require_extra
from .series import Series, read_series, series_kind

_KEPT = 20.0
"""Time for which readings are kept [s]: the way goes on from there, and depths are smoothed."""
_WAIT = 0.5


class MavlinkLink:
    """Listens to a vehicle, writes each packet down, and keeps the readings of the last seconds."""

    def __init__(self, address: str, path: Path) -> None:
        """Name where to listen.

        Args:
            address: HOST:PORT of this machine to which the vehicle, or its router, sends.
            path: The .tlog to write; what stands there is gone on with.

        Raises:
            InputError: The address is none.
            MissingDependency: pymavlink is not installed.
        """
        host, _, port = address.rpartition(":")
        if not host or not port.isdigit() or not 0 < int(port) < 65536:
            raise InputError(
                f"{address} is no address to listen at; give HOST:PORT, such as 0.0.0.0:14550."
            )
        try:
            from pymavlink import mavutil
        except ImportError as error:
            raise require_extra(error, "tlog", "MAVLink") from error
        self._open, self._address, self.path = mavutil.mavlink_connection, address, path
        self._lock, self._done = threading.Lock(), threading.Event()
        self._recent: dict[str, tuple[Topic, deque[tuple[float, tuple[float, ...]]]]] = {}

    @contextmanager
    def listening(self) -> Iterator[None]:
        """Listen while something else is done.

        Raises:
            DeviceError: The port is taken, or the file cannot be written.
        """
        try:
            link = self._open(f"udpin:{self._address}")
            self.path.parent.mkdir(parents=True, exist_ok=True)
            file = self.path.open("ab", buffering=0)
        except OSError as error:
            raise DeviceError(
                f"Cannot listen to MAVLink at {self._address}: {error.strerror or error}. Give "
                "another port, or end the program that has it."
            ) from error
        thread = threading.Thread(target=self._listen, args=(link, file), daemon=True)
        thread.start()
        try:
            yield
        finally:
            self._done.set()
            thread.join()
            file.close()
            link.close()

    def read_recent(self) -> Iterator[tuple[Series, ...]]:
        """Give what was measured in the last seconds; nothing where nothing was."""
        with self._lock:
            kept = [(topic, list(readings)) for topic, readings in self._recent.values()]
        series = []
        for topic, readings in kept:
            kind = series_kind(topic)
            if kind is not None and len(readings) > 1:
                times = np.array([moment for moment, _ in readings])
                values = np.array([numbers for _, numbers in readings], float)
                series.append(Series(topic.name, kind, times, values, topic))
        if series:
            yield tuple(series)

    def _listen(self, link: Any, file: Any) -> None:
        while not self._done.is_set():
            message = link.recv_match(blocking=True, timeout=_WAIT)
            if message is None or message.get_type() == "BAD_DATA":
                continue
            now = time.time()
            file.write(round(now * 1e6).to_bytes(8, "big") + bytes(message.get_msgbuf()))
            self._note(message, now)

    def _note(self, message: Any, now: float) -> None:
        kind = message.get_type()
        name = f"mavlink/{message.get_srcSystem()}/{message.get_srcComponent()}/{kind}"
        topic = Topic(name, kind, "mavlink")
        if series_kind(topic) is None:
            return
        readings, _ = read_series(topic, message.to_dict())
        with self._lock:
            _, kept = self._recent.setdefault(name, (topic, deque()))
            kept += [(now, values) for _, values, _ in readings]
            while kept and kept[0][0] < now - _KEPT:
                kept.popleft()
