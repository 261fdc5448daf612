"""Where a wheelset can be one sample later: enclosures for many cells of states at once.

Between two samples the slip obeys eq. (19) with a torque that is known in closed form, because the valve only
fills, vents and holds. With X = T/2 - R f and the train's deceleration a = (f_d + 8 f)/m,

    slip' = [R X / I - (1 - slip) a] / v + (1 - slip) B_W / I.

This is scalar in the slip and rises with the torque, so the largest slip of a cell never exceeds that of a wheel
that starts at its upper edge under its largest torque, and correspondingly below (comparison theorem). The bound
is followed over steps of the sample: if the rate is at most s while the slip lies in [u - d, u + e], and s dt <= e,
a slip that is at most u now stays below u + max(0, s dt) and ends below u + max(s dt, -d). Where the creep force is
too steep for the step, on the adhering side of the curve, no such e is found and the cell counts as leaving.

The creep force grows with the friction and with the load at given slip and speed, since both parts g of its shape,
x/(1 + x^2) and atan x, have g - x g' >= 0. Hence it is evaluated at the ends of their ranges.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from wspd_design.certificates.records import Problem
from wspd_design.certificates.search.invariant_sets.duals import Interval, mean_value
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.controllers.protocol import Measurement
from wspd_design.model import adhesion
from wspd_design.model import slip as slip_model
from wspd_design.model.generated.brake import vented_pressure
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Brake

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

ROUNDING = 2.0**-45
"""Relative width that covers pi as a double, and the products of plain doubles inside the kernels."""
MAX_SHAPE = 1.0 + 1.0 / math.pi
"""Bound of the creep force over friction times load: (2/pi)(x/(1 + x^2) + atan) <= (2/pi)(1/2 + pi/2)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Window:
    """A range of train speed at the sampling instant, and the coordinates of its cells.

    The second coordinate is the level z = T/T_max + tilt (slip - reference), so that a law which trades torque for
    slip has nearly upright cells.
    """

    low: float  # m/s
    high: float  # m/s
    tilt: float  # share of T_max per slip


@dataclass(frozen=True, slots=True)
class Images:
    """Bounds for each cell of where it is one sample later, and of the slip in between; infinite if unknown."""

    slip_low: "Array"
    slip_high: "Array"
    level_low: "Array"
    level_high: "Array"
    between_low: "Array"
    between_high: "Array"


def images(problem: Problem, window: Window, slip: Interval, level: Interval, *, steps: int) -> Images:
    """Enclose the images of cells over all speeds of a window and all parameters of the box.

    Parameters
    ----------
    problem : Problem
        Closed loop, with the parameter box.
    window : Window
        Speeds at the sampling instant.
    slip, level : Interval
        Arrays of the edges of the cells.
    steps : int
        Steps of equal length that a sample is cut into.
    """
    import ival
    import numpy as np

    brakes, sample = problem.vehicle.brake, problem.sample_time
    share = level - window.tilt * (slip - problem.slip)
    torque = brakes.max_torque * ival.Interval(np.clip(share.inf, 0.0, 1.0), np.clip(share.sup, 0.0, 1.0))
    fill, vent = commands(problem, window, slip, level)
    slowest = window.low - ival.Interval(sample, sample) * largest_deceleration(problem, window)
    speed = ival.Interval(slowest.inf, window.high)
    low, high = slip.inf, slip.sup
    between_low, between_high = low, high
    known = np.full(np.shape(low), True)
    change = ival.Interval(np.zeros_like(low), np.zeros_like(low))
    for k in range(steps):
        part = ival.Interval(k / steps, (k + 1) / steps)
        step = (ival.Interval(part.sup, part.sup) - part.inf) * sample
        passed = ival.Interval(
            torque_path(brakes, sample, torque.inf, fill.inf, vent.sup, part).inf,
            torque_path(brakes, sample, torque.sup, fill.sup, vent.inf, part).sup,
        )
        top = _advance(problem, speed, high, passed.sup, step, upwards=True)
        bottom = _advance(problem, speed, low, passed.inf, step, upwards=False)
        known &= top.known & bottom.known
        change = change + step * slip_rate(problem, ival.Interval(bottom.during, top.during), speed, passed)
        low, high = bottom.after, top.after
        between_low, between_high = (
            np.minimum(between_low, bottom.during),
            np.maximum(between_high, top.during),
        )
    known &= (between_low >= 0.0) & (between_high < 1.0)  # where the model holds: rolling, not locked
    # The new torque less the old one falls with the old torque and with venting, and rises with filling.
    rise = (torque_after(brakes, sample, torque.inf, fill.sup, vent.inf) - torque.inf).sup
    fall = (torque_after(brakes, sample, torque.sup, fill.inf, vent.sup) - torque.sup).inf
    moved = level + ival.Interval(fall, rise) / brakes.max_torque + window.tilt * change

    def bounds(low: "Array", high: "Array") -> tuple["Array", "Array"]:
        return np.where(known, low, -np.inf), np.where(known, high, np.inf)

    return Images(*bounds(low, high), *bounds(moved.inf, moved.sup), *bounds(between_low, between_high))


