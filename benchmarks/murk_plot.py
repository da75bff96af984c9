"""The curves: what each finder is worth against the attenuation lengths to the surface."""

from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator

RANGE = 0.9
"""Way from the camera to the middle of the hull [m]."""
STYLES = {
    "Murk": ("#000000", "o", "-"),
    "GrayGravity": ("#E69F00", "s", "--"),
    "GaussianFit": ("#56B4E9", "^", "--"),
    "Steger": ("#009E73", "v", "--"),
    "ThresholdSkeleton": ("#D55E00", "D", "--"),
    "Maximum": ("#CC79A7", "P", ":"),
    "FindPeaks": ("#0072B2", "X", ":"),
    "Oplab": ("#7F7F7F", "<", ":"),
    "RidgeDetector": ("#B8A800", ">", ":"),
}
"""Colours after Okabe and Ito, which the colour-blind can tell apart, with a marker each."""
LABELS = {
    "ThresholdSkeleton": "Otsu + thinning (the paper)",
    "Maximum": "maximum + centroid",
    "FindPeaks": "scipy find_peaks",
    "Oplab": "oplab-pipeline",
    "RidgeDetector": "ridge-detector (Steger)",
}
"""What finders are called, where not by their class."""
_PANELS = (
    ("recall", "recall of visible points", 100.0, (-3, 103)),
    ("precision", "precision", 100.0, (-3, 103)),
    ("ratio", "median |error| / bound, where found", 1.0, None),
    ("absolute", "median |error| [px], where found", 1.0, None),
)
_APART = 0.3
"""Attenuations that are nearer to each other than this have one label [1/m]."""
_BARS = {"recall": 95.0, "precision": 99.0, "ratio": 1.5}


def draw_curves(path: Path, curves: dict[str, dict[float, dict[str, float]]]) -> None:
    """Write the picture.

    Args:
        path: Where.
        curves: For each finder and attenuation [1/m] its figures.
    """
    figure, axes = plt.subplots(2, 2, figsize=(10, 8), sharex=True, layout="constrained")
    for axis, (name, title, scale, limits) in zip(axes.flat, _PANELS, strict=True):
        for finder in reversed([one for one in STYLES if one in curves]):
            _draw_line(axis, finder, curves[finder], name, scale)
        if name in _BARS:
            axis.axhline(_BARS[name], color="0.6", lw=0.8, zorder=0)
        axis.set_title(title + (" [%]" if scale == 100 else ""), loc="left", fontsize=11)
        axis.grid(alpha=0.25)
        if limits:
            axis.set_ylim(limits)
        else:
            _set_logarithmic(axis)
        _mark_attenuation(axis, curves)
    for axis in axes[1]:
        axis.set_xlabel(f"attenuation lengths to the hull, one way (c × {RANGE:g} m)")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles[::-1], labels[::-1], loc="outside lower center", ncols=3, frameon=False)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _set_logarithmic(axis: Axes) -> None:
    axis.set_yscale("log")
    axis.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.yaxis.set_major_formatter("{x:g}")
    axis.yaxis.set_minor_locator(NullLocator())


def _draw_line(
    axis: Axes, finder: str, curve: dict[float, dict[str, float]], name: str, scale: float
) -> None:
    colour, marker, style = STYLES[finder]
    waters = sorted(curve)
    is_ours = finder == "Murk"
    axis.plot(
        [c * RANGE for c in waters],
        [scale * curve[c][name] for c in waters],
        color=colour,
        marker=marker,
        ls=style,
        lw=2.4 if is_ours else 1.4,
        ms=6 if is_ours else 5,
        label=LABELS.get(finder, finder),
    )


def _mark_attenuation(axis: Axes, curves: dict[str, dict[float, dict[str, float]]]) -> None:
    """Write c itself on top."""
    waters = sorted({c for curve in curves.values() for c in curve})
    top = axis.secondary_xaxis("top", functions=(lambda x: x / RANGE, lambda c: c * RANGE))
    apart = [c for c, before in zip(waters, [-1.0, *waters], strict=False) if c - before > _APART]
    top.set_xticks(apart, [f"{c:g}" for c in apart], fontsize=8, color="0.4")
    top.tick_params(color="0.4", length=2)
    axis.annotate("c [1/m]", (1.0, 1.09), xycoords="axes fraction", ha="right", fontsize=8,
                  color="0.4")  # fmt: skip
