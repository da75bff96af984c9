"""The simulator against exact truth: centres, glow, bytes, speed and memory."""

import math
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
from harness import DOCS, Figure, tell
from scipy.integrate import quad

from murkscan.extract import GrayGravity
from murkscan.geometry.mesh_distance import distance_to_mesh
from murkscan.optics import back_project, intersect_rays_with_sheet
from murkscan.optics.medium import Medium
from murkscan.simulate import Light, Sensor, Simulator, load_scene
from murkscan.simulate.particles import Particles

LADDER = ("", "-c0.3", "-c0.5", "-c1.5", "-c3", "-c4", "-c5", "-c6")
SHAPES = (("plane", "plane"), ("sphere", "sphere"), ("sphere, bent sheet", "sphere-hd"))
CLEAN = Sensor(psf=1.0, peak_grey=4e4, read_noise=0.0, shot_noise=False, vignetting=False,
               black_level=0.0, full_well=1e6, bits=16)  # fmt: skip


def off_the_mesh(name: str, *, in_air: bool) -> float:
    """Farthest true centre, triangulated with the true rig, from the mesh [m], in five frames."""
    scene = load_scene(name)
    if in_air:
        camera = replace(scene.rig.camera, port=None)
        (laser,) = scene.rig.lasers
        laser = replace(laser, sheet=replace(laser.sheet, port=None))
        scene = replace(scene, rig=replace(scene.rig, camera=camera, lasers=(laser,), water=None))
    simulator, farthest = Simulator.of(scene), 0.0
    for number in np.linspace(0.3 * len(scene), 0.7 * len(scene), 5).astype(int).tolist():
        stripe = simulator.draw_frame(number).stripe
        rays = back_project(scene.rig.camera, stripe.pixels, scene.index)
        points = intersect_rays_with_sheet(rays, scene.rig.lasers[0], scene.index)
        away = distance_to_mesh(scene.pose(number) @ points, scene.surroundings.mesh)
        farthest = max(farthest, float(away.max()))
    return farthest


def gray_gravity_error() -> float:
    """RMS of gray gravity against the true centres of a clean plane [px]."""
    scene = replace(load_scene("plane-hd"), sensor=CLEAN, light=Light(waist=4e-3))
    frame = Simulator.of(scene).draw_frame(50)
    extractor = GrayGravity()
    background = extractor.learn([frame.frame], scene.rig)
    found = next(extractor.extract([frame.frame], scene.rig, background))
    truth = dict(zip(frame.stripe.pixels[:, 0], frame.stripe.pixels[:, 1], strict=True))
    errors = [v - truth[u] for u, v in found.pixels]
    return float(np.sqrt(np.mean(np.square(errors))))


def glow_error() -> float:
    """Largest error of the drawn glow against the integral along the ray through a thick sheet."""
    scene = replace(load_scene("plane-c3"), forward_scattering=False, particles=Particles())
    simulator = Simulator.of(scene)
    light, laser = simulator.draw_light(100).lasers[0], simulator.lasers[0]
    errors = []
    for u, v in ((100, 20), (360, 60), (600, 120), (360, 180)):
        if light.mask[v, u] == 1.0:
            exact = integrate_glow(scene.medium, laser, float(u), float(v))
            errors.append(abs(light.glow[v, u] / exact - 1))
    return float(max(errors))


def integrate_glow(medium: Medium, laser: object, u: float, v: float) -> float:
    """Add up what each bit of a camera's ray scatters towards it, by adaptive quadrature."""
    rays = laser.scan_lines.rays(np.array([u]), np.array([v]))
    middle = float(laser.view.camera_range.reshape(576, 720)[int(v), int(u)])

    def scattered(way: float) -> float:
        where = laser.beam.locate(rays.origins + way * rays.directions)
        cosine = -laser.beam.directions(where.angle) @ rays.directions[0]
        left = math.exp(-medium.attenuation * (way + where.range[0]))
        density = medium.scattering * medium.phase.at_cosine(cosine)[0]
        return float(density * laser.beam.irradiance(where)[0] * left)

    total, _ = quad(
        scattered, middle - 0.03, middle + 0.03, points=[middle], epsrel=1e-5, limit=200
    )
    return total


def frames_per_core_second(name: str, *, count: int = 40) -> float:
    """Pictures of full size drawn in a second of one core, with glow, particles and noise."""
    cv2.setNumThreads(1)
    simulator = Simulator.of(load_scene(name))
    middle = len(simulator.scene) // 2
    simulator.draw_frame(middle)
    start = time.process_time()
    for number in range(middle, middle + count):
        simulator.draw_frame(number)
    return count / (time.process_time() - start)


