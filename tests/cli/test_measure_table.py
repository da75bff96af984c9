"""What a table of measures shows."""

from dataclasses import replace

from murkscan.cli.measure_part import print_measurement
from murkscan.io.rig_toml import as_tables
from murkscan.project import MOTION, MotionResult, Project
from murkscan.types.measurement import Measurement
from murkscan.types.quantity import Quantity

from ..projects import SCAN, finish
from ..scenes import air_rig


def test_what_is_set_has_no_uncertainty_to_show(tmp_path, capsys):
    quantities = (
        Quantity("radius", 0.030264, "m", 1.2e-4, 0.0),
        Quantity("y", 0.2000485, "m", 0.0, 0.0),
        Quantity("axis_y", 0.99999999, "", 1e-9, 0.0),
    )
    project = Project(tmp_path)
    project.save_scan(replace(SCAN, rig=as_tables(air_rig())))
    finish(project, MOTION, MotionResult(1))
    print_measurement(tmp_path, "pipe", Measurement("cylinder", quantities, {}))
    said = capsys.readouterr().out
    assert "The log of the poses states no uncertainty" in " ".join(said.split())
    rows = [line.split("│") for line in said.splitlines() if "│" in line]
    shown = {row[1].strip(): [cell.strip() for cell in row[2:-1]] for row in rows}
    assert shown["radius"] == ["30.26", "0.24", "0.12", "0.00", "mm"]
    assert shown["y"] == ["0.2000", "–", "", "", "m"]
    assert shown["axis y"] == ["1.0000", "–", "", "", ""]
