"""Which parameters photos leave open, which go together, and what they are called in words."""

import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from ..errors import Degenerate, InputError
from ..optics.rig_parameters import tilt_directions
from ..types.laser import Fan, Laser
from ..types.rig import Rig
from ..types.rig_covariance import unit_of
from .adjust.log import CLOCK
from .adjust.observations import index_of
from .adjust.residuals import is_of_stand
from .adjust.solve import Adjustment

MEANING = (
    "Errors are one standard deviation, of what the calibration leaves open: of a laser, by how "
    "much all points near there are off together; of a camera or a window, by how much a flat "
    "shape comes out bent; of a mount, by how much a place is off. Told by these photos is the "
    "share of what is known of a number that comes from them, not from before. Two numbers that "
    "go together may both be off, and points be right."
)
"""What the figures of a calibration mean, for its page and the terminal."""
_LIMITS = {
    "focal_length": 0.05,
    "principal_point": 0.05,
    "distance": 5e-3,
    "centre": 5e-3,
    "shift": 5e-3,
    "normal": np.radians(2.0),
    "turn": np.radians(2.0),
    "index": 0.02,
}
"""Standard deviation from which a parameter that nothing was known of is not determined: lengths
in m, angles in rad; focal length and principal point as a share of the focal length."""
_SILENT = 0.1
"""Share of a parameter's variance beforehand below which photos tell nothing of it."""
_SHARE_MOVED = 0.05
"""Share of its variance beforehand that a direction must have lost to count as told by photos."""
_CHANCE = 4.0
"""Deviations of a chi-square number up to which it is chance."""
_TOGETHER = 0.9
"""Correlation from which two parameters are told to go together."""
_ATTRIBUTES = {"laser": "lasers", "layer": "layers", "mount": "vehicle_from_camera"}
"""Where a value has another name than the rig file's table."""
_SHOWN = {"m": (1e3, "mm"), "rad": (180 / np.pi, "degrees"), "px": (1.0, "px"), "": (1.0, "")}
"""Factor and unit in which people read a parameter."""


def refuse_open_parameters(found: Adjustment) -> None:
    """Refuse an adjustment of which a parameter is known neither beforehand nor from the photos.

    Raises:
        Degenerate: The message names the parameters, how little they are known, what they go with
            and what to do.
    """
    loose = []
    for name, sigma in zip(found.names, found.sigma, strict=True):
        word = name.rsplit(".", 1)[-1].split("[")[0]
        unit = found.rig.camera.focal_length[0] if unit_of(name) == "px" else 1.0
        if name not in found.prior.names and sigma > _LIMITS.get(word, np.inf) * unit:
            loose.append(
                f"the {describe(found.rig, name)} is known to ± {as_read(name, sigma)} only"
                f"{_partner(found, name)}"
            )
    if loose:
        raise Degenerate(
            f"The {len(found.camera_from_boards)} photos do not determine every parameter: "
            f"{'; '.join(loose)}. Give what you can measure with its deviation, such as "
            "--distance-mm 30±1, or photograph boards that are tilted more, nearer and farther, "
            "and out to the corners of the picture."
        )


def silent_parameters(found: Adjustment, wanted: tuple[str, ...]) -> list[str]:
    """Name those of the wanted parameters of which the photos tell nothing new."""
    share = dict(zip(found.names, found.worth.from_photos, strict=True))
    return [name for name in wanted if name in share and share[name] < _SILENT]


def contradicts_prior(found: Adjustment) -> bool:
    """Tell whether photos move what was known beforehand by more than both leave to chance.

    What photos add to a prior moves it by a random step, of a covariance that is the one before
    minus the one after; a longer step says that one of the two is wrong.

    References:
        Bar-Shalom, Li and Kirubarajan, Estimation with Applications to Tracking and Navigation,
        2001, section 5.4, for the test of innovations.
    """
    both = [name for name in found.names if name in found.prior.names]
    if not both:
        return False
    before, after = found.prior.select(both), found.rig.covariance.select(both)
    scale = np.outer(before.sigma, before.sigma)
    places = [found.names.index(name) for name in both]
    step = found.changes[places] / before.sigma
    shares, directions = np.linalg.eigh((before.matrix - after.matrix) / scale)
    moved = shares > _SHARE_MOVED
    surprise = np.sum((directions[:, moved].T @ step) ** 2 / shares[moved])
    count = int(moved.sum())
    return bool(surprise > count + _CHANCE * np.sqrt(2 * count))


def strongest_pairs(rig: Rig, count: int = 3) -> list[str]:
    """Say which pairs of parameters go together most, from a correlation of 0.9 on."""
    covariance = rig.covariance
    size = np.triu(np.abs(covariance.correlation), 1)
    order = np.argsort(size, axis=None)[::-1][:count]
    pairs = []
    for i, j in zip(*np.unravel_index(order, size.shape), strict=True):
        if size[i, j] >= _TOGETHER:
            names = covariance.names
            pairs.append(
                f"The {describe(rig, names[i])} and the {describe(rig, names[j])} go together: "
                f"correlation {covariance.correlation[i, j]:+.3f}."
            )
    return pairs


def as_read(name: str, value: float) -> str:
    """Write a parameter's value, or its deviation, in the unit in which people read it."""
    factor, unit = (1.0, "s") if name == CLOCK else _SHOWN[unit_of(name)]
    return f"{value * factor:.3g} {unit}".rstrip()


