"""Stripes in pandas
=================

What every stage leaves is a table; pandas, Polars, DuckDB and R read it.

The scan is that of example 01; of your own, take ``folder = Path("dive")``.
"""

from importlib import import_module

import pandas as pd

folder = import_module("01_scan_a_recording").project.root

stripes = pd.read_parquet(folder / "extract" / "stripes")
print(stripes[["frame", "u", "v", "sigma", "signal", "posterior"]].head(3).to_string(index=False))

# The five frames with the weakest stripe, and how many centres each has.
frames = stripes.groupby("frame").agg(centres=("u", "size"), signal=("signal", "median"))
print(frames.nsmallest(5, "signal").to_string())

# A profile is the same centres, seen as points in the camera's frame.
points = pd.read_parquet(folder / "triangulate" / "profiles")
middle = points[points.frame == points.frame.median().astype(int)]
nearest = middle.loc[middle.z_m.idxmin()]
print(f"in frame {nearest.frame:.0f} the nearest point lies {nearest.z_m * 1e3:.1f} mm away,")
print(f"known to {nearest.sigma_m * 1e6:.0f} µm along its ray")
