"""Modes of a named vehicle at one speed and the speeds from which it hunts, with what has to be said about them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from wspd_design.analysis.critical_speed import CriticalSpeed, critical_speeds
from wspd_design.analysis.modes import Mode, modes
from wspd_design.analysis.running import (
    RunningVehicle,
    SteadyRunning,
    contact_of,
    full_slope,
    running_vehicle,
    steady,
)
from wspd_design.model.wheel_rail import WheelRail, wheel_rail
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available, read_toml
from wspd_design.parameters.loading import load_rail, load_vehicle, steel
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.plants.locomotive import Locomotive
from wspd_design.plants.multibody.loading import available_multibodies, load_multibody
from wspd_design.plants.multibody.records import Multibody

CLEAN_RAIL = "polach-dry"
"""Its friction bounds the creep forces of a vehicle that rolls; their slope is then that of Kalker's theory."""

SPEEDS = (5.0, 120.0)
"""Lowest and highest speed that are tried for hunting [m/s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleModes:
    """Modes of a vehicle in steady running, and its critical speeds."""

    vehicle: str
    title: str
    rail: str
    slip: float  # -, that brakes hold; 0: the wheels roll
    conicity: float  # -, of the modes
    lateral_slope: float  # -, of small lateral creep, over that of Kalker's theory
    equations: RunningVehicle  # on this conicity
    running: SteadyRunning
    modes: tuple[Mode, ...]
    critical: tuple[CriticalSpeed, ...]  # none of a braked vehicle
    assumed: tuple[str, ...]  # names of the numbers that nobody published
    numbers: int  # of all numbers
    remarks: tuple[str, ...]  # sentences about what is doubtful

    @property
    def growing(self) -> tuple[Mode, ...]:
        """Modes that grow, fastest first."""
        return tuple(sorted((m for m in self.modes if m.unstable), key=lambda mode: -mode.pole.real))


def vehicle_modes(
    name_or_path: str | Path,
    *,
    speed: float,
    slip: float = 0.0,
    rail: str | None = None,
    conicities: Sequence[float] = (),
    lateral_slope: float = 1.0,
) -> VehicleModes:
    """Find modes and critical speeds of a vehicle.

    Parameters
    ----------
    name_or_path : str or Path
        A vehicle with a multibody file, or a multibody vehicle alone, which then runs on steel of its mean wheel load;
        or the path of a file of either kind.
    speed : float
        Of the modes [m/s].
    slip : float
        That brakes hold at all wheelsets; 0: they roll [-].
    rail : str, optional
        Whose factors reduce the slope of longitudinal creep forces; by default that of Kalker's theory where the
        wheels roll, and ``polach-dry`` where they are braked.
    conicities : sequence of float
        The modes are those on the first; for each the critical speed is found. By default that of the vehicle.
    lateral_slope : float
        Slope of the lateral force at small creep over that of Kalker's theory [-].

    Raises
    ------
    UserError
        If there is no such vehicle or rail, or a number is out of range.
    """
    for conicity in conicities:
        if not 0.0 < conicity < 1.0:
            raise UserError(f"conicity = {conicity:g} must lie in (0, 1); 1:40 is 0.025")
    model, contact = multibody_of(name_or_path, lateral_slope=lateral_slope)
    friction = load_rail(rail or CLEAN_RAIL)
    if rail is None and not slip:
        friction = full_slope(friction)
    vehicle = running_vehicle(model, contact, friction)
    tried = tuple(conicities) or (float(model.numbers["conicity"]),)
    first = vehicle if tried[0] == model.numbers["conicity"] else vehicle.with_conicity(tried[0])
    running = steady(first, speed, slip=slip)
    return VehicleModes(
        vehicle=str(name_or_path),
        title=model.title,
        rail=friction.name,
        slip=slip,
        conicity=tried[0],
        lateral_slope=lateral_slope,
        equations=first,
        running=running,
        modes=modes(running.motion),
        critical=() if slip else critical_speeds(vehicle, tried, speeds=SPEEDS),
        assumed=tuple(name for name, entry in model.entries.items() if entry.status == "assumed"),
        numbers=len(model.entries),
        remarks=_remarks(friction, lateral_slope),
    )


def multibody_of(name_or_path: str | Path, *, lateral_slope: float = 1.0) -> tuple[Multibody, WheelRail]:
    """Return the multibody vehicle behind a name, and the contact of its wheels.

    A vehicle has its own contact, mass, wheels and inertia; a multibody vehicle alone has the numbers of its file.
    """
    text = str(name_or_path)
    own = text.endswith(".toml")
    if (own and "bodies" in read_toml(Path(text), text)) or text in available_multibodies():
        model = load_multibody(name_or_path)
        return model, contact_of(model, lateral_slope=lateral_slope)
    if not own and text not in available("vehicle"):
        names = [*available_multibodies(), *_with_multibody()]
        raise UserError(
            f'unknown vehicle "{text}"; available: {", ".join(names)}, or the path of a .toml file'
        )
    return with_totals_of(load_vehicle(name_or_path), lateral_slope=lateral_slope)


def with_totals_of(vehicle: Vehicle, *, lateral_slope: float = 1.0) -> tuple[Multibody, WheelRail]:
    """Return the multibody vehicle of a vehicle, with its mass, wheels and inertia, and its contact."""
    plant = Locomotive(vehicle)
    numbers = dict(zip(plant.number_names, plant.numbers, strict=True))
    model = plant.model.with_numbers({name: numbers[name] for name in plant.model.number_names})
    return model, wheel_rail(vehicle.contact, poisson=steel().poisson, lateral_slope=lateral_slope)


def _with_multibody() -> list[str]:
    return [name for name in available("vehicle") if load_vehicle(name).multibody]


def _remarks(rail: Rail, lateral_slope: float) -> tuple[str, ...]:
    found = []
    if lateral_slope < 1.0:
        found.append(
            f"Lateral creep has {100.0 * lateral_slope:g} % of the slope of Kalker's theory. Factors that are fitted "
            "to traction need not hold for the small lateral creep of running; they lower the critical speed."
        )
    reduction = 0.5 * (rail.adhesion_reduction + rail.slip_reduction)
    if reduction < 1.0:
        found.append(
            f"Longitudinal creep has {100.0 * reduction:g} % of the slope of Kalker's theory, by factors of the rail "
            "that are fitted to traction; lateral creep has a factor of its own."
        )
    return tuple(found)
