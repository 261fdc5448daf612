"""What goes into a simulated stop."""

import math
from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Brake, Rail
from wspd_design.parameters.taken import check_numbers, check_rail, notice_of_fast_train


@dataclass(frozen=True, slots=True, kw_only=True)
class Patch:
    """A change of rail: from ``start`` on, every wheel that passes runs on ``rail``.

    Attributes
    ----------
    start : float [m]
    rail : Rail
    """

    start: float
    rail: Rail


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensing:
    """What disturbs a real WSP between the train and its controller and back; everything is off by default.

    A pulse wheel is counted as by an incremental encoder: the wheel speed is that of the whole pulses since the last
    sample, and the rest of the angle stays for the next one. With ``period_timing`` it is one pulse over the time
    between the last two, and never more than one pulse over the time since the last one, which is the rule where no
    pulse comes: a faster wheel would have given one. The clock is exact; the times of the pulses are interpolated
    within the steps, and the speeds agree with the true angle to 3e-5 up to 1000 pulses in steps of 0.2 ms. Before the
    stop the wheel turned at its first speed; where it stands at the start is drawn.

    The train speed that all controllers of the train know is v (1 + error) + drift t + noise, t from the start of the
    stop, and never negative.

    A command takes effect after the dead time, with as many others on their way as there are samples within it. A
    pulse of filling or venting that is shorter than the shortest one is left out of its command, unless the valve is
    open already: what moves in a valve has not left its seat before. The size of all these is the user's; no measured
    one is known here.

    Attributes
    ----------
    speed_noise : float [m/s]
        Rms of the measured rim speed, independent at each sample and axle.
    pulses_per_turn : int
        Of the pulse wheel; 0 for a wheel speed that is known at each instant.
    period_timing : bool
        The time between pulses gives the speed, in place of their count over a sample.
    reference_error : float [-]
        Relative error of the train speed that the controller knows.
    reference_drift : float [m/s2]
        By which that speed moves away from the true one.
    reference_noise : float [m/s]
        Rms of that speed, independent at each sample.
    torque_error : float [-]
        Relative error of cylinder pressures, and of the torques computed from them.
    accelerometer_bias : float [m/s2]
    accelerometer_noise : float [m/s2]
        Rms, independent at each sample.
    radius_errors : tuple[float, ...] [-]
        Of the speed read from each wheel, front first; empty: none.
    dead_time : float or None [s]
        From the command to the valve; None: that of the vehicle.
    shortest_pulse : float or None [s]
        That opens a valve; at most one sample time; None: the vehicle's.
    """

    speed_noise: float = 0.0
    pulses_per_turn: int = 0
    period_timing: bool = False
    reference_error: float = 0.0
    reference_drift: float = 0.0
    reference_noise: float = 0.0
    torque_error: float = 0.0
    accelerometer_bias: float = 0.0
    accelerometer_noise: float = 0.0
    radius_errors: tuple[float, ...] = ()
    dead_time: float | None = None
    shortest_pulse: float | None = None

    def __post_init__(self) -> None:
        """Refuse what is no disturbance."""
        for name, value, unit in (
            ("speed noise", self.speed_noise, "m/s"),
            ("reference noise", self.reference_noise, "m/s"),
            ("accelerometer noise", self.accelerometer_noise, "m/s2"),
            ("dead time", self.dead_time or 0.0, "s"),
            ("shortest pulse", self.shortest_pulse or 0.0, "s"),
        ):
            if not 0.0 <= value < math.inf:
                raise UserError(f"{name} = {value:g} {unit} must be finite and not negative; 0 is none")
        for name, value, positive in (
            ("reference error", self.reference_error, "a speed read"),
            ("torque error", self.torque_error, "a torque computed"),
        ):
            if not -1.0 < value < 1.0:
                raise UserError(
                    f"{name} = {value:g} must lie between -1 and 1, -100 % and 100 %; positive is {positive} too high"
                )
        for error in self.radius_errors:
            if not -0.5 < error < 0.5:
                raise UserError(
                    f"radius error = {error:g} must lie between -0.5 and 0.5; for half a percent write 0.005"
                )
        if not math.isfinite(self.accelerometer_bias):
            raise UserError(
                f"accelerometer bias = {self.accelerometer_bias:g} m/s2 must be finite; 0 is none"
            )
        if not math.isfinite(self.reference_drift):
            raise UserError(f"reference drift = {self.reference_drift:g} m/s2 must be finite; 0 is none")
        if self.pulses_per_turn < 0 or self.pulses_per_turn != int(self.pulses_per_turn):
            raise UserError(
                f"pulses per turn = {self.pulses_per_turn:g} must be a whole number from 1 on, such as 80; 0 is no "
                "pulse wheel"
            )
        if self.period_timing and not self.pulses_per_turn:
            raise UserError("period timing needs a pulse wheel; give the pulses per turn, such as 100")

    def dead_time_of(self, brake: Brake) -> float:
        """Dead time of a stop [s]: that of the vehicle's brake unless another one is given."""
        return brake.dead_time if self.dead_time is None else self.dead_time

    def shortest_pulse_of(self, brake: Brake) -> float:
        """Shortest pulse that opens a valve in a stop [s], likewise."""
        return brake.shortest_pulse if self.shortest_pulse is None else self.shortest_pulse


