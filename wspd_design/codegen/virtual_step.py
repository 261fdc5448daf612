"""One integration step of the closed loop as a CasADi function, and several of them in one call.

The formulas are those of ``templates/motion.c``. Steps beyond the goal, and the one that would end below the
stop speed, leave the state as it is, so that a call may hold more steps than are needed.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import accumulate
from typing import Any, NamedTuple

from wspd_design.codegen.kernels import PARAMETERS, Kernels
from wspd_design.model.number import maximum, minimum, where

RADIUS = PARAMETERS.index(("vehicle", "wheel_radius"))
INERTIA = PARAMETERS.index(("vehicle", "wheelset_inertia"))
INTEGRATED = 8  # totals of a lane that are integrals; those of locks and the largest slip follow


def _places(sizes: dict[str, int]) -> dict[str, slice]:
    ends = list(accumulate(sizes.values()))
    return {name: slice(end - size, end) for (name, size), end in zip(sizes.items(), ends, strict=True)}


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Places of everything in the vectors of a step."""

    axles: int
    state: dict[str, slice]
    given: dict[str, slice]  # what a step needs beside the state

    @property
    def states(self) -> int:
        """Length of the state."""
        return int(self.state["stop"].stop)

    @property
    def inputs(self) -> int:
        """Length of what a step needs beside the state."""
        return int(self.given["hold"].stop)

    @property
    def row(self) -> int:
        """Length of a row of the trace.

        After it come whether the step was made, the speed at its end, and the angles that the wheels have turned.
        """
        return 3 + 5 * self.axles


def layout(kernels: Kernels) -> Layout:
    """Lay out the vectors for the numbers of axles and states of a plant."""
    axles = kernels.axles
    constants = {
        name: getattr(kernels, name).size1_out(0)
        for name in ("lane_constants", "stop_constants", "window_constants")
    }
    return Layout(
        axles=axles,
        state=_places(
            {
                "speed": 1,
                "axle": kernels.axle_states * axles,  # first the wheel speeds
                "transfer": 2 * kernels.transfers,
                "locked": axles,
                "held": axles,
                "lock_length": axles,
                "pressure": axles,
                "torque": axles,
                "filled": axles,
                "time": 1,
                "lane": (INTEGRATED + 4) * axles,
                "stop": 5,  # distance, impulse and work of the resistance, judged time, time
            }
        ),
        given=_places(
            {
                "lane_constants": constants["lane_constants"] * axles,
                "stop_constants": constants["stop_constants"],
                "window_constants": constants["window_constants"] * axles,
                "radius": axles,
                "inertia": axles,
                "until": 1,
                "scale": 1,
                "longest_step": 1,
                "per_creep_rate": 1,
                "regularization_speed": 1,
                "stop_speed": 1,
                "judging_speed": 1,
                "load_factors": 3 * axles,  # at the start, middle and end of the step
                "hold": 3
                + 3 * axles,  # first point, spacing and place of the table; slip there and beside it
            }
        ),
    )


class StepFunctions(NamedTuple):
    """What runs a stop without a compiler."""

    layout: Layout
    single: Any  # (state, inputs) -> state, row with what follows it
    batches: dict[int, Any]  # number of steps -> (state, inputs) -> state, one column per step


def step_functions(kernels: Kernels, *, holding: bool, batches: Iterable[int]) -> StepFunctions:
    """Build the functions of a plant; ``holding`` for the ideal brake that never exceeds a slip."""
    import casadi as ca

    places = layout(kernels)
    state, given = ca.SX.sym("state", places.states), ca.SX.sym("given", places.inputs)
    outputs = ca.cse(_Step(kernels, places, state, given, holding).outputs())
    single = ca.Function("step", [state, given], outputs)
    repeated = {}
    for number in batches:
        following, rows = ca.MX.sym("state", places.states), []
        inputs = [following, ca.MX.sym("given", places.inputs)]
        for _ in range(number):
            following, row = single(following, inputs[1])
            rows.append(row)
        repeated[number] = ca.Function(f"steps{number}", inputs, [following, ca.horzcat(*rows)])
    return StepFunctions(layout=places, single=single, batches=repeated)


