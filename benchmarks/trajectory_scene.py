"""Profiles of a hull from a vehicle's true way, made from geometry alone, and what its log says."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from harness import DATA
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter, map_coordinates, spline_filter
from scipy.spatial.transform import Rotation, RotationSpline

from murkscan.motion.adjust import Pass
from murkscan.motion.measured import CLOCK
from murkscan.simulate.vehicle import Unrest, drive
from murkscan.types.navigation import Navigation, NavigationAccuracy, Readings

RATE = 25.0
"""Profiles a second [1/s]."""
SPEED = 0.1
"""Usual speed [m/s]."""
STAND_OFF = 0.8
FAN = 0.5
"""Width of the line on the hull [m]."""
POINTS = 300
NOISE = 0.15e-3
"""Of a point along its ray [m]."""
LOG_RATE = 10.0
TURN = 15.0
"""Time from one pass to the next [s]."""
WAVES = Unrest(0.15, 6e-3, 8e-3, np.deg2rad(0.7), 5.0)
REACH, HALVINGS = (0.2, 4.0), 25
"""Between which distances, in usual ones, the hull lies, and how often they are halved: to 0.1 µm,
whatever the surface's slope."""
BASELINE = 0.2
"""From the camera to the lasers, along the way [m]."""


@dataclass(frozen=True)
class Case:
    """What is scanned, how, and what the log knows."""

    log: str = "a"
    sheets: int = 2
    passes: int = 4
    length: float = 2.0
    crossing: bool = False
    relief: str = "growth"
    """`growth`, `plain` or `seams`."""
    speed_swing: float = 0.0
    """Share of the speed by which it swings with a period of 5 s."""
    stand_off_swing: float = 0.0
    """How far the stand-off swings [m]."""
    motion: str = "made"
    """`made`, `waves`, or the name of a real recording."""
    clock: float = 0.0
    """How much too late the log's stamps are [s]; unless 0, nothing is stated of its clock."""
    tilt: float = 1.0
    """Swing of roll, pitch and heading [deg]."""


@dataclass(frozen=True, eq=False)
class Hull:
    """A cylinder about an axis along x with growth on it, as heights over a plane; z is down."""

    radius: float
    relief: np.ndarray
    """Heights on a grid of `PITCH` [m]."""
    corner: tuple[float, float]

    PITCH = 2e-3

    def height(self, x, y):
        """Compute the depth of the surface below the vehicle's usual place [m]."""
        places = np.stack([(x - self.corner[0]), (y - self.corner[1])]) / self.PITCH
        bumps = map_coordinates(self.relief, places, order=3, mode="nearest", prefilter=False)
        return STAND_OFF + y**2 / (2 * self.radius) - bumps

    def normals(self, points):
        """Compute the unit normals towards the vehicle."""
        step = 1e-4
        x, y = points[:, 0], points[:, 1]
        slope_x = (self.height(x + step, y) - self.height(x - step, y)) / (2 * step)
        slope_y = (self.height(x, y + step) - self.height(x, y - step)) / (2 * step)
        normals = np.stack([slope_x, slope_y, -np.ones_like(x)], axis=1)
        return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def make_hull(case, random):
    """Draw a hull: R 5 to 10 m, growth of 0.5 to 1.5 mm RMS that goes together over 8 to 20 mm."""
    margin = 0.6
    width = 0.7 * FAN * case.passes + 2 * margin
    size = (int((case.length + 2 * margin) / Hull.PITCH), int(width / Hull.PITCH))
    corner = (-margin, -margin - FAN / 2)
    relief = np.zeros(size)
    if case.relief == "growth":
        field = gaussian_filter(random.normal(size=size), random.uniform(8e-3, 20e-3) / Hull.PITCH)
        relief = field * (random.uniform(0.5e-3, 1.5e-3) / field.std())
    elif case.relief == "seams":
        relief = draw_seams(size, random)
    return Hull(random.uniform(5, 10), spline_filter(relief), corner)


