"""What an E57 file says before its points: pye57 writes it without a coordinate system."""

from pathlib import Path
from typing import Any
from uuid import uuid4


def open_new(pye57: Any, path: Path, wkt: str) -> Any:
    """Open an E57 file to be written.

    Args:
        pye57: The library.
        path: The file.
        wkt: Coordinate system as well-known text; empty for none.
    """

    class Placed(pye57.E57):  # type: ignore[misc]
        def write_default_header(self) -> None:
            _write_header(pye57.libe57, self.image_file, wkt)

    return Placed(str(path), mode="w")


def _write_header(lib: Any, image: Any, wkt: str) -> None:
    """Write the required children of the root (ASTM E2807, table 3), and empty lists."""
    image.extensionsAdd("", lib.E57_V1_0_URI)
    created = lib.StructureNode(image)
    created.set("dateTimeValue", lib.FloatNode(image, 0.0))
    created.set("isAtomicClockReferenced", lib.IntegerNode(image, 0))
    for name, node in {
        "formatName": lib.StringNode(image, "ASTM E57 3D Imaging Data File"),
        "guid": lib.StringNode(image, f"{{{uuid4()}}}"),
        "versionMajor": lib.IntegerNode(image, lib.E57_FORMAT_MAJOR),
        "versionMinor": lib.IntegerNode(image, lib.E57_FORMAT_MINOR),
        "e57LibraryVersion": lib.StringNode(image, lib.E57_LIBRARY_ID),
        "coordinateMetadata": lib.StringNode(image, wkt),
        "creationDateTime": created,
        "data3D": lib.VectorNode(image, True),
        "images2D": lib.VectorNode(image, True),
    }.items():
        image.root().set(name, node)
