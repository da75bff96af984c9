"""From centres in scan lines to the stripe of a frame."""

import numpy as np

from ..types.arrays import Indices, Scalars
from ..types.frame import Frame
from ..types.laser import Axis
from ..types.stripe import Stripe
from .centres import Centres

_APART = 1.0
"""Centres of one scan line that are closer than this are one centre, found twice [px]."""
_FAINT = 0.25
"""Share of a brighter centre's height below which one near it is no surface of its own."""
_MOST = 256
"""Branches of a scan line that have a number."""


def assemble_stripe(
    frame: Frame,
    axis: Axis,
    laser: int,
    *,
    lines: Indices,
    centres: Scalars,
    sigma: Scalars,
    signal: Scalars,
    posterior: Scalars | None = None,
    blur_shift: Scalars | None = None,
    width: Scalars | None = None,
    shadow: float = 0.0,
) -> Stripe:
    """Order centres by scan line, number their branches, and give them in full-frame pixels.

    Args:
        frame: The frame that they were found in.
        axis: The camera axis along which the laser sits; for y, scan lines are image columns.
        laser: Number of the laser in the rig.
        lines: Scan line of each centre, in pixels of the image.
        centres: Position along the scan line [px of the image]; rows with NaN are left out.
        sigma: Standard deviation of each centre [px of the image].
        signal: Height of the stripe above its surroundings [grey levels].
        posterior: Probability of each centre; 1 unless given.
        blur_shift: How far each was put back for the lens's blur [px of the image]; 0 unless given.
        width: 1σ of the stripe, at right angles to it [px of the full frame]; 0 unless given.
        shadow: Distance from a brighter centre up to which a much fainter one is its halo or its
            speckle, and is left out [px of the image].
    """
    order = np.lexsort((-signal, lines))
    order = order[np.isfinite(centres[order])]
    branch = _number_branches(lines[order], centres[order], signal[order], shadow)
    order, branch = order[branch < _MOST], branch[branch < _MOST]
    lines, centres, n = lines[order], centres[order], len(order)
    if axis == "y":
        pixels = np.stack([lines.astype(float), frame.as_full_rows(centres)], axis=1)
    else:
        pixels = np.stack([centres, frame.as_full_rows(lines.astype(float))], axis=1)
    stretch = frame.row_step if axis == "y" else 1
    return Stripe(
        frame=np.full(n, frame.index, np.uint32),
        time=np.full(n, float(frame.time)),
        pixels=pixels,
        sigma=(sigma[order] * stretch).astype(np.float32),
        signal=signal[order].astype(np.float32),
        posterior=np.ones(n, np.float32)
        if posterior is None
        else posterior[order].astype(np.float32),
        laser=np.full(n, laser, np.uint8),
        branch=branch.astype(np.uint8),
        blur_shift=np.zeros(n, np.float32)
        if blur_shift is None
        else (blur_shift[order] * stretch).astype(np.float32),
        width=np.zeros(n, np.float32) if width is None else width[order].astype(np.float32),
    )


def assemble_centres(centres: Centres, laser: int) -> Stripe:
    """Make the stripe of one frame's centres."""
    lines = centres.lines
    stretch = lines.frame.row_step if lines.axis == "y" else 1
    return assemble_stripe(
        lines.frame,
        lines.axis,
        laser,
        lines=centres.scan_line,
        centres=lines.from_full_frame(centres.position),
        sigma=centres.sigma / stretch,
        signal=centres.signal,
        posterior=centres.posterior,
        blur_shift=centres.blur_shift / stretch,
        width=centres.width,
    )


def _number_branches(lines: Indices, centres: Scalars, signal: Scalars, shadow: float) -> Indices:
    """Count up within each scan line; what is no centre of its own gets a number out of range."""
    branch = np.zeros(len(lines), np.int64)
    kept: list[int] = []
    # Few scan lines have more than one centre: only these are looked at one by one.
    for i in np.flatnonzero(np.diff(lines, prepend=-1) == 0).tolist():
        if i < 2 or lines[i - 1] != lines[i - 2]:
            kept = [i - 1]
        apart = [abs(centres[i] - centres[other]) for other in kept]
        hidden = (
            distance < shadow and signal[i] < _FAINT * signal[other]
            for distance, other in zip(apart, kept, strict=True)
        )
        if min(apart) < _APART or any(hidden):
            branch[i] = _MOST
        else:
            branch[i] = len(kept)
            kept.append(i)
    return branch
