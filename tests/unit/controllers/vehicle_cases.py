"""Cases of laws of a vehicle that several tests share."""

from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import VehicleMeasurement
from wspd_design.design.records import Specification
from wspd_design.design.selection import named_design
from wspd_design.parameters.loading import load_rail

LAWS = ("observer-smc", "super-twisting", "integral-smc", "afsmc-mended")


def protection(vehicle, law="observer-smc", *, rail="polach-wet", **specification) -> Protection:
    """Return a law by its rules, sampled every 20 ms unless stated otherwise."""
    wanted = Specification(**({"sample_time": 0.02} | specification))
    friction = load_rail(rail)
    made = named_design(law, vehicle, friction, wanted).build(vehicle, friction)
    assert isinstance(made, Protection)
    return made


def seen(vehicle, speed, slips, pressures, *, healthy=None, demand=1.0) -> VehicleMeasurement:
    """Return what ideal sensors show."""
    wheels = tuple(speed * (1.0 - slip) / vehicle.wheel_radius for slip in slips)
    share = vehicle.brake.max_torque / vehicle.brake.max_pressure
    return VehicleMeasurement(
        speed=speed,
        wheel_speeds=wheels,
        torques=tuple(share * pressure for pressure in pressures),
        healthy=healthy or (1.0,) * len(slips),
        pressures=tuple(pressures),
        acceleration=0.0,
        demand=demand,
        reservoir=vehicle.brake.max_pressure,
    )
