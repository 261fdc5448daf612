"""The check that every run carries: what changes when all integration steps are halved.

A run that changes is repeated with shorter steps until it does not. Rule tables and relays on falling friction can
be chaotic: they amplify the last digit of anything until it moves the result, and no step makes them accurate. Such
a run says so and gives the spread over slightly different initial speeds in place of a digit that it does not have.
"""

from dataclasses import dataclass, replace

from wspd_design.controllers.protocol import Controller
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.names import DEFAULT_PLANT, plant_of
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.records import Run, Scenario
from wspd_design.simulation.stop import simulate_on

DISTANCE_TOLERANCE = 1e-6  # relative
SLIP_TOLERANCE = 1e-4
LOWEST_SPEED = 0.3  # m/s, below it the slip is not compared
REFINEMENTS = (1, 2, 4, 8)
PERTURBATION = 1e-6  # relative, of the initial speed: far below what anybody can measure
PERTURBED_RUNS = 8
AMPLIFICATION = 10.0  # of the perturbation in the distance, from which on a loop counts as chaotic


@dataclass(frozen=True, slots=True, kw_only=True)
class StepCheck:
    """Difference between a run and the same run with half the steps."""

    distance: float  # -, relative
    slip: float  # -, largest at any sample above 0.3 m/s
    refinement: int  # by which the steps were divided
    chaotic: bool  # no step is short enough: the closed loop amplifies the last digits
    spread: float  # m, of the distance over slightly perturbed runs; 0 where the steps are short enough

    @property
    def passed(self) -> bool:
        """Tell whether the steps are short enough."""
        return self.distance <= DISTANCE_TOLERANCE and self.slip <= SLIP_TOLERANCE


def simulate_checked(
    vehicle: Vehicle, controller: Controller, scenario: Scenario, *, plant: str = DEFAULT_PLANT
) -> tuple[Run, StepCheck]:
    """Simulate a stop with steps that are short enough, as far as that is possible.

    Parameters
    ----------
    vehicle, controller, scenario, plant
        As in :func:`~wspd_design.simulation.stop.simulate`.

    Returns
    -------
    run : Run
        The run whose steps passed, or the one with the shortest steps.
    check : StepCheck
        How far it can be trusted.
    """
    braked = plant_of(plant, vehicle)
    run = simulate_on(braked, controller, scenario)
    for refinement in REFINEMENTS:
        finer = simulate_on(braked, controller, scenario, refinement=2 * refinement)
        check = StepCheck(
            distance=abs(finer.totals.distance / run.totals.distance - 1.0),
            slip=slip_difference(vehicle, run, finer),
            refinement=refinement,
            chaotic=False,
            spread=0.0,
        )
        if check.passed:
            return run, check
        run = finer
    spread = perturbed_spread(braked, controller, scenario)
    # A stop from a speed that is higher by a share is longer by twice that share.
    expected = 2.0 * PERTURBATION * PERTURBED_RUNS * run.totals.distance
    return run, replace(check, chaotic=spread > AMPLIFICATION * expected, spread=spread)


def perturbed_spread(plant: Plant, controller: Controller, scenario: Scenario) -> float:
    """Range of the distance over slightly different initial speeds [m]."""
    distances = [
        simulate_on(
            plant,
            controller,
            replace(scenario, initial_speed=scenario.initial_speed * (1.0 + PERTURBATION * k)),
        ).totals.distance
        for k in range(PERTURBED_RUNS + 1)
    ]
    return max(distances) - min(distances)


def slip_difference(vehicle: Vehicle, run: Run, other: Run) -> float:
    """Largest difference of the slip that the controllers saw, at samples above the lowest speed."""
    worst = 0.0
    for mine, theirs in zip(run.axle_samples, other.axle_samples, strict=True):
        for a, b in zip(mine, theirs, strict=False):
            if min(a.seen.speed, b.seen.speed) > LOWEST_SPEED:
                difference = a.seen.wheel_speed / a.seen.speed - b.seen.wheel_speed / b.seen.speed
                worst = max(worst, vehicle.wheel_radius * abs(difference))
    return worst
