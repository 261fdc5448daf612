"""What goes into the closed loop and what comes out of it, as arrays of numbers.

Arrays over lanes or stops have them as their last axis; lane ``axle * stops + stop`` is one wheelset of one stop.
"""

import ctypes
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

LANE_TOTALS = (
    "torque",
    "damping_impulse",
    "brake_work",
    "sliding_work",
    "damping_work",
    "slip",
    "slip_squared",
    "angle",
    "lock_time",
    "slip_max",
    "judged_lock_time",
    "longest_lock",
    "vented_pressure",
    "valve_switches",
    "filled_pressure",
    "watchdog",
    "slip_band",  # -1 before the first sample beyond the reference, and for laws that do not tell it
)
STOP_TOTALS = (
    "distance",
    "resistance_impulse",
    "resistance_work",
    "judged_time",
    "time",
    "end_speed",
    "speed_error",  # of laws that tell the train speed which they go by
    "distance_error",  # likewise
)
DISTURBANCES = (
    "reference_factor",  # of the train speed that a law is told
    "reference_drift",  # m/s2
    "reference_noise",  # m/s rms
    "speed_noise",  # m/s rms, of the rim speed
    "pulse_angle",  # rad, 0 for a wheel speed without a pulse wheel
    "timed",  # 1 where the time between pulses is taken, 0 where they are counted
    "torque_factor",  # of the torque that a law is told
    "dead_time",  # s
    "shortest_pulse",  # s
    "longest_release",  # s, 0 without a watchdog
    "reservoir_pressure",  # Pa, at the start
    "accelerometer_bias",  # m/s2
    "accelerometer_noise",  # m/s2 rms
)
"""What disturbs measurement and valves of a stop; in C in the same order."""
FAULTS = (
    "wheel_factor",  # of the wheel speed that a law is told
    "sensor_lost",  # s, from when on the speed sensor gives nothing
    "stuck",  # valves that follow no command: 0 none, then as STUCK_VALVES
    "stuck_since",  # s
)
"""What a wheelset of a stop has of its own; in C in the same order."""
STUCK_VALVES = ("holds", "vents", "fills")
LANE_SEEN = 5
"""What a law sees of each wheelset: train speed, wheel speed, torque, whether the speed sensor works, pressure."""
STOP_SEEN = 3
"""And of the vehicle: acceleration, demand, reservoir."""
ERROR_SPEED = 20.0 / 3.6
"""Above it the error of the train speed counts that a law goes by [m/s]."""
DISTANCE_TOLERANCE = (5.0, 0.05)
"""Error of a distance that train control allows: metres, and share of the distance (ETCS, subset 041)."""
RAIL_NUMBERS = 5
DOUBLES = ctypes.POINTER(ctypes.c_double)


class Settings(ctypes.Structure):
    """Numbers of the run that are the same for all stops, in SI units."""

    _fields_ = tuple(
        (name, ctypes.c_double)
        for name in (
            "sample_time",
            "longest_step",
            "creep_rate",
            "slope_limit",
            "stop_speed",
            "regularization_speed",
            "time_limit",
            "judging_speed",
            "record_interval",
        )
    )


class Head(ctypes.Structure):
    """What the caller sets in the C structure ``Loop``; its state follows."""

    _fields_ = (
        ("set", Settings),
        ("disturbance", DOUBLES),
        ("fault", DOUBLES),
        ("seed", ctypes.POINTER(ctypes.c_uint64)),
        ("queue", DOUBLES),
        ("queue_rows", ctypes.c_long),
        ("patch_start", DOUBLES),
        ("patch_rail", DOUBLES),
        ("patches", ctypes.c_long),
        ("load_factor", DOUBLES),
        ("load_points", ctypes.c_long),
        ("load_spacing", DOUBLES),
        ("hold", DOUBLES),
        ("hold_points", ctypes.c_long),
        ("hold_first", ctypes.c_double),
        ("hold_spacing", ctypes.c_double),
        ("track", DOUBLES),
        ("track_points", ctypes.c_long),
        ("track_again", ctypes.c_long),
        ("track_spacing", ctypes.c_double),
        ("trace", DOUBLES),
        ("trace_rows", ctypes.c_long),
        ("trace_used", ctypes.c_long),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopInput:
    """Everything that the loop takes, as numbers."""

    stop_parameters: "Array"  # (PARAMETERS, stops)
    lane_parameters: "Array"  # (PARAMETERS, lanes)
    numbers: "Array"  # (numbers, stops), of a coupled plant beyond those of its vehicle
    speeds: "Array"  # (stops,), initial [m/s]
    wheel_speeds: "Array"  # (lanes,), initial [rad/s]
    rest: "Array"  # (further states of the plant, stops), initial
    pressures: "Array"  # (lanes,), of the cylinders, initial [Pa]
    settings: Settings
    disturbances: "Array"  # (DISTURBANCES, stops)
    faults: "Array"  # (FAULTS, lanes)
    seeds: "NDArray[np.uint64]"  # (stops,)
    patch_starts: "Array | None" = None  # (patches, stops) [m], inf where a stop has fewer
    patch_rails: "Array | None" = None  # (patches, stops, RAIL_NUMBERS)
    load_factors: "Array | None" = None  # (lanes, points)
    load_spacings: "Array | None" = None  # (stops,) [m]
    held_slips: "Array | None" = None  # (lanes, points), what an ideal brake never exceeds
    held_speeds: tuple[float, float] = (1.0, 1.0)  # m/s, first and second of the points, evenly spaced in log
    track: "Array | None" = None  # (stops, points, 6): value and slope over distance of each channel
    track_again: int = 0  # point that comes after the last one
    track_spacing: float = 1.0  # m
    trace_rows: int = 0

    @property
    def waiting_commands(self) -> int:
        """Most commands that wait for their dead time at once."""
        longest = min(float(self.disturbance("dead_time").max()), float(self.settings.time_limit))
        return math.floor(longest / float(self.settings.sample_time)) + 2

    def fault(self, name: str) -> "Array":
        """One of the faults of every lane."""
        row: Array = self.faults[FAULTS.index(name)]
        return row

    def disturbance(self, name: str) -> "Array":
        """One of the disturbances of every stop."""
        row: Array = self.disturbances[DISTURBANCES.index(name)]
        return row


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopOutput:
    """What the loop gives back, as numbers."""

    result: int
    stopped: "NDArray[np.bool_]"  # (stops,)
    lane_totals: dict[str, "Array"]  # (lanes,) each
    stop_totals: dict[str, "Array"]  # (stops,) each
    wheel_speeds: "Array"  # (lanes,)
    trace: "Array"  # (rows, 3 + (5 + states of an axle) axles + further traces), of the first stop
    samples: "Array"  # time, then by stop: state of the law, fill and vent of each wheelset, what it saw
    bad_command: tuple[float, float, float]  # time, fill, vent
    steps: int
