"""The plan against the simulator, on rigs and waters drawn at random."""

import math
import time
from functools import partial

import numpy as np
from harness import Figure, tell
from kept import Kept, make_in_pieces

from murkscan.errors import NotEnoughData
from murkscan.optics.beam import Light
from murkscan.optics.medium import Medium
from murkscan.optics.sensor import Sensor
from murkscan.plan import VISIBLE, Conditions, Forecast, forecast
from murkscan.simulate import Body, Scene
from murkscan.simulate.frames import Simulator
from murkscan.simulate.shapes import Plane
from murkscan.simulate.textures import Plain
from murkscan.triangulate import RaySheet
from murkscan.types.camera import Camera
from murkscan.types.laser import Fan, Laser
from murkscan.types.port import FlatPort, Layer
from murkscan.types.pose import Pose
from murkscan.types.rig import Rig
from murkscan.types.trajectory import Trajectory
from murkscan.types.true_stripe import TrueStripe
from murkscan.types.water import Water

COUNT = 30
STEP = 0.25


def draw_rig(rng: np.random.Generator) -> Rig:
    """Draw a camera behind a flat window or without one, and a laser beside it."""
    width, height = [(720, 576), (640, 480), (800, 600)][rng.integers(3)]
    focal = width * rng.uniform(0.65, 1.1)
    window = Layer(0.008, 1.49)
    glass = FlatPort(np.array([0.0, 0.0, 1.0]), rng.uniform(0.01, 0.05), (window,))
    camera = Camera(
        size=(width, height),
        focal_length=(focal, focal),
        principal_point=((width - 1) / 2, (height - 1) / 2),
        port=glass if rng.random() < 0.7 else None,
    )
    axis = "xy"[rng.integers(2)]
    at = "xy".index(axis)
    axes = np.eye(3)
    baseline, crossing = rng.uniform(0.1, 0.5), rng.uniform(0.4, 1.2)
    side = rng.choice([-1.0, 1.0])
    ahead = side * baseline * axes[at] + crossing * axes[2]
    fan = Fan.spread(-side * baseline * axes[at], ahead, axes[1 - at], math.radians(32))
    return Rig(camera, (Laser(fan, axis),), 532e-9, Water(rng.uniform(5, 28), 35.0, 5.0))


def draw_conditions(rng: np.random.Generator) -> Conditions:
    """Draw a water, a lamp, a sensor and a paint."""
    medium = Medium(float(np.exp(rng.uniform(np.log(0.2), np.log(5.0)))), rng.uniform(0.7, 0.92))
    light = Light(power=float(np.exp(rng.uniform(np.log(0.01), np.log(0.2)))))
    sensor = Sensor(
        exposure=float(np.exp(rng.uniform(np.log(2e-3), np.log(20e-3)))),
        f_number=rng.uniform(1.4, 4.0),
        psf=rng.uniform(0.7, 1.3),
        bits=[8, 10, 12][rng.integers(3)],
        read_noise=rng.uniform(2, 12),
        interlaced=bool(rng.random() < 0.3),
    )
    return Conditions(medium, light, sensor, rng.uniform(0.03, 0.3))


def simulate_walls(rig: Rig, conditions: Conditions, depths: np.ndarray) -> list[TrueStripe]:
    """Simulate a wall at each depth: the camera goes backwards."""
    size = 4 * float(depths.max())
    wall = Body(Plane(size, size).mesh(), Pose.identity(), texture=Plain(conditions.albedo))
    places = np.zeros((len(depths), 3))
    places[:, 2] = -depths
    times = np.arange(len(depths)) / 25
    still = np.tile([1.0, 0, 0, 0], (len(depths), 1))
    scene = Scene(
        (wall,),
        rig,
        Trajectory(times, places, still),
        times,
        medium=conditions.medium,
        light=conditions.light,
        sensor=conditions.sensor,
    )
    simulator = Simulator.of(scene)
    return [simulator.draw_frame(number).stripe for number in range(len(depths))]


def judge(stripe: TrueStripe, rig: Rig) -> tuple[float, float, float]:
    """Give share found, median σ along the ray [m] and median bound [px] of a simulated wall."""
    direct = ~stripe.is_reflected
    bound, pixels = stripe.crlb[direct].astype(float), stripe.pixels[direct]
    if len(bound) == 0:
        return 0.0, math.nan, math.inf
    found = bound <= VISIBLE
    if not found.any():
        return 0.0, math.nan, float(np.median(bound))
    axis = "xy".index(rig.lasers[0].axis)
    step = STEP * np.eye(2)[axis]
    ends = [RaySheet().locate(pixels[found] + sign * step, rig, 0) for sign in (-1, 1)]
    # As a scan states it: how far the point moves along its ray.
    ranges = [np.linalg.norm(end, axis=1) for end in ends]
    per_pixel = np.abs(ranges[1] - ranges[0]) / (2 * STEP)
    return found.mean(), float(np.nanmedian(bound[found] * per_pixel)), float(np.median(bound))


