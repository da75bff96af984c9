"""The simulator's pictures of murky water, against a path tracer that shares nothing with it.

A wall 0.8 m before the camera, a laser 0.3 m above it, and the same water in murkscan and in
Mitsuba 3 (`pip install 'murkscan[validate]'`).

Usage: python benchmarks/path_tracer.py [--samples N]
"""

import argparse
import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import matplotlib.pyplot as plt
import numpy as np
from harness import DOCS, Figure, skip, tell
from path_tracer_scene import (
    ALBEDO,
    BASELINE,
    FOCAL,
    HOUSING,
    LENS,
    SIZE,
    THICKNESS,
    WALL,
    describe,
    render,
)

from murkscan.optics.medium import Medium
from murkscan.optics.phase import AbstractPhase
from murkscan.optics.phase_henyey_greenstein import HenyeyGreenstein
from murkscan.optics.phase_petzold import PetzoldHarbour

LLVM = "/usr/lib/x86_64-linux-gnu/libLLVM.so.19.1"
"""Where Debian puts the library that makes Mitsuba ten times faster."""
SCATTERED = 0.83
DEPTH = 60
"""Scatterings after which a path ends."""
PHASES: dict[str, AbstractPhase] = {
    "Petzold": PetzoldHarbour(),
    "Henyey-Greenstein 0.9": HenyeyGreenstein(0.9),
}
PEAKED = 4
"""More paths for a sharp phase function, at whose peak a path tracer sparkles."""
ATTENUATIONS = (1.5, 3.0, 5.0)
EDGES = np.array([0, 2, 5, 8, 11, 14, 18, 23, 29, 36, 45, 56, 70, 88, 120])
"""Distances from the stripe [px] between which rows are averaged: fine where the profile is steep,
wide where it is smooth and the path tracer noisy."""


