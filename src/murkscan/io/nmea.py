"""NMEA 0183, as GNSS receivers, compasses and motion sensors write it."""

from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np

from ..errors import FormatError
from .dive.messages import Topic
from .dive.series import Series, SeriesKind

_HALF_DAY = 43_200.0


def is_nmea(path: Path) -> bool:
    """Tell by its first lines whether a file holds NMEA sentences."""
    with path.open("rb") as file:
        return any(_fields(line) for line in file.read(4096).splitlines())


def read_nmea(path: Path) -> tuple[Series, ...]:
    """Read positions and attitudes; sentences with a wrong checksum are passed over.

    Of use are GGA (position), RMC and ZDA (date), HDT and THS (heading), PASHR and PRDID (roll,
    pitch, heading). Heading alone makes no attitude: roll and pitch are 0 then.

    Raises:
        FormatError: There is no sentence with a position or an attitude.

    References:
        NMEA 0183 version 4.11; PASHR of Novatel's OEM7 manual, PRDID of Teledyne's PD6.
    """
    reader = _Reader()
    with path.open("rb") as file:
        for line in file:
            fields = _fields(line)
            if fields:
                reader.take(fields)
    found = tuple(reader.series(path.name))
    if not found:
        raise FormatError(
            f"{path} holds no NMEA sentence with a position (GGA) or an attitude (PASHR, PRDID, "
            "HDT)."
        )
    return found


def _fields(line: bytes) -> list[str]:
    """Cut a sentence at its commas; nothing where it is none or its checksum is wrong."""
    begin = line.find(b"$")
    body, star, check = line[begin + 1 :].strip().partition(b"*")
    if begin < 0 or b"," not in body or not body[:2].isalpha():
        return []
    total = 0
    for byte in body:
        total ^= byte
    try:
        if star and int(check[:2], 16) != total:
            return []
        return body.decode("ascii").split(",")
    except ValueError:
        return []


class _Reader:
    def __init__(self) -> None:
        self._day = datetime(1970, 1, 1, tzinfo=UTC)
        self._last: float | None = None
        self._rows: dict[SeriesKind, list[tuple[float, ...]]] = {"geodetic": [], "orientation": []}
        self._times: dict[SeriesKind, list[float]] = {"geodetic": [], "orientation": []}

    def take(self, fields: list[str]) -> None:
        kind = fields[0] if fields[0].startswith("P") else fields[0][2:]
        try:
            if kind == "ZDA" and fields[4]:
                self._set_day(int(fields[4]), int(fields[3]), int(fields[2]))
                self._clock(fields[1])
            elif kind == "RMC" and fields[9]:
                day, month, year = (int(fields[9][k : k + 2]) for k in (0, 2, 4))
                self._set_day(2000 + year, month, day)
                self._clock(fields[1])
            elif kind == "GGA" and fields[6] not in ("", "0"):
                place = (_angle(fields[2], fields[3]), _angle(fields[4], fields[5]))
                self._add("geodetic", self._clock(fields[1]), (*place, float(fields[9] or 0)))
            elif kind == "PASHR" and len(fields) > 5 and fields[4]:
                turn = (float(fields[4]), float(fields[5]), float(fields[2]))
                self._add("orientation", self._clock(fields[1]), turn)
            elif kind == "PRDID" and self._last is not None:
                turn = (float(fields[2]), float(fields[1]), float(fields[3]))
                self._add("orientation", self._last, turn)
            elif kind in ("HDT", "THS") and self._last is not None and fields[1]:
                self._add("orientation", self._last, (0.0, 0.0, float(fields[1])))
        except (ValueError, IndexError):
            return

    def series(self, name: str) -> list[Series]:
        found = list[Series]()
        for kind, rows in self._rows.items():
            if rows:
                times, values = np.array(self._times[kind]), np.array(rows, float)
                times, first = np.unique(times, return_index=True)
                values = values[first]
                if kind == "orientation":
                    values = np.hstack([np.radians(values), np.full((len(values), 3), np.nan)])
                topic = Topic(name, "NMEA", "nmea")
                use: SeriesKind = "attitude" if kind == "orientation" else kind
                found.append(Series(f"{name} {kind}", use, times, values, topic))
        return found

    def _add(self, kind: SeriesKind, time: float, values: tuple[float, ...]) -> None:
        self._rows[kind].append(values)
        self._times[kind].append(time)

    def _set_day(self, year: int, month: int, day: int) -> None:
        self._day = datetime(year, month, day, tzinfo=UTC)
        self._last = None

    def _clock(self, text: str) -> float:
        """Read hhmmss.ss [s since 1970]; after midnight the next day has come."""
        hours, minutes, seconds = int(text[:2]), int(text[2:4]), float(text[4:])
        time = self._day.timestamp() + 3600 * hours + 60 * minutes + seconds
        if self._last is not None and time < self._last - _HALF_DAY:
            self._day += timedelta(days=1)
            time += 2 * _HALF_DAY
        self._last = time
        return time


def _angle(text: str, side: str) -> float:
    """Read ddmm.mmmm [degrees]."""
    point = text.index(".") if "." in text else len(text)
    value = float(text[: point - 2]) + float(text[point - 2 :]) / 60
    return -value if side in ("S", "W") else value
