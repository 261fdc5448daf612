"""The protection of a whole vehicle: a source of the train speed, observers, and a law for each wheelset.

At each sample the source says how fast the train is, and whether a wheelset has to be released or held so that it shows
the speed. For each wheelset the protection observes the friction torque and models the torque of the brake, the law
commands the valve, and the command is replaced where the source, a lost speed sensor or a low speed asks for it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, NamedTuple

from wspd_design.controllers.gains import Quantity
from wspd_design.controllers.observers.protocol import SpeedEstimate, SpeedSource
from wspd_design.controllers.protocol import Command, State, VehicleMeasurement, slip_reference_name
from wspd_design.controllers.references import DesiredSlip, Reference
from wspd_design.controllers.seeking import PeakSeeking, Shown
from wspd_design.controllers.valve_inversion import ValveInversion
from wspd_design.controllers.wheel_law import WheelLaw, WheelView
from wspd_design.model.generated import friction_observer, slip_tracking
from wspd_design.model.generated.slip import wheel_speed_at_slip
from wspd_design.model.number import Number, exp, maximum, minimum, where
from wspd_design.model.slip import slip_ratio

_YES = 0.5  # flags are above it
_NEAR = 0.5  # of the slip, within which a wheel holds it
_CAREFUL = 0.85  # of the least torque of the others: loads and friction differ from wheelset to wheelset
_HELD_SLOWING = 0.05  # m/s2, least deceleration with which a valve is held at low speed
_FAR = 0.5  # slip beyond which a wheel is let go at low speed, too, before it locks


@dataclass(frozen=True, slots=True, kw_only=True)
class ProtectionGains:
    """Gains that every law of a vehicle has; the reference is one of those of its specification."""

    slip_reference: float  # -, of the constant reference
    falling_slip: float  # -, at 1 m/s, of the reference that falls as 1/sqrt(v)
    largest_slip: float  # -, its upper limit
    peak_speeds: Annotated[tuple[float, ...], Quantity(dimension="speed")] = ()  # of the table of the peak
    peak_slips: tuple[float, ...] = ()  # -
    seeking_amplitude: float = 0.0  # -, of the search for the peak, in the logarithm of the slip
    seeking_period: Annotated[float, Quantity(dimension="time")] = 0.0  # half of it
    seeking_gain: float = 0.0  # -
    seeking_bias: float = 0.0  # -
    observer_rate: Annotated[float, Quantity(dimension="rate", divisor=True)]  # of the friction torque
    least_pulse: Annotated[float, Quantity(dimension="time")]  # shorter ones are not commanded
    cut_out_speed: Annotated[float, Quantity(dimension="speed")]  # below it the valves hold


class _Wheelset(NamedTuple):
    """What the protection remembers of one wheelset."""

    slip_reference: Number  # -
    friction_torque: Number  # N m, as observed
    torque: Number  # N m, at the end of the last sample, by the model of the valve
    mean_torque: Number  # N m, over that sample
    observed_speed: Number  # rad/s
    released: Number  # 1 while it is vented so that it rolls


@dataclass(frozen=True, slots=True, kw_only=True)
class Protection:
    """The sampled controller of a vehicle.

    Its state is that of the source, then what it remembers of the wheelsets, then the states of their laws; the first
    element of all wheelsets comes first, then the second one, and so on.
    """

    name: str
    sample_time: float  # s
    wheel_radius: float  # m, nominal
    wheelset_inertia: float  # kg m2, nominal
    torque_shares: tuple[float, ...]  # of the torque of the brake, from the front, 0 without one
    source: SpeedSource
    reference: Reference
    core: WheelLaw
    valve: ValveInversion
    pressure_sensors: bool
    observer_rate: float  # 1/s
    cut_out_speed: float  # m/s
    seeking: PeakSeeking | None = None

    @property
    def wheelsets(self) -> int:
        """Number of wheelsets that it acts on."""
        return len(self.torque_shares)

    @property
    def memory(self) -> tuple[str, ...]:
        """Names of the elements of the state."""
        numbers = range(1, self.wheelsets + 1)
        references = [slip_reference_name(number) for number in numbers]
        own = [f"{name}_{number}" for name in _Wheelset._fields[1:] for number in numbers]
        law = [f"{name}_{number}" for name in self.core.memory for number in numbers]
        search = () if self.seeking is None else self.seeking.memory
        return (*self.source.memory, *search, *references, *own, *law)

    def start(self, measurement: VehicleMeasurement) -> State:
        """Start source, observers and laws with wheels that follow the train."""
        at_rest = SpeedEstimate(measurement.speed, 0.0, (0.0,) * self.wheelsets, (0.0,) * self.wheelsets)
        desired = self.reference.at(measurement.speed, 1.0)
        wheels, laws = [], []
        for axle in range(self.wheelsets):
            torque = self._torque_of_pressure(measurement, axle)
            wheel = _Wheelset(desired.slip, torque, torque, torque, measurement.wheel_speeds[axle], 0.0)
            wheels.append(wheel)
            laws.append(self.core.start(self._view(axle, measurement, at_rest, desired, wheel)))
        search = () if self.seeking is None else self.seeking.start()
        return (*self.source.start(measurement), *search, *_by_element(wheels), *_by_element(laws))

    def step(self, state: State, measurement: VehicleMeasurement) -> tuple[State, tuple[Command, ...]]:
        """Estimate the train speed, observe each wheelset and command its valve."""
        source, search, wheels, laws = self._parts(state)
        source, estimate = self.source.step(
            source,
            measurement,
            tuple(wheel.friction_torque for wheel in wheels),
            tuple(wheel.slip_reference for wheel in wheels),
        )
        wheels = [self._observe(axle, measurement, wheel) for axle, wheel in enumerate(wheels)]
        search, scales = self._seek(search, measurement, estimate, wheels)
        wanted = [self.reference.at(estimate.speed, scale) for scale in scales]
        views = [
            self._view(axle, measurement, estimate, desired, wheel)
            for axle, (desired, wheel) in enumerate(zip(wanted, wheels, strict=True))
        ]
        decided = [self.core.step(law, view) for law, view in zip(laws, views, strict=True)]
        commands = [command for _, command in decided]
        commands = [
            self._without_sensor(axle, command, measurement, views, wheels)
            for axle, command in enumerate(commands)
        ]
        commands = [self._at_low_speed(view, each) for view, each in zip(views, commands, strict=True)]
        commands = [_asked(axle, estimate, command) for axle, command in enumerate(commands)]
        following = [
            self._remember(*each)
            for each in zip(wheels, views, commands, wanted, estimate.release, strict=True)
        ]
        laws = [after for after, _ in decided]
        return (*source, *search, *_by_element(following), *_by_element(laws)), tuple(commands)

    def _parts(self, state: State) -> tuple[State, State, list[_Wheelset], list[State]]:
        """Split the state into that of the source, that of the search and those of each wheelset."""
        count, first = self.wheelsets, len(self.source.memory)
        begin = first + (0 if self.seeking is None else len(self.seeking.memory))
        end = begin + len(_Wheelset._fields) * count
        wheels = [_Wheelset(*state[begin + axle : end : count]) for axle in range(count)]
        laws = [state[end + axle :: count] for axle in range(count)]
        return state[:first], state[first:begin], wheels, laws

    def _seek(
        self,
        search: State,
        measurement: VehicleMeasurement,
        estimate: SpeedEstimate,
        wheels: Sequence[_Wheelset],
    ) -> tuple[State, tuple[Number, ...]]:
        """Search for the peak; without a search the reference is held as it is."""
        if self.seeking is None:
            return search, (1.0,) * self.wheelsets
        shown = []
        for axle, wheel in enumerate(wheels):
            slip = slip_ratio(estimate.speed, wheel.observed_speed, self.wheel_radius)
            near = abs(slip - wheel.slip_reference) < _NEAR * wheel.slip_reference
            well = where(wheel.released > _YES, False, measurement.healthy[axle] > _YES)
            holds = where(estimate.speed > self.cut_out_speed, where(near, well, False), False)
            braked = self.torque_shares[axle] > 0.0
            shown.append(Shown(wheel.friction_torque, slip, where(holds, 1.0, 0.0) if braked else 0.0))
        return self.seeking.step(search, tuple(shown))

    def _full_torque(self, axle: int) -> Number:
        return self.torque_shares[axle] * self.valve.brake.max_torque

    def _torque_of_pressure(self, measurement: VehicleMeasurement, axle: int) -> Number:
        """Nominal torque of the cylinder pressure, 0 without its sensor [N m]."""
        if not self.pressure_sensors:
            return 0.0
        return measurement.pressures[axle] * self._full_torque(axle) / self.valve.brake.max_pressure

    def _observe(self, axle: int, measurement: VehicleMeasurement, wheel: _Wheelset) -> _Wheelset:
        """Observe speed and friction torque of a wheelset, and measure its torque if it has a sensor."""
        turned = (wheel.friction_torque - wheel.mean_torque) / self.wheelset_inertia * self.sample_time
        seen = where(
            measurement.healthy[axle] > _YES, measurement.wheel_speeds[axle], wheel.observed_speed + turned
        )
        speed, friction = friction_observer.observed(
            seen,
            wheel.observed_speed,
            wheel.friction_torque,
            wheel.mean_torque,
            self.sample_time,
            self.wheelset_inertia,
            exp(-self.observer_rate * self.sample_time),
        )
        torque = self._torque_of_pressure(measurement, axle) if self.pressure_sensors else wheel.torque
        return wheel._replace(observed_speed=speed, friction_torque=maximum(friction, 0.0), torque=torque)

    def _view(
        self,
        axle: int,
        measurement: VehicleMeasurement,
        estimate: SpeedEstimate,
        desired: DesiredSlip,
        wheel: _Wheelset,
    ) -> WheelView:
        """Collect what the law of a wheelset goes by."""
        speed = estimate.speed
        return WheelView(
            speed=speed,
            acceleration=estimate.acceleration,
            wheel_speed=measurement.wheel_speeds[axle],
            rolling_speed=speed / self.wheel_radius,
            desired_speed=wheel_speed_at_slip(desired.slip, speed, self.wheel_radius),
            desired_acceleration=slip_tracking.reference_acceleration(
                speed, estimate.acceleration, desired.slip, desired.slope, self.wheel_radius
            ),
            friction_torque=wheel.friction_torque,
            torque=wheel.torque,
            available=measurement.demand * self._full_torque(axle),
            full_torque=self._full_torque(axle),
        )

    def _without_sensor(
        self,
        axle: int,
        command: Command,
        measurement: VehicleMeasurement,
        views: Sequence[WheelView],
        wheels: Sequence[_Wheelset],
    ) -> Command:
        """Return the command of a wheelset; without its speed sensor it brakes less than all that have theirs.

        Without any sensor it takes the whole brake, as without a protection.
        """
        own = views[axle]
        target = own.available
        for other, (view, wheel) in enumerate(zip(views, wheels, strict=True)):
            if other != axle and self.torque_shares[other] > 0.0:
                seen = where(wheel.released > _YES, False, measurement.healthy[other] > _YES)
                target = minimum(target, where(seen, _CAREFUL * view.torque, own.available))
        careful = self.valve.command(own.torque, target, own.available, 0.0, own.full_torque)
        well = measurement.healthy[axle] > _YES
        return Command(
            fill=where(well, command.fill, careful.fill), vent=where(well, command.vent, careful.vent)
        )

    def _at_low_speed(self, view: WheelView, command: Command) -> Command:
        """Hold, and let only a wheel go that slides far: at low speed neither slip nor wheel speed can be trusted."""
        # What is held has to brake: a train that came to that speed with empty cylinders would run on down a grade.
        slow = (view.speed < self.cut_out_speed) * (view.acceleration < -_HELD_SLOWING)
        slides_far = self.wheel_radius * view.wheel_speed < (1.0 - _FAR) * view.speed
        return Command(
            fill=where(slow, 0.0, command.fill),
            vent=where(slow, where(slides_far, 1.0, 0.0), command.vent),
        )

    def _remember(
        self, wheel: _Wheelset, view: WheelView, command: Command, desired: DesiredSlip, released: Number
    ) -> _Wheelset:
        """Work out what the command makes of the torque."""
        torque, mean = self.valve.after(command, wheel.torque, view.available, view.full_torque)
        return wheel._replace(slip_reference=desired.slip, torque=torque, mean_torque=mean, released=released)


def _asked(axle: int, estimate: SpeedEstimate, command: Command) -> Command:
    """Vent a wheelset that the source wants to roll, hold one that shows the speed to it."""
    release, hold = estimate.release[axle] > _YES, estimate.hold[axle] > _YES
    fill = where(release, 0.0, where(hold, 0.0, command.fill))
    return Command(fill=fill, vent=where(release, 1.0, where(hold, 0.0, command.vent)))


def _by_element(states: Sequence[tuple[Number, ...]]) -> State:
    """Put the first elements of all wheelsets first, then the second ones, and so on."""
    return tuple(element for elements in zip(*states, strict=True) for element in elements)