def _partner(found: Adjustment, name: str) -> str:
    covariance = found.rig.covariance
    row = np.abs(covariance.correlation[covariance.names.index(name)])
    row[covariance.names.index(name)] = 0
    best = int(np.argmax(row))
    return (
        f" (it goes with the {describe(found.rig, covariance.names[best])})"
        if row[best] >= _TOGETHER
        else ""
    )


def most_influential(found: Adjustment, photos: Sequence[str]) -> str:
    """Say which photo the answer hangs on most, and by how much."""
    sigma = found.sigma
    changes = found.worth.without_photo / np.where(sigma > 0, sigma, np.inf)
    photo, column = np.unravel_index(int(np.argmax(np.abs(changes))), changes.shape)
    name = found.names[int(column)]
    return (
        f"Leaving out one photo changes most the {describe(found.rig, name)}: by "
        f"{as_read(name, abs(found.worth.without_photo[photo, column]))} "
        f"({abs(changes[photo, column]):.1f} σ) without {photos[int(photo)]}."
    )


def value_of(rig: Rig, name: str) -> str:
    """Write a parameter's value; a dash where a direction has none of its own."""
    if unit_of(name) == "rad" or ".shift[" in name or is_of_stand(name):
        return "–"
    if name == "water.index":
        return f"{index_of(rig):.5f}"
    value: Any = rig
    for word, number in re.findall(r"(\w+)(?:\[(\d+)\])?", name):
        value = getattr(_inside(value), _ATTRIBUTES.get(word, word))
        value = value if not number else value[int(number)]
    unit = unit_of(name)
    if unit == "m":
        return f"{value * 1e3:.3f} mm"
    return f"{value:.2f} px" if unit == "px" else f"{value:.5f}"


def _inside(value: Any) -> Any:
    """Take a laser's sheet, of which its parameters are."""
    return value.sheet if isinstance(value, Laser) else value


def describe(rig: Rig, name: str) -> str:
    """Say what a parameter is, as an engineer would: "radial distortion k1", "lean of the sheet".

    Raises:
        InputError: There is no such parameter.
    """
    for pattern, words in _WORDS:
        found = re.fullmatch(pattern, name)
        if found is not None:
            groups = {"n": "0", "i": "0", "word": ""} | found.groupdict()
            n, i = int(groups["n"]), int(groups["i"])
            return words.format(
                n=n, i=i, word=groups["word"], axis="xyz"[i % 3], pixel="uv"[i % 2],
                distortion=_DISTORTION[i % 5], way=_WAYS[i % 3], tilt=_tilt_of_sheet(rig, n, i),
            )  # fmt: skip
    raise InputError(f"A rig has no parameter {name}.")


def _tilt_of_sheet(rig: Rig, laser: int, number: int) -> str:
    """Say whether a tilt of a sheet's normal leans the sheet, or rolls its line in the picture."""
    if laser >= len(rig.lasers):
        return "tilt"
    sheet = rig.lasers[laser].sheet
    normal = sheet.plane.normal if isinstance(sheet, Fan) else sheet.normal
    along_z = [abs(way[2]) for way in tilt_directions(normal)]
    return "lean" if along_z[number % 2] == max(along_z) else "roll"


_DISTORTION = (
    "radial distortion k1", "radial distortion k2", "tangential distortion p1",
    "tangential distortion p2", "radial distortion k3",
)  # fmt: skip
_WAYS = ("its direction", "its line", "its sheet's normal")
_I, _N = r"\[(?P<i>\d)\]", r"laser\[(?P<n>\d+)\]"
_WORDS = (
    (rf"camera\.focal_length{_I}", "focal length along {pixel}"),
    (rf"camera\.principal_point{_I}", "principal point's {pixel}"),
    (rf"camera\.distortion{_I}", "{distortion}"),
    (rf"camera\.port\.normal{_I}", "port's tilt towards {axis}"),
    (r"camera\.port\.distance", "port's distance"),
    (rf"camera\.port\.centre{_I}", "dome's centre {axis}"),
    (rf"camera\.port\.layer{_I}\.(?P<word>\w+)", "{word} of the port's layer {i}"),
    (r"camera\.port\.(?P<word>\w+)", "dome's {word}"),
    (rf"{_N}\.normal{_I}", "{tilt} of laser {n}'s sheet"),
    (rf"{_N}\.distance", "distance of laser {n}'s sheet"),
    (rf"{_N}\.shift{_I}", "place of laser {n} along {way}"),
    (rf"{_N}\.turn{_I}", "turn of laser {n} about {way}"),
    (rf"{_N}\.port\.normal{_I}", "tilt of laser {n}'s port towards {axis}"),
    (rf"{_N}\.port\.layer{_I}\.(?P<word>\w+)", "{word} of layer {i} of laser {n}'s port"),
    (rf"{_N}\.port\.centre{_I}", "centre {axis} of laser {n}'s dome"),
    (rf"{_N}\.port\.(?P<word>\w+)", "{word} of laser {n}'s port"),
    (r"water\.index", "index of the water"),
    (rf"mount\.translation{_I}", "camera's place along the vehicle's {axis}"),
    (rf"mount\.turn{_I}", "camera's turn about its own {axis}"),
    (rf"stand\.translation{_I}", "board's place along the world's {axis}"),
    (rf"stand\.turn{_I}", "board's turn about its own {axis}"),
    (r"clock\.offset", "clock's offset"),
)
"""What parameters are called, by their names' patterns."""
