"""What each inferred number does alone: a stop at both ends of its bounds, with all others nominal."""

import math
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass

from wspd_design.controllers.protocol import Law
from wspd_design.parameters.bounds import Ends
from wspd_design.plants.protocol import Plant
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.stop import simulate_on
from wspd_design.studies.rung import axle_figures


@dataclass(frozen=True, slots=True, kw_only=True)
class Effects:
    """What a stop is compared by."""

    distance: float  # m; infinite for a train that does not stop
    transfer: float  # -, relative change of the wheel load of the first wheelset by braking
    relief: float  # -, likewise of the wheelset that braking relieves most
    slip: float  # -, largest mean slip of a wheelset above 10 km/h


@dataclass(frozen=True, slots=True, kw_only=True)
class Swing:
    """What one number does alone."""

    name: str
    low: float  # ends of the bounds [SI units]
    high: float
    at_low: Effects
    at_high: Effects

    def reach(self, figure: str, nominal: Effects) -> float:
        """Return the largest change of one of the effects."""
        ends = (self.at_low, self.at_high)
        return max(abs(float(getattr(end, figure)) - float(getattr(nominal, figure))) for end in ends)


@dataclass(frozen=True, slots=True, kw_only=True)
class Tornado:
    """What each number does alone to a stop; the numbers are held at all other times."""

    plant: str
    controller: str
    rail: str
    initial_speed: float  # m/s
    nominal: Effects
    swings: tuple[Swing, ...]  # in the order of the numbers
    stops: int  # that were simulated

    def strongest(self, figure: str) -> tuple[Swing, ...]:
        """Return the swings by what they do to one of the effects, the strongest first."""
        return tuple(sorted(self.swings, key=lambda each: -each.reach(figure, self.nominal)))


def tornado(
    plant: Plant,
    law: Law,
    scenario: Scenario,
    bounds: Mapping[str, Ends],
    *,
    varied: Callable[[str, float], Plant],
    build_up: float,
    pool: Executor,
) -> Tornado:
    """Simulate a stop with each number at each end of its bounds.

    Parameters
    ----------
    plant : Plant
        Nominal.
    law : Law
        As it was designed: it knows the nominal numbers.
    scenario : Scenario
        The stop.
    bounds : mapping of str to ends
        Of the numbers, in SI units.
    varied : callable
        Returns the plant with one number, given by its name, at a value.
    build_up : float
        Time from which on the brake of the nominal stop is built up [s].
    pool : Executor
        Runs the stops side by side.
    """

    def effects(changed: Plant) -> Effects:
        run = simulate_on(changed, law, scenario)
        axles = axle_figures(
            run,
            wheelsets=changed.vehicle.wheelsets,
            wheel_radius=changed.vehicle.wheel_radius,
            build_up=build_up,
        )
        return Effects(
            distance=run.totals.distance if run.ending is Ending.STOPPED else math.inf,
            transfer=axles[0].transfer,
            relief=min(axle.transfer for axle in axles),
            slip=max(axle.slip_mean for axle in axles),
        )

    ends = [(name, end) for name, pair in bounds.items() for end in pair]
    nominal, *found = pool.map(effects, [plant, *(varied(name, end) for name, end in ends)])
    return Tornado(
        plant=plant.name,
        controller=law.name,
        rail=scenario.rail.name,
        initial_speed=scenario.initial_speed,
        nominal=nominal,
        swings=tuple(
            Swing(name=name, low=low, high=high, at_low=found[2 * k], at_high=found[2 * k + 1])
            for k, (name, (low, high)) in enumerate(bounds.items())
        ),
        stops=1 + len(found),
    )
