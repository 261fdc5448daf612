"""Runs of the idealized loop: speed, slip, the integral of the error and what the law adapts, as one smooth system."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.certificates.checks.rosenbrock import Rates, Track, integrate
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
    return _runs([adaptive_flow(vehicle, rail, gains)], [start], speeds[0])[0]


def sliding_runs(
    plants: Sequence[tuple[Vehicle, Rail]],
    law: SlidingMode,
    *,
    speeds: tuple[float, float],
    slips: Sequence[float],
) -> list[ProofRun]:
    """Brake each plant with the sliding-mode law, from the initial slip of the same place; speeds as above."""
    flows = [sliding_flow(vehicle, rail, law) for vehicle, rail in plants]
    return _runs(flows, [[speeds[1], slip, 0.0] for slip in slips], speeds[0])


def sliding_run(
    vehicle: Vehicle, rail: Rail, law: SlidingMode, *, speeds: tuple[float, float], slip: float
) -> ProofRun:
    """Brake one plant with the sliding-mode law."""
    return sliding_runs([(vehicle, rail)], law, speeds=speeds, slips=[slip])[0]


def _runs(flows: Sequence[Flow], starts: Sequence[Sequence[float]], lowest_speed: float) -> list[ProofRun]:
    """Integrate until the lowest speed, or until the wheel no longer turns and slips forwards."""
    import numpy as np

    def limits(states: "Array") -> "Array":
        speed, slip = states[:, 0], states[:, 1]
        return np.array([speed - lowest_speed, np.minimum(slip + 1e-3, 1.0 - slip)])

    tracks = integrate(
        Rates(flows, len(starts[0])),
        np.array(starts),
        limits,
        until=constants().time_limit,
        relative=RELATIVE_TOLERANCE,
        absolute=ABSOLUTE_TOLERANCE,
    )
    return [_run(flow, track, lowest_speed) for flow, track in zip(flows, tracks, strict=True)]


def _run(flow: Flow, track: Track, lowest_speed: float) -> ProofRun:
    """Say how a run ended."""
    import numpy as np

    end, cut = f"{track.times[-1]:.3g} s", ""
    if track.event == 1:
        cut = f"the slip leaves the range 0 to 1 at {end}, where the wheel locks or outruns the train"
    elif track.failed:
        cut = f"the integration fails at {end}"
    elif track.event is None:
        cut = f"the train does not slow down to {lowest_speed:g} m/s within {end}"
    states = np.array(track.states).T
    rates = np.array([np.broadcast_to(each, states.shape[1:]) for each in flow(states)], dtype=np.float64)
    return ProofRun(time=np.array(track.times), states=states, rates=rates, cut=cut)


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