def commands(problem: Problem, window: Window, slip: Interval, level: Interval) -> tuple[Interval, Interval]:
    """Enclose the shares of the sample time that the law fills and vents, over cells and the speeds of a window."""
    import ival

    law, radius, full = problem.wheelset_law, problem.vehicle.wheel_radius, problem.vehicle.brake.max_torque

    def command(slip: Any, level: Any, speed: Any) -> tuple[Any, ...]:
        torque = full * (level - window.tilt * (slip - problem.slip))
        _, answer = law.step((), Measurement(speed, speed * (1.0 - slip) / radius, torque))
        return tuple(answer)

    fill, vent = mean_value(command, (slip, level, ival.Interval(window.low, window.high)))
    return fill, vent


def slip_rate(problem: Problem, slip: Interval, speed: Interval, torque: Interval) -> Interval:
    """Enclose slip' over boxes of slip, speed [m/s] and torque [N m], and all parameters of the box [1/s]."""
    import ival

    vehicle = problem.vehicle
    mass, inertia = (
        ival.Interval(*problem.span("mass")),
        ival.Interval(*problem.span("wheelset inertia")) / 2.0,
    )
    force, used = _forces(problem, slip, speed)
    rolling = 1.0 - slip
    deceleration = slip_model.resistance(vehicle, speed) / mass + _braking_gravity(problem) * used
    radius = vehicle.wheel_radius
    excess = torque / 2.0 - radius * force
    damping = ival.Interval(0.0, vehicle.wheel_damping)
    return (radius * excess / inertia - rolling * deceleration) / speed + rolling * damping / inertia


def _forces(problem: Problem, slip: Interval, speed: Interval) -> tuple[Interval, Interval]:
    """Enclose the creep force [N] and the adhesion f/Q that it uses [-], between the ends of friction and load."""
    import ival

    widened = ival.Interval(1.0 - ROUNDING, 1.0 + ROUNDING)
    sliding = slip * speed
    loads, forces = [], []
    # With a single value of both, one end will do.
    for friction, mass in dict.fromkeys(zip(problem.span("mu0"), problem.span("mass"), strict=True)):
        thin = ival.Interval(mass, mass)
        vehicle, rail = plant_with(problem, {"mass": thin, "mu0": ival.Interval(friction, friction)})
        loads.append(slip_model.static_wheel_load(vehicle))
        slope = widened * adhesion.contact_stiffness(vehicle.contact, loads[-1])
        forces.append(widened * adhesion.creep_force(slip, sliding, loads[-1], rail, slope))
    force = ival.Interval(forces[0].inf, forces[-1].sup)
    return force, force / ival.Interval(loads[0].inf, loads[-1].sup)


