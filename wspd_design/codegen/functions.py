"""CasADi functions of the plant, built by running the model's own kernels on symbols."""

from functools import lru_cache
from typing import Any, NamedTuple

from wspd_design.model.brake import braking_torque, flow_rates
from wspd_design.model.generated import brake as generated
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Brake, Rail, Vehicle
from wspd_design.plants.quarter import quarter


class SlipPlant(NamedTuple):
    """Slip and torque at a frozen train speed."""

    drift_and_gain: Any  # (slip, speed) -> (F, G)
    derivative: Any  # (slip, torque, speed, duty) -> (slip', torque')
    jacobians: Any  # (slip, torque, speed, duty) -> (A, B)


@lru_cache(maxsize=64)
def slip_plant(vehicle: Vehicle, rail: Rail) -> SlipPlant:
    """Eq. (19) with the averaged valve, as CasADi functions: it fills for the duty and vents for the rest.

    Demand and reservoir are full. For lags with T_F = T_V the torque follows eq. (14).

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Numbers of the model.

    Returns
    -------
    SlipPlant
        ``casadi.Function`` objects in SI units.
    """
    import casadi as ca

    brake = vehicle.brake
    slip, torque, speed, duty = (ca.SX.sym(name) for name in ("slip", "torque", "speed", "duty"))
    dynamics = slip_dynamics(vehicle, rail, slip, speed)
    state = ca.vertcat(slip, torque)
    derivative = ca.vertcat(dynamics.drift + dynamics.gain * torque, _averaged(brake, torque, duty))
    arguments = [slip, torque, speed, duty]
    return SlipPlant(
        drift_and_gain=ca.Function("slip_drift", [slip, speed], [dynamics.drift, dynamics.gain]),
        derivative=ca.Function("slip_plant", arguments, [derivative]),
        jacobians=ca.Function(
            "slip_jacobians", arguments, [ca.jacobian(derivative, state), ca.jacobian(derivative, duty)]
        ),
    )


def _averaged(brake: Brake, torque: Any, duty: Any) -> Any:
    """Rate of the torque of a valve that fills for the duty and vents for the rest [N m/s]."""
    if brake.valve == "lag":
        return duty * (brake.max_torque - torque) / brake.fill_time - (1.0 - duty) * torque / brake.vent_time
    unit = brake.max_torque / brake.max_pressure
    filling, venting = flow_rates(brake, torque / unit)
    return unit * (duty * filling - (1.0 - duty) * venting)


@lru_cache(maxsize=64)
def quarter_plant(vehicle: Vehicle, rail: Rail) -> Any:
    """The quarter model, eqs. (1), (2), (8), (9), as one CasADi function.

    Returns
    -------
    casadi.Function
        (time [s], [v, omega, P] in SI units, [fill, vent]) -> time derivative of the state. The wheel rolls: lock
        and standstill are events of the simulation.
    """
    import casadi as ca

    time, state, valve = ca.SX.sym("time"), ca.SX.sym("state", 3), ca.SX.sym("valve", 2)
    speed, wheel_speed, pressure = (state[i] for i in range(3))
    brake = vehicle.brake
    if (brake.build_up, brake.valve, brake.hold_leak) != ("main-pipe", "lag", 0.0):
        raise UserError(
            f"the brake of {vehicle.name} is not that of eqs. (8), (9); the quarter model is one function with "
            'brake.build_up = "main-pipe", brake.valve = "lag" and no brake.hold_leak'
        )
    motion = quarter(vehicle, rail).motion(time, speed, wheel_speed, braking_torque(brake, pressure))
    supply = generated.supply_pressure(time, brake.max_pressure, brake.supply_rate)
    filling = generated.cylinder_pressure_rate(
        pressure, supply, valve[0], valve[1], brake.fill_time, brake.vent_time
    )
    derivative = ca.vertcat(motion.acceleration, motion.wheel_acceleration, filling)
    return ca.Function("quarter_plant", [time, state, valve], [derivative], ["t", "x", "u"], ["dx"])
