"""Runs of the idealized loop: speed, slip, the integral of the error and what the law adapts, as one smooth system."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.certificates.theorems.ideal_loop import Flow, adaptive_flow, sliding_flow
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzyGains
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Rail, Vehicle

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

RELATIVE_TOLERANCE = 1e-8
ABSOLUTE_TOLERANCE = 1e-10


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


def numeric_rate(candidate: Callable[["Array"], "Array"], run: ProofRun) -> "Array":
    """Derivative of a function of the states along the run, by central differences along the flow.

    It needs no formula of the derivative and no interpolation between the solver's steps.
    """
    import numpy as np

    scale = 1e-6 / np.maximum(1.0, np.max(np.abs(run.rates) / np.maximum(np.abs(run.states), 1e-3), axis=0))
    forward, backward = candidate(run.states + scale * run.rates), candidate(run.states - scale * run.rates)
    rate: Array = (forward - backward) / (2.0 * scale)
    return rate


def largest_rise(values: "Array") -> tuple[float, int, int]:
    """Largest rise of a function of time over all earlier values, with both places; zero without any."""
    import numpy as np

    lowest = np.minimum.accumulate(values)
    end = int(np.argmax(values - lowest))
    start = int(np.argmin(values[: end + 1]))
    return float(values[end] - values[start]), start, end


def cut_short(runs: Iterable[ProofRun]) -> str:
    """Say which runs were cut short, as a sentence that follows others."""
    reasons = dict.fromkeys(run.cut for run in runs if run.cut)
    return "".join(f" A run was cut short: {reason}." for reason in reasons)