@dataclass(frozen=True)
class Traced:
    """Passes of the path tracer over one scene."""

    passes: np.ndarray
    """One picture a pass."""

    @property
    def picture(self) -> np.ndarray:
        """The mean of all."""
        return self.passes.mean(axis=0)

    @property
    def doubt(self) -> np.ndarray:
        """Standard error of the profile, as a share of it."""
        profiles = np.array([profile_of(one) for one in self.passes])
        return profiles.std(axis=0, ddof=1) / np.sqrt(len(profiles)) / profiles.mean(axis=0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--samples", type=int, default=1024, help="paths a pixel")
    samples = parser.parse_args().samples
    mitsuba = import_mitsuba()
    clear = trace(mitsuba, None, samples=64).mean(axis=0)
    unit = render(None).sum() / clear.sum()
    figures = [measure_clear(clear * unit), *measure_single(mitsuba, unit, samples)]
    figures += measure_full(mitsuba, unit, samples)
    tell(
        "path_tracer",
        "The simulator against a path tracer",
        figures,
        note=f"{NOTE}\n\n{PICTURES}".format(samples=samples),
    )


NOTE = f"""\
Mitsuba 3's volumetric path tracer (`prbvolpath`: the transmittance towards the laser in closed
form, where `volpath` draws it by chance), {{samples}} paths a pixel, for Petzold {PEAKED} times as
many, draws what murkscan draws:
{SIZE[0]} × {SIZE[1]} px, f = {FOCAL:g} px, a laser {BASELINE:g} m above the camera behind an
index-matched dome of {HOUSING:g} m, its sheet 1σ = {THICKNESS * FOCAL:.1f} px thick and crossing
the axis at a wall of albedo {ALBEDO:g} at {WALL:g} m; b/c {SCATTERED:g}. One factor, from the
picture in clear water, makes the units of both the same; nothing else is fitted. Profiles are the
mean of all columns, in bands of {EDGES[1]} to {EDGES[-1] - EDGES[-2]} rows that widen away from
the stripe. *Off* is murkscan / Mitsuba - 1 in the worst band of those that carry more than 1 % of
the profile's peak, on either side of the stripe; *doubt* is the path tracer's own standard error,
the mean of those bands. Petzold's table goes to Mitsuba in 8192 steps of the cosine, so what is
scattered by less than 1.3°, the width of the stripe, is spread evenly over that angle."""
PICTURES = """\
Above Mitsuba, below murkscan, c = 1.5, 3 and 5 /m, Henyey-Greenstein 0.9, each as bright as its
brightest rows, as the square root of the light so that the skirt is seen. The sparkle is the path
tracer's own noise.

![Both pictures side by side](path_tracer.png)

![Profiles](path_tracer_profiles.png)"""


def import_mitsuba() -> Any:
    """Give the path tracer in its fastest variant that works here."""
    if Path(LLVM).exists():
        os.environ.setdefault("DRJIT_LIBLLVM_PATH", LLVM)
    try:
        import mitsuba
    except ImportError:
        skip("path_tracer", "mitsuba is not installed; pip install 'murkscan[validate]'")
    mitsuba.set_variant("llvm_ad_mono" if "DRJIT_LIBLLVM_PATH" in os.environ else "scalar_rgb")
    return mitsuba


def measure_clear(clear: np.ndarray) -> Figure:
    """Compare the stripe without water: what is left is geometry."""
    ours, theirs = profile_of(render(None)), profile_of(clear)
    return Figure("clear water: off", worst(ours, theirs), "%")


def measure_single(mitsuba: Any, unit: float, samples: int) -> Iterator[Figure]:
    """Compare glow and stripe, each the sum of its rows, where light is scattered once at most."""
    for name, phase in PHASES.items():
        for attenuation in ATTENUATIONS:
            medium = Medium(attenuation, SCATTERED, phase)
            theirs = trace(mitsuba, medium, samples=samples // 4, depth=2)
            ours = render(medium, forward_scattering=False).mean(axis=1)
            rows = theirs.mean(axis=(0, 2)) * unit
            stripe = np.abs(np.arange(SIZE[1]) - (SIZE[1] - 1) / 2) < 5 * THICKNESS * FOCAL
            above = ~stripe & (np.arange(SIZE[1]) < SIZE[1] / 2)
            ratio = ours[above].sum() / ours[stripe].sum()
            of_it = rows[above].sum() / rows[stripe].sum()
            title = f"single scattering, {name}, c = {attenuation:g} /m: glow/stripe"
            yield Figure(title, ratio)
            yield Figure(f"{title}, off", 100 * abs(ratio / of_it - 1), "%", at_most=10)


def measure_full(mitsuba: Any, unit: float, samples: int) -> Iterator[Figure]:
    """Compare profiles with all scatterings, and draw both."""
    pairs, profiles = [], []
    for name, phase in PHASES.items():
        for attenuation in ATTENUATIONS:
            medium = Medium(attenuation, SCATTERED, phase)
            paths = samples * (1 if isinstance(phase, HenyeyGreenstein) else PEAKED)
            traced = Traced(trace(mitsuba, medium, samples=paths) * unit)
            ours = render(medium)
            theirs = traced.picture
            rows, of_it = profile_of(ours), profile_of(theirs)
            kept = of_it > 0.01 * of_it.max()
            title = f"{name}, c = {attenuation:g} /m"
            yield Figure(f"{title}: off", worst(rows, of_it), "%", at_most=25)
            rms = np.sqrt(np.mean((rows[kept] / of_it[kept] - 1) ** 2))
            yield Figure(f"{title}: off, RMS", 100 * float(rms), "%")
            yield Figure(f"{title}: doubt", 100 * float(traced.doubt[kept].mean()), "%")
            profiles.append((title, rows, of_it))
            if isinstance(phase, HenyeyGreenstein):
                pairs.append((theirs, ours))
    draw_pictures(pairs)
    draw_profiles(profiles)


def profile_of(picture: np.ndarray) -> np.ndarray:
    """Give the mean of all columns, averaged over bands of rows from top to bottom."""
    rows = picture.mean(axis=1)
    edges = SIZE[1] // 2 + np.concatenate([-EDGES[:0:-1], EDGES])
    return np.add.reduceat(rows, edges[:-1]) / np.diff(edges)


def worst(ours: np.ndarray, theirs: np.ndarray) -> float:
    """Give the largest difference [%] where the profile carries more than 1 % of its peak."""
    kept = theirs > 0.01 * theirs.max()
    return 100 * float(np.abs(ours[kept] / theirs[kept] - 1).max())


def trace(mitsuba: Any, medium: Medium | None, *, samples: int, depth: int = DEPTH) -> np.ndarray:
    """Draw the scene with Mitsuba: some passes of radiance, in a unit of its own."""
    scene = mitsuba.load_dict(describe(mitsuba, medium, depth))
    count = min(32, max(2, samples // 16))
    passes = [
        np.array(mitsuba.render(scene, spp=samples // count, seed=number))[:, :, 0]
        for number in range(count)
    ]
    return np.array([cv2.GaussianBlur(one.astype(float), (0, 0), LENS) for one in passes])


def draw_pictures(pairs: list[tuple[np.ndarray, np.ndarray]]) -> None:
    """Write both renderers' pictures side by side, one water a column."""
    columns = []
    for theirs, ours in pairs:
        scale = profile_of(theirs).max()
        shown = np.sqrt(np.clip(np.concatenate([theirs, ours]) / scale, 0, 1))
        columns.append(np.pad(shown, 2, constant_values=1.0))
    sheet = np.rint(255 * np.hstack(columns)).astype(np.uint8)
    sheet = cv2.resize(sheet, None, fx=2 / 3, fy=2 / 3, interpolation=cv2.INTER_AREA)
    cv2.imwrite(str(DOCS / "path_tracer.png"), sheet, [cv2.IMWRITE_PNG_COMPRESSION, 9])


def draw_profiles(profiles: list[tuple[str, np.ndarray, np.ndarray]]) -> None:
    """Plot the profiles of both renderers."""
    edges = np.concatenate([-EDGES[:0:-1], EDGES])
    middles = (edges[1:] + edges[:-1]) / 2
    figure, axes = plt.subplots(2, 3, figsize=(10, 5.5), sharex=True, layout="constrained")
    for axis, (title, ours, theirs) in zip(axes.flat, profiles, strict=True):
        axis.semilogy(middles, theirs / theirs.max(), "o-", color="0.6", ms=4, label="Mitsuba")
        axis.semilogy(middles, ours / theirs.max(), color="C0", lw=1.2, label="murkscan")
        axis.axhline(0.01, color="0.8", lw=0.8)
        axis.set(title=title, ylim=(3e-3, 1.6))
    axes[0, 0].legend()
    for axis in axes[1]:
        axis.set_xlabel("below the stripe [px]")
    for axis in axes[:, 0]:
        axis.set_ylabel("light / peak")
    figure.savefig(DOCS / "path_tracer_profiles.png", dpi=90)
    plt.close(figure)


if __name__ == "__main__":
    main()
