"""The closed loop in the setting of the proofs: torque equal to command, no sampling, no limits, no valve.

Speed, slip, the integral of the error and what the law adapts are integrated as one smooth system.
"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import TYPE_CHECKING, Any, TypeAlias

from wspd_design.certificates.balls import Ball, below, point
from wspd_design.certificates.domain import KMH
from wspd_design.certificates.invariance.ball_slopes import law_slopes
from wspd_design.certificates.plant import model_variables, plant_records, plant_variables, records_of
from wspd_design.certificates.records import Point, Problem, Status
from wspd_design.controllers.adaptive_fuzzy import (
    AdaptiveFuzzyGains,
    adaptation,
    sliding_variable,
    torque_demand,
)
from wspd_design.controllers.sliding_mode import SlidingMode, sliding_torque
from wspd_design.model.generated import sliding_surface
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

RELATIVE_TOLERANCE = 1e-8
ABSOLUTE_TOLERANCE = 1e-10
MOST_TRIED = 50  # states of a run whose derivative is evaluated exactly
ASSUMPTIONS = (
    "T = u: torque equals command, without valve lag, sampling or limits of the brake",
    "quarter locomotive with static wheel load and nominal parameters",
    "slip reference constant",
)

State = Any  # (speed, slip, integral of e, what the law adapts ...), one instant or arrays over time
Flow: TypeAlias = Callable[[State], list[Any]]
"""Time derivatives of the states, in whatever numbers the states are."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ProofRun:
    """A run of the idealized loop; the states are rows over time.

    A run that does not reach its lowest speed says why in ``cut``: what happened before still counts.
    """

    time: "Array"  # s
    states: "Array"  # speed [m/s], slip [-], integral of e [s], then what the law adapts
    rates: "Array"  # their time derivatives
    cut: str = ""

    @property
    def speed(self) -> "Array":
        """Train speed [m/s]."""
        row: Array = self.states[0]
        return row

    @property
    def slip(self) -> "Array":
        """Slip ratio [-]."""
        row: Array = self.states[1]
        return row

    @property
    def integral(self) -> "Array":
        """Integral of the slip error [s]."""
        row: Array = self.states[2]
        return row

    def state(self, index: int, rate: float, name: str, unit: str) -> tuple[Point, ...]:
        """Return the state at an instant, at which a function falls no faster than a rate, in readable units."""
        _, _, integral, *adapted = self.states[:, index].tolist()
        names = [*(f"weight {k}" for k in range(1, len(adapted))), "bound"] if adapted else []
        return (
            Point(name="slip", value=float(self.slip[index]), unit="-"),
            Point(name="speed", value=float(self.speed[index]) * KMH, unit="km/h"),
            Point(name="integral of the slip error", value=integral, unit="s"),
            *(Point(name=each, value=x, unit="of u") for each, x in zip(names, adapted, strict=True)),
            Point(name=f"least {name}", value=rate, unit=unit),
            Point(name="time", value=float(self.time[index]), unit="s"),
        )

    def certainty(self, shown: tuple[int, float] | None, name: str, unit: str) -> str:
        """Say what :func:`certain_rise` found."""
        if shown is None:
            return "But at no state of the run that was tried its derivative is positive for certain."
        index, rate = shown
        return (
            f"At {self.time[index]:.3g} s, with {self.speed[index] * KMH:.3g} km/h and slip {self.slip[index]:.4f}, "
            f"{name} is at least {rate:.3g} {unit} in exact arithmetic."
        )


def adaptive_flow(vehicle: Vehicle, rail: Rail, gains: AdaptiveFuzzyGains) -> Flow:
    """Return the loop of the adaptive fuzzy law with continuous adaptation."""

    def rates(state: State) -> list[Any]:
        speed, slip, integral, *weights, bound = state
        error = sliding_surface.slip_error(gains.slip_reference, slip)
        surface = sliding_variable(gains, error, integral)
        torque = torque_demand(gains, surface, tuple(weights), bound)
        plant = slip_dynamics(vehicle, rail, slip, speed)
        adapted = adaptation(gains, surface, speed)
        return [
            -plant.deceleration,
            plant.drift + plant.gain * torque,
            error,
            *adapted.weights,
            adapted.bound,
        ]

    return rates


def sliding_flow(vehicle: Vehicle, rail: Rail, law: SlidingMode) -> Flow:
    """Return the loop of the sliding-mode law."""

    def rates(state: State) -> list[Any]:
        speed, slip, integral = state
        plant = slip_dynamics(vehicle, rail, slip, speed)
        torque = sliding_torque(law, slip, speed, integral)
        error = sliding_surface.slip_error(law.gains.slip_reference, slip)
        return [-plant.deceleration, plant.drift + plant.gain * torque, error]

    return rates


def adaptive_run(
    vehicle: Vehicle, rail: Rail, gains: AdaptiveFuzzyGains, *, speeds: tuple[float, float]
) -> ProofRun:
    """Brake from rolling with the adaptive fuzzy law and continuous adaptation.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Plant.
    gains : AdaptiveFuzzyGains
        Law.
    speeds : tuple of float
        Lowest and highest speed [m/s]; the run goes from the highest down to the lowest.
    """
    start = [speeds[1], 0.0, 0.0, *gains.initial_weights, gains.initial_bound]
    return _run(adaptive_flow(vehicle, rail, gains), start, speeds[0])


def sliding_run(
    vehicle: Vehicle, rail: Rail, law: SlidingMode, *, speeds: tuple[float, float], slip: float
) -> ProofRun:
    """Brake from an initial slip with the sliding-mode law; parameters as in :func:`adaptive_run`."""
    return _run(sliding_flow(vehicle, rail, law), [speeds[1], slip, 0.0], speeds[0])


