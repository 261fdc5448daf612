"""How much of the adhesion of a rail a brake asks for: whether its wheels slide at all."""

from wspd_design.analysis.stopping import demanded_adhesion
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import load_rail
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import KMH
from wspd_design.simulation.peak import peak_adhesion


def used_adhesion(vehicle: Vehicle, rail: Rail, speeds: tuple[float, float]) -> tuple[float, float]:
    """Return the largest share of the adhesion peak that the brake asks for, and the speed of it.

    Parameters
    ----------
    vehicle : Vehicle
        With the brake fully applied, every wheel under its static load.
    rail : Rail
        Where it brakes.
    speeds : (float, float)
        Range of train speeds [m/s].

    Returns
    -------
    (float, float)
        Share [-], above 1 where wheels slide, and speed [m/s].
    """
    import numpy as np

    over = np.geomspace(*speeds, 50)
    _, peaks = peak_adhesion(vehicle, rail, over)
    least = int(peaks.argmin())
    return demanded_adhesion(vehicle) / float(peaks[least]), float(over[least])


def adhesion_sentence(vehicle: Vehicle, rail: Rail, speeds: tuple[float, float]) -> str:
    """Say how much of the adhesion the brake asks for, and what that means for a protection."""
    share, speed = used_adhesion(vehicle, rail, speeds)
    asked = (
        f"The brake asks for an adhesion of {demanded_adhesion(vehicle):.3f}, {100.0 * share:.0f} % of what "
        f"{rail.name} gives at {speed * KMH:.3g} km/h under the static load"
    )
    if share < 1.0:
        return f"{asked}: no wheel slides there and the protection stays idle; {_where_it_slides(vehicle, speeds)}."
    return f"{asked}: wheels slide without a protection."


def _where_it_slides(vehicle: Vehicle, speeds: tuple[float, float]) -> str:
    """Name the shipped rails that give less than the brake asks for."""
    rails = [name for name in uniform_rails() if used_adhesion(vehicle, load_rail(name), speeds)[0] >= 1.0]
    return f"wheels slide on {', '.join(rails)}" if rails else "so it does on every shipped rail"
