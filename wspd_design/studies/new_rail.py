"""A rail from the adhesion at its peak, or from a measured creep curve by least squares."""

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from wspd_design.model.adhesion import contact_stiffness, creep_force
from wspd_design.parameters.bounds import EXACT
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import load_rail
from wspd_design.parameters.provenance import Entry
from wspd_design.parameters.records import Contact, Rail, Vehicle
from wspd_design.simulation.peak import peak_adhesion

NUMBERS = ("mu0", "friction_ratio", "friction_decay", "adhesion_reduction", "slip_reduction")
"""The numbers of a rail, eqs. (5)-(7)."""

FEWEST = 6
"""Points of a curve: one more than numbers."""

_LOW = (1e-3, 0.0, 0.0, 1e-2, 1e-2)
_HIGH = (1.0, 1.0, 5.0, 1.0, 1.0)
_SPREAD = 0.2  # bounds about each number, an engineering estimate as for the shipped rails
_DIGITS = 4


@dataclass(frozen=True, slots=True)
class Fit:
    """The rail that comes nearest to a curve."""

    rail: Rail
    rms: float  # of the adhesion [-]
    largest: float  # deviation [-]
    points: int


def read_curve(path: Path) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Read slips and adhesions, the first two columns of a CSV file with or without a line of titles.

    Raises
    ------
    UserError
        If the file cannot be read, or a line of it is not a slip in (0, 1) and an adhesion in (0, 1].
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"curve {path} cannot be read as text ({error}); check the path") from None
    separator = ";" if ";" in text else ","
    rows = [row for row in csv.reader(text.splitlines(), delimiter=separator) if any(map(str.strip, row))]
    points: list[tuple[float, float]] = []
    for number, row in enumerate(rows, start=1):
        try:
            slip, adhesion = (float(cell.strip().replace(",", ".")) for cell in row[:2])
        except ValueError:
            if number == 1:
                continue  # titles
            raise UserError(
                f'line {number} of curve {path} is "{separator.join(row)}" but must be a slip and an adhesion, such as '
                "0.02,0.31"
            ) from None
        if not (0.0 < slip < 1.0 and 0.0 < adhesion <= 1.0):
            raise UserError(
                f"line {number} of curve {path} has slip {slip:g} and adhesion {adhesion:g}; slip must lie in (0, 1), "
                "adhesion in (0, 1]: divide percent by 100, and leave the origin out"
            )
        points.append((slip, adhesion))
    if len(points) < FEWEST:
        raise UserError(
            f"curve {path} has {len(points)} points; a fit of five numbers needs {FEWEST} or more"
        )
    points.sort()
    return tuple(slip for slip, _ in points), tuple(adhesion for _, adhesion in points)


def fit_rail(
    name: str,
    slips: Sequence[float],
    adhesions: Sequence[float],
    *,
    speed: float,
    wheel_load: float,
    contact: Contact,
) -> Fit:
    """Fit the five numbers of a rail to a creep curve; the search starts from each shipped rail and keeps the best.

    Parameters
    ----------
    name : str
        Name of the rail to be.
    slips, adhesions : sequence of float
        Points of the curve, force over wheel load.
    speed : float
        Of the vehicle in the measurement [m/s].
    wheel_load : float
        Of the measurement [N].
    contact : Contact
        Ellipse and elasticity of its wheel.
    """
    import numpy as np
    from scipy.optimize import least_squares

    slip, measured = np.array(slips), np.array(adhesions)
    stiffness = contact_stiffness(contact, wheel_load)

    def rail_of(numbers: Sequence[float]) -> Rail:
        return Rail(name=name, **dict(zip(NUMBERS, map(float, numbers), strict=True)), bounds=EXACT)

    def misfit(numbers: Sequence[float]) -> "np.typing.NDArray[np.float64]":
        force = creep_force(slip, slip * speed, wheel_load, rail_of(numbers), stiffness)
        return np.asarray(force / wheel_load - measured)

    found = []
    for known in uniform_rails():
        like = load_rail(known)
        start = [float(measured.max()), *(getattr(like, number) for number in NUMBERS[1:])]
        inside = np.clip(start, np.array(_LOW) + 1e-6, np.array(_HIGH) - 1e-6)
        found.append(
            least_squares(misfit, inside, bounds=(_LOW, _HIGH), x_scale=inside, xtol=1e-10, ftol=1e-12)
        )
    best = min(found, key=lambda each: float(each.cost))
    rail = rail_of([float(f"{number:.{_DIGITS}g}") for number in best.x])
    left = misfit([getattr(rail, number) for number in NUMBERS])
    return Fit(
        rail=rail,
        rms=math.sqrt(float(np.mean(left**2))),
        largest=float(np.abs(left).max()),
        points=len(slips),
    )


def rail_with_peak(rail: Rail, peak: float, *, vehicle: Vehicle, speed: float) -> Rail:
    """Return the rail with the friction coefficient that gives an adhesion at the peak of its creep curve.

    Parameters
    ----------
    rail : Rail
        Gives the other four numbers.
    peak : float
        Adhesion at the peak [-].
    vehicle : Vehicle
        Under the static load of its wheels.
    speed : float
        Train speed [m/s].

    Raises
    ------
    UserError
        If no friction coefficient up to 1 gives it.
    """
    import numpy as np

    def peak_of(mu0: float) -> float:
        return float(peak_adhesion(vehicle, replace(rail, mu0=mu0), np.array([speed]))[1][0])

    low, high = 1e-4, 1.0
    if not peak_of(low) < peak < peak_of(high):
        raise UserError(
            f"peak = {peak:g} must lie between {peak_of(low):.2g} and {peak_of(high):.2g}, which a friction "
            f"coefficient up to 1 gives with these numbers at {3.6 * speed:g} km/h"
        )
    for _ in range(40):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if peak_of(middle) < peak else (low, middle)
    return replace(rail, mu0=float(f"{math.sqrt(low * high):.{_DIGITS}g}"))


def rail_entries(rail: Rail, history: dict[str, tuple[str, str, str]]) -> tuple[Entry, ...]:
    """Return the numbers of a rail with their histories and bounds of 20 %.

    Parameters
    ----------
    rail : Rail
        The numbers.
    history : dict
        Source, place and status of each.
    """
    entries = []
    for name in NUMBERS:
        value = getattr(rail, name)
        most = math.inf if name == "friction_decay" else 1.0
        ends = (
            float(f"{(1.0 - _SPREAD) * value:.3g}"),
            min(float(f"{(1.0 + _SPREAD) * value:.3g}"), most),
        )
        source, at, status = history[name]
        entries.append(
            Entry(
                name=name,
                value=value,
                unit="s/m" if name == "friction_decay" else "-",
                bounds=ends,
                source=source,
                at=at,
                status=status,
                note="",
            )
        )
    return tuple(entries)
