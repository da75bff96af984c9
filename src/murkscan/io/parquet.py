"""Tables of stripes, profiles and clouds: Parquet, one part a chunk of frames."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from jaxtyping import Float

from ..errors import FormatError
from ..types.cloud_part import CloudPart
from ..types.profile import Profile
from ..types.stripe import Stripe
from ..types.true_stripe import TrueStripe
from .atomic import replacing
from .cloud_columns import ADDED, COLUMNS, as_rows, from_columns

_SHOWN_AS = {"scan_line": "line"} | {axis: f"{axis}_m" for axis in "xyz"}
"""What columns of a cloud are called here, where units stand in the names."""
_ERRORS = ("x_m", "y_m", "z_m", "turn_x_rad", "turn_y_rad", "turn_z_rad")
_FIRST = ("laser", "frame", "scan_line", "branch")
_ORDER = [*_FIRST, *(name for name in COLUMNS.names or () if name not in _FIRST)]


def save_stripe(path: Path, stripe: Stripe) -> None:
    """Write stripes as columns.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    u, v = stripe.pixels.T
    columns = {"frame": stripe.frame, "time_s": stripe.time, "u": u, "v": v}
    columns |= {"sigma": stripe.sigma, "signal": stripe.signal, "posterior": stripe.posterior}
    columns |= {"laser": stripe.laser, "branch": stripe.branch, "blur_shift_px": stripe.blur_shift}
    save_columns(path, columns | {"width_px": stripe.width})


def load_stripe(path: Path) -> Stripe:
    """Read what `save_stripe` wrote.

    Raises:
        FormatError: The file is no such table.
    """
    columns = load_columns(path)
    return Stripe(
        frame=columns["frame"],
        time=columns["time_s"],
        pixels=np.stack([columns["u"], columns["v"]], axis=1),
        sigma=columns["sigma"],
        signal=columns["signal"],
        posterior=columns["posterior"],
        laser=columns["laser"],
        branch=columns["branch"],
        blur_shift=columns.of_late("blur_shift_px"),
        width=columns.of_late("width_px"),
    )


def save_profile(path: Path, profile: Profile) -> None:
    """Write profiles as columns.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    (u, v), (x, y, z) = profile.pixels.T, profile.points.T
    columns = {"frame": profile.frame, "time_s": profile.time, "laser": profile.laser}
    columns |= {"u": u, "v": v, "x_m": x, "y_m": y, "z_m": z, "sigma_m": profile.sigma}
    columns |= {"signal": profile.signal, "posterior": profile.posterior}
    columns |= {"branch": profile.branch, "blur_shift_m": profile.blur_shift}
    save_columns(path, columns | {"width_px": profile.width})


def load_profile(path: Path) -> Profile:
    """Read what `save_profile` wrote.

    Raises:
        FormatError: The file is no such table.
    """
    columns = load_columns(path)
    return Profile(
        frame=columns["frame"],
        time=columns["time_s"],
        laser=columns["laser"],
        pixels=np.stack([columns["u"], columns["v"]], axis=1),
        points=np.stack([columns["x_m"], columns["y_m"], columns["z_m"]], axis=1),
        sigma=columns["sigma_m"],
        signal=columns["signal"],
        posterior=columns["posterior"],
        branch=columns["branch"],
        blur_shift=columns.of_late("blur_shift_m"),
        width=columns.of_late("width_px"),
    )


def save_pose_errors(path: Path, errors: Float[np.ndarray, "n 6 m"]) -> None:
    """Write the independent errors of a trajectory: a row a pose, six columns an error.

    What moves no pose at all is left out of the columns: most errors are of one axis.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    columns = {
        f"{name}_{mode}": errors[:, axis, mode].astype(np.float32)
        for mode in range(errors.shape[2])
        for axis, name in enumerate(_ERRORS)
        if errors[:, axis, mode].any() or axis == 0
    }
    save_columns(path, columns)


def load_pose_errors(path: Path) -> Float[np.ndarray, "n 6 m"]:
    """Read what `save_pose_errors` wrote.

    Raises:
        FormatError: The file is no such table.
    """
    columns = load_columns(path)
    modes = sum(name.startswith(f"{_ERRORS[0]}_") for name in columns)
    errors = np.zeros((len(columns[f"{_ERRORS[0]}_0"]), len(_ERRORS), modes), np.float32)
    for mode in range(modes):
        for axis, name in enumerate(_ERRORS):
            if f"{name}_{mode}" in columns:
                errors[:, axis, mode] = columns[f"{name}_{mode}"]
    return errors


