"""Stiff runs side by side: linearly implicit steps of order four, each run with steps of its own.

The method is RODAS, L-stable with six stages and an embedded solution of order three (Hairer and Wanner, Solving
Ordinary Differential Equations II, 2nd edition, section IV.10, with the coefficients of their program).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from wspd_design.certificates.theorems.ideal_loop import Flow

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

GAMMA = 0.25
INNER = (
    (),
    (1.544,),
    (0.9466785280815826, 0.2557011698983284),
    (3.314825187068521, 2.896124015972201, 0.9986419139977817),
    (1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950),
    (1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1.0),
)
"""Weights of the earlier stages in the state at which a stage looks; the result adds the last stage once more."""
MIXED = (
    (),
    (-5.6688,),
    (-2.430093356833875, -0.2063599157091915),
    (-0.1073529058151375, -9.594562251023355, -20.47028614809616),
    (7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160),
    (8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054),
)
"""Weights of the earlier stages beside the derivative, over the step."""
FIRST_STEP, LEAST_STEP = 1e-6, 1e-13  # s
SAFETY, NARROWEST, WIDEST = 0.9, 0.2, 5.0  # of the factor from step to step
NEAR = 1e-12  # how near to its end a run has ended: of the value of an event at the start, of the time


@dataclass(slots=True)
class Track:
    """Accepted instants of one run."""

    times: list[float] = field(default_factory=lambda: [0.0])
    states: "list[Array]" = field(default_factory=list)
    event: int | None = None  # number of the one that ended the run
    failed: bool = False  # whether no step was short enough


class Rates:
    """The flows of all runs, and their slopes, as one CasADi function that NumPy calls without copying."""

    def __init__(self, flows: Sequence[Flow], size: int) -> None:
        import casadi as ca
        import numpy as np

        x = ca.SX.sym("x", size, len(flows))
        columns = [ca.vertcat(*flow(ca.vertsplit(x[:, k]))) for k, flow in enumerate(flows)]
        slopes = [ca.densify(ca.jacobian(column, x[:, k])).T for k, column in enumerate(columns)]
        # A matrix of CasADi lies column by column in memory: here each run, and each row of its slopes.
        self._kept: list[Any] = []  # what the calls below need to stay alive
        self._states = np.zeros((len(flows), size))
        self._rates, self._slopes = np.zeros((len(flows), size)), np.zeros((len(flows), size, size))
        self._rate = self._call(ca.Function("rates", [x], [ca.densify(ca.horzcat(*columns))]), self._rates)
        self._slope = self._call(ca.Function("slopes", [x], [ca.horzcat(*slopes)]), self._slopes)

    def _call(self, function: Any, result: "Array") -> Any:
        buffer, call = function.buffer()
        buffer.set_arg(0, memoryview(self._states))  # type: ignore[arg-type]
        buffer.set_res(0, memoryview(result))  # type: ignore[arg-type]
        self._kept += [function, buffer]
        return call

    def rates(self, states: "Array") -> "Array":
        """Return the derivatives (runs, states)."""
        self._states[:] = states
        self._rate()
        return self._rates.copy()

    def slopes(self, states: "Array") -> "Array":
        """Return their Jacobians (runs, rates, states)."""
        self._states[:] = states
        self._slope()
        return self._slopes.copy()


def integrate(
    rates: Rates,
    starts: "Array",
    events: "Callable[[Array], Array]",
    *,
    until: float,
    relative: float,
    absolute: float,
) -> list[Track]:
    """Integrate all runs until an event each.

    Parameters
    ----------
    rates : Rates
        Of the runs.
    starts : ndarray
        States at time zero (runs, states).
    events : callable
        Functions of the states (events, runs); a run ends where the first of them reaches zero from above.
    until : float
        Time at which every run ends [s].
    relative, absolute : float
        Tolerances of the error of a step.
    """
    import numpy as np

    count = len(starts)
    tracks = [Track(states=[start]) for start in starts]
    x, time, step = starts.copy(), np.zeros(count), np.full(count, FIRST_STEP)
    moving, near, late = np.ones(count, dtype=bool), NEAR * events(starts), until * (1.0 - NEAR)
    while moving.any():
        step = np.minimum(step, until - time)
        reached, error = _step(rates, x, np.where(moving, step, FIRST_STEP))
        bound = absolute + relative * np.maximum(np.abs(x), np.abs(reached))
        wrong = np.sqrt(np.mean((error / bound) ** 2, axis=1))
        before, after = events(x), events(reached)
        good = moving & (wrong <= 1.0)  # what is not a number is not good
        passed = good & (after < -near).any(axis=0)
        taken = good & ~passed
        for k in np.flatnonzero(taken):
            tracks[k].times.append(float(time[k] + step[k]))
            tracks[k].states.append(reached[k].copy())
        time[taken] += step[taken]
        x[taken] = reached[taken]
        with np.errstate(all="ignore"):
            factor = np.clip(SAFETY * wrong**-0.25, NARROWEST, WIDEST)
            # Straight to where the first event falls to zero.
            share = np.where(after < -near, before / (before - after), 1.0).min(axis=0)
        factor = np.where(passed, share, np.where(np.isnan(wrong), NARROWEST, factor))
        now = np.where(taken, after, before)
        happened = (now <= near) & moving
        step = step * factor
        for k in np.flatnonzero(happened.any(axis=0)):
            tracks[k].event = int(np.argmax(happened[:, k]))
        moving &= ~happened.any(axis=0) & (time < late)
        for k in np.flatnonzero(moving & (step < LEAST_STEP)):
            tracks[k].failed = True
        moving &= step >= LEAST_STEP
    return tracks


def _step(rates: Rates, x: "Array", step: "Array") -> "tuple[Array, Array]":
    """One step of every run: the new states, and their estimated errors."""
    import numpy as np

    h = step[:, np.newaxis]
    with np.errstate(all="ignore"):
        matrix = np.eye(x.shape[1]) / (GAMMA * h[:, :, np.newaxis]) - rates.slopes(x)
        inverse = _inverse(matrix)
        stages: list[Array] = []
        for inner, mixed in zip(INNER, MIXED, strict=True):
            inside = x + sum((w * k for w, k in zip(inner, stages, strict=True)), np.zeros_like(x))
            right = (
                rates.rates(inside)
                + sum((w * k for w, k in zip(mixed, stages, strict=True)), np.zeros_like(x)) / h
            )
            stages.append(np.einsum("kij,kj->ki", inverse, right))
        return inside + stages[-1], stages[-1]


def _inverse(matrices: "Array") -> "Array":
    """Invert each matrix; if one has no inverse, nothing is a number, and every step is refused."""
    import numpy as np

    try:
        return np.asarray(np.linalg.inv(matrices), dtype=np.float64)
    except np.linalg.LinAlgError:
        return np.full_like(matrices, np.nan)
