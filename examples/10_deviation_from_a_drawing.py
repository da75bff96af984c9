"""Deviation from a drawing
========================

How far a scan lies from what it should be, as numbers, a table and a coloured map.

The scan is that of example 01, a ball before a wall; its drawing is the simulation's true mesh. On
the command line: ``murkscan measure dive deviation --reference hull.stl --unit mm``.
"""

# sphinx_gallery_thumbnail_path = "ship/deviation.png"

from importlib import import_module

from murkscan.survey.deviation import compare_scan, load_reference

first = import_module("01_scan_a_recording")
project, drawing = first.project, first.folder / "recording" / "truth" / "mesh.ply"

# The poses put the scan into the drawing's own frame; elsewhere, `lay_on` aligns them first.
found = compare_scan(project, load_reference(drawing, unit="m"), within=0.01)
for quantity in found.quantities:
    scale, unit = (1e3, "mm") if quantity.unit == "m" else (1.0, quantity.unit)
    name = quantity.name.replace("_", " ")
    print(f"{name:24} {scale * quantity.value:9.3f} ± {scale * quantity.half_width:.3f} {unit}")
print(f"the map: {project.root / 'measure' / 'deviation.ply'}")
