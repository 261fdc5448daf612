"""The protection that the band of slip speaks about, written out: sliding mode of relative degree two, told speed.

It shares with the classes of the law nothing but the numbers: a slip that is constant or falls as 1/sqrt(v), the train
speed of a source of its own with the scale of the rolling wheels, pressure sensors, and an observer of the friction
torque of each wheelset.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from wspd_design.certificates.kernel.checker import PRIME, element
from wspd_design.certificates.setting.graph_field import same_in_field
from wspd_design.codegen.emitter import UntraceableError
from wspd_design.codegen.laws import LawKernels, law_constants
from wspd_design.controllers.observer_smc import ObserverSmc
from wspd_design.controllers.observers.rolling import RELEASED_DEMAND
from wspd_design.controllers.observers.told import ToldSpeed
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import Command, State, VehicleMeasurement
from wspd_design.controllers.references import ConstantSlip, FallingSlip
from wspd_design.model.number import Number, exp, log, maximum, minimum, sqrt, where
from wspd_design.parameters.loading import constants

POINTS, DOUBLES, DIGITS = (
    2,
    24,
    1e-9,
)  # of the field, in doubles, and the difference that rounding may make there
LEAST = 1e-3  # of the full torque, and in N m
HALF, CAREFUL, LARGEST_BAND = 0.5, 0.85, 0.5
LEAST_SLOWING = 0.05  # m/s2


@dataclass(frozen=True, slots=True, kw_only=True)
class WrittenProtection:
    """The law with the numbers of a protection."""

    of: Protection
    core: ObserverSmc
    reference: ConstantSlip | FallingSlip
    source: ToldSpeed

    @property
    def name(self) -> str:
        """Name of the law."""
        return self.of.name

    @property
    def sample_time(self) -> float:
        """Sampling interval [s]."""
        return self.of.sample_time

    @property
    def wheelsets(self) -> int:
        """Number of wheelsets."""
        return self.of.wheelsets

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of the state."""
        return self.of.memory

    def start(self, m: VehicleMeasurement) -> State:
        """Scale of the speed from rolling wheels; friction and torque from the pressure."""
        n, radius = self.wheelsets, self.of.wheel_radius
        healthy: Number = 0.0
        turning: Number = 0.0
        for wheel, seen in zip(m.wheel_speeds, m.healthy, strict=True):
            healthy, turning = healthy + seen, turning + seen * wheel
        scale = (
            radius * turning / maximum(healthy, 1.0) / maximum(m.speed, constants().slip_regularization_speed)
        )
        rolling = (m.demand <= RELEASED_DEMAND) * (healthy > 0.0)
        rolling = rolling * (abs(scale - 1.0) <= self.source.largest_scale_error)
        scale = where(rolling, scale, 1.0)
        torques = [self._torque(m, k) for k in range(n)]
        slips = (self._slip(m.speed)[0],) * n
        return (
            scale * m.speed,
            0.0 * scale,
            scale,
            *slips,
            *torques,
            *torques,
            *torques,
            *m.wheel_speeds,
            *(0.0,) * n,
        )

    def _slip(self, speed: Number) -> tuple[Number, Number]:
        """Slip that is held, and the part of a change of the train speed that the rims take part in."""
        if isinstance(self.reference, ConstantSlip):
            return self.reference.slip, 1.0 - self.reference.slip
        least = maximum(speed, constants().slip_regularization_speed)
        own = self.reference.slip / sqrt(least)
        slip = minimum(own, self.reference.largest)
        return slip, 1.0 - slip + where(own < self.reference.largest, speed * own / (2.0 * least), 0.0)

    def _full(self, k: int) -> Number:
        return self.of.torque_shares[k] * self.of.valve.brake.max_torque

    def _torque(self, m: VehicleMeasurement, k: int) -> Number:
        return m.pressures[k] * self._full(k) / self.of.valve.brake.max_pressure

    def step(self, state: State, m: VehicleMeasurement) -> tuple[State, tuple[Command, ...]]:
        """One sample."""
        n, h, inertia = self.wheelsets, self.sample_time, self.of.wheelset_inertia
        before, acceleration, scale = state[:3]
        _, frictions, _, means, observed, released = (state[3 + k * n : 3 + (k + 1) * n] for k in range(6))
        speed = scale * m.speed
        new = 1.0 - exp(-h / self.source.acceleration_time)
        acceleration = acceleration + new * ((speed - before) / h - acceleration)
        theta = exp(-self.of.observer_rate * h)
        slip, turning = self._slip(speed)
        wanted_speed = (1.0 - slip) * speed / self.of.wheel_radius
        wanted_rate = acceleration / self.of.wheel_radius * turning
        commands, speeds, torques = [], [], []
        taus = []
        for k in range(n):
            expected = observed[k] + h * (frictions[k] - means[k]) / inertia
            r = where(m.healthy[k] > HALF, m.wheel_speeds[k], expected) - expected
            speeds.append(expected + (1.0 - theta**2) * r)
            taus.append(maximum(frictions[k] + inertia * r * (1.0 - theta) ** 2 / h, 0.0))
            torques.append(self._torque(m, k))
            commands.append(self._pulses(k, m, speed, wanted_speed, wanted_rate, taus[k], torques[k]))
        well = [
            where(flag > HALF, False, seen > HALF) for flag, seen in zip(released, m.healthy, strict=True)
        ]
        commands = [self._careful(k, m, commands[k], torques, well) for k in range(n)]
        commands = [
            self._slow(speed, acceleration, wheel, each)
            for wheel, each in zip(m.wheel_speeds, commands, strict=True)
        ]
        after = [self._after(k, m, torques[k], each) for k, each in enumerate(commands)]
        ends, averages = zip(*after, strict=True)
        slips = (slip,) * n
        following = (speed, acceleration, scale, *slips, *taus, *ends, *averages, *speeds, *(0.0,) * n)
        return following, tuple(commands)

    def _pulses(
        self,
        k: int,
        m: VehicleMeasurement,
        speed: Number,
        wanted_speed: Number,
        wanted_rate: Number,
        tau: Number,
        torque: Number,
    ) -> Command:
        """Torque at which the error falls at the pull, and the pulse that leads there."""
        tracking, h = self.core.tracking, self.sample_time
        inertia, rate = tracking.wheelset_inertia, tracking.approach_rate
        error = (
            m.wheel_speeds[k] - wanted_speed + tracking.ahead * h * ((tau - torque) / inertia - wanted_rate)
        )
        slew = self.core.torque_slew / inertia
        curve = sqrt(maximum(2.0 * slew * (error - slew / (2.0 * rate**2)), 0.0))
        pull = where(error * rate * rate > slew, curve, rate * error)
        available, full = m.demand * self._full(k), self._full(k)
        target = tau - inertia * (wanted_rate - pull)
        sliding = maximum(speed / self.of.wheel_radius - wanted_speed, 0.0)
        band = minimum(tracking.dead_band, tracking.dead_band_share * sliding * inertia * rate)
        return self._towards(torque, target, available, minimum(band, LARGEST_BAND * torque), full)

    def _towards(
        self, torque: Number, target: Number, available: Number, band: Number, full: Number
    ) -> Command:
        """Pulse that leads to a target, for a share of the nominal times."""
        valve, h = self.of.valve, self.sample_time
        target = minimum(maximum(target, 0.0), available)
        least = LEAST * full + LEAST
        room, left = maximum(available - torque, least), maximum(available - target, least)
        filling = valve.brake.fill_time * log(room / left) / h
        venting = valve.brake.vent_time * log(maximum(torque, least) / maximum(target, least)) / h
        shares = []
        for share, way in ((filling, target - torque), (venting, torque - target)):
            limited = minimum(valve.time_share * share, 1.0)
            long_enough = where(limited * h >= valve.least_pulse, limited, 0.0)
            shares.append(where(way > band, long_enough, 0.0))
        return Command(*shares)

    def _careful(
        self,
        k: int,
        m: VehicleMeasurement,
        command: Command,
        torques: Sequence[Number],
        well: Sequence[Number],
    ) -> Command:
        """Without its speed sensor a wheelset brakes less than all that have theirs and do not roll."""
        available = m.demand * self._full(k)
        target = available
        for other, torque in enumerate(torques):
            if other != k and self.of.torque_shares[other] > 0.0:
                target = minimum(target, where(well[other], CAREFUL * torque, available))
        careful = self._towards(torques[k], target, available, 0.0, self._full(k))
        own = m.healthy[k] > HALF
        return Command(
            fill=where(own, command.fill, careful.fill), vent=where(own, command.vent, careful.vent)
        )

    def _slow(self, speed: Number, acceleration: Number, wheel: Number, command: Command) -> Command:
        """Hold at low speed while the train slows down; vent a wheel that turns with less than half of the speed."""
        slow = (speed < self.of.cut_out_speed) * (acceleration < -LEAST_SLOWING)
        far = self.of.wheel_radius * wheel < HALF * speed
        return Command(
            fill=where(slow, 0.0, command.fill), vent=where(slow, where(far, 1.0, 0.0), command.vent)
        )

    def _after(
        self, k: int, m: VehicleMeasurement, torque: Number, command: Command
    ) -> tuple[Number, Number]:
        """Torque at the end of the sample and its mean, with the nominal times of the valve."""
        h, fill_time, vent_time = (
            self.sample_time,
            self.of.valve.brake.fill_time,
            self.of.valve.brake.vent_time,
        )
        supply = maximum(m.demand * self._full(k), torque)
        filled = supply - (supply - torque) * exp(-command.fill * h / fill_time)
        end = filled * exp(-command.vent * h / vent_time)
        rate = 1.0 / h
        missed = fill_time * (supply - torque) * rate * (1.0 - exp(-command.fill * h / fill_time))
        venting = vent_time * filled * rate * (1.0 - exp(-command.vent * h / vent_time))
        return end, command.fill * supply - missed + venting + (1.0 - command.fill - command.vent) * end