class _Step:
    """The expressions of one step."""

    def __init__(self, kernels: Kernels, places: Layout, state: Any, given: Any, holding: bool) -> None:
        self.kernels, self.holding, self.whole, self.axles = kernels, holding, state, places.axles
        self.state = {name: state[place] for name, place in places.state.items()}
        self.given = {name: given[place] for name, place in places.given.items()}

    def per_axle(self, name: str, axle: int) -> Any:
        """Constants of one axle."""
        values = self.given[name]
        size = values.size1() // self.axles
        return values[axle * size : (axle + 1) * size]

    def outputs(self) -> list[Any]:
        import casadi as ca

        now, given, axles = self.state, self.given, self.axles
        integrated = INTEGRATED * axles
        h, following = self._length()
        pressure, torque, filled = self._actuators(now["time"] + 0.5 * h, following)
        condition = self._conditions(h)
        motion = ca.vertcat(now["speed"], now["axle"], now["transfer"])
        shares = ((0.0, 0, now["torque"], 1.0), (0.5, 1, torque[0], 2.0), (0.5, 1, torque[0], 2.0))
        rates, sums = ca.SX.zeros(motion.size1()), [ca.SX(0)] * 3
        last: list[Any] = []
        for share, column, demand, weight in (*shares, (1.0, 2, torque[1], 1.0)):
            rates, lane, stop, last = self._stage(motion + share * h * rates, demand, condition, column)
            for k, part in enumerate((rates, lane, stop)):
                sums[k] += h / 6.0 * weight * part
        reached = motion + sums[0]
        force, slip, load, passed = last
        slip = minimum(slip, 1.0)
        speed, wheel = reached[0], reached[1 : 1 + axles]
        wheel, locked, held, lost = self._settled(speed, wheel, force, passed, torque[1])
        lock_time, most, judged_lock, longest = ca.vertsplit(now["lane"][integrated:], axles)
        judged = where(speed > given["judging_speed"], now["locked"] * h, 0.0)
        length = where(now["locked"], now["lock_length"] + judged, 0.0)
        totals = ca.vertcat(
            now["lane"][:axles] + sums[1][:axles] + lost,
            now["lane"][axles:integrated] + sums[1][axles:],
            lock_time + now["locked"] * h,
            where(speed > given["judging_speed"], maximum(most, slip), most),
            judged_lock + judged,
            maximum(longest, length),
        )
        stop = now["stop"] + ca.vertcat(sums[2], h)
        ahead = ca.vertcat(
            *(speed, wheel, reached[1 + axles :], locked, held, length),
            *(pressure, torque[1], filled, following, totals, stop),
        )
        made = where(given["scale"] < 1.0, 1.0, where(speed < given["stop_speed"], 0.0, 1.0))
        made = where(following > now["time"], made, 0.0)
        turned = totals[(INTEGRATED - 1) * axles : integrated]
        row = ca.vertcat(stop[4], speed, stop[0], wheel, slip, passed, load, torque[1], made, speed, turned)
        return [where(made, ahead, self.whole), row]

    def _length(self) -> tuple[Any, Any]:
        """Length of the step, and the time after it."""
        import casadi as ca

        given, time = self.given, self.state["time"]
        slowest = maximum(self.state["speed"], given["regularization_speed"])
        wanted = minimum(slowest * given["per_creep_rate"], given["longest_step"])
        span = given["until"] - time
        count = ca.ceil(span / wanted * (1.0 - 1e-12))
        h = where(count > 1.0, span / maximum(count, 1.0), span)
        last = time + h > given["until"] - 1e-12
        return where(last, span, h) * given["scale"], where(last, given["until"], time + h)

    def _actuators(self, middle: Any, end: Any) -> tuple[Any, tuple[Any, Any], Any]:
        """Pressure at the end, torque in the middle and at the end, pressure without venting at the end."""
        import casadi as ca

        half, full = (
            [
                self.kernels.actuator(self.per_axle("window_constants", axle), time)
                for axle in range(self.axles)
            ]
            for time in (middle, end)
        )
        pressure, torque, filled = (ca.vertcat(*column) for column in zip(*full, strict=True))
        return pressure, (ca.vertcat(*(column[1] for column in half)), torque), filled

    def _conditions(self, h: Any) -> list[Any]:
        import casadi as ca

        transfer, half = self.state["transfer"], self.kernels.transfers
        ahead = ca.vertcat(transfer[:half] + 0.5 * h * transfer[half:], ca.SX.zeros(half))
        loads = self._loads(ahead, 1)
        time = self.state["time"] + 0.5 * h
        return [
            self.kernels.condition(self.per_axle("lane_constants", axle), time, loads[axle])
            for axle in range(self.axles)
        ]

    def _loads(self, transfer: Any, column: int) -> Any:
        factors = self.given["load_factors"][column * self.axles : (column + 1) * self.axles]
        return self.kernels.loads(self.given["stop_constants"], transfer) * factors

    def _stage(
        self, at: Any, demand: Any, condition: list[Any], column: int
    ) -> tuple[Any, Any, Any, list[Any]]:
        """Rates of the motion, integrands of the totals of lanes and stop, and what is recorded."""
        import casadi as ca

        size = self.kernels.axle_states * self.axles
        speed, states, transfer = at[0], at[1 : 1 + size], at[1 + size :]
        wheel = states[: self.axles]
        locked, radius = self.state["locked"], self.given["radius"]
        load = self._loads(transfer, column)
        axles = [
            self.kernels.axle(
                self.per_axle("lane_constants", a),
                speed,
                states[a :: self.axles],
                load[a],
                demand[a],
                locked[a],
                condition[a],
            )
            for a in range(self.axles)
        ]
        force, rolling, slip, damping, passed = (
            # Element by element, each for all axles, as the state has them.
            ca.reshape(ca.horzcat(*column).T, -1, 1)
            for column in zip(*axles, strict=True)
        )
        rolling, others = rolling[: self.axles], rolling[self.axles :]
        acceleration, resistance, transferring = self.kernels.train(
            self.given["stop_constants"], speed, force, transfer
        )
        if self.holding:
            held_slip, slope = self._held_slip(speed)
            following = acceleration / radius * (1.0 - held_slip - speed * slope)
            taken = 2.0 * (radius * force - damping) - self.given["inertia"] * following
            rolling = where(self.state["held"], following, rolling)
            passed = where(self.state["held"], taken, passed)
        judged = where(speed > self.given["judging_speed"], 1.0, 0.0)
        lane = (
            passed,
            2.0 * damping,
            passed * wheel,
            2.0 * force * (speed - radius * wheel),
            2.0 * damping * wheel,
            judged * slip,
            judged * slip * slip,
            wheel,
        )
        stop = ca.vertcat(speed, resistance, resistance * speed, judged)
        rates = ca.vertcat(acceleration, rolling, others, transferring)
        return rates, ca.vertcat(*lane), stop, [force, slip, load, passed]

    def _held_slip(self, speed: Any) -> tuple[Any, Any]:
        """The slip to be held at a speed, and its slope over speed."""
        import casadi as ca

        first, spacing, k = (self.given["hold"][i] for i in range(3))
        below, here, above = (
            self.given["hold"][3 + i * self.axles : 3 + (i + 1) * self.axles] for i in range(3)
        )
        beyond = (ca.log(speed) - first) / spacing - k
        rise = where(beyond >= 0.0, above - here, here - below)
        return here + beyond * rise, rise / (spacing * speed)

    def _settled(
        self, speed: Any, wheel: Any, force: Any, passed: Any, torque: Any
    ) -> tuple[Any, Any, Any, Any]:
        """Wheel speeds, locks and holds after the step, and the impulse that the brake could not pass on."""
        radius, inertia, held = self.given["radius"], self.given["inertia"], self.state["held"]
        below = minimum(wheel, 0.0)
        released = where(torque < 2.0 * radius * force, 0.0, self.state["locked"])
        locked, wheel, lost = where(below < 0.0, 1.0, released), wheel - below, inertia * below
        if not self.holding:
            return wheel, locked, held, lost
        slip, _ = self._held_slip(speed)
        rolling = speed * (1.0 - slip) / radius
        caught = where(held, 0.0, where(locked, 0.0, wheel <= rolling))
        lost += where(caught, inertia * (wheel - rolling), 0.0)
        kept = where(held, where(passed > torque, 0.0, 1.0), 0.0)
        return where(caught, rolling, wheel), locked, where(caught, 1.0, kept), lost
