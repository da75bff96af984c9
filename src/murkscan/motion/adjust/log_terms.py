"""What a vehicle's instruments say of its way, as equations.

Each reading is what the way predicts, plus the instrument's own errors, plus noise. A log whose
clock is wrong reads the way at another time: that is one more unknown, with the way's own rate of
change as its slope.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy import sparse

from ...types.arrays import Mask, Scalars, Vector
from ...types.navigation import Navigation, Readings
from .instruments import Heading, Instrument, Place, Rates, Tilt, Velocity
from .path import Path, Poses
from .settings import AdjustSettings
from .spline import evaluate
from .unknowns import Equations, Layout, equations_of_path, slopes_of_turn

UNREST = (0.2, 0.2, 0.2, 0.4, 0.4, 0.4)
"""Usual acceleration of a vehicle that scans along each of the world's axes [m/s²], and of its turn
about each [rad/s²]: a thruster's push on a vehicle of some ten kilograms. Weak: it only holds what
nothing else does, until the scan has shown how restless its vehicle is."""
LASTING = 0.2
"""How long an acceleration lasts [s]: over it one is independent of the next, whatever the length
of a spline's pieces."""
_SAMPLE = 0.1
"""Time between the points at which an assumption is made where no instrument measured [s]."""
_FIXED = 1e-9
"""Standard deviation of what no reading can tell, and what is stated as without error."""
_ORIGIN = 1e-6
"""Standard deviation of the first place where nothing measured it: the world begins there [m]."""
_CLOCK_STEP = LASTING / 2
"""Step of the central difference by which a prediction changes with the clock [s]. Over shorter
times than an acceleration lasts a path follows its log's noise: rates that are noise would seem to
tell the clock, and pull it, since the same noise is in what they are to explain. A rate over longer
times goes with the true one and hardly with the noise of one reading: an instrumental variable.

Sargan, The estimation of economic relationships using instrumental variables, Econometrica 26(3),
1958.
"""


