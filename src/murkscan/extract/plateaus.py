"""Stripes that saturate the sensor: a band of white with two edges, found and measured by both."""

import numpy as np
from jaxtyping import Float

from .._kernels.plateaus import find_plateaus, measure_plateaus
from ..types.arrays import Indices, Scalars
from ..types.background import Noise
from .scan_lines import ScanLines

SHARE = 0.98
"""Share of white from which a pixel counts as saturated: encoders and sharpening leave a saturated
band rippled by a few levels of 255."""
_SHORTEST, _LONGEST = 3, 80
"""White pixels of the narrowest plateau that has no peak of its own, and of the widest stripe; more
is glare."""
_MOST = 8
"""Plateaus of a scan line."""


def measure_at(
    lines: ScanLines, scan_lines: Indices, positions: Scalars, noise: Noise
) -> Float[np.ndarray, "n 4"]:
    """Measure the plateaus that some pixels are in; see `measure_plateaus`."""
    law = noise.as_law()
    law[4] *= SHARE
    scan_lines = np.ascontiguousarray(scan_lines)  # loops are compiled anew for each layout
    return measure_plateaus(lines.levels, scan_lines, np.rint(positions), law)


def list_plateaus(lines: ScanLines, noise: Noise) -> tuple[Indices, Float[np.ndarray, "n 4"]]:
    """List the plateaus of a frame: scan line, and what `measure_plateaus` gives of each."""
    white = SHARE * noise.white
    levels = lines.levels
    if lines.has_fixed:
        # What is white by itself, as text is, shows nothing of the scene.
        levels = np.where(lines.signal > 0.5 * white, levels, 0)
    rows = np.flatnonzero(levels.max(axis=1, initial=0) >= white)
    if len(rows) == 0:
        return np.zeros(0, int), np.zeros((0, 4))
    some = levels[rows[0] : rows[-1] + 1]
    runs, counts = find_plateaus(some, white, _SHORTEST, _LONGEST, _MOST)
    line, number = np.nonzero(np.arange(_MOST) < counts[:, None])
    found = measure_at(lines, line, rows[0] + runs[line, number].mean(axis=1), noise)
    whole = np.isfinite(found[:, 0])
    return line[whole], found[whole]