def largest_deceleration(problem: Problem, window: Window) -> Interval:
    """Bound the deceleration of the train in a window [m/s2]."""
    import ival

    top = ival.Interval(window.high, window.high)
    resistance = slip_model.resistance(problem.vehicle, top) / problem.span("mass")[0]
    grip = ival.Interval(0.0, MAX_SHAPE * (1.0 + ROUNDING)) * problem.span("mu0")[1]
    return ival.Interval(0.0, (resistance + _braking_gravity(problem) * grip).sup)


def _braking_gravity(problem: Problem) -> Interval:
    """Deceleration per adhesion, g for a vehicle of which every wheel brakes [m/s2]."""
    import ival

    count = float(slip_model.wheels(problem.vehicle))
    return constants().gravity * ival.Interval(count, count) / count


class _Bound(NamedTuple):
    """Bound of the slip after a step and during it, and whether one was found."""

    after: "Array"
    during: "Array"
    known: "NDArray[np.bool_]"


def _advance(
    problem: Problem, speed: Interval, edge: "Array", torque: "Array", step: Interval, *, upwards: bool
) -> _Bound:
    """Follow an upper or a lower bound of the slip through one step."""
    import ival
    import numpy as np

    sign = 1.0 if upwards else -1.0
    thin = ival.Interval(torque, torque)
    at_edge = slip_rate(problem, ival.Interval(edge, edge), speed, thin) * step
    guess = sign * (at_edge.sup if upwards else at_edge.inf)
    ahead, behind = 1.3 * np.maximum(guess, 0.0) + 1e-6, 1.3 * np.maximum(-guess, 0.0)
    near = edge - behind, edge + ahead
    if not upwards:
        near = edge - ahead, edge + behind
    moves = slip_rate(problem, ival.Interval(*near), speed, thin) * step
    move = sign * (moves.sup if upwards else moves.inf)
    known = move <= 0.999 * ahead  # less than ahead, which is added in plain doubles above
    move = np.where(known, move, 0.0)
    # One more digit outwards, since these sums are rounded to the nearest.
    after = np.nextafter(edge + sign * np.maximum(move, -behind), sign * np.inf)
    during = np.nextafter(edge + sign * np.maximum(move, 0.0), sign * np.inf)
    return _Bound(after, during, known)


def torque_after(brakes: Brake, sample: float, start: "Array", fill: "Array", vent: "Array") -> Interval:
    """Enclose the torque at the end of a sample [N m]."""
    import ival

    return torque_path(brakes, sample, start, fill, vent, ival.Interval(1.0, 1.0))


def torque_path(
    brakes: Brake, sample: float, start: "Array", fill: "Array", vent: "Array", part: Interval
) -> Interval:
    """Enclose the torque during a part of a sample that fills, then vents, then holds [N m].

    Parameters
    ----------
    brakes : Brake
        Time constants and full torque; the supply is at full pressure.
    sample : float
        Sample time [s].
    start : array
        Torque at the sampling instant [N m].
    fill, vent : array
        Shares of the sample time.
    part : Interval
        From where to where, as shares of the sample time.
    """
    import ival
    import numpy as np

    full = brakes.max_torque

    def at(time: "Array") -> Interval:
        filled = ival.Interval(np.minimum(time, fill), np.minimum(time, fill)) * sample
        # The part of the sample after filling, as the difference of two doubles, is not exact.
        vented = ival.max(ival.Interval(time, time) - fill, ival.Interval(0.0, 0.0))
        vented = ival.min(vented, ival.Interval(vent, vent)) * sample
        lacking = ival.Interval(full, full) - start
        peak = full - vented_pressure(filled, lacking, brakes.fill_time)
        return vented_pressure(vented, peak, brakes.vent_time)

    shape = np.shape(start)
    first, last = at(np.full(shape, part.inf)), at(np.full(shape, part.sup))
    # The torque rises while it fills and falls afterwards: extremes at the ends or where the filling stops.
    top = at(np.clip(fill, part.inf, part.sup))
    return ival.Interval(np.minimum(first.inf, last.inf), top.sup)
