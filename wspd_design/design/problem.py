"""From a design's specification to the problem that the certificates speak about."""

from wspd_design.certificates.quantities import TABLE
from wspd_design.certificates.records import Problem
from wspd_design.controllers.protocol import Law
from wspd_design.design.records import Specification
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.records import Brake, Contact, Rail, Vehicle
from wspd_design.parameters.taken import check_kinds, check_record
from wspd_design.simulation.taken import check_law


def stated_bounds(vehicle: Vehicle, rail: Rail) -> Bounds:
    """Return the range of every number that stands in claims, as vehicle and rail state it."""
    records: dict[str, Vehicle | Brake | Contact | Rail] = {
        "vehicle": vehicle,
        "brake": vehicle.brake,
        "contact": vehicle.contact,
        "rail": rail,
    }
    return Bounds.of(
        {
            row.name: records[row.record].bounds[row.field]
            for row in TABLE
            if row.record in records and row.field in records[row.record].bounds
        }
    )


def stability_problem(
    vehicle: Vehicle, rail: Rail, controller: Law, specification: Specification, *, seed: int = 0
) -> Problem:
    """Return closed loop and domain of a specification, with the uncertainty from the bounds of the parameters.

    Parameters
    ----------
    vehicle, rail : Vehicle, Rail
        Nominal numbers with their bounds.
    controller : Law
        The law.
    specification : Specification
        Reference and ranges; the sample time is that of the law.
    seed : int
        Of samples.
    """
    check_kinds(vehicle, rail, by="stability_problem")
    check_law(controller, by="stability_problem")
    remedy = "make one, Specification(slip=0.14)"
    check_record(specification, Specification, by="stability_problem", remedy=remedy)
    return Problem(
        vehicle=vehicle,
        rail=rail,
        controller=controller,
        slip=specification.slip,
        speeds=specification.speeds,
        slips=specification.slips,
        slip_tolerance=specification.slip_tolerance,
        bounds=stated_bounds(vehicle, rail),
        sample_time=controller.sample_time,
        seed=seed,
    )