def draw_seams(size, random):
    """Draw weld seams of 3 mm every half metre or so, both ways, and an anode every metre."""
    x, y = (np.arange(n) * Hull.PITCH for n in size)
    relief = np.zeros(size)
    for places, axis in ((x, 0), (y, 1)):
        for at in np.arange(random.uniform(0.1, 0.5), places[-1], 0.6):
            seam = 3e-3 * np.exp(-0.5 * ((places - at) / 4e-3) ** 2)
            relief = np.maximum(relief, seam[:, None] if axis == 0 else seam[None])
    for at_x in np.arange(random.uniform(0.2, 0.8), x[-1], 1.0):
        for at_y in np.arange(random.uniform(0.2, 0.6), y[-1], 0.8):
            near = (abs(x[:, None] - at_x) < 0.1) & (abs(y[None] - at_y) < 0.05)
            relief = np.where(near, 15e-3, relief)
    return gaussian_filter(relief, 1.5e-3 / Hull.PITCH)


@dataclass(frozen=True, eq=False)
class Way:
    """A true way, finely sampled."""

    times: np.ndarray
    positions: np.ndarray
    rotations: Rotation

    def at(self, times):
        """Compute positions [m] and rotations world_from_vehicle at some times [s]."""
        positions = CubicSpline(self.times, self.positions)(times)
        return positions, RotationSpline(self.times, self.rotations)(times)


def wander(times, random, *, shortest, longest):
    """Draw a smooth random motion of variance 1 whose waves have periods in between [s]."""
    periods = np.exp(random.uniform(np.log(shortest), np.log(longest), 12))
    phases = random.uniform(0, 2 * np.pi, 12)
    return np.sqrt(2 / 12) * np.cos(2 * np.pi * times[:, None] / periods + phases).sum(axis=1)


def make_way(case, number, start, random):
    """Draw the true way of one pass; every second goes back, a crossing one goes across."""
    duration = case.length / SPEED
    if number == case.passes:
        duration = 0.7 * FAN * case.passes / SPEED
    times = np.arange(-1.0, duration + 1.0, 0.02)
    swing = case.speed_swing * np.sqrt(2) * np.sin(2 * np.pi * times / 5 + random.uniform(0, 6.28))
    share = {"a": 0.05, "b": 0.2, "c": 0.2}[case.log]
    speed = (
        1
        + swing
        + share * (0 if case.speed_swing else 1) * wander(times, random, shortest=4, longest=12)
    )
    speed *= 1 + (0.1 * random.normal() if case.log != "a" else 0)
    gone = np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2 * 0.02)]) * SPEED
    gone -= np.interp(0, times, gone)
    sway, heave = (0.01 * wander(times, random, shortest=4, longest=20) for _ in range(2))
    heave += case.stand_off_swing * np.sin(2 * np.pi * times / 7 + random.uniform(0, 6.28))
    forward = np.array([1.0, 0, 0]) if number % 2 == 0 else np.array([-1.0, 0, 0])
    heading = 0.0 if number % 2 == 0 else np.pi
    if number == case.passes:
        forward, heading = np.array([0.0, 1, 0]), np.pi / 2
    side = np.array([-forward[1], forward[0], 0])
    positions = start + gone[:, None] * forward + sway[:, None] * side
    positions[:, 2] += heave
    tilt = np.deg2rad(case.tilt) * np.stack(
        [wander(times, random, shortest=3, longest=12) for _ in range(3)], axis=1
    )
    if case.motion != "made":
        move = ride_waves if case.motion == "waves" else partial(real_motion, case.motion)
        shifts, tilt = move(times, random)
        positions = start + shifts @ np.stack([forward, side, [0, 0, 1]])
    rotations = Rotation.from_rotvec([0, 0, heading]) * Rotation.from_rotvec(tilt)
    return Way(times, positions, rotations)


def ride_waves(times, random):
    """Ride waves as the vehicle of the scene `two-lasers` does, up to 1 Hz; z is down."""
    seed = int(random.integers(1 << 30))
    way = drive(WAVES, np.array([SPEED, 0, 0]), np.zeros(3), times[-1], seed=seed).at(times)
    return way.positions, Rotation.from_quat(way.quaternions, scalar_first=True).as_rotvec()


