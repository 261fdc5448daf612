"""Friction of the pads, electrodynamic brake and magnetic track brake, for their records.

Corners of tables and characteristics are rounded within SPEED_ROUNDING or TEMPERATURE_ROUNDING.
"""

from wspd_design.model.corners import corner, lower, step, table
from wspd_design.model.number import Number, exp, maximum, where
from wspd_design.parameters.brake_checks import SPEED_ROUNDING, TEMPERATURE_ROUNDING
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake

_POWER_ROUNDING = 0.05  # of the torque: about the speed where torque and power are both at their limit
_NO_TORQUE = 1e-9  # N m, that keeps the rounding of an axle without a motor above zero
_STANDING = 1e-3  # rad/s, by which the power is divided at least; the brake has cut out long before
LEAST_SHARE = 1e-6
"""Of its pressure, that is asked of a friction brake in any case: it is applied."""
_AT_ONCE = 1e-6  # s, in place of a time constant of zero


def pad_factor(pads: Pads, rim_speed: Number, temperature: Number) -> Number:
    """Friction of the pads at a speed of the wheel rim [m/s] and a temperature above that before the stop [K] [-]."""
    factor = table(rim_speed, pads.speeds, pads.speed_factors, SPEED_ROUNDING) if pads.speeds else 1.0
    if pads.temperatures:
        factor = factor * table(
            temperature, pads.temperatures, pads.temperature_factors, TEMPERATURE_ROUNDING
        )
    return factor


def pad_warming(pads: Pads, friction_torque: Number, wheel_speed: Number, temperature: Number) -> Number:
    """Rate of the temperature of what the friction of a wheelset heats [K/s]."""
    return (friction_torque * wheel_speed - pads.cooling * temperature) / pads.heat_capacity


def dynamic_torque(brake: DynamicBrake, wheel_speed: Number, wheel_radius: Number) -> Number:
    """Torque of the built-up electrodynamic brake at a speed of the wheel [N m per wheelset]."""
    by_power = brake.power / maximum(wheel_speed, _STANDING)
    full = lower(brake.torque, by_power, _POWER_ROUNDING * brake.torque + _NO_TORQUE)
    rim, fade, out = wheel_radius * wheel_speed, brake.fade_speed, brake.cut_out_speed
    share = (corner(rim - out, SPEED_ROUNDING) - corner(rim - fade, SPEED_ROUNDING)) / (fade - out)
    return full * share


def build_up(since: Number, before: Number, goal: Number, time_constant: Number) -> Number:
    """Level of an electrodynamic brake some time [s] after it left another level for a goal [-]."""
    return goal + (before - goal) * exp(-since / time_constant)


def friction_share(dynamic: Number, demanded: Number) -> Number:
    """Share of its pressure that is asked of the friction brake beside a torque of the electrodynamic one [-]."""
    idle = demanded <= 0.0
    return maximum(where(idle, 0.0, 1.0 - dynamic / where(idle, 1.0, demanded)), LEAST_SHARE)


def track_brake_force(brake: TrackBrake, speed: Number, time: Number) -> Number:
    """Force of the magnets at a train speed, some time after the brake was applied [N]."""
    force = brake.force
    if brake.speeds:
        force = force * table(speed, brake.speeds, brake.speed_factors, SPEED_ROUNDING)
    down = step(speed - brake.cut_out_speed, SPEED_ROUNDING)
    force = force * where(brake.cut_out_speed > 0.0, down, 1.0)
    lag = brake.build_up_time
    return force * where(lag > 0.0, 1.0 - exp(-time / maximum(lag, _AT_ONCE)), 1.0)