def written(law: object) -> WrittenProtection | None:
    """Write the law out with the numbers of a protection; None if it lacks what the law needs."""
    if not isinstance(law, Protection):
        return None
    core, reference, source = law.core, law.reference, law.source
    kinds = type(core) is ObserverSmc and type(reference) in (ConstantSlip, FallingSlip)
    kinds = kinds and type(source) is ToldSpeed
    if not kinds or law.seeking is not None or not law.pressure_sensors or law.valve.brake.valve != "lag":
        return None
    assert isinstance(core, ObserverSmc)
    assert isinstance(reference, ConstantSlip | FallingSlip)
    assert isinstance(source, ToldSpeed)
    return WrittenProtection(of=law, core=core, reference=reference, source=source)


def not_written(law: Protection) -> str:
    """Say why the step of a protection is not shown to be the one that is written here; empty if it is."""
    wanted = written(law)
    if law.seeking is not None:
        return "searches for the peak, so that its reference jumps, which no bound on its rate covers"
    if not isinstance(law.source, ToldSpeed):
        return (
            "estimates the train speed, and no bound on the error of the estimate is proved; a law of one's own that "
            "is told a speed may state one (slip_error and slip_drift of observer_form)"
        )
    if wanted is None:
        return (
            "is not the sliding mode of relative degree two with told speed, a slip that is constant or falls as "
            "1/sqrt(v), and pressure sensors"
        )
    try:
        pair = law_constants(law), law_constants(wanted)
    except UntraceableError as reason:
        return f"cannot be traced ({reason})"
    if not same_step(*pair):
        return "has a step that is not shown to be the sliding mode of relative degree two"
    return ""


def same_step(one: LawKernels, other: LawKernels) -> bool:
    """Whether two laws are the same function, in the prime field and in doubles."""
    if one.states != other.states:
        return False
    pairs = ((one.start, other.start), (one.step, other.step))
    return same_in_field(pairs, POINTS) and all(_agree_in_doubles(a, b) for a, b in pairs)


def _agree_in_doubles(one: Any, other: Any) -> bool:
    import numpy as np

    for number in range(DOUBLES):
        point = [
            [
                10.0 ** (number % 6 - 1) * (element("double", place, k, number) / PRIME)
                for k in range(one.nnz_in(place))
            ]
            for place in range(one.n_in())
        ]
        found, wanted = (np.array(each.call(point)[0]).ravel() for each in (one, other))
        if not np.allclose(found, wanted, rtol=DIGITS, atol=DIGITS, equal_nan=True):
            return False
    return True
