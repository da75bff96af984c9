"""One scene for two renderers: murkscan, and Mitsuba 3's path tracer."""

from typing import Any

import numpy as np

from murkscan.optics.medium import Medium
from murkscan.optics.phase import AbstractPhase
from murkscan.optics.phase_henyey_greenstein import HenyeyGreenstein
from murkscan.simulate import Body, Light, Scene, Sensor, Simulator
from murkscan.simulate.textures import Plain
from murkscan.types.camera import Camera
from murkscan.types.laser import Fan, Laser
from murkscan.types.mesh import Mesh
from murkscan.types.port import DomePort
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory
from murkscan.types.water import Water

SIZE, FOCAL = (320, 240), 280.0
BASELINE, WALL, ALBEDO = 0.3, 0.8, 0.2
HOUSING = 0.15
"""Radius of the laser's window [m]: near its source a path tracer's error has no bound."""
THICKNESS = 0.015
"""Of the sheet, 1σ, as the tangent of an angle: 4 px."""
LENS_WINDOW = 2e-3
"""Radius of the camera's: this path tracer wants cameras outside the water [m]."""
LENS = 2.0
"""Blur of the lens, 1σ [px]; the path tracer's pictures are blurred by it afterwards."""


def render(medium: Medium | None, *, forward_scattering: bool = True) -> np.ndarray:
    """Draw the scene with murkscan: radiance without noise."""
    lean = np.array([0.0, BASELINE, WALL]) / np.hypot(BASELINE, WALL)
    dome = DomePort(np.zeros(3), HOUSING - 1e-3, 1e-3, 1.0)
    start, along = np.array([0.0, -BASELINE, 0.0]), np.array([1.0, 0.0, 0.0])
    fan = Fan(start, lean, along, np.pi / 4, dome)
    middle = ((SIZE[0] - 1) / 2, (SIZE[1] - 1) / 2)
    camera = Camera(SIZE, (FOCAL, FOCAL), middle)
    corners = np.array([[-30.0, -30, WALL], [30, -30, WALL], [30, 30, WALL], [-30, 30, WALL]])
    wall = Mesh(corners, np.array([[0, 2, 1], [0, 3, 2]]))
    scene = Scene(
        bodies=(Body(wall, Pose(np.eye(3), np.zeros(3)), Plain(ALBEDO)),),
        rig=Rig(camera, (Laser.from_sheet(fan),), water=Water(index=1.0)),
        trajectory=Trajectory(np.zeros(1), np.zeros((1, 3)), np.array([[1.0, 0.0, 0.0, 0.0]])),
        times=np.zeros(1),
        medium=medium,
        light=Light(divergence=4 * THICKNESS, waist=0.0),
        sensor=Sensor(psf=LENS, vignetting=False),
        forward_scattering=forward_scattering,
    )
    return Simulator.of(scene).draw_light(0).total.astype(float)


def describe(mitsuba: Any, medium: Medium | None, depth: int) -> dict[str, Any]:
    """Describe the scene as Mitsuba wants it: camera, projector and wall share one water."""
    turn = mitsuba.ScalarTransform4f()
    view = turn.look_at(origin=[0, 0, 0], target=[0, 0, 1], up=[0, -1, 0])
    shine = turn.look_at(origin=[0, -BASELINE, 0], target=[0, 0, WALL], up=[0, -1, 0])
    place = turn.look_at(origin=[0, 0, WALL], target=[0, 0, 0], up=[0, 1, 0])
    film = {"type": "hdrfilm", "width": SIZE[0], "height": SIZE[1], "pixel_format": "luminance"}
    field = float(np.degrees(2 * np.arctan(SIZE[0] / 2 / FOCAL)))
    paint = {"type": "diffuse", "reflectance": {"type": "rgb", "value": ALBEDO}}
    camera = {
        "type": "perspective",
        "fov": field,
        "to_world": view,
        "near_clip": 1e-3,
        "film": film | {"component_format": "float32", "rfilter": {"type": "box"}},
    }
    sheet = {"type": "bitmap", "bitmap": mitsuba.Bitmap(sheet_texture()), "raw": True}
    laser = {"type": "projector", "fov": 90.0, "to_world": shine, "irradiance": sheet}
    board = {"type": "rectangle", "to_world": place @ turn.scale([30, 30, 1]), "bsdf": paint}
    scene = {
        "type": "scene",
        "integrator": {"type": "prbvolpath", "max_depth": depth, "rr_depth": 8},
        "laser": laser,
        "wall": board,
    }
    if medium is None:
        return scene | {"camera": camera}
    water = {
        "type": "homogeneous",
        "albedo": medium.single_scattering_albedo,
        "sigma_t": medium.attenuation,
        "phase": describe_phase(medium.phase),
    }
    water = mitsuba.load_dict(water)
    window = {"type": "sphere", "bsdf": {"type": "null"}, "exterior": water}
    scene["dome"] = window | {"center": [0, -BASELINE, 0], "radius": HOUSING}
    scene["lens"] = window | {"radius": LENS_WINDOW}
    scene["wall"] = board | {"exterior": water}
    return scene | {"camera": camera}


def sheet_texture() -> np.ndarray:
    """Draw the sheet on the projector's plane: 90° wide, and of one thickness across each ray."""
    width, height = 2048, 256
    x = (np.arange(width) + 0.5) / width * 2 - 1
    y = ((np.arange(height) + 0.5) / height * 2 - 1) * height / width
    # murkscan's sheet thickens from its window on; at the wall both are the same.
    way = np.hypot(BASELINE, WALL)
    thickness = THICKNESS * (1 - HOUSING / way) * np.sqrt(1 + x**2)
    profile = np.exp(-0.5 * (y[:, None] / thickness) ** 2) / thickness
    return profile[:, :, None].astype(np.float32)


def describe_phase(phase: AbstractPhase) -> dict[str, Any]:
    """Describe a phase function as Mitsuba wants it."""
    if isinstance(phase, HenyeyGreenstein):
        return {"type": "hg", "g": phase.g}
    angle = np.concatenate([[0.0], np.geomspace(1e-7, np.pi, 100_000)])
    ring = 2 * np.pi * np.sin(angle) * phase.at_angle(angle)
    below = np.concatenate([[0.0], np.cumsum(np.diff(angle) * (ring[1:] + ring[:-1]) / 2)])
    cosine = np.linspace(-1.0, 1.0, 2**13)
    edges = np.interp(np.arccos(cosine), angle, below)
    steps = -np.diff(edges) / (2 * np.pi * (cosine[1] - cosine[0]))
    # A node is the mean of the steps beside it: so the peak keeps its light.
    nodes = np.concatenate([steps[:1], (steps[1:] + steps[:-1]) / 2, steps[-1:]])
    return {"type": "tabphase", "values": ",".join(f"{node:.7g}" for node in nodes)}
