"""How large a deviation of the slip full venting brings back, sampled over speed and the bounds of the parameters.

Samples choose what is proved and where a witness is looked for, and are what the plot shows.
"""

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import INERTIA, MASS, MU0, SLIP, SPEED
from wspd_design.certificates.setting.plant import dynamics_at
from wspd_design.certificates.theorems.recovery import per_deviation, reach

if TYPE_CHECKING:
    from wspd_design.certificates.setting.domain import Array

SPEEDS, SLIPS = 121, 33
VENT_STEPS, HOLD_STEPS = 80, 24  # of the integration
HALVINGS = 40  # of the range of a parameter


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """What is recoverable at sampled speeds, found by integration, and what the condition guarantees [-]."""

    speeds: "Array"  # m/s
    nominal: "Array"
    worst: "Array"  # smallest over the corners of the parameters and the ends of T* = T_max between them
    tightest: "Array"  # points where it is smallest
    guaranteed: "Array"  # by the condition, smallest over corners and slips
    growth: "Array"  # largest within a sample, over corners and slips


def sample(problem: Problem) -> Samples:
    """Integrate and evaluate the condition at many speeds and all corners of the parameters.

    Up to T* = T_max the torque that has to be vented grows with load and friction. Beyond it grows no more, and a
    wheel that the full torque cannot hold at its reference comes back the easier. So the worst may lie between corners.
    """
    import numpy as np

    speeds = np.geomspace(*problem.speeds, SPEEDS)
    vehicle = problem.vehicle
    nominal = (vehicle.mass, vehicle.wheelset_inertia, problem.rail.mu0)
    slips = np.linspace(problem.slip, problem.slips[1], SLIPS)

    def at(corner: tuple[float, ...], slip: float) -> "Array":
        points = np.empty((SPEEDS, 5))
        points[:, SPEED], points[:, SLIP] = speeds, slip
        points[:, MASS], points[:, INERTIA], points[:, MU0] = corner
        return points

    corners = list(product(problem.span("mass"), problem.span("wheelset inertia"), problem.span("mu0")))
    held = [at(corner, problem.slip) for corner in corners]
    # Each edge of the box once, from the corners at the lower end of its mass or mu0.
    edges = [*((MASS, each) for each in held[:4]), *((MU0, each) for each in held[::2])]
    tried = np.array([*held, *(just_held(problem, each, column) for column, each in edges)])
    everywhere = np.concatenate([*tried, at(nominal, problem.slip)])
    exact = recoverable(problem, everywhere).reshape(-1, SPEEDS)
    shares, poles = [], []
    for corner in corners:
        fall = -dynamics_at(problem, at(corner, problem.slip)).drift
        for slip in slips:
            pole = dynamics_at(problem, at(corner, float(slip))).pole
            shares.append(per_deviation(problem, vehicle.brake.vent_time, pole, pole / fall))
            poles.append(pole)
    worst = exact[:-1]
    return Samples(
        speeds=speeds,
        nominal=exact[-1],
        worst=worst.min(axis=0),
        tightest=tried[worst.argmin(axis=0), np.arange(SPEEDS)],
        guaranteed=1.0 / np.max(shares, axis=0),
        growth=np.exp(problem.sample_time * np.max(poles, axis=0)),
    )


def just_held(problem: Problem, points: "Array", column: int) -> "Array":
    """Move points along one parameter to where T_max just holds the reference, or as near as its range allows.

    Parameters
    ----------
    problem : Problem
        Plant and ranges.
    points : ndarray
        Points of the domain at the reference slip.
    column : int
        Of a parameter with which T* grows.
    """
    import numpy as np

    def lacking(value: "Array") -> "Array":
        moved[:, column] = value
        plant = dynamics_at(problem, moved)
        found: Array = -plant.drift / plant.gain - problem.vehicle.brake.max_torque
        return found

    moved = points.copy()
    low, high = (np.full(len(points), end[column]) for end in domain.box(problem))
    low = np.where(lacking(high) <= 0.0, high, low)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        beyond = lacking(middle) > 0.0
        low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
    moved[:, column] = low
    return moved


def recoverable(problem: Problem, points: "Array") -> "Array":
    """Integrate how large a deviation may be that full venting, one sample late, keeps below slip_max [-].

    The path that just touches slip_max is followed backwards, from where its slip stands still to where it began.

    Parameters
    ----------
    problem : Problem
        Plant and sample time.
    points : ndarray
        Points of the domain, in the order of its columns; their slip does not matter.
    """
    import numpy as np

    brake, room = problem.vehicle.brake, reach(problem)
    at = points.copy()

    def dynamics(slip: "float | Array") -> tuple["Array", "Array"]:
        at[:, SLIP] = slip
        plant = dynamics_at(problem, at)
        return plant.drift, plant.gain

    def back(x: "Array", torque: Callable[[float], "Array"], step: "float | Array", count: int) -> "Array":
        """Follow the deviation backwards through steps of Runge and Kutta; the torque takes the count of steps."""

        def rate(k: float, x: "Array") -> "Array":
            drift, gain = dynamics(problem.slip + x)
            found: Array = -(drift + gain * torque(k))
            return found

        for k in range(count):
            one = rate(k, x)
            two = rate(k + 0.5, x + 0.5 * step * one)
            three = rate(k + 0.5, x + 0.5 * step * two)
            four = rate(k + 1, x + step * three)
            x = np.clip(x + step * (one + 2.0 * two + 2.0 * three + four) / 6.0, 0.0, room)
        return x

    drift, gain = dynamics(problem.slip)
    start = np.minimum(-drift / gain, brake.max_torque)
    drift, gain = dynamics(problem.slips[1])
    touching = np.clip(-drift / gain, 1e-9 * start, start)
    step = brake.vent_time * np.log(start / touching) / VENT_STEPS
    seen = back(
        np.full(len(points), room), lambda k: touching * np.exp(k * step / brake.vent_time), step, VENT_STEPS
    )
    return back(seen, lambda _: start, problem.sample_time / HOLD_STEPS, HOLD_STEPS)
