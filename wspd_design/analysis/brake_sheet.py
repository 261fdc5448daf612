"""What a brake office asks first about a vehicle: its brake on full adhesion, by the mean values of EN 14531-1."""

from collections.abc import Sequence
from dataclasses import dataclass

from wspd_design.analysis.stopping import (
    PERCENTAGE_SPEEDS,
    MeanStop,
    braked_weight_percentage,
    demanded_adhesion,
    full_adhesion_stop,
    rim_force,
    rotating_mass,
)
from wspd_design.parameters.records import Vehicle
from wspd_design.parameters.units import KMH

SPEEDS = tuple(kmh / KMH for kmh in (60.0, 80.0, *PERCENTAGE_SPEEDS))
"""That are shown where none is asked for [m/s]."""

RULES = (
    "Stop by mean values, EN 14531-1: distance v0 t_e + v0²/(2 a_e), t_e the equivalent time of the build-up, a_e the "
    "mean deceleration of the developed brake, brake and running resistance over the mass with its rotating part. "
    "Braked weight percentage C/s - D of a single vehicle, EN 16834. No wheel slides here; what the protection of "
    "sliding wheels costs, a simulated stop tells."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class SheetStop:
    """A stop by mean values from one speed."""

    speed: float  # m/s
    mean: MeanStop
    percentage: float | None  # braked weight percentage; None off the level and from speeds without constants


@dataclass(frozen=True, slots=True, kw_only=True)
class BrakeSheet:
    """The brake of a vehicle while no wheel slides."""

    vehicle: str
    grade: float  # -, rise over run
    rim_force: float  # N, of the fully applied friction brake, all wheels, where pads fade with their stated friction
    by_steps: (
        bool  # whether pads fade, an electrodynamic brake blends in or magnets pull, so that forces change
    )
    rotating_mass: float  # kg, that turning parts add
    demanded_adhesion: float  # -, of the axle that asks for most
    stops: tuple[SheetStop, ...]


def brake_sheet(vehicle: Vehicle, speeds: Sequence[float] = SPEEDS, *, grade: float = 0.0) -> BrakeSheet:
    """Work out the brake of a vehicle on full adhesion.

    Parameters
    ----------
    vehicle : Vehicle
        Its nominal numbers.
    speeds : sequence of float
        Initial speeds [m/s].
    grade : float
        Rise over run, positive uphill [-].

    Raises
    ------
    UserError
        If the brake does not hold the vehicle on the grade.
    """
    return BrakeSheet(
        vehicle=vehicle.name,
        grade=grade,
        rim_force=rim_force(vehicle),
        by_steps=bool(vehicle.pads or vehicle.dynamic or vehicle.track_brake),
        rotating_mass=rotating_mass(vehicle),
        demanded_adhesion=demanded_adhesion(vehicle),
        stops=tuple(_stop(vehicle, speed, grade) for speed in speeds),
    )


def _stop(vehicle: Vehicle, speed: float, grade: float) -> SheetStop:
    mean = full_adhesion_stop(vehicle, speed, grade=grade)
    known = grade == 0.0 and any(abs(speed * KMH - kmh) < 1e-6 for kmh in PERCENTAGE_SPEEDS)
    return SheetStop(
        speed=speed, mean=mean, percentage=braked_weight_percentage(mean.distance, speed) if known else None
    )
