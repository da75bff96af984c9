"""The page on which a model is turned, cut and measured: one file, which needs no network."""

import base64
from collections.abc import Sequence
from functools import lru_cache
from importlib.resources import files
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined, Template
from markupsafe import Markup

from ..errors import InputError, NotEnoughData
from ..types.arrays import Indices, Scalars
from ..types.georeference import Georeference
from ..types.mesh import used_vertices
from .depth import Depth
from .model import Layer, Model
from .packing import pack, pack_directions, pack_moves, pack_positions, pack_values
from .shift_field import ShiftField

_KNOTS = 500
"""Profiles at which the errors of poses are kept: some hundreds of kilobytes."""
_SHARE = 1.0
"""Percent of a layer's values at each end that may lie beyond the colours."""
_DEPTH_MAP = "viridis_r"


def render_viewer(
    models: Sequence[Model], *, title: str, pictures: str = "", relation: str = ""
) -> str:
    """Make the page.

    Args:
        models: What it shows; of two or more, which lie in one world frame, one at a time.
        title: Its name, such as the recording's.
        pictures: Address of the page with the pictures, relative to this one; empty for none.
        relation: How several models lie to one another, in a sentence.

    Returns:
        The whole document, with all data in it. Text from outside is escaped.

    Raises:
        NotEnoughData: There is no model, or one without vertices.
        InputError: A vertex is not finite.
    """
    for model in models:
        _check(model)
    if not models:
        raise NotEnoughData("There is nothing to show: give one model or more.")
    maps = {_DEPTH_MAP} | {layer.colour_map for model in models for layer in model.layers}
    packed = [_pack_model(model) for model in models]
    _share_ranges([about for about, _ in packed])
    content = {
        "title": title,
        "pictures": pictures,
        "relation": relation,
        "maps": {name: _as_texture(name) for name in sorted(maps)},
        "models": [about for about, _ in packed],
    }
    assets = files("murkscan.view") / "viewer"
    return _template().render(
        title=title,
        content=content,
        blobs=[blobs for _, blobs in packed],
        style=Markup((assets / "viewer.css").read_text("utf-8")),
        script=Markup((assets / "viewer.js").read_text("utf-8")),
    )


