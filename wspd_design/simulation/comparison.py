"""Several controllers on the same stop."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protocol import Law
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.names import DEFAULT_PLANT
from wspd_design.simulation.metrics import Metrics, metrics
from wspd_design.simulation.records import Run, Scenario
from wspd_design.simulation.self_check import StepCheck, simulate_checked


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """A stop, its figures and how far the integration can be trusted."""

    run: Run
    metrics: Metrics
    check: StepCheck


def trial(
    vehicle: Vehicle,
    controller: Law,
    scenario: Scenario,
    *,
    slip_reference: float,
    plant: str = DEFAULT_PLANT,
) -> Trial:
    """Simulate one stop, check its steps and judge it."""
    run, check = simulate_checked(vehicle, controller, scenario, plant=plant)
    return Trial(run=run, metrics=metrics(run, vehicle, scenario, slip_reference=slip_reference), check=check)


def compare(
    vehicle: Vehicle,
    controllers: Sequence[Law],
    scenario: Scenario,
    *,
    slip_reference: float,
    plant: str = DEFAULT_PLANT,
    progress: Callable[[str], object] = str,
) -> tuple[Trial, ...]:
    """Simulate the same stop with each controller.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    controllers : sequence of Law
        Laws to compare.
    scenario : Scenario
        Rail and initial speed.
    slip_reference : float
        Reference of ``slip_rms`` for the laws that hold none of their own [-].
    plant : {"planar", "quarter", "locomotive", "locomotive-linear"}
        With load transfer, without, or with all degrees of freedom.
    progress : callable, optional
        Told the name of each controller before its stop.

    Returns
    -------
    tuple of Trial
        In the order of the controllers.
    """
    trials = []
    for controller in controllers:
        progress(controller.name)
        held = slip_reference_of(controller)
        reference = slip_reference if held is None else held
        trials.append(trial(vehicle, controller, scenario, slip_reference=reference, plant=plant))
    return tuple(trials)
