"""murkscan calibrate check: measure a known length."""

from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import InputError
from ..ui.calibration_values import read_margin
from ..ui.choices import ExtractorName, make_extractor
from ..ui.values import read_numbers
from .calibrate import parse_board
from .calibrate_result import say_unused
from .progress import progress_bars
from .words import print_table, say, say_verdict

if TYPE_CHECKING:
    from ..survey.calibrate_check import BoardCheckResult, ScanCheckResult


def check(
    source: Path,
    *,
    board: str | None = None,
    square_mm: float | None = None,
    rig: Path | None = None,
    margin_mm: str | None = None,
    laser: int = 0,
    extractor: ExtractorName = "gray-gravity",
    length_mm: float | None = None,
    length_sigma_mm: float = 0.0,
    from_m: str | None = None,
    to_m: str | None = None,
) -> None:
    """Measure a known length in the scan's own water, and say whether the rig is right.

    Either on photos of a board with the laser's line across it, with --board, --square-mm and
    --rig; or between two points of a finished scan, with --length-mm, --from-m and --to-m.
    Nothing is written.

    Parameters
    ----------
    source
        A folder of photos or a video; or the folder of a scan.
    board
        Inner corners of the board, such as 9x6: where black squares touch, not squares.
    square_mm
        Known side of a square [mm].
    rig
        The rig file; its [water] is the water of the photos.
    margin_mm
        How far the flat paper runs on beyond the squares, as LEFT,RIGHT,TOP,BOTTOM [mm]; one
        square on each side unless given.
    laser
        Number of the laser, from 0.
    extractor
        The way to find the stripe.
    length_mm
        Known length between two points of the scan [mm].
    length_sigma_mm
        Its standard deviation [mm].
    from_m
        Where it begins, as X,Y,Z read off cloud.ply [m].
    to_m
        Where it ends [m].
    """
    if (source / "scan.json").exists():
        if length_mm is None or from_m is None or to_m is None:
            raise InputError(
                f"{source} is a scan: give the known length with --length-mm, and its two ends "
                "with --from-m X,Y,Z and --to-m X,Y,Z as cloud.ply has them, in metres."
            )
        _check_scan(source, length_mm, length_sigma_mm, (from_m, to_m))
        return
    if board is None or square_mm is None or rig is None:
        raise InputError(
            f"{source} is no scan, so it must be photos of a board with the line on it: give "
            "--board, --square-mm and --rig."
        )
    chessboard = parse_board(board, square_mm)
    margin = None if margin_mm is None else read_margin(margin_mm)
    from ..survey.calibrate_check import check_on_photos

    with progress_bars() as progress:
        result = check_on_photos(
            source,
            chessboard,
            rig,
            margin=margin,
            laser=laser,
            extractor=make_extractor(extractor, ()),
            progress=progress,
        )
    _print_photos(result)


def _check_scan(out: Path, length_mm: float, sigma_mm: float, ends: tuple[str, str]) -> None:
    import numpy as np

    from ..project import Project
    from ..survey.calibrate_check import check_in_scan

    places = np.array([_place(text) for text in ends])
    result = check_in_scan(Project(out), places, length_mm / 1e3, known_sigma=sigma_mm / 1e3)
    _print_scan(result)


def _place(text: str) -> list[float]:
    """Read the X,Y,Z of --from-m or --to-m [m]."""
    place = read_numbers(text, 3)
    if place is None:
        raise InputError(
            f"{text!r} is not X,Y,Z; give three numbers of metres, such as 0.12,0.5,0.803."
        )
    return place


def _print_photos(result: "BoardCheckResult") -> None:
    found = result.check
    say_verdict(str(result.verdict), result.verdict.is_good, is_usable=result.verdict.is_usable)
    rows: list[tuple[str, ...]] = [
        (name, f"{1e3 * distance:.0f}", f"{1e3 * square:.3f}", f"{square / found.known - 1:+.2%}")
        for distance, name, square in sorted(
            zip(found.distances.tolist(), found.names, found.squares.tolist(), strict=True)
        )
    ]
    print_table("Squares", ("photo", "range [mm]", "square [mm]", "off"), rows)
    common = "unknown" if found.sigma_common is None else f"{1e3 * found.sigma_common:.4f} mm"
    say(
        f"A square of {1e3 * found.known:g} mm measures {1e3 * found.measured:.4f} mm; "
        f"± {1e3 * found.sigma_independent:.4f} mm by how the photos scatter, ± {common} by the "
        "rig's covariance (1σ)."
    )
    say_unused(result.unused, used=len(found.names))


def _print_scan(result: "ScanCheckResult") -> None:
    length = result.length
    say_verdict(str(result.verdict), result.verdict.is_good)
    rows: list[tuple[str, ...]] = [
        (name, *(f"{part:.4f}" for part in end.tolist()))
        for name, end in zip(("from", "to"), result.ends, strict=True)
    ]
    print_table("Ends [m]", ("", "x", "y", "z"), rows)
    common = f"{1e3 * length.sigma_common:.3f} mm" if result.is_common_known else "unknown"
    say(
        f"Length {1e3 * length.value:.3f} mm; ± {1e3 * length.sigma_independent:.3f} mm by the "
        f"noise of its ends, ± {common} by what is stated of the rig and "
        "of the motion (1σ)."
    )
