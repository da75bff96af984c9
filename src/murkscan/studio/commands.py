"""What a page may have done: commands and flags by name, and how they are typed.

The commands themselves judge values; here it is held that no path leaves the folder and that
nothing but these flags is given.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from shlex import quote
from typing import Any, Literal

from ..errors import InputError
from .sandbox import Sandbox

Kind = Literal["text", "switch", "in", "out", "in or text"]
"""A value as it is, a flag without one, a path that is there, one that may be made, or either."""
_ADDRESS = re.compile(r"(udp|rtp|rtsps?|tcp|srt|https?)://\S+|/dev/video\d+|\d+")
"""A stream or a camera: all that is no file."""
_LONGEST = 2000
"""Letters of a value."""


@dataclass(frozen=True)
class Command:
    """A command as it runs in the folder."""

    words: tuple[str, ...]
    """What follows `murkscan`."""
    page: str
    """The page that asks for it."""
    out: str = ""
    """The folder that it works in, within the studio's."""

    @property
    def text(self) -> str:
        """The line that does the same when it is typed in the folder."""
        return " ".join(["murkscan", *map(quote, self.words)])


@dataclass(frozen=True)
class _Form:
    """What a command takes."""

    places: Mapping[str, Kind]
    """Arguments without a flag, in order."""
    flags: Mapping[str, Kind]
    middle: str = ""
    """A word between the first argument and the flags, as `measure OUT sphere` has."""


_TEXT: Kind = "text"


def _flags(words: str, kind: Kind = _TEXT) -> dict[str, Kind]:
    return dict.fromkeys(words.split(), kind)


_MOTION = _flags(
    "speed-mm-s step-mm along speed-sigma-percent start-time time-offset-s gap-s crs log-time "
    "log-quaternion log-axes log-angles"
) | _flags("poses navigation", "in")  # fmt: skip
_BOARD = _flags("board square-mm") | _flags("rig", "in")
_PART = _flags("near-m within-mm box-m name")
_NEW_RIG = _flags("rig", "out")

FORMS: dict[str, _Form] = {
    "calibrate board": _Form({"out": "out"}, _flags("board square-mm")),
    "calibrate describe": _Form(
        {},
        _NEW_RIG | _flags(
            "size-px view-deg baseline-mm angle-deg axis window-mm dome-radius-mm glass-mm "
            "glass-index temperature-c salinity-psu wavelength-nm"
        ),
    ),
    "calibrate photograph": _Form(
        {"source": "in or text", "folder": "out"}, _flags("board boards wavelength-nm timeout-s")
    ),
    "calibrate camera": _Form(
        {"images": "in"},
        _flags("board square-mm charuco-marker-mm charuco-dictionary wavelength-nm") | _NEW_RIG,
    ),
    "calibrate port": _Form({"images": "in"}, _BOARD | _flags("distance-mm index camera")),
    "calibrate laser": _Form({"images": "in"}, _BOARD | _flags("kind margin-mm laser extractor")),
    "calibrate mount": _Form(
        {"images": "in"},
        _BOARD | _flags("poses", "in") | _flags("fps start-time time-offset-s measured-mm"),
    ),
    "calibrate check": _Form(
        {"source": "in"}, _BOARD | _flags("margin-mm laser length-mm length-sigma-mm from-m to-m")
    ),
    "capture": _Form({"source": "in or text", "out": "out"}, _flags("seconds timeout-s")),
    "live": _Form(
        {"source": "in or text"},
        _flags("rig", "in") | _flags("out", "out") | _flags("spacing-mm") | _MOTION
        | _flags("mavlink extractor laser"),
    ),
    "scan": _Form(
        {"recording": "in"},
        _flags("rig", "in") | _flags("out", "out") | _MOTION
        | _flags("fps fields topic extractor mesher laser volume-m")
        | _flags("no-navigation", "switch"),
    ),
    "plan": _Form(
        {},
        _flags("rig", "in") | _flags("out", "out") | _flags("interlaced", "switch")
        | _flags(
            "attenuation-per-m visibility-m secchi-m from-m to-m spacing-mm frame-rate-hz albedo "
            "power-mw exposure-ms f-number daylight-w-m2 longest-baseline-mm laser baseline-mm "
            "angle-deg"
        ),
    ),
    "merge": _Form(
        {"first": "in", "second": "in", "third": "in", "fourth": "in"},
        _flags("out", "out") | _flags("as-logged", "switch") | _flags("voxel-mm reach-mm"),
    ),
    "cloud": _Form({"out": "in"}, _flags("export", "out")),
    "mesh": _Form({"out": "in"}, _flags("mesher close-holes-mm faces colour")),
    "view": _Form({"out": "in"}, _flags("with", "in") | _flags("title deviation")),
    "report": _Form({"out": "in"}, _flags("spacing-mm title client place")),
    "accept": _Form({"out": "in"}, _flags("test", "in")),
    "georeference": _Form({"out": "in"}, _flags("control", "in") | _flags("crs")),
    "check": _Form({"out": "in"}, {}),
    **{
        f"measure {kind}": _Form({"out": "in"}, flags, kind)
        for kind, flags in {
            "distance": _flags("from-m to-m name"),
            "section": _flags("point-m normal formats name"),
            "plane": _PART,
            "sphere": _PART,
            "cylinder": _PART,
            "step": _flags("first-m second-m within-mm name"),
            "area": _PART,
            "volume": _PART | _flags("point-m normal base-near-m base-within-mm"),
            "deviation": _PART | _flags("reference", "in") | _flags("unit reach-mm"),
            "dents": _PART | _flags("reference", "in")
            | _flags("unit smallest-mm largest-mm least-depth-mm"),
        }.items()
    },
}  # fmt: skip
"""Commands by name; each flag is one that the command has (a test compares)."""


