"""A dent of 2 mm in a ship's bottom: found, placed and measured; and none on an intact one."""

import inspect
import itertools
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import trimesh
from harness import Figure, tell
from kept import Kept, digest_code, make_in_pieces

from murkscan.cli.scan import scan as scan_command
from murkscan.cloud import merge_profiles, remove_outliers
from murkscan.geometry.stripe_blur import Sight
from murkscan.measure import (
    Box,
    DentSearch,
    Sample,
    cut_out,
    deviation_from_mesh,
    deviation_from_smooth,
    find_dents,
)
from murkscan.simulate import Body, Scene, load_scene, simulate_frames
from murkscan.triangulate import RaySheet, learn_paint_pulls, triangulate, undo_paint_pull
from murkscan.types.mesh import Mesh
from murkscan.types.stripe import Stripe
from murkscan.types.trajectory import Trajectory
from murkscan.ui.choices import make_extractor

SEEDS = 40
DEPTH, WIDTH = 2e-3, 60e-3
RIM = WIDTH * 1e3 * float(np.arccos(-0.8) / np.pi)
"""Width of the dent at a tenth of its depth [mm]."""
SPACING, TRAVEL = 2e-3, 0.16
PANEL = Box((0.012, 0.87, 0.7), (0.130, 1.03, 0.95))
"""Between the keel and the bilge keel."""
CORNER, SIZE = (920, 380), (400, 190)
"""First column and row, and the size, of the part of the picture that shows the panel [px]."""
AHEAD = 0.053
"""How far the stripe on the panel lies behind the camera, along its way [m]."""
MADE_BY = digest_code(
    ("murkscan.simulate", "murkscan.extract", "murkscan.triangulate", "murkscan.cloud",
     "murkscan.measure.sample"),
    ("dent.py",),
)  # fmt: skip
EXTRACTOR = inspect.signature(scan_command).parameters["extractor"].default
SMALLEST, LARGEST = 0.02, 0.15


@dataclass(frozen=True)
class Found:
    """What one search gave beside the truth [mm]."""

    others: int
    """Dents and bumps that are not there."""
    placed: float | None = None
    """Distance of the dent's middle from the true one; None: not found."""
    depth: float = 0.0
    half_width: float = 0.0
    diameter: float = 0.0
    diameter_half_width: float = 0.0
    threshold: float = 0.0


def true_place(seed: int) -> np.ndarray:
    """Give the middle of a seed's dent, but for its depth [m]."""
    x, y = np.random.default_rng(seed).uniform(-1, 1, 2) * [0.010, 0.030]
    return np.array([0.071 + x, 0.95 + y])


def press_dent(mesh: Mesh, place: np.ndarray) -> tuple[Mesh, np.ndarray]:
    """Press a round dent with a smooth rim (half a wave of a cosine) along the hull's normal."""
    middles = mesh.vertices[mesh.faces].mean(axis=1)
    away = np.linalg.norm(middles[:, :2] - place, axis=1)
    outside = (away < 0.75 * WIDTH) & (middles[:, 2] < 0.95)
    patch = trimesh.Trimesh(mesh.vertices, mesh.faces[outside], process=True)
    for _ in range(2):
        patch = patch.subdivide()
    vertices = np.array(patch.vertices)
    number = int(np.argmin(np.linalg.norm(vertices[:, :2] - place, axis=1)))
    middle, inwards = vertices[number], -patch.vertex_normals[number]
    inwards = inwards * np.sign(inwards[2])
    from_middle = vertices - middle
    across = from_middle - np.outer(from_middle @ inwards, inwards)
    share = np.linalg.norm(across, axis=1) / (WIDTH / 2)
    depth = np.where(share < 1, DEPTH * (1 + np.cos(np.pi * share)) / 2, 0.0)
    pressed = vertices + depth[:, None] * inwards
    joined = np.concatenate([mesh.faces[~outside], patch.faces + len(mesh.vertices)])
    return Mesh(np.concatenate([mesh.vertices, pressed]), joined), middle + DEPTH * inwards


