"""The closed loop without a C compiler: one integration step as a CasADi function, the rest in Python.

The steps, their order and the events are those of ``templates/closed_loop.c``; a test holds the two together.
"""

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from wspd_design.codegen.closed_loop import (
    BAD_COMMAND,
    BUFFER_FULL,
    GOOD,
    LANE_TOTALS,
    RAIL_NUMBERS,
    STOP_TOTALS,
    LoopInput,
    LoopOutput,
    drive,
)
from wspd_design.codegen.kernels import PARAMETERS, Kernels, closed_loop_kernels
from wspd_design.controllers.protocol import Command, Controller, Measurement
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.plants.four_axle import AXLES

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

_PITCH = 6
_SHORTEST = 1e-9  # s: edges closer together than this are one
_MOTION = 1 + AXLES + _PITCH  # speed, wheel speeds, pitch
_INTEGRATED = LANE_TOTALS[:7]  # the lane totals that are integrals
_OFFSET = PARAMETERS.index(("surroundings", "axle_offset"))
_RADIUS = PARAMETERS.index(("vehicle", "wheel_radius"))
_INERTIA = PARAMETERS.index(("vehicle", "wheelset_inertia"))
_FIRST_RAIL = next(k for k, (record, _) in enumerate(PARAMETERS) if record == "rail")


def run_virtual(
    vehicle: Vehicle,
    rail: Rail,
    controller: Controller,
    given: LoopInput,
    *,
    sample_rows: int,
    disturbed: bool,
) -> LoopOutput:
    """Run a single stop; takes and returns what :meth:`ClosedLoop.run` does."""
    import numpy as np

    plant = _VirtualPlant(step_function(vehicle, rail, disturbed=disturbed), given)
    result, samples = drive(plant, controller, sample_rows)
    stop = dict(zip(STOP_TOTALS, plant.stop_totals[:, np.newaxis], strict=True))
    return LoopOutput(
        result=result,
        stopped=stop["end_speed"] <= given.settings.stop_speed * (1.0 + 1e-6),
        lane_totals=dict(zip(LANE_TOTALS, plant.lane_totals, strict=True)),
        stop_totals=stop,
        wheel_speeds=plant.motion[1 : 1 + AXLES].copy(),
        trace=np.array(plant.rows).reshape(len(plant.rows), 3 + 5 * AXLES),
        samples=samples,
        bad_command=plant.bad_command,
        steps=plant.steps,
    )


