"""Pressure and torque of the electro-pneumatic brake, eqs. (8)-(14), for the records of a brake."""

import math
from enum import Enum

from wspd_design.model.generated import brake as generated
from wspd_design.model.number import Number, exp, sin
from wspd_design.parameters.records import Brake


class Valve(Enum):
    """States of the valve pair (EV, BV), Table 2; the value is (fill, vent) of eq. (9)."""

    FILL = (1.0, 0.0)
    VENT = (0.0, 1.0)
    HOLD = (0.0, 0.0)


def pressure_after(
    brake: Brake, valve: Valve, time: Number, start_time: Number, start_pressure: Number
) -> Number:
    """Cylinder pressure while the valve stays in one state since ``start_time``: the exact solution of (8), (9).

    Parameters
    ----------
    brake : Brake
        Time constants and supply.
    valve : Valve
        State of the valve since ``start_time``.
    time, start_time : number
        Time since the start of braking [s].
    start_pressure : number
        Cylinder pressure at ``start_time`` [Pa].

    Returns
    -------
    number
        Pressure [Pa].
    """
    match valve:
        case Valve.FILL:
            return generated.filled_pressure(
                time, start_time, start_pressure, brake.max_pressure, brake.supply_rate, brake.fill_time
            )
        case Valve.VENT:
            return generated.vented_pressure(time - start_time, start_pressure, brake.vent_time)
        case Valve.HOLD:
            return start_pressure


def braking_torque(brake: Brake, pressure: Number) -> Number:
    """Torque per wheelset of a cylinder pressure [Pa], eq. (12) with constant pad friction [N m]."""
    return generated.braking_torque(pressure, brake.max_torque, brake.max_pressure)


def torque_disturbance(brake: Brake, time: Number) -> Number:
    """Vibration of the pads at the onset of braking, T_d / T of Section 7 [-]."""
    decay = exp(-brake.disturbance_decay * time)
    return brake.disturbance_gain * decay * sin(2.0 * math.pi * brake.disturbance_frequency * time)