def make_scene(seed: int, *, is_dented: bool) -> tuple[Scene, Mesh, np.ndarray]:
    """Give the scene, the intact hull, and the true deepest place."""
    scene = load_scene("hull-c1.5-hd")
    camera = scene.rig.camera
    (u, v), (left, top) = camera.principal_point, CORNER
    camera = replace(camera, size=SIZE, principal_point=(u - left, v - top))
    hull = scene.bodies[0]
    intact = Mesh(hull.world_from_object @ hull.mesh.vertices, hull.mesh.faces)
    dented, deepest = press_dent(intact, true_place(seed))
    if is_dented:
        local = hull.world_from_object.inverse() @ dented.vertices
        hull = replace(hull, mesh=Mesh(local, dented.faces))
    count = round(TRAVEL / SPACING)
    along = 0.95 + AHEAD + (np.arange(count) - count / 2) * SPACING
    places = np.stack([np.zeros(count), along, np.zeros(count)], axis=1)
    times = np.arange(count) / 25.0
    way = Trajectory(times, places, np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)))
    bodies: tuple[Body, ...] = (hull, *scene.bodies[1:])
    rig = replace(scene.rig, camera=camera)
    made = replace(scene, bodies=bodies, rig=rig, trajectory=way, times=times, seed=seed)
    return made, intact, deepest


def scan(scene: Scene) -> Sample:
    """Record and scan as the commands do, without their files; the panel alone."""
    frames = [simulated.frame for simulated in simulate_frames(scene, 0, len(scene))]
    extractor = make_extractor(EXTRACTOR, ())
    background = extractor.learn(frames, scene.rig)
    stripes = list(extractor.extract(frames, scene.rig, background))
    stripe = Stripe.concatenate(stripes)
    stripe = undo_paint_pull(stripe, learn_paint_pulls([stripe], scene.rig), scene.rig)
    profile = triangulate(stripe, scene.rig, RaySheet())
    cloud = remove_outliers(merge_profiles(profile, scene.trajectory, axes=("y",)))
    rays = cloud.points - scene.trajectory.positions[cloud.frame]
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    sight = Sight(rays, np.tile([1.0, 0.0, 0.0], (len(cloud), 1)))
    sample = Sample.from_cloud(cloud, sight=sight)
    return sample[PANEL.contains(cloud.points)]


def judge(search: DentSearch, deepest: np.ndarray, *, is_dented: bool) -> Found:
    """Take the nearest dent for the true one, if it is one; all else is false."""
    near = [
        dent
        for dent in search.dents
        if np.linalg.norm(dent.place - deepest) < WIDTH / 2 and dent.depth.value > 0
    ]
    threshold = search.threshold * 1e3
    if not is_dented or not near:
        return Found(len(search.dents), threshold=threshold)
    dent = near[0]
    return Found(
        len(search.dents) - 1,
        float(np.linalg.norm(dent.place - deepest)) * 1e3,
        dent.depth.value * 1e3,
        dent.depth.half_width * 1e3,
        dent.diameter.value * 1e3,
        dent.diameter.half_width * 1e3,
        threshold,
    )


def scan_seed(seed: int, *, is_dented: bool) -> Sample:
    """Scan the hull of a seed."""
    return scan(make_scene(seed, is_dented=is_dented)[0])


def search_seed(seed: int, sample: Sample, *, is_dented: bool) -> dict[str, Found]:
    """Look for dents, once beside a smooth surface through the scan, once beside the drawing."""
    _, intact, deepest = make_scene(seed, is_dented=is_dented)
    drawing = cut_out(intact, Box((-0.05, 0.8, 0.6), (0.2, 1.1, 1.0)))
    deviations = {
        "without a drawing": deviation_from_smooth(sample, largest=LARGEST),
        "with the drawing": deviation_from_mesh(sample, drawing, within=0.02),
    }
    return {
        name: judge(find_dents(sample, deviation, smallest=SMALLEST), deepest, is_dented=is_dented)
        for name, deviation in deviations.items()
    }