def peak_memory(frames: int) -> float:
    """Largest resident memory of a process that records so many small frames [MB]."""
    code = f"""
import tempfile, numpy as np
from dataclasses import replace
from pathlib import Path
from murkscan.simulate import Recorder, load_scene
from murkscan.survey.simulate import simulate_recording
from murkscan.types.trajectory import Trajectory
scene = load_scene("plane-c1.5")
camera = replace(scene.rig.camera, size=(180, 144), focal_length=(138.5, 138.5),
                 principal_point=(89.5, 71.5))
sensor = replace(scene.sensor, interlaced=False)
times = np.arange({frames}) * 0.04
ends = np.array([[0.0, 0.0, 0.0], [0.0, 0.4, 0.0]])
way = Trajectory(np.array([0.0, 400.0]), ends, np.tile([1.0, 0.0, 0.0, 0.0], (2, 1)))
scene = replace(scene, rig=replace(scene.rig, camera=camera), times=times, sensor=sensor,
                trajectory=way, recorder=Recorder("ffv1"))
with tempfile.TemporaryDirectory() as folder:
    simulate_recording(scene, Path(folder))
# Not the resource module's figure: that of a child starts at its parent's.
print(next(line.split()[1] for line in open("/proc/self/status") if line.startswith("VmHWM")))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return int(done.stdout) / 1024


def same_bytes() -> float:
    """Share of frames that come out alike when drawn twice, in another order."""
    scenes = [Simulator.of(load_scene("hull-c3")) for _ in range(2)]
    numbers = (200, 300, 400)
    first = {n: scenes[0].draw_frame(n).frame.image.tobytes() for n in numbers}
    again = {n: scenes[1].draw_frame(n).frame.image.tobytes() for n in reversed(numbers)}
    return sum(first[n] == again[n] for n in numbers) / len(numbers)


def draw_contact_sheet(path: Path) -> None:
    """Show the hull in every water of the ladder, as recorded and with its darks brightened."""
    tiles = []
    for murk in LADDER:
        simulator = Simulator.of(load_scene(f"hull{murk}"))
        fields = [simulator.draw_frame(number).frame.image for number in (300, 301)]
        picture = np.empty((576, 720), np.uint8)
        picture[0::2], picture[1::2] = fields
        bright = (255 * (np.clip(picture.astype(float) - 4, 0, 255) / 251) ** 0.45).astype(np.uint8)
        tile = np.vstack([picture, bright])
        tile = cv2.resize(tile, (360, 576), interpolation=cv2.INTER_AREA)
        name = f"c = {murk[2:]} /m" if murk else "clear"
        cv2.putText(tile, name, (10, 24), cv2.FONT_HERSHEY_SIMPLEX, 0.6, 230, 1, cv2.LINE_AA)
        tiles.append(cv2.copyMakeBorder(tile, 2, 2, 2, 2, cv2.BORDER_CONSTANT, value=90))
    rows = [np.hstack(tiles[k : k + 4]) for k in (0, 4)]
    cv2.imwrite(str(path), np.vstack(rows), [cv2.IMWRITE_PNG_COMPRESSION, 9])


def main() -> None:
    DOCS.mkdir(parents=True, exist_ok=True)
    draw_contact_sheet(DOCS / "ladder.png")
    few, many = peak_memory(1000), peak_memory(10_000)
    figures = [
        Figure(f"{shape} {where}: farthest true centre from the mesh",
               off_the_mesh(name, in_air=where == "in air") * 1e6, "µm", at_most=1.0)
        for shape, name in SHAPES
        for where in ("in air", "through ports")
    ]  # fmt: skip
    figures += [
        Figure("gray gravity on a clean plane: RMS to the true centres", gray_gravity_error(), "px",
               at_most=0.02),
        Figure("glow: largest error to the integral through the sheet", 100 * glow_error(), "%",
               at_most=1.0),
        Figure("frames that come out the same, to the byte", 100 * same_bytes(), "%", at_least=100),
        Figure("720 × 576, c = 3 /m: pictures a second of one core",
               frames_per_core_second("hull-c3"), "1/s", at_least=8),
        Figure("1920 × 1200, c = 3 /m: pictures a second of one core",
               frames_per_core_second("hull-c3-hd", count=10), "1/s"),
        Figure("memory for 1 000 frames", few, "MB"),
        Figure("memory for 10 000 frames", many, "MB", at_most=1.1 * few),
    ]  # fmt: skip
    tell(
        "simulator",
        "The simulator against exact truth",
        figures,
        note="Scenes that ship with the package. Drawing is measured in time of the processor, so "
        "that other work on the machine counts less; each picture has glow, particles and noise, "
        "and a field of an interlaced recording takes as long as a whole picture. Memory is "
        "measured with small frames, of 180 × 144 px.\n\n"
        "![The hull in clear water and in every water of the ladder](ladder.png)\n\n"
        "Each pair of pictures is one frame of the hull: as recorded above, with its darks "
        "brightened below.",
    )


if __name__ == "__main__":
    main()
