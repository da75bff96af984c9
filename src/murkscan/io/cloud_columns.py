"""A cloud as columns with the names that every format gives them, and what others call them."""

from collections.abc import Mapping

import numpy as np

from ..types.cloud import PointCloud

COLUMNS = np.dtype(
    [(name, "<f8") for name in ("x", "y", "z")]
    + [(name, "<f4") for name in ("nx", "ny", "nz")]
    + [(name, "<f4") for name in ("signal", "posterior", "sigma", "sigma_common")]
    + [
        ("frame", "<i4"),
        ("scan_line", "<i4"),
        ("laser", "u1"),
        ("branch", "u1"),
        ("reflectance", "<f4"),
    ]
)
"""The columns of cloud.ply, in order."""
SCALARS = (
    "signal", "posterior", "sigma", "sigma_common", "frame", "scan_line", "laser", "branch",
    "reflectance",
)  # fmt: skip
"""Those that are no coordinates; named as the fields of a cloud."""
ADDED = ("reflectance",)
"""Columns that clouds of earlier versions lack."""
BLOCK = 500_000
"""Points that are read or written at once."""

_OTHERS = {
    "normalx": "nx",
    "normaly": "ny",
    "normalz": "nz",
    "normal_x": "nx",
    "normal_y": "ny",
    "normal_z": "nz",
    "intensity": "signal",
}
"""What other programs call them, in small letters; `scalar_` before a name is CloudCompare's."""


def as_rows(cloud: PointCloud) -> np.ndarray:
    """Give a cloud as rows of `COLUMNS`."""
    rows = np.empty(len(cloud), COLUMNS)
    for axis, name in enumerate("xyz"):
        rows[name] = cloud.points[:, axis]
        rows["n" + name] = cloud.normals[:, axis]
    for name in SCALARS:
        rows[name] = getattr(cloud, name)
    return rows


def known_name(name: str) -> str | None:
    """Give our name of a column that a file names; None where it is no column of a cloud."""
    name = name.strip().lower().removeprefix("scalar_")
    name = _OTHERS.get(name, name)
    return name if name in (COLUMNS.names or ()) else None


def from_columns(columns: Mapping[str, np.ndarray]) -> PointCloud:
    """Make a cloud of columns by our names, of which x, y and z must be there.

    What is missing says nothing: no normals, signal 0, posterior 1, no sigma, frame 0, branch 0,
    reflectance 0.
    """
    count = len(columns["x"])

    def column(name: str) -> np.ndarray:
        missing = 1 if name == "posterior" else 0
        values = columns.get(name)
        if values is None:
            return np.full(count, missing, COLUMNS[name])
        return _convert(np.asarray(values), COLUMNS[name])

    return PointCloud(
        points=np.stack([column(name) for name in "xyz"], axis=1),
        normals=np.stack([column("n" + name) for name in "xyz"], axis=1),
        **{name: column(name) for name in SCALARS},
    )


def _convert(values: np.ndarray, dtype: np.dtype[np.generic]) -> np.ndarray:
    """Give values in another type; whole numbers that do not fit are 0."""
    if dtype.kind == "f":
        with np.errstate(over="ignore"):
            return np.ascontiguousarray(values, dtype)
    limits = np.iinfo(dtype)  # type: ignore[type-var]
    fits = (values >= limits.min) & (values <= limits.max)
    return np.where(fits, values, 0).astype(dtype)
