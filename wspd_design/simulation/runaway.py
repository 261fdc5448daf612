"""Trains that no brake can stop: where the grade pulls harder than rail and resistance can hold.

Where that is so at any speed up to the initial one, the train never gets below this speed, whatever the wheels do.
"""

from wspd_design.model import slip as slip_model
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Vehicle
from wspd_design.simulation.peak import peak_adhesion
from wspd_design.simulation.records import Scenario

_SPEEDS = 50  # at which it is looked for
_LIGHTEST = 0.5  # of the static load: a lighter wheel has more adhesion for its load


def runs_away(vehicle: Vehicle, scenario: Scenario) -> bool:
    """Tell whether the train cannot stop, by the balance of forces alone; False where that does not decide it.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    scenario : Scenario
        Rails, initial speed and grade.
    """
    if scenario.grade >= 0.0:
        return False
    import numpy as np

    weight = vehicle.mass * constants().gravity
    irregularity = scenario.load_irregularity
    heaviest = max(map(max, irregularity.factors)) if irregularity else 1.0
    rails = {*(scenario.axle_rails or (scenario.rail,)), *(patch.rail for patch in scenario.patches)}
    speeds = np.linspace(scenario.initial_speed, constants().stop_speed, _SPEEDS)
    best = np.max([peak_adhesion(vehicle, rail, speeds, load_share=_LIGHTEST)[1] for rail in rails], axis=0)
    held = best * weight * heaviest + slip_model.resistance(vehicle, speeds, weight * scenario.grade)
    return bool((held < 0.0).any())
