"""Several controllers on the same stop."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from wspd_design.controllers.protocol import Controller
from wspd_design.parameters.records import Vehicle
from wspd_design.simulation.metrics import Metrics, metrics
from wspd_design.simulation.records import Run, Scenario
from wspd_design.simulation.stop import simulate


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """A stop and its figures."""

    run: Run
    metrics: Metrics


def trial(vehicle: Vehicle, controller: Controller, scenario: Scenario, *, slip_reference: float) -> Trial:
    """Simulate one stop and judge it."""
    run = simulate(vehicle, controller, scenario)
    return Trial(run=run, metrics=metrics(run, vehicle, slip_reference=slip_reference))


def compare(
    vehicle: Vehicle,
    controllers: Sequence[Controller],
    scenario: Scenario,
    *,
    slip_reference: float,
    progress: Callable[[str], object] = str,
) -> tuple[Trial, ...]:
    """Simulate the same stop with each controller.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    controllers : sequence of Controller
        Laws to compare.
    scenario : Scenario
        Rail and initial speed.
    slip_reference : float
        Reference of ``slip_rms`` for all of them [-].
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
        trials.append(trial(vehicle, controller, scenario, slip_reference=slip_reference))
    return tuple(trials)
