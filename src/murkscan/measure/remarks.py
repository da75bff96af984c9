"""When a number means little: what is odd about it, and what to do, in sentences."""

import numpy as np

from ..geometry.shape import AnyShape
from ..geometry.shape_fit import ShapeFit
from ..types.arrays import Points, Scalars
from ..types.deviation import Deviation
from .sample import Sample

_PART = "--near-m and --within-mm or --box-m"
_NO_SHAPE = 3.0
"""Scatter about a shape, in that of points about their neighbours, from which it is none: those of
planes, balls and pipes in murk reach 1.5."""
_MOST = 0.8
"""Share of the points on a plane below which others may be meant."""
_MOST_ASTRAY = 0.05
"""Share of a scan that may depart from its smooth surface by as much as no dent does: a few dents
take up a percent or two."""
_NO_DENT = 0.1
"""Depth over the width of the widest dent from which a departure is none."""


def remark_on_fit(kind: str, fit: ShapeFit[AnyShape], sample: Sample) -> tuple[str, ...]:
    """Say whether points scatter about a shape as if they were not of it.

    Args:
        kind: What was fitted: plane, sphere, cylinder.
        fit: The fit to the sample's points.
        sample: The points.
    """
    share = float(np.mean(fit.inliers))
    if kind == "plane" and share < _MOST:
        return (
            f"Only {share:.0%} of the {len(sample):,} points lie on this plane, and the others "
            f"were left out. Choose the part that is meant with {_PART}.",
        )
    noise = sample.usual_noise
    if not fit.rms > _NO_SHAPE * noise:
        return ()
    return (
        f"This part of the scan is no {kind}: its points lie {1e3 * fit.rms:.2g} mm (rms) off it, "
        f"{fit.rms / max(noise, 1e-9):.0f} times as far as off their own neighbours, so that the "
        f"numbers mean little. Choose a part of one shape with {_PART}, or measure it with section "
        "or deviation.",
    )


def remark_on_ends(asked: Points, found: Points, half_width: float) -> tuple[str, ...]:
    """Say whether a distance was taken between other places than those asked for.

    Args:
        asked: The two places [m].
        found: The points of the scan that were taken instead [m].
        half_width: Half the interval of the distance, which does not know of it [m].
    """
    moved = np.linalg.norm(found - asked, axis=1)
    if not moved.max() > half_width:
        return ()
    near, far = (1e3 * moved).tolist()
    first, second = (",".join(f"{part:.4f}" for part in point) for point in found.tolist())
    return (
        f"This is the distance from {first} to {second} m, the scan's nearest points: {near:.2f} "
        f"and {far:.2f} mm from the places asked for, which ±95% does not hold. Give places that "
        "are points of cloud/cloud.ply, or pick them on view/index.html.",
    )


def remark_on_smooth(sample: Sample, deviation: Deviation, largest: float) -> tuple[str, ...]:
    """Say whether a scan is too unlike its own smooth surface for dents to be looked for so.

    Args:
        sample: The scan's points.
        deviation: Their distances from the smooth surface.
        largest: Width of the largest dent looked for [m].
    """
    off: Scalars = np.abs(deviation.values[np.isfinite(deviation.values)])
    astray = float(np.mean(off > _NO_DENT * largest)) if len(off) else 0.0
    if not astray > _MOST_ASTRAY:
        return ()
    return (
        f"{astray:.0%} of the {len(sample):,} points lie more than "
        f"{1e3 * _NO_DENT * largest:.0f} mm off the smooth surface through the scan: keels, edges "
        "or what stands behind, beside which dents are missed or made up. Choose a part without "
        f"them with {_PART}, or give the drawing with --reference.",
    )
