"""From a design's specification to the problem that the certificates speak about."""

from wspd_design.certificates.records import Problem
from wspd_design.controllers.protocol import Controller
from wspd_design.design.records import Specification
from wspd_design.parameters.records import Rail, Vehicle


def stability_problem(
    vehicle: Vehicle, rail: Rail, controller: Controller, specification: Specification, *, seed: int = 0
) -> Problem:
    """Closed loop and domain of a specification, with the uncertainty from the bounds of the parameters."""
    return Problem(
        vehicle=vehicle,
        rail=rail,
        controller=controller,
        slip=specification.slip,
        speeds=specification.speeds,
        slips=specification.slips,
        mass_bounds=vehicle.mass_bounds,
        inertia_bounds=vehicle.wheelset_inertia_bounds,
        mu0_bounds=rail.mu0_bounds,
        sample_time=controller.sample_time,
        seed=seed,
    )