@dataclass(frozen=True, eq=False)
class Log:
    """One pass's instruments, and where its unknowns stand."""

    number: int
    """Of the pass."""
    navigation: Navigation
    layout: Layout
    elapsed: float
    """Time since the same instruments' first pass [s]: how long the heading has drifted."""
    origin: Vector = field(default_factory=lambda: np.zeros(3))
    """Where the way begins, about, if no instrument has measured its place [m]."""
    origin_sigma: float = _ORIGIN
    """Standard deviation of that [m]; unless said, the world begins there."""
    unrest: tuple[float, ...] = UNREST
    """Usual accelerations of the vehicle; see `UNREST`."""

    def equations(
        self, path: Path, errors: Float[np.ndarray, " u"], settings: AdjustSettings
    ) -> Equations:
        """Give the equations of one pass at its present way.

        Args:
            path: The way.
            errors: All unknowns that are no path's, by their place in the whole vector.
            settings: For what no instrument measured.
        """
        parts = [one for one in self._measured(path, errors) if one is not None]
        parts += self._assumed(path, errors, settings)
        return Equations.stack([*parts, _steady(path, self._start, self.layout.count, self.unrest)])

    @property
    def _start(self) -> int:
        return self.layout.starts[self.number]

    def _measured(self, path: Path, errors: Float[np.ndarray, " u"]) -> list[Equations | None]:
        log, accuracy = self.navigation, self.navigation.accuracy
        heading = accuracy.heading_noise or accuracy.attitude_noise
        attitude = log.attitude
        tilt, course = None, None
        if attitude is not None:
            both = Readings(attitude.times, attitude.values[:, :2])
            tilt = self._equations(path, errors, both, accuracy.attitude_noise, Tilt())
            alone = Readings(attitude.times, attitude.values[:, 2:])
            course = self._equations(path, errors, alone, heading, Heading(_middle(path)))
        return [
            tilt,
            course,
            self._equations(path, errors, log.velocity, accuracy.velocity_noise, Velocity()),
            self._equations(path, errors, log.rates, accuracy.rate_noise, Rates()),
            self._equations(path, errors, log.depth, accuracy.depth_noise, Place((2,))),
            self._equations(path, errors, log.position, accuracy.position_noise, Place((0, 1, 2))),
        ]

    def _equations(
        self,
        path: Path,
        errors: Float[np.ndarray, " u"],
        readings: Readings | None,
        sigma: float | None,
        kind: Instrument,
    ) -> Equations | None:
        """Give the equations of one instrument; None where it did not measure."""
        if readings is None or sigma is None:
            return None
        times = self._own_times(readings.times, path, errors)
        inside = _within(times, path)
        times, values = times[inside], readings.values[inside]
        if len(times) == 0:
            return None
        poses = path.at(times)
        predicted = kind.predict(path, poses)
        places = [self._place(name) for name in kind.errors]
        slopes = kind.error_slopes(times)
        offset = sum(s * errors[p] for s, p in zip(slopes, places, strict=True))
        residuals = kind.subtract(predicted, values) + offset
        terms = list(zip(places, slopes, strict=True))
        if self.navigation.accuracy.clock_offset > 0:
            terms += self._clock_terms(kind, path, times)
        return equations_of_path(
            residuals,
            kind.slopes(path, poses),
            poses.first,
            self._start,
            self.layout.count,
            errors=terms,
            sigma=sigma,
        )

    def _place(self, name: str) -> int:
        own = name.startswith("heading")
        return self.layout.own(self.number, name) if own else self.layout.shared(self.number, name)

    def _own_times(self, times: Scalars, path: Path, errors: Float[np.ndarray, " u"]) -> Scalars:
        """Give when, by the recording's clock, readings were taken."""
        offset = errors[self.layout.shared(self.number, "clock_offset")]
        drift = errors[self.layout.shared(self.number, "clock_drift")]
        return times + offset + drift * self._since_start(times, path)

    def _since_start(self, times: Scalars, path: Path) -> Scalars:
        return times - path.knots.first + self.elapsed

    def _clock_terms(
        self, kind: Instrument, path: Path, times: Scalars
    ) -> list[tuple[int, Float[np.ndarray, "n m"]]]:
        inner = np.clip(times, path.knots.start + _CLOCK_STEP, path.knots.end - _CLOCK_STEP)
        ahead = kind.predict(path, path.at(inner + _CLOCK_STEP))
        behind = kind.predict(path, path.at(inner - _CLOCK_STEP))
        change = kind.subtract(ahead, behind) / (2 * _CLOCK_STEP)
        drift = change * self._since_start(times, path)[:, None]
        place = self.layout.shared
        return [
            (place(self.number, "clock_offset"), change),
            (place(self.number, "clock_drift"), drift),
        ]

    def _assumed(
        self, path: Path, errors: Float[np.ndarray, " u"], settings: AdjustSettings
    ) -> list[Equations]:
        """Stand in for instruments that a vehicle does not have."""
        log, parts = self.navigation, []
        times = np.arange(path.knots.start, path.knots.end, _SAMPLE)
        if log.speed is not None:
            wander = settings.speed_wander * abs(log.speed)
            factor = self.layout.shared(self.number, "speed_factor")
            ahead = np.tile(log.speed * np.array(log.course), (len(times), 1))
            poses = path.at(times)
            residuals = Velocity().predict(path, poses) - ahead * (1 + errors[factor])
            slopes = Velocity().slopes(path, poses)
            drifting = self._plain(residuals, slopes, poses, 1.0, [(factor, -ahead)])
            parts.append(_wandering(drifting, len(times), wander, settings.wander_time))
        if log.accuracy.attitude_noise is None:
            poses = path.at(times)
            change = np.tile(np.eye(3), (len(times), 1, 1))
            turns = evaluate(path.knots, path.turns, times)
            drifting = self._plain(turns, slopes_of_turn(poses, change), poses, 1.0, [])
            wander = settings.attitude_wander
            parts.append(_wandering(drifting, len(times), wander, settings.wander_time))
        accuracy = log.accuracy
        if not self._holds(log.position, accuracy.position_noise, path, errors):
            knows_depth = self._holds(log.depth, accuracy.depth_noise, path, errors)
            place = Place((0, 1) if knows_depth else (0, 1, 2))
            poses = path.at(np.array([path.knots.first]))
            off = place.predict(path, poses) - self.origin[list(place.axes)]
            sigma = self.origin_sigma
            parts.append(self._plain(off, place.slopes(path, poses), poses, sigma, []))
        return parts

    def _holds(
        self,
        readings: Readings | None,
        sigma: float | None,
        path: Path,
        errors: Float[np.ndarray, " u"],
    ) -> bool:
        """Tell whether an instrument has measured the way: a fix may be of before it began."""
        if readings is None or sigma is None:
            return False
        return bool(_within(self._own_times(readings.times, path, errors), path).any())

    def _plain(
        self,
        residuals: Float[np.ndarray, "n m"],
        slopes: Float[np.ndarray, "n 4 m 6"],
        poses: Poses,
        sigma: float,
        terms: list[tuple[int, Float[np.ndarray, "n m"]]],
    ) -> Equations:
        return equations_of_path(
            residuals, slopes, poses.first, self._start, self.layout.count,
            errors=terms, sigma=sigma,
        )  # fmt: skip

    def priors(self) -> list[tuple[int, float]]:
        """Give the standard deviation that is stated for each of the instruments' errors."""
        accuracy = self.navigation.accuracy
        heading = np.hypot(
            accuracy.heading_noise or accuracy.attitude_noise or 0.0,
            accuracy.heading_drift * self.elapsed,
        )
        shared = {
            **dict.fromkeys(("velocity_bias_x", "velocity_bias_y", "velocity_bias_z"),
                            accuracy.velocity_bias),
            "speed_factor": accuracy.speed or 0.0,
            **dict.fromkeys(("roll_bias", "pitch_bias"), accuracy.attitude_bias),
            **dict.fromkeys(("rate_bias_x", "rate_bias_y", "rate_bias_z"), accuracy.rate_bias),
            "clock_offset": accuracy.clock_offset,
            "clock_drift": accuracy.clock_drift,
        }  # fmt: skip
        own = {"heading_offset": float(heading), "heading_drift": accuracy.heading_drift}
        return [
            *((self.layout.shared(self.number, name), s) for name, s in shared.items()),
            *((self.layout.own(self.number, name), s) for name, s in own.items()),
        ]


