"""Whether a law lets the brake go before the train stands."""

import math
from collections.abc import Iterable

from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.records import Vehicle
from wspd_design.simulation.peak import peak_adhesion
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending, Run

SHARE = 0.1  # of what brake and rail give, below which a brake is as good as released
SHORTEST = 1.0  # s, to the end of the run
_KMH = 3.6


def released_below(run: Run, vehicle: Vehicle, scenario: Scenario) -> float:
    """Return the speed below which the brake was as good as released until the end [m/s]; NaN where it was not.

    From there on, for at least a second, the wheelsets together transmit less than a tenth of the torque that the
    brake gives or, if that is less, the poorest of the rails under the static load. A train that nothing can stop is
    not judged.
    """
    import numpy as np

    if run.ending is Ending.RUNAWAY or len(run.time) == 1:
        return math.nan
    rails = (*(scenario.axle_rails or (scenario.rail,)), *(patch.rail for patch in scenario.patches))
    peaks = np.min([peak_adhesion(vehicle, rail, run.speed)[1] for rail in rails], axis=0)
    on_rail = 2.0 * vehicle.wheel_radius * float(static_wheel_load(vehicle)) * peaks
    torques = [share * vehicle.brake.max_torque for share in vehicle.brake_shares]
    given = np.mean([np.minimum(torque, on_rail) for torque in torques], axis=0)
    held = np.flatnonzero(run.torque.mean(axis=1) >= SHARE * given)
    first = int(held[-1]) + 1 if held.size else 0
    if first >= len(run.time) or run.time[-1] - run.time[first] < SHORTEST:
        return math.nan
    return float(run.speed[first])


def released_sentence(found: Iterable[tuple[str, float]]) -> str:
    """Say which laws released the brake below which speed [m/s]; nothing for NaN."""
    told = [f"{name} below v = {speed * _KMH:.2g} km/h" for name, speed in found if not math.isnan(speed)]
    if not told:
        return ""
    return (
        f"The brake was released by {', '.join(told)}, and stayed so to the end: the wheelsets transmit less than a "
        "tenth of what brake and rail give. Hold the brake on at low speeds, where the slip of a wheel says nothing."
    )
