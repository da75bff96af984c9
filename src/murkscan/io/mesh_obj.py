"""Meshes as OBJ files, and what of one a library is given to read."""

import io
import re
from pathlib import Path

import numpy as np

from ..errors import FormatError
from ..types.mesh import Mesh

_GEOMETRY = re.compile(rb"^[vf][ \t].*$", re.MULTILINE)
"""Lines that place corners and triangles; the others name groups and materials."""
_EXTRAS = re.compile(rb"/\S*")
"""What a corner of a face says beside its vertex: texture and normal."""
_RELATIVE = re.compile(rb"^f[ \t].*-", re.MULTILINE)
"""A face whose corners count backwards from the last vertex before it."""
_NO_CORNER = re.compile(rb"^f[ \t](?:.*[ \t])?[-+]?0+(?=[ \t]|$)", re.MULTILINE)


def as_obj(mesh: Mesh) -> bytes:
    """Give an OBJ file: vertices, with the colours that most programs read behind them, and faces.

    Positions are written to a tenth of a micrometre.
    """
    text = io.BytesIO(b"")
    text.write(b"# murkscan: metres\n")
    columns, form = mesh.vertices, "v %.7f %.7f %.7f"
    if mesh.colours is not None:
        columns, form = np.column_stack([columns, mesh.colours / 255]), form + " %.4f %.4f %.4f"
    np.savetxt(text, columns, form)
    np.savetxt(text, mesh.faces + 1, "f %d %d %d")
    return text.getvalue()


def only_geometry(path: Path, data: bytes) -> bytes:
    """Give an OBJ file without all that is no triangle: materials, groups, textures, normals.

    Thousands of materials of one triangle each would cost hours.

    Args:
        path: What errors call it.
        data: The file.

    Raises:
        FormatError: A face has the corner 0, which there is not: they count from 1.
    """
    lines = _GEOMETRY.findall(data.replace(b"\r\n", b"\n").replace(b"\\\n", b" "))
    text = _EXTRAS.sub(b"", b"\n".join(lines))
    if _RELATIVE.search(text):
        text = _count_from_start(text)
    if wrong := _NO_CORNER.search(text):
        raise FormatError(
            f"{path} has a face with the corner 0 ({wrong[0][:40].decode('ascii', 'replace')!r}), "
            "but corners count from 1; it is damaged."
        )
    return text


def _count_from_start(text: bytes) -> bytes:
    """Let corners that count backwards from the last vertex count from the first."""
    lines, count = [], 0
    for line in text.split(b"\n"):
        words = line.split()
        if words[:1] == [b"v"]:
            count += 1
        elif words and any(word.startswith(b"-") for word in words[1:]):
            line = b" ".join([b"f", *(_from_start(word, count) for word in words[1:])])
        lines.append(line)
    return b"\n".join(lines)


def _from_start(word: bytes, count: int) -> bytes:
    try:
        number = int(word)
    except ValueError:
        return word
    return word if number >= 0 else b"%d" % (count + 1 + number)