@lru_cache(maxsize=8)
def step_function(vehicle: Vehicle, rail: Rail, *, disturbed: bool) -> Any:
    """One Runge-Kutta step of a stop with its totals, as a CasADi function of dense vectors.

    Returns
    -------
    casadi.Function
        (parameters (PARAMETERS, axles), motion, locked, torque, [time, step, window], pressure, fill end,
        vent end, load factors (axles, 3)) -> (motion after the step, lane totals (axles, 7), stop totals (4),
        last stage (axles, 4: force, slip, load, passed torque), actuator (axles, 3: pressure, torque,
        pressure before venting)).
    """
    import casadi as ca

    kernels = closed_loop_kernels(vehicle, rail, None, disturbed=disturbed)
    p = ca.SX.sym("p", len(PARAMETERS), AXLES)
    motion = ca.SX.sym("motion", _MOTION)
    locked, torque, pressure, fill_end, vent_end = (
        ca.SX.sym(name, AXLES) for name in ("locked", "torque", "pressure", "fill_end", "vent_end")
    )
    when = ca.SX.sym("when", 3)
    factors = ca.SX.sym("factors", AXLES, 3)
    time, h, window = when[0], when[1], when[2]

    def actuator(at: Any) -> Any:
        columns = [
            kernels.actuator(p[:, a], ca.vertcat(at, window, pressure[a], fill_end[a], vent_end[a]))
            for a in range(AXLES)
        ]
        return ca.horzcat(*columns).T

    middle, end = actuator(time + 0.5 * h), actuator(time + h)
    half = AXLES + 1 + _PITCH // 2
    pitch_ahead = motion[AXLES + 1 : half] + 0.5 * h * motion[half:]
    loads = kernels.loads(p[:, 0], ca.vertcat(pitch_ahead, ca.SX.zeros(_PITCH // 2))) * factors[:, 1]
    conditions = [kernels.condition(p[:, a], ca.vertcat(time + 0.5 * h, loads[a])) for a in range(AXLES)]

    half_way = (0.5, 1, middle[:, 1], 2.0)
    shares = ((0.0, 0, torque, 1.0), half_way, half_way, (1.0, 2, end[:, 1], 1.0))
    rates, lane, stop = ca.SX.zeros(_MOTION), ca.SX.zeros(AXLES, len(_INTEGRATED)), ca.SX.zeros(4)
    total_rates, last = ca.SX.zeros(_MOTION), ca.SX.zeros(AXLES, 4)
    judging = ca.SX.sym("judging")
    for share, column, demand, weight in shares:
        at = motion + share * h * rates
        rates, integrands, stop_integrands, last = _stage(
            ca, kernels, p, at, locked, demand, conditions, factors[:, column], judging
        )
        total_rates += weight * rates
        lane += h * weight / 6.0 * integrands
        stop += h * weight / 6.0 * stop_integrands
    reached = motion + h / 6.0 * total_rates
    inputs = [p, motion, locked, torque, when, pressure, fill_end, vent_end, factors, judging]
    return ca.Function("step", inputs, [reached, lane, stop, last, end])


def _stage(
    ca: Any,
    kernels: Kernels,
    p: Any,
    at: Any,
    locked: Any,
    demand: Any,
    conditions: list[Any],
    factors: Any,
    judging: Any,
) -> tuple[Any, Any, Any, Any]:
    """Rates of the motion and integrands of the totals at one stage."""
    speed, wheels, pitch = at[0], at[1 : 1 + AXLES], at[1 + AXLES :]
    loads = kernels.loads(p[:, 0], pitch) * factors
    axles = [
        kernels.axle(p[:, a], ca.vertcat(speed, wheels[a], loads[a], demand[a], conditions[a]))
        for a in range(AXLES)
    ]
    force, free, slip, damping = (ca.vertcat(*(axle[k] for axle in axles)) for k in range(4))
    train = kernels.train(p[:, 0], ca.vertcat(speed, force, pitch))
    radius = p[_RADIUS, :].T
    passed = ca.if_else(locked, 2.0 * radius * force, demand)
    judged = ca.if_else(speed > judging, 1.0, 0.0)
    rates = ca.vertcat(train[0], ca.if_else(locked, 0.0, free), train[2:])
    integrands = ca.horzcat(
        passed,
        2.0 * damping,
        passed * wheels,
        2.0 * force * (speed - radius * wheels),
        2.0 * damping * wheels,
        judged * slip,
        judged * slip * slip,
    )
    return (
        rates,
        integrands,
        ca.vertcat(speed, train[1], train[1] * speed, judged),
        ca.horzcat(force, slip, loads, passed),
    )


class _VirtualPlant:
    """The plant behind the interface of ``SampledPlant``."""

    def __init__(self, step: Any, given: LoopInput) -> None:
        import numpy as np

        self.given, self.set = given, given.settings
        self.parameters = np.asfortranarray(given.lane_parameters, dtype=np.float64).copy(order="F")
        radius = self.parameters[_RADIUS]
        speed = float(given.speeds[0])
        self.motion = np.concatenate([[speed], speed / radius, np.zeros(_PITCH)])
        self.locked, self.pressure = np.zeros(AXLES), np.zeros(AXLES)
        self.fill_end, self.vent_end = np.zeros(AXLES), np.zeros(AXLES)
        self.torque = np.zeros((AXLES, 3))  # pressure, torque, pressure before venting at the present time
        self.time = self.window = 0.0
        self.edge = math.inf
        self.recorded = -1.0
        self.sample = self.steps = 0
        self.patch = [0] * AXLES
        self.moving = True
        self.lane_totals, self.stop_totals = np.zeros((len(LANE_TOTALS), AXLES)), np.zeros(len(STOP_TOTALS))
        self.rows: list[NDArray[np.float64]] = []
        self.bad_command = (0.0, 0.0, 0.0)
        self._bind(step)

    def _bind(self, step: Any) -> None:
        """Give the CasADi function fixed memory: a call then costs no conversion."""
        import numpy as np

        self._inputs = [np.zeros(step.numel_in(k)) for k in range(step.n_in())]
        self._outputs = [np.zeros(step.numel_out(k)) for k in range(step.n_out())]
        self._buffer, self._call = step.buffer()
        for k, array in enumerate(self._inputs):
            self._buffer.set_arg(k, array.data)
        for k, array in enumerate(self._outputs):
            self._buffer.set_res(k, array.data)

    def running(self) -> bool:
        return self.moving and self.time <= self.set.time_limit

    def measure(self) -> list[Measurement]:
        import numpy as np

        given = self.given
        wheels = self.motion[1 : 1 + AXLES].copy()
        if given.wheel_noise is not None:
            wheels += given.wheel_noise[self.sample]
        if given.quantum > 0.0:
            wheels = given.quantum * np.floor(wheels / given.quantum + 0.5)
        speed = float(self.motion[0]) * given.reference_factor
        return [
            Measurement(speed=speed, wheel_speed=max(float(w), 0.0), torque=float(t))
            for w, t in zip(wheels, self.torque[:, 1], strict=True)
        ]

    def advance(self, commands: list[Command]) -> int:
        h = self.set.sample_time
        start = self.sample * h
        result = self._advance_to(start + self.set.dead_time)
        present = self.time
        self.lane_totals[9] += self.torque[:, 2] - self.torque[:, 0]
        self.pressure[:] = self.torque[:, 0]
        self.window = present
        for axle, (fill, vent) in enumerate(commands):
            if not (0.0 <= fill <= 1.0 and vent >= 0.0 and fill + vent <= 1.0 + 1e-9):
                self.bad_command = (start, fill, vent)
                return BAD_COMMAND
            self.fill_end[axle] = present + fill * h
            whole = 1.0 - fill - vent < 1e-12
            self.vent_end[axle] = present + h if whole else self.fill_end[axle] + vent * h
        self.edge = self.time  # that is, look for the next one
        self.sample += 1
        return result or self._advance_to(self.sample * h)

    def _advance_to(self, until: float) -> int:
        result = GOOD
        while self.time < until and self.moving and result == GOOD:
            result = self._step(until)
        return result

    def _lay_rails(self) -> float:
        given, soonest = self.given, math.inf
        if given.patch_starts is None or given.patch_rails is None:
            return soonest
        for axle in range(AXLES):
            place = self.stop_totals[0] - self.parameters[_OFFSET, axle]
            reached = self.patch[axle]
            while reached < len(given.patch_starts) and given.patch_starts[reached] <= place:
                reached += 1
            if reached != self.patch[axle]:
                rail = given.patch_rails[reached - 1, axle]
                self.parameters[_FIRST_RAIL : _FIRST_RAIL + RAIL_NUMBERS, axle] = rail
                self.patch[axle] = reached
            if reached < len(given.patch_starts):
                wait = (given.patch_starts[reached] - place) / self.motion[0] + 1e-9
                soonest = min(soonest, wait)
        return soonest

    def _step_length(self, until: float) -> float:
        if self.edge <= self.time + _SHORTEST:
            edges = (*self.fill_end.tolist(), *self.vent_end.tolist())
            self.edge = min((edge for edge in edges if edge > self.time + _SHORTEST), default=math.inf)
        if self.edge < until - _SHORTEST:
            until = self.edge
        change = self._lay_rails()
        slowest = max(float(self.motion[0]), self.set.regularization_speed)
        wanted = min(slowest / self.set.creep_rate, self.set.longest_step)
        span = until - self.time
        count = math.ceil(span / wanted * (1.0 - 1e-12))
        return min(change, span / count if count > 1 else span)

    def _load_factors(self, h: float) -> "Array":
        import numpy as np

        given = self.given
        if given.load_factors is None:
            return np.ones((AXLES, 3))
        points = np.arange(given.load_factors.shape[1]) * given.load_spacing
        places = self.stop_totals[0] + np.array([0.0, 0.5, 1.0]) * h * self.motion[0]
        return np.array([np.interp(places, points, row) for row in given.load_factors])

    def _evaluate(self, h: float) -> None:
        given = (
            self.parameters,
            self.motion,
            self.locked,
            self.torque[:, 1],
            (self.time, h, self.window),
            self.pressure,
            self.fill_end,
            self.vent_end,
            self._load_factors(h),
            (self.set.judging_speed,),
        )
        for array, values in zip(self._inputs, given, strict=True):
            array[:] = values.ravel(order="F") if hasattr(values, "ravel") else values
        self._call()

    def _step(self, until: float) -> int:
        h = self._step_length(until)
        following = self.time + h
        if following > until - 1e-12:
            following, h = until, until - self.time
        self._evaluate(h)
        reached = self._outputs[0]
        if reached[0] < self.set.stop_speed:
            h *= (self.motion[0] - self.set.stop_speed) / (self.motion[0] - reached[0])
            self._evaluate(h)
        lane = self._outputs[1].reshape((len(_INTEGRATED), AXLES))
        force, slip, load, passed = self._outputs[3].reshape((4, AXLES))
        slip = slip.clip(max=1.0)  # the last stage may turn a stopping wheel back
        actuator = self._outputs[4].reshape((3, AXLES))
        torque = actuator[1]
        self.motion[:] = reached
        self.lane_totals[: len(_INTEGRATED)] += lane
        self.lane_totals[7] += self.locked * h
        if self.motion[0] > self.set.judging_speed:
            self.lane_totals[8] = self.lane_totals[8].clip(min=slip)
        self.stop_totals[:4] += self._outputs[2]
        for axle in range(AXLES):
            wheel = self.motion[1 + axle]
            if not self.locked[axle] and wheel < 0.0:
                self.lane_totals[0, axle] += self.parameters[_INERTIA, axle] * wheel
                self.motion[1 + axle] = 0.0
                self.locked[axle] = 1.0
            elif self.locked[axle] and torque[axle] < 2.0 * self.parameters[_RADIUS, axle] * force[axle]:
                self.locked[axle] = 0.0
        self.torque[:] = actuator.T
        self.time = following
        self.steps += 1
        self.stop_totals[4] += h
        self.stop_totals[5] = self.motion[0]
        if self.motion[0] <= self.set.stop_speed * (1.0 + 1e-6):
            self.moving = False
        return self._record(slip, passed, load)

    def _record(self, slip: "Array", passed: "Array", load: "Array") -> int:
        import numpy as np

        if self.time - self.recorded >= self.set.record_interval or not self.moving:
            if len(self.rows) == self.given.trace_rows:
                return BUFFER_FULL
            self.recorded = self.time
            head = [self.stop_totals[4], self.motion[0], self.stop_totals[0]]
            wheels = self.motion[1 : 1 + AXLES]
            self.rows.append(np.concatenate([head, wheels, slip, passed, load, self.torque[:, 1]]))
        return GOOD