def save_cloud_part(path: Path, part: CloudPart) -> None:
    """Write a part of a cloud as columns, with the points that were taken out of it and why.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    rows = as_rows(part.cloud)
    columns = {_SHOWN_AS.get(name, name): rows[name] for name in _ORDER}
    causes = np.array(["", *part.causes])
    columns |= {"blur_shift_m": part.cloud.blur_shift, "width_px": part.cloud.width}
    save_columns(path, columns | {"taken_out": causes[part.taken_out]})


def load_cloud_part(path: Path) -> CloudPart:
    """Read what `save_cloud_part` wrote.

    Raises:
        FormatError: The file is no such table.
    """
    columns = load_columns(path)
    words, numbers = np.unique(columns["taken_out"].astype(str), return_inverse=True)
    causes = tuple(word for word in words.tolist() if word)
    taken_out = numbers + (0 if "" in words else 1)
    there = [name for name in _ORDER if name not in ADDED or name in columns]
    cloud = from_columns({name: columns[_SHOWN_AS.get(name, name)] for name in there})
    late = {"blur_shift": columns.of_late("blur_shift_m"), "width": columns.of_late("width_px")}
    cloud = replace(cloud, **late)
    return CloudPart(cloud, taken_out.astype(np.uint8), causes)


def count_rows(path: Path) -> int:
    """Count the rows of a table, without reading them.

    Raises:
        FormatError: The file is no table, or missing.
    """
    with _blaming(path):
        return int(pq.read_metadata(path).num_rows)


@contextmanager
def writing_true_stripes(path: Path) -> Iterator[Callable[[TrueStripe], None]]:
    """Write true centres as columns, part by part; points are in the world frame.

    The file appears whole when the context ends, or not at all.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    with replacing(path) as aside, ExitStack() as stack:
        writer: pq.ParquetWriter | None = None

        def write(stripe: TrueStripe) -> None:
            nonlocal writer
            table = pa.table(_columns_of_truth(stripe))
            if writer is None:
                writer = stack.enter_context(
                    pq.ParquetWriter(aside, table.schema, **_options(table))
                )
            writer.write_table(table)

        write(TrueStripe.concatenate([]))
        yield write


def load_true_stripe(path: Path) -> TrueStripe:
    """Read what `writing_true_stripes` wrote.

    Raises:
        FormatError: The file is no such table.
    """
    columns = load_columns(path)
    return TrueStripe(
        frame=columns["frame"],
        laser=columns["laser"],
        branch=columns["branch"],
        is_reflected=columns["kind"] == "reflected",
        pixels=np.stack([columns["u"], columns["v"]], axis=1),
        points=np.stack([columns["x_m"], columns["y_m"], columns["z_m"]], axis=1),
        signal=columns["signal"],
        snr=columns["snr"],
        crlb=columns["crlb_px"],
    )


def _columns_of_truth(stripe: TrueStripe) -> dict[str, np.ndarray]:
    (u, v), (x, y, z) = stripe.pixels.T, stripe.points.T
    columns = {"frame": stripe.frame, "laser": stripe.laser, "branch": stripe.branch}
    columns |= {"kind": np.where(stripe.is_reflected, "reflected", "direct")}
    columns |= {"u": u, "v": v, "x_m": x, "y_m": y, "z_m": z}
    return columns | {"signal": stripe.signal, "snr": stripe.snr, "crlb_px": stripe.crlb}


def save_columns(path: Path, columns: Mapping[str, np.ndarray]) -> None:
    """Write columns of equal length.

    Raises:
        DeviceError: The disk is full or cannot be written.
    """
    table = pa.table(dict(columns))
    with replacing(path) as aside:
        pq.write_table(table, aside, **_options(table))


def _options(table: pa.Table) -> dict[str, Any]:
    floats = [field.name for field in table.schema if pa.types.is_floating(field.type)]
    return {
        "compression": "zstd",
        "compression_level": 1,
        "use_dictionary": [name for name in table.column_names if name not in floats],
        "use_byte_stream_split": floats,
        "write_page_checksum": True,
    }


@contextmanager
def _blaming(path: Path) -> Iterator[None]:
    try:
        yield
    except (pa.ArrowInvalid, OSError) as error:
        raise FormatError(f"{path} cannot be read as a table; delete it and run again.") from error


def load_columns(path: Path) -> "Columns":
    """Read what `save_columns` wrote.

    Raises:
        FormatError: The file is no such table.
    """
    with _blaming(path):
        table = pq.read_table(path, page_checksum_verification=True)
    return Columns(
        path,
        {
            name: table[name].combine_chunks().to_numpy(zero_copy_only=False)
            for name in table.column_names
        },
    )


class Columns:
    """Columns by name; a missing one is the file's fault."""

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    def __init__(self, path: Path, columns: dict[str, np.ndarray]) -> None:
        self._path, self._columns = path, columns

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._columns:
            raise FormatError(f"{self._path} has no column {name}; delete it and run again.")
        return self._columns[name]

    def of_late(self, name: str) -> np.ndarray:
        """Give a column that tables of earlier versions lack; empty where it is missing."""
        return self._columns.get(name, np.zeros(0, np.float32))