def _run(rates: Flow, start: list[float], lowest_speed: float) -> ProofRun:
    """Integrate until the lowest speed."""
    import numpy as np
    from scipy.integrate import solve_ivp

    def derivative(_: float, state: "Array") -> list[float]:
        return rates(state.tolist())

    def slow_enough(_: float, state: "Array") -> float:
        return float(state[0]) - lowest_speed

    def inside(_: float, state: "Array") -> float:
        """Positive while the wheel turns forwards and slips forwards."""
        return min(float(state[1]) + 1e-3, 1.0 - float(state[1]))

    slow_enough.terminal = inside.terminal = True  # type: ignore[attr-defined]
    solution = solve_ivp(
        derivative,
        (0.0, constants().time_limit),
        start,
        method="Radau",
        rtol=RELATIVE_TOLERANCE,
        atol=ABSOLUTE_TOLERANCE,
        events=(slow_enough, inside),
    )
    end, cut = f"{solution.t[-1]:.3g} s", ""
    if solution.status == 0:
        cut = f"the train does not slow down to {lowest_speed:g} m/s within {end}"
    elif solution.status < 0:
        cut = f"the integration fails at {end}"
    elif solution.t_events[1].size:
        cut = f"the slip leaves the range 0 to 1 at {end}, where the wheel locks or outruns the train"
    states = np.asarray(solution.y)
    derivatives = np.array([rates(column) for column in states.T.tolist()]).T
    return ProofRun(time=np.asarray(solution.t), states=states, rates=derivatives, cut=cut)


def exact_plant(problem: Problem, mass: float, inertia: float, mu0: float) -> tuple[Vehicle, Rail]:
    """Return vehicle and rail with their numbers as balls [kg, kg m2 per wheelset, -], so that nothing is rounded."""
    known = plant_variables(problem, mass=mass, inertia=inertia, mu0=mu0)
    return plant_records(problem, {v.name: point(v.low) for v in known})


def exact_law(law: SlidingMode) -> SlidingMode:
    """Return a law with the numbers of its design model as balls."""
    known = {v.name: point(v.low) for v in model_variables(law.vehicle, law.rail)}
    vehicle, rail = records_of(known, law.vehicle, law.rail, "model ")
    return replace(law, vehicle=vehicle, rail=rail)


def exact_rate(candidate: Callable[[State], Any], flow: Flow, state: Sequence[float]) -> Ball:
    """Enclose the derivative of a function of the states along the flow, at one state without rounding.

    A rise between two instants of a run is what its floats say; a derivative that is positive here is positive.

    Parameters
    ----------
    candidate : callable
        The function; it has to run on balls with slopes.
    flow : Flow
        Of the loop, with its numbers as balls.
    state : sequence of float
        Taken as exact.
    """
    balls = tuple(point(float(each)) for each in state)
    ((_, slopes),) = law_slopes(lambda *x: (candidate(x),), balls)
    return sum((slope * rate for slope, rate in zip(slopes, flow(balls), strict=True)), point(0.0))


def numeric_rate(candidate: Callable[["Array"], "Array"], run: ProofRun) -> "Array":
    """Derivative of a function of the states along the run, by central differences along the flow.

    It needs no formula of the derivative and no interpolation between the solver's steps.
    """
    import numpy as np

    scale = 1e-6 / np.maximum(1.0, np.max(np.abs(run.rates) / np.maximum(np.abs(run.states), 1e-3), axis=0))
    forward, backward = candidate(run.states + scale * run.rates), candidate(run.states - scale * run.rates)
    rate: Array = (forward - backward) / (2.0 * scale)
    return rate


def certain_rise(
    candidate: Callable[[State], Any],
    flow: Flow,
    run: ProofRun,
    order: Iterable[int],
    *,
    speaks: Callable[[State], bool] = lambda _: True,
) -> tuple[int, float] | None:
    """Look for an instant of a run at whose state a function rises for certain.

    Parameters
    ----------
    candidate, flow : callable, Flow
        As in :func:`exact_rate`.
    run : ProofRun
        Its states are taken as exact.
    order : iterable of int
        Instants, the most promising first.
    speaks : callable, optional
        Whether the claim speaks about a state of balls.

    Returns
    -------
    tuple or None
        The instant and a number that the derivative exceeds there.
    """
    for index in islice(order, MOST_TRIED):
        state = run.states[:, index].tolist()
        rate = exact_rate(candidate, flow, state)
        if rate > 0 and speaks(tuple(map(point, state))):
            return index, below(rate)
    return None


def largest_rise(values: "Array") -> tuple[float, int, int]:
    """Largest rise of a function of time over all earlier values, with both places; zero without any."""
    import numpy as np

    lowest = np.minimum.accumulate(values)
    end = int(np.argmax(values - lowest))
    start = int(np.argmin(values[: end + 1]))
    return float(values[end] - values[start]), start, end


def verdict(rises: bool, shown: bool, runs: Iterable[ProofRun]) -> Status:
    """Verdict on a function that must not rise.

    Parameters
    ----------
    rises : bool
        Whether it does along a run, in floats.
    shown : bool
        Whether its derivative is positive for certain at a state of that run.
    runs : iterable of ProofRun
        A run that was cut short can refute, but not support.
    """
    if rises:
        return Status.REFUTED if shown else Status.UNDECIDED
    return Status.UNDECIDED if any(run.cut for run in runs) else Status.EVIDENCE


def cut_short(runs: Iterable[ProofRun]) -> str:
    """Say which runs were cut short, as a sentence that follows others."""
    reasons = dict.fromkeys(run.cut for run in runs if run.cut)
    return "".join(f" A run was cut short: {reason}." for reason in reasons)