@lru_cache(maxsize=1)
def _template() -> Template:
    environment = Environment(
        loader=PackageLoader("murkscan.view", "viewer"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.policies["json.dumps_kwargs"] = {"sort_keys": False, "allow_nan": False}
    return environment.get_template("viewer.html")


def _check(model: Model) -> None:
    if len(model.vertices) == 0:
        raise NotEnoughData(f"There is nothing to show of {model.name}: it has no points.")
    places = np.concatenate([model.vertices, model.surface], axis=1)
    broken = len(places) - int(np.isfinite(places).all(axis=1).sum())
    if broken:
        raise InputError(
            f"{broken} of {len(model.vertices)} points of {model.name} are not finite; leave them "
            "out."
        )


def _pack_model(model: Model) -> tuple[dict[str, Any], dict[str, str]]:
    """Give what the page must know of a model, and its arrays as texts by name."""
    unknown = np.zeros(len(model.vertices))
    sigma = next((1e-3 * one.values for one in model.layers if one.name == "sigma"), unknown)
    positions = pack_positions(model.vertices, sigma)
    blobs = {
        "positions": positions.text,
        "normals": pack_directions(model.normals),
        "faces": pack(model.faces, 4),
        "moments": pack(model.moments[:, None], 4),
    }
    moves = pack_moves(model.vertices, model.surface, positions)
    if moves is not None:
        blobs["moves"] = moves[0]
    layers, typical = [_about_depth(model)], _typical(model)
    for number, layer in enumerate(model.layers):
        blobs[f"layer{number}"], low, step = pack_values(layer.values)
        layers.append(_about(layer, typical) | {"blob": f"layer{number}", "low": low, "step": step})
    about = {
        "name": model.name,
        "note": model.note,
        "vertices": len(model.vertices),
        "measured": model.num_measured,
        "faces": len(model.faces),
        "positions": positions.as_plain(),
        "moves": None if moves is None else moves[1],
        "spacing": model.spacing,
        "layers": layers,
        "times": _rounded(model.times, 6),
        "timed": model.is_timed,
        "path": _rounded(model.path - np.array(positions.low), 6),
        "attitudes": _rounded(model.attitudes, 9),
        "shifts": _about_shifts(model.shift_field),
        "poseErrors": _about_pose_errors(model.pose_errors),
        "sharing": _name_shared(model),
        "place": _about_place(model.place),
        "views": {view.name: _rounded(view.view_from_world, 9) for view in model.views},
    }
    return about, blobs


def _share_ranges(models: Sequence[dict[str, Any]]) -> None:
    """Give layers of one name the same colours in all models, so that they can be compared."""
    for name in {layer["name"] for model in models for layer in model["layers"]}:
        same = [one for model in models for one in model["layers"] if one["name"] == name]
        lows, highs = zip(*(one["range"] for one in same), strict=True)
        for one in same:
            one["range"] = [min(lows), max(highs)]


def _about_shifts(field: ShiftField | None) -> dict[str, Any] | None:
    if field is None:
        return None
    return {
        "centre": field.centre.tolist(),
        "scale": field.scale,
        "powers": field.powers.tolist(),
        "coefficients": _rounded(field.coefficients, 9),
    }


def _about_place(place: Georeference | None) -> dict[str, Any] | None:
    if place is None:
        return None
    hull = place.hull
    return {
        "rotation": place.ground_from_model.rotation.tolist(),
        "translation": place.ground_from_model.translation.tolist(),
        "scale": place.scale,
        "origin": place.origin.tolist(),
        "hull": None
        if hull is None
        else {
            "spacing": hull.frame_spacing,
            "framesFrom": hull.frames_from,
            "heightsAbove": hull.heights_above,
        },
    }


def _name_shared(model: Model) -> str:
    """Say whose errors a distance's shared part is made of."""
    if model.shift_field is not None and model.pose_errors is not None:
        return "The part of calibration and motion in it"
    if model.pose_errors is not None:
        return "The motion's part of it, without the calibration's"
    return "The calibration's part of it, without the motion's"


def _about_pose_errors(errors: np.ndarray | None) -> dict[str, Any] | None:
    """Describe the errors of the poses, of long scans at every so many profiles."""
    if errors is None or errors.shape[2] == 0:
        return None
    last = len(errors) - 1
    profiles = np.unique(np.linspace(0, last, min(len(errors), _KNOTS)).astype(int))
    columns = [
        [mode, axis, _rounded(errors[profiles, axis, mode], 9)]
        for mode in range(errors.shape[2])
        for axis in range(6)
        if errors[:, axis, mode].any()
    ]
    return {"profiles": profiles.tolist(), "modes": errors.shape[2], "columns": columns}


def _about_depth(model: Model) -> dict[str, Any]:
    """Describe the layer that the page finds from the positions."""
    front = next(view for view in model.views if view.name == "front")
    x, y, z = (float(part) for part in front.view_from_world[2])
    legend = Depth((x, y, z), front.start).legend(model.vertices[_typical(model)])
    return {
        "name": "depth",
        "unit": "mm",
        "map": _DEPTH_MAP,
        "signed": False,
        "range": [legend.low, legend.high] if legend else [0.0, 1.0],
        "start": front.start,
    }


def _typical(model: Model) -> Indices:
    """Give the vertices that decide on the colours: stray points are on no surface."""
    return used_vertices(model.faces) if len(model.faces) else np.arange(len(model.vertices))


def _about(layer: Layer, typical: Indices) -> dict[str, Any]:
    return {
        "name": layer.name,
        "unit": layer.unit,
        "map": layer.colour_map,
        "signed": layer.is_signed,
        "range": _range(layer.values[typical], is_signed=layer.is_signed),
    }


def _range(values: Scalars, *, is_signed: bool) -> list[float]:
    """Give the values at the ends of the colours."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return [0.0, 1.0]
    low, high = (float(end) for end in np.percentile(finite, [_SHARE, 100 - _SHARE]))
    if is_signed:
        far = max(-low, high, 1e-9)
        return [-far, far]
    return [low, high] if high > low else [low - 0.5, low + 0.5]


def _as_texture(name: str) -> str:
    """Give the 256 colours of a map, three bytes each, in base64."""
    import matplotlib as mpl

    colours = np.rint(mpl.colormaps[name](np.arange(256))[:, :3] * 255).astype(np.uint8)
    return base64.b64encode(colours.tobytes()).decode()


def _rounded(values: np.ndarray, digits: int) -> list[Any]:
    return np.round(values, digits).tolist()