FaultKind: TypeAlias = Literal["sensor-lost", "valve-holds", "valve-vents", "valve-fills"]
FAULT_KINDS: tuple[FaultKind, ...] = get_args(FaultKind)


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """What fails at one wheelset for the rest of a stop.

    A lost speed sensor reads 0 and its monitoring says so. A stuck valve holds, vents or fills from the first command
    after it fails, whatever law and watchdog ask for.

    Attributes
    ----------
    axle : int
        From 1 at the front.
    kind : FaultKind
    since : float [s]
        From the start of the stop.
    """

    axle: int
    kind: FaultKind
    since: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what is no fault."""
        if self.axle < 1:
            raise UserError(f"axle = {self.axle} of a fault must be 1, the front axle, or more")
        if self.kind not in FAULT_KINDS:
            raise UserError(f'fault = "{self.kind}" must be one of {", ".join(FAULT_KINDS)}')
        if not 0.0 <= self.since < math.inf:
            raise UserError(f"start = {self.since:g} s of a fault must be finite and not negative")


Irregularities: TypeAlias = Literal["none", "low", "high"]
IRREGULARITIES: tuple[Irregularities, ...] = get_args(Irregularities)
"""An even track, and the levels of irregularity of ERRI B176."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadIrregularity:
    """Relative wheel load of each axle over distance, from track irregularity or measurement.

    Attributes
    ----------
    spacing : float [m]
    factors : tuple[tuple[float, ...], ...]
        Per axle, at multiples of the spacing; the last value stays.
    """

    spacing: float
    factors: tuple[tuple[float, ...], ...]

    @property
    def spread(self) -> float:
        """Root mean square of what the relative wheel loads differ from 1 by [-]."""
        values = [value - 1.0 for row in self.factors for value in row]
        return math.sqrt(math.fsum(value * value for value in values) / len(values))

    def __post_init__(self) -> None:
        """Refuse what is no table of wheel loads."""
        if not 0.0 < self.spacing < math.inf:
            raise UserError(f"load irregularity: spacing = {self.spacing:g} m must be finite and above 0")
        for axle, row in enumerate(self.factors, start=1):
            if not row or not all(0.0 <= value < math.inf for value in row):
                raise UserError(
                    f"load irregularity: the relative wheel loads of axle {axle} must be one or more finite numbers "
                    "that are not negative; 1 is the static load"
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class Start:
    """State of all wheelsets at the start of a stop; by default they roll and the brake is applied now.

    The supply (8), the vibration of the pads and the damping of the wheels are as far on as ``braking_time`` says.
    Load transfer begins with the stop.

    Attributes
    ----------
    slip : float [-]
        Share by which the rims are slower than the train.
    torque : float [N m]
        Per wheelset, of the cylinder pressure (12).
    braking_time : float [s]
        Since the brake was applied.
    """

    slip: float = 0.0
    torque: float = 0.0
    braking_time: float = 0.0

    def __post_init__(self) -> None:
        """Refuse what is not a state of a turning wheel."""
        if not 0.0 <= self.slip < 1.0:
            raise UserError(
                f"slip = {self.slip:g} of the start must lie in [0, 1): 0 for rolling wheels; a stop cannot "
                "start with locked ones"
            )
        for name, value, unit in (
            ("torque", self.torque, "N m"),
            ("braking time", self.braking_time, "s"),
        ):
            if not 0.0 <= value < math.inf:
                raise UserError(f"{name} = {value:g} {unit} of the start must be finite and not negative")


@dataclass(frozen=True, slots=True, kw_only=True)
class Scenario:
    """A stop on straight track.

    Attributes
    ----------
    rail : Rail
    initial_speed : float [m/s]
        An ``int`` above 200 km/h is a warning; a float there may be a speed in km/h that was converted.
    start : Start
    seed : int
    axle_rails : tuple[Rail, ...] or None
        Front axle first, in place of ``rail``.
    patches : tuple[Patch, ...]
    grade : float [-]
        Rise over run, positive uphill.
    pad_vibration : bool
        T_d of Section 7.
    sensing : Sensing
    load_irregularity : LoadIrregularity or None
    irregularities : Irregularities
        Of the track, which the wheels roll over; drawn by the seed.
    faults : tuple[Fault, ...]
    """

    rail: Rail
    initial_speed: float
    start: Start = Start()
    seed: int = 0
    axle_rails: tuple[Rail, ...] | None = None
    patches: tuple[Patch, ...] = ()
    grade: float = 0.0
    pad_vibration: bool = False
    sensing: Sensing = Sensing()
    load_irregularity: LoadIrregularity | None = None
    irregularities: Irregularities = "none"
    faults: tuple[Fault, ...] = ()

    def __post_init__(self) -> None:
        """Refuse what is not a stop."""
        for rail in (self.rail, *(self.axle_rails or ()), *(patch.rail for patch in self.patches)):
            check_rail(rail, by="Scenario")
        check_numbers("Scenario", {"initial_speed": (self.initial_speed, "m/s"), "grade": (self.grade, "")})
        if not hasattr(self.seed, "__index__"):
            raise UserError(f"seed = {self.seed} of Scenario must be a whole number")
        if not 0.0 < self.initial_speed < 150.0:
            raise UserError(
                f"initial speed = {self.initial_speed:g} m/s must be above 0 and below 150 m/s (540 km/h); "
                'give it with its unit, for example "120 km/h"'
            )
        notice_of_fast_train(
            self.initial_speed,
            "initial speed",
            f"for {self.initial_speed:g} km/h write Scenario.stop(from_kmh={self.initial_speed:g}, ...)",
        )
        if not -0.1 <= self.grade <= 0.1:
            raise UserError(f"grade = {self.grade:g} must lie in [-0.1, 0.1]; for 10 per mille write 0.01")
        if not 0 <= self.seed < 2**63:
            raise UserError(f"seed = {self.seed} must lie between 0 and 2^63 - 1")
        if self.irregularities not in IRREGULARITIES:
            raise UserError(
                f'irregularities = "{self.irregularities}" must be one of {", ".join(IRREGULARITIES)}'
            )
        starts = [patch.start for patch in self.patches]
        if starts != sorted(starts) or any(start < 0.0 for start in starts):
            raise UserError(f"patches start at {starts} m; their starts must rise and not be negative")

    @classmethod
    def stop(cls, *, from_kmh: float, rail: Rail, seed: int = 0) -> "Scenario":
        """Brake to standstill from a speed in km/h."""
        check_numbers("Scenario.stop", {"from_kmh": (from_kmh, "km/h")})
        return cls(rail=rail, initial_speed=from_kmh / 3.6, seed=seed)