def real_motion(name, times, random):
    """Take a stretch of a real vehicle's way, scaled to our mean speed and laid along x.

    One of those stretches is drawn in which the vehicle turns least: a scan goes straight.
    """
    table = np.loadtxt(DATA / "underwater_trajectories" / f"{name}.txt")
    clock = table[:, 0] - table[0, 0]
    keep = np.concatenate([[True], np.diff(clock) > 0])
    clock, places = clock[keep], table[keep, 1:4]
    attitudes = Rotation.from_quat(table[keep, 4:8])
    span = times[-1] - times[0]
    found = []
    for begin in np.arange(0, clock[-1] - span, span / 4):
        inside = (clock >= begin) & (clock <= begin + span)
        known = np.concatenate([[begin], clock[inside], [begin + span]])
        if inside.sum() < span * 3 or np.diff(known).max() > 1.0:
            continue
        turns = (attitudes[inside] * attitudes[inside].mean().inv()).as_rotvec()
        found.append((np.abs(turns).max(), begin))
    calm = sorted(found)[: max(len(found) // 4, 1)]
    begin = calm[random.integers(len(calm))][1]
    at = begin + times - times[0]
    inside = (clock >= begin - 1) & (clock <= begin + span + 1)
    middle = attitudes[inside].mean()
    turns = CubicSpline(clock[inside], (middle.inv() * attitudes[inside]).as_rotvec())(at)
    shifts = CubicSpline(clock[inside], middle.inv().apply(places[inside]))(at)
    way = shifts[-1] - shifts[0]
    shifts *= SPEED * span / np.linalg.norm(way)
    ahead = way / np.linalg.norm(way)
    side = np.cross([0.0, 0.0, 1.0], ahead)
    side /= np.linalg.norm(side)
    axes = np.stack([ahead, side, np.cross(ahead, side)])
    shifts = shifts @ axes.T
    return shifts - CubicSpline(times, shifts)(0.0), turns @ axes.T


def starts(case):
    """Where each pass begins: side by side, 30 % over one another."""
    places = []
    for number in range(case.passes):
        x = 0.0 if number % 2 == 0 else case.length
        places.append(np.array([x, 0.7 * FAN * number, 0.0]))
    if case.crossing:
        places.append(np.array([case.length / 2, -0.1, 0.0]))
    return places


def see(hull, way, tilts, duration):
    """Intersect the sheets with the hull: (times, profile, line, laser, points, true normals)."""
    times = np.arange(0, duration, 1 / RATE)
    positions, rotations = way.at(times)
    matrices = rotations.as_matrix()
    found = []
    for laser, tilt in enumerate(tilts):
        side = np.linspace(-0.5, 0.5, POINTS) * FAN / STAND_OFF
        beams = np.stack([np.full(POINTS, np.tan(tilt)), side, np.ones(POINTS)], axis=1)
        origin = np.array([BASELINE, 0, 0])
        from_there = positions + matrices @ origin
        directions = np.einsum("nij,lj->nli", matrices, beams)
        near, far = (np.full(directions.shape[:2], at * STAND_OFF) for at in REACH)
        for _ in range(HALVINGS):
            middle = (near + far) / 2
            at = from_there[:, None] + middle[..., None] * directions
            depth = hull.height(at[..., 0].ravel(), at[..., 1].ravel()).reshape(far.shape)
            near, far = np.where(at[..., 2] < depth, [middle, far], [near, middle])
        assert near.min() > REACH[0] * STAND_OFF, "a vehicle goes into the hull"
        assert far.max() < REACH[1] * STAND_OFF, "a sheet looks past the hull"
        at = origin + far[..., None] * beams
        world = from_there[:, None] + far[..., None] * directions
        count = far.size
        profile = np.repeat(np.arange(len(times)), POINTS)
        line = np.tile(np.arange(POINTS), len(times))
        found.append(
            (profile, line, np.full(count, laser), at.reshape(-1, 3), world.reshape(-1, 3))
        )
    return times, [np.concatenate([one[k] for one in found]) for k in range(5)]


LOGS = {
    "a": NavigationAccuracy(
        velocity_noise=3e-3,
        velocity_bias=1e-3,
        attitude_noise=np.deg2rad(0.1),
        attitude_bias=np.deg2rad(0.2),
        heading_drift=np.deg2rad(0.5) / 60,
        depth_noise=5e-3,
        position_noise=0.03,
    ),
    "b": NavigationAccuracy(
        speed=0.1,
        attitude_noise=np.deg2rad(0.1),
        attitude_bias=np.deg2rad(0.2),
        heading_drift=np.deg2rad(0.5) / 60,
        depth_noise=5e-3,
        position_noise=0.03,
    ),
    "c": NavigationAccuracy(speed=0.1, position_noise=0.03),
}


def dive_errors(case, random):
    """Draw the errors that all passes of a dive share."""
    accuracy = LOGS[case.log]
    return {
        "velocity": accuracy.velocity_bias * random.normal(size=3),
        "tilt": accuracy.attitude_bias * random.normal(size=2),
        "heading": accuracy.heading_drift * random.normal(),
    }


def read_log(case, way, errors, number, duration, random):
    """Measure a way as the vehicle's instruments do; a fix of its place only at the start."""
    accuracy = replace(LOGS[case.log], clock_offset=CLOCK if case.clock else 0.0)
    start, rotation = way.at(np.array([0.0]))
    fix = Readings(np.array([0.0]), start + accuracy.position_noise * random.normal(size=(1, 3)))
    if case.log == "c":
        # Which way a pass goes is known to the pilot, and no more: no accuracy is stated.
        heading = rotation.as_euler("ZYX")[0, 0]
        course = np.array([[0.0, 0.0, np.round(heading / (np.pi / 2)) * np.pi / 2]])
        course = Readings(np.array([0.0]), course)
        return Navigation(accuracy, attitude=course, position=fix, speed=SPEED)
    times = np.arange(0, duration + 0.2, 1 / LOG_RATE)
    positions, rotations = way.at(times)
    attitude = rotations.as_euler("ZYX")[:, ::-1]
    attitude = attitude + accuracy.attitude_noise * random.normal(size=attitude.shape)
    attitude[:, :2] += errors["tilt"]
    attitude[:, 2] += errors["heading"] * (number * (duration + TURN) + times)
    step = 1e-3
    velocity = (way.at(times + step)[0] - way.at(times - step)[0]) / (2 * step)
    velocity = rotations.inv().apply(velocity) + errors["velocity"]
    stamps = times + case.clock
    depth = positions[:, 2:] + accuracy.depth_noise * random.normal(size=(len(times), 1))
    log = Navigation(
        accuracy,
        attitude=Readings(stamps, attitude),
        depth=Readings(stamps, depth),
        position=fix,
    )
    if case.log == "a":
        velocity += accuracy.velocity_noise * random.normal(size=velocity.shape)
        return replace(log, velocity=Readings(stamps, velocity))
    return replace(log, speed=SPEED)


@dataclass(frozen=True, eq=False)
class Dive:
    """Passes as an adjustment gets them, and the truth of each."""

    hull: Hull
    passes: list[Pass]
    truths: list["Truth"]


@dataclass(frozen=True, eq=False)
class Truth:
    """What the first sheet of a pass really saw, without noise."""

    way: Way
    profile: np.ndarray
    line: np.ndarray
    own: np.ndarray
    """In the vehicle's frame [m]."""
    world: np.ndarray


def make_dive(case, seed):
    """Make a dive of one case."""
    random = np.random.default_rng(seed)
    hull = make_hull(case, random)
    gap = np.deg2rad(random.uniform(10, 20))
    first = -np.arctan(BASELINE / STAND_OFF)
    errors = dive_errors(case, random)
    passes, truths = [], []
    for number, start in enumerate(starts(case)):
        is_crossing = number == case.passes
        duration = (0.7 * FAN * case.passes if is_crossing else case.length) / SPEED
        way = make_way(case, number, start, random)
        times, found = see(hull, way, [first, first + gap][: case.sheets], duration)
        profile, line, laser, own, world = found
        log = read_log(case, way, errors, number, duration, random)
        far = np.linalg.norm(own, axis=1, keepdims=True)
        noisy = own * (1 + NOISE * random.normal(size=far.shape) / far)
        begun = number * (case.length / SPEED + TURN)
        passes.append(
            Pass(
                times + begun,
                profile,
                line,
                laser.astype(np.uint8),
                noisy,
                np.zeros(len(own)),
                later(log, begun),
            )
        )
        first_sheet = laser == 0
        truths.append(Truth(way, *(one[first_sheet] for one in (profile, line, own, world))))
    return Dive(hull, passes, truths)


def later(log, seconds):
    """Shift a log's times: all passes of a dive have one clock."""
    moved = {
        name: Readings(readings.times + seconds, readings.values)
        for name in ("attitude", "velocity", "depth", "position")
        if (readings := getattr(log, name)) is not None
    }
    return replace(log, **moved)
