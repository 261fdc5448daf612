"""The witness of a certificate file as a state that a stop can start from.

Nothing in a file is believed: whatever is not a finite number within what a railway vehicle can have is refused.
"""

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.kernel.file import read_certificate
from wspd_design.certificates.quantities import TABLE
from wspd_design.certificates.records import Problem, Status
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import KMH
from wspd_design.simulation.records import Start
from wspd_design.simulation.start import full_supply_time, holding_torque


class _Allowed(NamedTuple):
    """Unit and range of a coordinate."""

    unit: str
    low: float
    high: float


_STATE = {
    "slip": _Allowed("-", 0.0, math.nextafter(1.0, 0.0)),  # locked wheels are not a state to start from
    "speed": _Allowed("km/h", 0.36, 500.0),  # below it the slip is not referred to the speed
    "torque": _Allowed("N m", 0.0, 1e6),
}
_TIGHT = {
    "mass": _Allowed("kg", 1e3, 1e6),
    "wheelset inertia": _Allowed("kg m2", 10.0, 1e4),
    "mu0": _Allowed("-", 1e-3, 1.0),
}
_NUMBERS = {row.name: _Allowed(row.unit, 0.0, 1e15) for row in TABLE if row.record not in ("state", "axle")}
_COORDINATES = {**_NUMBERS, **_TIGHT, **_STATE}
_ANEW = "write it anew with wspd certify"


@dataclass(frozen=True, slots=True, kw_only=True)
class Witness:
    """A point where a claim fails; None for what it does not name."""

    source: str  # file
    check: str  # name
    status: Status
    model_hash: str  # of the problem that the certificate is about
    slip: float  # -
    speed: float  # m/s
    torque: float | None  # N m per wheelset
    numbers: Mapping[str, float]  # of vehicle and rail, by their names in the table [SI units]


def read_witness(text: str, source: str) -> Witness:
    """Read the witness of a certificate.

    Parameters
    ----------
    text : str
        The file; it may be anything.
    source : str
        Its name, for the sentences to the user.

    Raises
    ------
    UserError
        If the text is no certificate, or its witness is no state that a stop can start from.
    """
    try:
        _, content = read_certificate(text)
    except Refused as refusal:
        raise UserError(
            f"{source} has no witness to start from: {refusal}; name a file that this version of wspd certify wrote"
        ) from None
    check, status, points = content["check"], content["status"], content.get("witness")
    if not isinstance(points, list) or not points:
        refuted = status == Status.REFUTED.name
        reason = "but it states no point" if refuted else "and only REFUTED ones carry one"
        raise UserError(
            f"{source} has no witness to start from: {check} is {status}, {reason}; choose another certificate"
        )
    values = _values(points, source)
    for name in ("slip", "speed"):
        if name not in values:
            raise UserError(
                f"{source} has a witness without {name}: {check} does not fail at a state of the wheels, so that "
                "no stop can start there; choose the certificate of another check"
            )
    fingerprint = content.get("model_sha256")
    return Witness(
        source=source,
        check=check,
        status=Status[status],
        model_hash=fingerprint if isinstance(fingerprint, str) else "",
        slip=values["slip"],
        speed=values["speed"] / KMH,
        torque=values.get("torque"),
        numbers={name: value for name, value in values.items() if name not in _STATE},
    )


def plant_at(problem: Problem, witness: Witness) -> tuple[Vehicle, Rail]:
    """Return the vehicle and the rail with the numbers of the witness.

    Parameters
    ----------
    problem : Problem
        The closed loop; its numbers hold for what the witness does not name.
    witness : Witness
        The point.
    """
    nominal = problem.vehicle
    mass = witness.numbers.get("mass", nominal.mass)
    # The bodies take up what the mass gains or loses.
    body_mass = nominal.body_mass + (mass - nominal.mass) / nominal.bodies
    if body_mass <= 0.0:
        raise UserError(
            f"{witness.source} has a witness with a mass of {mass:g} kg, which leaves none for the body of "
            f"{nominal.name}; name the vehicle that the certificate is about with --vehicle"
        )
    vehicle, rail = plant_with(problem, witness.numbers)
    return replace(vehicle, body_mass=body_mass), rail


def start_at(witness: Witness, vehicle: Vehicle, rail: Rail, *, grade: float = 0.0) -> tuple[Start, float]:
    """Return the state of the wheels at the witness, and the torque that holds its slip.

    Parameters
    ----------
    witness : Witness
        The point.
    vehicle, rail : Vehicle, Rail
        As :func:`plant_at` returns them.
    grade : float
        Rise over run, positive uphill [-].

    Returns
    -------
    start : Start
        With full supply and, unless the witness names a torque, the holding torque as far as the brake has it.
    holding : float
        Torque per wheelset that holds the slip, whether the brake has it or not [N m].
    """
    time, most = full_supply_time(vehicle.brake), vehicle.brake.max_torque
    holding = holding_torque(
        vehicle, rail, slip=witness.slip, speed=witness.speed, braking_time=time, grade=grade
    )
    if witness.torque is not None and witness.torque > most:
        raise UserError(
            f"{witness.source} has a witness with a torque of {witness.torque:g} N m, more than the {most:g} N m "
            f"of {vehicle.name}; name the vehicle that the certificate is about with --vehicle"
        )
    torque = min(max(holding, 0.0), most) if witness.torque is None else witness.torque
    return Start(slip=witness.slip, torque=torque, braking_time=time), holding


def _values(points: list[Any], source: str) -> dict[str, float]:
    """Return the coordinates that belong to a state; others are left aside."""
    values: dict[str, float] = {}
    for point in points:
        name = point.get("name") if isinstance(point, dict) else None
        allowed = _COORDINATES.get(name) if isinstance(name, str) else None
        if name is None or allowed is None:
            continue
        if name in values:
            raise UserError(f"{source} has a witness that names {name} twice; {_ANEW}")
        if point.get("unit") != allowed.unit:
            raise UserError(
                f'{source} has a witness whose {name} is not in its unit, "{allowed.unit}"; {_ANEW}'
            )
        values[name] = _number(name, point.get("value"), allowed, source)
    return values


def _number(name: str, value: Any, allowed: _Allowed, source: str) -> float:
    number = math.nan
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        with suppress(OverflowError):
            number = float(value)
    if not math.isfinite(number):
        raise UserError(f"{source} has a witness whose {name} is not a finite number; {_ANEW}")
    if not allowed.low <= number <= allowed.high:
        unit = f" {allowed.unit}".removesuffix(" -")
        raise UserError(
            f"{source} has a witness with {name} {number:g}{unit}, which must lie between {allowed.low:g} and "
            f"{allowed.high:g}{unit} for a stop to start there; {_ANEW}"
        )
    return number