def search_all(kept: Kept) -> dict[bool, list[dict[str, Found]]]:
    """Search hulls with the dent and without, of as many seeds as there is time for."""
    found: dict[bool, list[dict[str, Found]]] = {True: [], False: []}
    for seed, is_dented in itertools.product(range(SEEDS), found):
        name = f"{EXTRACTOR} {'dent' if is_dented else 'intact'} {seed}"
        try:
            sample = kept.take_scan(name, partial(scan_seed, seed, is_dented=is_dented))
        except TimeoutError:
            continue
        found[is_dented].append(search_seed(seed, sample, is_dented=is_dented))
    return found


def figures_of(name: str, dented: list[Found], intact: list[Found]) -> list[Figure]:
    found = [one for one in dented if one.placed is not None]
    placed = [one.placed for one in found if one.placed is not None]
    off = np.array([one.depth - DEPTH * 1e3 for one in found])
    held = np.mean([abs(o) <= one.half_width for o, one in zip(off, found, strict=True)])
    share = 100 * np.abs(off) / (DEPTH * 1e3)
    round_held = np.mean([abs(one.diameter - RIM) <= one.diameter_half_width for one in found])
    return [
        Figure(f"{name}: dents found", 100 * len(found) / len(dented), "%", at_least=100),
        Figure(f"{name}: farthest from its place", max(placed), "mm", at_most=5),
        Figure(f"{name}: largest error of a depth", float(share.max()), "%", at_most=10),
        Figure(f"{name}: mean error of the depths", float(off.mean()), "mm"),
        Figure(f"{name}: standard deviation of these errors", float(off.std()), "mm"),
        Figure(f"{name}: depths within their 95 % interval", 100 * float(held), "%", at_least=90),
        Figure(f"{name}: usual half width of that interval",
               float(np.median([one.half_width for one in found])), "mm"),
        Figure(f"{name}: usual diameter", float(np.median([one.diameter for one in found])), "mm"),
        Figure(f"{name}: diameters within their 95 % interval", 100 * float(round_held), "%"),
        Figure(f"{name}: usual threshold",
               float(np.median([one.threshold for one in dented])), "mm"),
        Figure(f"{name}: false dents or bumps beside the true one",
               sum(one.others for one in dented), "", at_most=0),
        Figure(f"{name}: false dents or bumps on intact hulls",
               sum(one.others for one in intact), "", at_most=0),
    ]  # fmt: skip


def main() -> None:
    found = make_in_pieces(search_all, code=MADE_BY)
    names = tuple(found[True][0])
    tell(
        "dent",
        "A dent of 2 mm in a ship's bottom",
        [
            figure
            for name in names
            for figure in figures_of(
                name, [one[name] for one in found[True]], [one[name] for one in found[False]]
            )
        ],
        note=f"""{len(found[True])} seeds with the dent and {len(found[False])} without: the scene
`hull-c1.5-hd`, whose bottom is grown over in dark and light patches, in water of c = 1.5 /m with
particles, before the machine-vision rig 0.8 m away, {SPACING * 1e3:g} mm from frame to frame. The
dent is {DEPTH * 1e3:g} mm deep and {WIDTH * 1e3:g} mm wide, half a wave of a cosine, in the panel
between keel and bilge keel, which is what is searched. Only the part of the picture that shows the
panel is drawn ({SIZE[0]} × {SIZE[1]} of 1920 × 1200 px), {round(TRAVEL / SPACING)} frames a seed;
the stripe is found by `{EXTRACTOR}`, the default of `murkscan scan`. Diameters are those at a tenth
of the depth, where this dent is {RIM:.0f} mm wide. How far growth pulls the stripe is learnt from
the stripes and taken back, as by `murkscan triangulate`. The drawing is the true hull in its true
place.

The dents lie up to 10 mm across and 30 mm along the way from the middle of the panel. What
is left of the pull of patches of growth is alike in every seed: dents in one place are all off by
the same.""",
    )


if __name__ == "__main__":
    main()
