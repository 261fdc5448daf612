"""The check that every run carries: what changes when all integration steps are halved.

A run that changes is repeated with shorter steps until it does not; if it still does with the shortest ones, it is
*unresolved*. Whether a run is *sensitive* is another question: rule tables and relays on falling friction can amplify
a change that nobody can measure until it moves the result. Steps may then be short enough for this very run, but its
neighbours end elsewhere, so that it gives the spread over them in place of a digit that it does not have.
"""

import math
from dataclasses import dataclass, replace

from wspd_design.controllers.protocol import Law
from wspd_design.parameters.records import Vehicle
from wspd_design.plants.names import DEFAULT_PLANT, plant_of
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Run
from wspd_design.simulation.stop import simulate_on

DISTANCE_TOLERANCE = 1e-6  # relative
SLIP_TOLERANCE = 1e-4
LOWEST_SPEED = 0.3  # m/s, below it the slip is not compared
REFINEMENTS = (1, 2, 4, 8)
PERTURBATION = 1e-6  # relative, of the initial speed: far below what anybody can measure
PERTURBED_RUNS = 8
AMPLIFICATION = 10.0  # of the perturbation in the distance, from which on a loop counts as sensitive
SLIP_AMPLIFICATION = 1e4  # the same in the slip, which moves quickly wherever a wheel is let go


@dataclass(frozen=True, slots=True, kw_only=True)
class StepCheck:
    """Difference between a run and the same run with half the steps.

    Attributes
    ----------
    distance : float [-]
        Relative.
    slip : float [-]
        Largest at any sample above 0.3 m/s.
    refinement : int
        By which the steps were divided.
    sensitive : bool
        The closed loop amplifies: runs from slightly different initial speeds diverge.
    spread : float [m]
        Of the distance over such runs; 0 unless sensitive.
    """

    distance: float
    slip: float
    refinement: int
    sensitive: bool
    spread: float

    @property
    def unresolved(self) -> bool:
        """Tell whether none of the steps is short enough."""
        return not (self.distance <= DISTANCE_TOLERANCE and self.slip <= SLIP_TOLERANCE)


def simulate_checked(
    vehicle: Vehicle, controller: Law, scenario: Scenario, *, plant: str = DEFAULT_PLANT
) -> tuple[Run, StepCheck]:
    """Simulate a stop with steps that are short enough, as far as that is possible.

    Parameters
    ----------
    vehicle, controller, scenario, plant
        As in :func:`~wspd_design.simulation.stop.simulate`.

    Returns
    -------
    run : Run
        The run whose steps are short enough, or the one with the shortest steps.
    check : StepCheck
        How far it can be trusted.
    """
    braked = plant_of(plant, vehicle)
    first = run = simulate_on(braked, controller, scenario)
    spread = perturbed_spread(braked, controller, scenario, first)
    for refinement in REFINEMENTS:
        finer = simulate_on(braked, controller, scenario, refinement=2 * refinement)
        check = StepCheck(
            distance=distance_difference(finer, run.totals.distance),
            slip=slip_difference(vehicle, run, finer),
            refinement=refinement,
            sensitive=spread > 0.0,
            spread=spread,
        )
        if not check.unresolved:
            return run, check
        run = finer
    return run, check


def perturbed_spread(
    plant: Plant, controller: Law, scenario: Scenario, run: Run, *, neighbours: int = PERTURBED_RUNS
) -> float:
    """Range of the distance over slightly different initial speeds [m]; 0 where a neighbour stays near the run."""

    def neighbour(number: int) -> Run:
        speed = scenario.initial_speed * (1.0 - PERTURBATION * number)
        return simulate_on(plant, controller, replace(scenario, initial_speed=speed))

    nearest, distance = neighbour(1), run.totals.distance
    # A stop from a speed that is lower by a share is shorter by twice that share.
    moved = distance_difference(nearest, run.totals.distance) > AMPLIFICATION * 2.0 * PERTURBATION
    slipped = slip_difference(plant.vehicle, run, nearest) > SLIP_AMPLIFICATION * PERTURBATION
    if not moved and not slipped:
        return 0.0
    further = (neighbour(number).totals.distance for number in range(2, neighbours + 1))
    distances = (distance, nearest.totals.distance, *further)
    return max(distances) - min(distances)


def distance_difference(run: Run, distance: float) -> float:
    """Relative difference of a distance from that of a run; none between trains that are at rest at once."""
    if run.totals.distance == distance:
        return 0.0
    return abs(run.totals.distance / distance - 1.0) if distance != 0.0 else math.inf


def slip_difference(vehicle: Vehicle, run: Run, other: Run) -> float:
    """Largest difference of the slip that the controllers saw, at samples above the lowest speed."""
    worst = 0.0
    for mine, theirs in zip(run.axle_samples, other.axle_samples, strict=True):
        for a, b in zip(mine, theirs, strict=False):
            if min(a.seen.speed, b.seen.speed) > LOWEST_SPEED:
                difference = a.seen.wheel_speed / a.seen.speed - b.seen.wheel_speed / b.seen.speed
                worst = max(worst, vehicle.wheel_radius * abs(difference))
    return worst
