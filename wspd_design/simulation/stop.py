"""One stop of the quarter locomotive with a sampled controller, integrated from valve edge to valve edge.

Between two edges the cylinder pressure has a closed form and the rest is smooth, so that an explicit Runge-Kutta
method of order four keeps its order. Its step follows the creep stiffness, which grows as 1/v. Wheel lock and
standstill are events with states of their own: a locked wheel stays locked while the brake torque exceeds what
the rail can give, and passes on no more than that.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from wspd_design.controllers.protocol import Command, Controller, Measurement, State
from wspd_design.model.brake import Valve, braking_torque, pressure_after
from wspd_design.parameters.loading import constants
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.quarter import Quarter, quarter
from wspd_design.simulation.records import Ending, Run, Sample, Scenario, Totals

LONGEST_STEP = 1e-3  # s, numerics: see the convergence test
STEPS_PER_CREEP_TIME = 1.0
RECORD_INTERVAL = 2e-3  # s, of the traces
JUDGING_SPEED = 10.0 / 3.6  # m/s, slip statistics count above it
WHEELS = 8

# Layout of the integrated vector: two states, then the integrals of Totals.
SPEED, WHEEL_SPEED = 0, 1
INTEGRALS = 2
Vector = tuple[float, ...]


def simulate(vehicle: Vehicle, controller: Controller, scenario: Scenario) -> Run:
    """Brake from the initial speed to standstill.

    Parameters
    ----------
    vehicle : Vehicle
        The quarter locomotive.
    controller : Controller
        Law of every wheelset.
    scenario : Scenario
        Rail and initial speed.

    Returns
    -------
    Run
        Traces, samples and integrals; ``ending`` says whether the train stopped.

    Raises
    ------
    UserError
        If the controller returns a command outside [0, 1] or one that is not a number.
    """
    stop = _Stop(vehicle, controller, scenario)
    while stop.ending is None:
        stop.run_sample()
    return stop.result()


@dataclass(slots=True)
class _Stop:
    """The moving state of one simulation."""

    vehicle: Vehicle
    controller: Controller
    scenario: Scenario
    plant: Quarter = field(init=False)
    time: float = 0.0
    vector: Vector = ()
    pressure: float = 0.0
    locked: bool = False
    lock_time: float = 0.0
    slip_max: float = 0.0
    ending: Ending | None = None
    controller_state: State = ()
    samples: list[Sample] = field(default_factory=list)
    trace: list[tuple[float, ...]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.plant = quarter(self.vehicle, self.scenario.rail)
        speed = self.scenario.initial_speed
        self.vector = (speed, speed / self.vehicle.wheel_radius, *([0.0] * 11))
        self.controller_state = self.controller.start(self.measure())
        self.record()

    def measure(self) -> Measurement:
        return Measurement(
            speed=self.vector[SPEED],
            wheel_speed=self.vector[WHEEL_SPEED],
            torque=braking_torque(self.vehicle.brake, self.pressure),
        )

    def run_sample(self) -> None:
        """One sampling interval: ask the controller once, then run through its valve states."""
        index = len(self.samples)
        h = self.controller.sample_time
        self.controller_state, command = self.controller.step(self.controller_state, self.measure())
        _check_command(self.controller.name, command, self.time)
        self.samples.append(
            Sample(time=self.time, fill=command.fill, vent=command.vent, state=tuple(self.controller_state))
        )
        for valve, start, end in segments(command, index * h, (index + 1) * h):
            self.run_segment(valve, start, end)
            if self.ending is not None:
                return
        if self.time > constants().time_limit:
            self.ending = Ending.TIME_LIMIT

    def run_segment(self, valve: Valve, start: float, end: float) -> None:
        """Integrate over one valve state."""
        brake = self.vehicle.brake
        start_pressure = self.pressure

        def torque(time: float) -> float:
            return float(braking_torque(brake, pressure_after(brake, valve, time, start, start_pressure)))

        self.time = start
        while self.time < end and self.ending is None:
            speed = max(self.vector[SPEED], constants().slip_regularization_speed)
            step = min(LONGEST_STEP, STEPS_PER_CREEP_TIME / self.plant.creep_rate(speed), end - self.time)
            if end - self.time - step < 1e-3 * step:  # no sliver of a step before the edge
                step = end - self.time
            self.advance(torque, step, end)
        self.pressure = pressure_after(brake, valve, self.time, start, start_pressure)
        self.record()

    def advance(self, torque: Callable[[float], float], step: float, end: float) -> None:
        """One step, cut short where the wheel locks, unlocks or the train stands."""

        def stepped(h: float) -> Vector:
            return runge_kutta(lambda t, y: self.rates(t, y, torque(t)), self.time, self.vector, h)

        def event(h: float, y: Vector) -> bool:
            if y[SPEED] <= constants().stop_speed:
                return True
            if self.locked:
                return torque(self.time + h) < self.plant.adhesion_torque(y[SPEED])
            return y[WHEEL_SPEED] < 0.0

        vector = stepped(step)
        happened = event(step, vector)
        if happened:
            step = first_time(lambda h: event(h, stepped(h)), step)
            vector = stepped(step)
        self.lock_time += step if self.locked else 0.0
        reached_end = not happened and step >= end - self.time
        self.time = end if reached_end else self.time + step
        self.vector = vector
        if happened:
            self.settle_event()
        if self.vector[SPEED] > JUDGING_SPEED:
            motion = self.plant.motion(self.time, self.vector[SPEED], self.vector[WHEEL_SPEED], 0.0)
            self.slip_max = max(self.slip_max, motion.slip)
        if self.time - self.trace[-1][0] >= RECORD_INTERVAL or happened:
            self.record(torque(self.time))

    def settle_event(self) -> None:
        """Enter the state that the event leads to."""
        if self.vector[SPEED] <= constants().stop_speed:
            self.ending = Ending.STOPPED
        elif self.locked:
            self.locked = False
        else:
            self.locked = True
            self.vector = (self.vector[SPEED], 0.0, *self.vector[INTEGRALS:])

    def rates(self, time: float, vector: Vector, torque: float) -> Vector:
        """Derivatives of the states and integrands of the totals."""
        speed, wheel_speed = vector[SPEED], vector[WHEEL_SPEED]
        motion = self.plant.motion(time, speed, wheel_speed, torque)
        radius = self.vehicle.wheel_radius
        wheel_acceleration = motion.wheel_acceleration
        if self.locked:
            torque, wheel_acceleration = 2.0 * radius * motion.creep_force, 0.0
        total_torque = self.vehicle.wheelsets * torque
        damping = WHEELS * motion.wheel_damping * wheel_speed
        judged = 1.0 if speed > JUDGING_SPEED else 0.0
        return (
            motion.acceleration,
            wheel_acceleration,
            speed,
            total_torque,
            motion.resistance,
            damping,
            total_torque * wheel_speed,
            WHEELS * motion.creep_force * (speed - radius * wheel_speed),
            motion.resistance * speed,
            damping * wheel_speed,
            judged,
            judged * motion.slip,
            judged * motion.slip**2,
        )

    def record(self, torque: float | None = None) -> None:
        """Append one line to the traces."""
        if self.trace and self.trace[-1][0] == self.time:
            return
        speed, wheel_speed, distance = self.vector[:3]
        demand = braking_torque(self.vehicle.brake, self.pressure) if torque is None else torque
        transmitted = self.plant.adhesion_torque(speed) if self.locked else demand
        slip = self.plant.motion(self.time, speed, wheel_speed, demand).slip
        self.trace.append((self.time, speed, distance, wheel_speed, slip, transmitted))

    def result(self) -> Run:
        import numpy as np

        traces = np.asarray(self.trace, dtype=np.float64).T
        names = ("distance", "torque", "resistance_impulse", "damping_impulse", "brake_work", "sliding_work")
        names += ("resistance_work", "damping_work", "judged_time", "slip", "slip_squared")
        assert self.ending is not None
        return Run(
            controller=self.controller.name,
            vehicle=self.vehicle.name,
            rail=self.scenario.rail.name,
            plant="quarter",
            sample_time=self.controller.sample_time,
            initial_speed=self.scenario.initial_speed,
            ending=self.ending,
            time=traces[0],
            speed=traces[1],
            distance=traces[2],
            wheel_speed=traces[3][:, np.newaxis],
            slip=traces[4][:, np.newaxis],
            torque=traces[5][:, np.newaxis],
            samples=tuple(self.samples),
            totals=Totals(
                **dict(zip(names, self.vector[INTEGRALS:], strict=True)), lock_time=self.lock_time
            ),
            final_wheel_speed=self.vector[WHEEL_SPEED],
            slip_max=self.slip_max,
        )


def segments(command: Command, start: float, end: float) -> Iterator[tuple[Valve, float, float]]:
    """Valve states of one sampling interval with their edges: fill, then vent, then hold."""
    span = end - start
    fill_end = start + command.fill * span
    vent_end = min(fill_end + command.vent * span, end)
    if 1.0 - command.fill - command.vent < 1e-12:
        vent_end = end
    for valve, a, b in (
        (Valve.FILL, start, fill_end),
        (Valve.VENT, fill_end, vent_end),
        (Valve.HOLD, vent_end, end),
    ):
        if b > a:
            yield valve, a, b


def runge_kutta(rates: Callable[[float, Vector], Vector], time: float, vector: Vector, h: float) -> Vector:
    """One step of the classical Runge-Kutta method of order four."""
    half = 0.5 * h
    k1 = rates(time, vector)
    k2 = rates(time + half, _moved(vector, k1, half))
    k3 = rates(time + half, _moved(vector, k2, half))
    k4 = rates(time + h, _moved(vector, k3, h))
    sixth = h / 6.0
    return tuple(
        y + sixth * (a + 2.0 * (b + c) + d) for y, a, b, c, d in zip(vector, k1, k2, k3, k4, strict=True)
    )


def _moved(vector: Vector, rates: Vector, h: float) -> Vector:
    """States moved along their rates; no rate depends on the integrals."""
    return (vector[SPEED] + h * rates[SPEED], vector[WHEEL_SPEED] + h * rates[WHEEL_SPEED])


def first_time(happened: Callable[[float], bool], latest: float) -> float:
    """Bisect for the earliest step length at which an event has happened."""
    low, high = 0.0, latest
    while high - low > 1e-15 + 1e-12 * latest:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if happened(middle) else (middle, high)
    return high


def _check_command(name: str, command: Command, time: float) -> None:
    total = command.fill + command.vent
    if not (0.0 <= command.fill <= 1.0 and 0.0 <= command.vent <= 1.0 and total <= 1.0 + 1e-9):
        raise UserError(
            f"controller {name} commanded fill = {command.fill:g}, vent = {command.vent:g} at t = {time:.3f} s; "
            "both must lie in [0, 1] and their sum must not exceed 1: limit the command in its step function"
        )
