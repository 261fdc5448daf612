"""What releasing wheelsets is worth: a stop by a protection that looks for the train speed, and by one that does not.

Wheels that are held at a slip follow the speed that the protection believes in, right or wrong. Their friction torques
say how fast that speed falls, but for a scale by which pads and mass are wrong; the error grows until a wheel rolls.
"""

from dataclasses import dataclass, replace

from wspd_design.controllers.observers.wheel_filter import WheelFilter
from wspd_design.controllers.protection import Protection
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Vehicle
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Run
from wspd_design.simulation.stop import simulate

_NEVER = 1e9  # of the slip speed: no train speed becomes so uncertain


@dataclass(frozen=True, slots=True, kw_only=True)
class Looks:
    """One stop twice."""

    looking: Run  # wheelsets are released to look
    blind: Run  # none is


def without_looks(law: Protection) -> Protection:
    """Return the same protection, which releases no wheelset.

    Parameters
    ----------
    law : Protection
        A protection that has its train speed from the wheels.

    Raises
    ------
    UserError
        If it has its train speed from elsewhere.
    """
    if not isinstance(law.source, WheelFilter):
        raise UserError(
            f"{law.name} releases no wheelset: its train speed is not filtered from the wheels; design it with the "
            'speed source "wheels"'
        )
    numbers = replace(law.source.numbers, release_share=_NEVER, lost_share=0.0)
    return replace(law, source=replace(law.source, numbers=numbers))


def looks(vehicle: Vehicle, law: Protection, scenario: Scenario) -> Looks:
    """Stop with and without releases.

    Parameters
    ----------
    vehicle : Vehicle
        The true one, which may differ from that of the law.
    law : Protection
        A protection that has its train speed from the wheels.
    scenario : Scenario
        The stop.
    """
    seen, unseen = (simulate(vehicle, each, scenario) for each in (law, without_looks(law)))
    return Looks(looking=seen, blind=unseen)