def make_command(
    sandbox: Sandbox, name: str, values: Mapping[str, Any], *, page: str = ""
) -> Command:
    """Make the command that a page asks for.

    Args:
        sandbox: The folder.
        name: The command's, such as `calibrate camera`.
        values: Its arguments and flags by name; what is empty is left out.
        page: The page that asks.

    Raises:
        InputError: It is none of the studio's, or a path is not in the folder.
    """
    form = FORMS.get(name)
    if form is None:
        raise InputError(f"{name!r} is not one of the studio's commands.")
    unknown = set(values) - set(form.places) - set(form.flags)
    if unknown:
        raise InputError(f"`murkscan {name}` has no {sorted(unknown)[0]!r} here.")
    given = {key: _read(key, value) for key, value in values.items()}
    places = [
        _place(sandbox, kind, given[key]) for key, kind in form.places.items() if given.get(key)
    ]
    flags = list[str]()
    for key, kind in form.flags.items():
        if given.get(key):
            flags += _flag(sandbox, key, kind, given[key])
    words = ["measure", *places, form.middle] if form.middle else [*name.split(), *places]
    return Command((*words, *flags), page, given.get("out") or given.get("folder", ""))


def _read(key: str, value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else ""
    if not isinstance(value, str | int | float):
        raise InputError(f"{key} must be a number or a line of text.")
    text = str(value).strip()
    if len(text) > _LONGEST or any(ord(letter) < 32 for letter in text):
        raise InputError(f"{key} must be one line of text of at most {_LONGEST} letters.")
    return text


def _flag(sandbox: Sandbox, key: str, kind: Kind, value: str) -> list[str]:
    if kind == "switch":
        return [f"--{key}"]
    text = _place(sandbox, kind, value)
    # What begins with a hyphen would be taken for a flag, were it not joined to its own.
    return [f"--{key}={text}"] if text.startswith("-") else [f"--{key}", text]


def _place(sandbox: Sandbox, kind: Kind, value: str) -> str:
    """Write a value as the command takes it; a path such that no name is taken for a flag."""
    if kind == "text":
        return value
    if kind == "in or text":
        if _ADDRESS.fullmatch(value):
            return value
        kind = "in"
    path = sandbox.existing(value) if kind == "in" else sandbox.resolve(value)
    name = sandbox.name(path)
    return f"./{name}" if name.startswith("-") else name
