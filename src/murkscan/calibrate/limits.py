"""Which parameters photos leave open, and which go together, in plain words."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import Degenerate
from ..types.laser import Laser
from ..types.rig import Rig
from ..types.rig_covariance import RigCovariance, unit_of
from .adjust import Adjustment
from .observed import index_of

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


@dataclass(frozen=True)
class Pair:
    """Two parameters whose errors go together."""

    first: str
    second: str
    correlation: float


def refuse_open_parameters(found: Adjustment) -> None:
    """Refuse an adjustment of which a parameter is known neither beforehand nor from the photos.

    Raises:
        Degenerate: The message names the parameters, how little they are known, what they go with
            and what to do.
    """
    loose = []
    for name, sigma in zip(found.names, _sigma(found), strict=True):
        word = name.rsplit(".", 1)[-1].split("[")[0]
        unit = found.rig.camera.focal_length[0] if unit_of(name) == "px" else 1.0
        if name not in found.prior.names and sigma > _LIMITS.get(word, np.inf) * unit:
            loose.append(f"{name} is known to ± {as_read(name, sigma)} only{_partner(found, name)}")
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


def strongest_pairs(covariance: RigCovariance, count: int = 3) -> list[Pair]:
    """Give the pairs of parameters that go together most, from a correlation of 0.9 on."""
    size = np.triu(np.abs(covariance.correlation), 1)
    order = np.argsort(size, axis=None)[::-1][:count]
    pairs = []
    for i, j in zip(*np.unravel_index(order, size.shape), strict=True):
        if size[i, j] >= _TOGETHER:
            names = covariance.names
            pairs.append(Pair(names[i], names[j], float(covariance.correlation[i, j])))
    return pairs


def as_read(name: str, value: float) -> str:
    """Write a parameter's value, or its deviation, in the unit in which people read it."""
    factor, unit = _SHOWN[unit_of(name)]
    return f"{value * factor:.3g} {unit}".rstrip()


def _sigma(found: Adjustment) -> np.ndarray:
    return found.rig.covariance.select(found.names).sigma


def _partner(found: Adjustment, name: str) -> str:
    covariance = found.rig.covariance
    row = np.abs(covariance.correlation[covariance.names.index(name)])
    row[covariance.names.index(name)] = 0
    best = int(np.argmax(row))
    return f" (it goes with {covariance.names[best]})" if row[best] >= _TOGETHER else ""


def most_influential(found: Adjustment, photos: Sequence[str]) -> str:
    """Say which photo the answer hangs on most, and by how much."""
    sigma = found.rig.covariance.select(found.names).sigma
    changes = found.worth.without_photo / np.where(sigma > 0, sigma, np.inf)
    photo, column = np.unravel_index(int(np.argmax(np.abs(changes))), changes.shape)
    name = found.names[int(column)]
    return (
        f"Leaving out one photo changes most {name}: by "
        f"{as_read(name, abs(found.worth.without_photo[photo, column]))} "
        f"({abs(changes[photo, column]):.1f} σ) without {photos[int(photo)]}."
    )


def value_of(rig: Rig, name: str) -> str:
    """Write a parameter's value; a dash where a direction has none of its own."""
    if unit_of(name) == "rad" or ".shift[" in name:
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
    """Give a laser's sheet, of which its parameters are."""
    return value.sheet if isinstance(value, Laser) else value