def compare(seed: int) -> dict[str, float] | None:
    """Compare one rig in one water; None where the plan says that it sees nothing."""
    rng = np.random.default_rng(seed)
    rig, conditions = draw_rig(rng), draw_conditions(rng)
    start = time.process_time()
    whole = forecast(rig, conditions)
    spent = time.process_time() - start
    try:
        near, far = whole.reach
    except NotEnoughData:
        return None
    edge = [0.8, 0.9, 0.96, 1.04, 1.12, 1.25]
    depths = np.array([*(near + (far - near) * np.array([0.1, 0.3, 0.5])), *(far * np.array(edge))])
    depths = np.unique(depths)
    planned: Forecast = forecast(rig, conditions, depths=depths)
    truth = [judge(stripe, rig) for stripe in simulate_walls(rig, conditions, depths)]
    share, sigma, bound = (np.array(column) for column in zip(*truth, strict=True))
    ours, expected = planned.median(planned.sigma_along), planned.share_found
    both = np.isfinite(sigma) & np.isfinite(ours)
    off = np.abs(ours[both] / sigma[both] - 1)
    return {
        "c": conditions.medium.attenuation,
        "sigma": float(np.max(off[depths[both] <= far], initial=0.0)),
        "sigma_beyond": float(np.max(off, initial=0.0)),
        "share": float(np.mean(np.abs(expected - share))),
        "share_worst": float(np.max(np.abs(expected - share))),
        "limit": far / true_limit(depths, bound) - 1,
        "far": far,
        "seconds": spent,
    }


def true_limit(depths: np.ndarray, bound: np.ndarray) -> float:
    """Interpolate the depth at which the median bound passes what is visible."""
    good = np.flatnonzero(bound <= VISIBLE)
    if len(good) == 0:
        return float(depths[0])
    last = int(good[-1])
    if last + 1 == len(depths) or not np.isfinite(bound[last + 1]):
        return float(depths[last])
    here, there = np.log(bound[last]), np.log(bound[last + 1])
    share = (np.log(VISIBLE) - here) / (there - here)
    return float(depths[last] + share * (depths[last + 1] - depths[last]))


def _compare_all(kept: Kept) -> tuple[list[dict[str, float]], int]:
    """Compare rigs until there are as many as wanted; tells how many more would see nothing."""
    results, seed, blind = list[dict[str, float]](), 0, 0
    while len(results) < COUNT:
        seed += 1
        result = kept.take(f"{seed:03d}", partial(compare, seed))
        if result is None:
            blind += 1
            continue
        results.append(result)
        print(seed, {name: round(value, 3) for name, value in result.items()}, flush=True)
    return results, blind


def main() -> None:
    forecast(draw_rig(np.random.default_rng(0)), draw_conditions(np.random.default_rng(0)))
    results, blind = make_in_pieces(_compare_all)
    sigma, beyond, share, worst, limit, seconds = (
        np.array([abs(one[name]) for one in results])
        for name in ("sigma", "sigma_beyond", "share", "share_worst", "limit", "seconds")
    )
    figures = [
        Figure("σ within the range limit, worst rig", 100 * sigma.max(), "%", at_most=20),
        Figure("the same, median rig", 100 * float(np.median(sigma)), "%"),
        Figure("σ of the few points beyond it, too, worst rig", 100 * beyond.max(), "%"),
        Figure(
            "share found, mean over distances, worst rig", 100 * share.max(), "points", at_most=5
        ),
        Figure(
            "share found at the worst distance, median rig", 100 * float(np.median(worst)), "points"
        ),
        Figure("share found at the worst distance, worst rig", 100 * worst.max(), "points"),
        Figure("range limit, worst rig", 100 * limit.max(), "%", at_most=10),
        Figure("range limit, median rig", 100 * float(np.median(limit)), "%"),
        Figure("a forecast, slowest rig", seconds.max(), "s of CPU", at_most=1.0),
    ]
    note = (
        f"{COUNT} rigs and waters drawn at random (c 0.2 to 5 /m; with and without windows, "
        f"progressive and interlaced, 10 to 200 mW); {blind} more would see nothing and say so. A "
        "plain wall, simulated at nine distances each, six of them within 25 % of the range limit; "
        f"found is what has a bound of {VISIBLE:g} px or better in the simulator's truth. σ is the "
        "median over the scan lines along the ray, at the worst distance where both have one."
    )
    tell("plan", "The plan against the simulator", figures, note=note)


if __name__ == "__main__":
    main()