def _wandering(raw: Equations, count: int, wander: float, period: float) -> Equations:
    """Make readings of what wanders about a known value independent of one another.

    An Ornstein-Uhlenbeck process keeps the share ρ = exp(-dt/τ) of itself from one sample to the
    next, and what it gains in between is independent, of variance s²·(1 - ρ²).

    Args:
        raw: Its readings, three at each time, `_SAMPLE` apart.
        count: Of times.
        wander: Its standard deviation s.
        period: Time τ over which it goes together with itself [s].

    References:
        Uhlenbeck and Ornstein, On the theory of the Brownian motion, Physical Review 36, 1930.
    """
    share = float(np.exp(-_SAMPLE / period))
    gained = np.full(count, wander * np.sqrt(1 - share**2))
    gained[0] = wander
    steps = sparse.eye_array(count) - share * sparse.eye_array(count, k=-1)
    whiten = sparse.kron(sparse.diags(1 / gained) @ steps, sparse.eye_array(3)).tocsr()
    return Equations(whiten @ raw.residuals, sparse.csr_matrix(whiten @ raw.jacobian))


def prior_equations(logs: Sequence[Log], unknowns: Float[np.ndarray, " u"]) -> Equations:
    """Hold each instrument's errors near 0, as far as its accuracy says."""
    sigmas = dict(entry for log in logs for entry in log.priors())
    places = np.array(sorted(sigmas))
    sigma = np.array([max(sigmas[p], _FIXED) for p in places])
    entries = (1 / sigma, (np.arange(len(places)), places))
    jacobian = sparse.csr_matrix(entries, shape=(len(places), logs[0].layout.count))
    return Equations(unknowns[places] / sigma, jacobian)


def _steady(path: Path, start: int, width: int, unrest: Sequence[float]) -> Equations:
    """Hold accelerations near 0: weakly, so that nothing stays without any equation."""
    times = path.knots.quadrature_times
    first, weights = path.knots.weights(times, derivative=2)
    slopes = weights[:, :, None, None] * np.eye(6)
    sigma = np.array(unrest) * np.sqrt(2 * LASTING / path.knots.step)
    change = np.hstack(
        [
            evaluate(path.knots, path.positions, times, derivative=2),
            evaluate(path.knots, path.turns, times, derivative=2),
        ]
    )
    return equations_of_path(change / sigma, slopes / sigma[:, None], first, start, width)


def _middle(path: Path) -> float:
    return (path.knots.start + path.knots.end) / 2


def _within(times: Scalars, path: Path) -> Mask:
    return (times >= path.knots.start) & (times <= path.knots.end)
