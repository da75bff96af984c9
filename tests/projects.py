"""Folders of scans of which only some stages are there."""

import time
from collections.abc import Callable, Mapping
from typing import Any

from murkscan.project import Kind, Project, RecordingRecord, ScanRecord, Stage
from murkscan.types.cloud_part import CloudPart

RECORDING = RecordingRecord("dive.mkv", "1", (640, 480), is_timed=True, fields_per_picture=1)
SCAN = ScanRecord(versions={}, recording=RECORDING, rig={})
MERGED = ScanRecord(versions={}, recording=None, rig={})


def finish(
    project: Project,
    kind: Kind[Any],
    result: Any,
    *,
    inputs: Mapping[str, Any] | None = None,
    make: Callable[[], object] = lambda: None,
    label: str = "",
) -> Stage[Any]:
    """Finish a stage with a result and with the files that `make` saves."""
    stage = project.stage(kind, settings={}, inputs=inputs or {}, label=label)
    stage.begin()
    make()
    stage.finish(result, since=time.monotonic())
    return stage


def save_cloud(project: Project, cloud: Any) -> None:
    project.save_cloud_part(0, CloudPart.whole(cloud))
    project.export_cloud(frames=False)
