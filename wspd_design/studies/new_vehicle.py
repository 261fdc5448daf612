"""A vehicle from some ten answers: what is asked, and by which rule everything else follows.

What neither an answer nor a rule gives is taken from a shipped vehicle of the same kind, and says so.
"""

import math
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import get_args

from wspd_design.analysis.stopping import full_adhesion_stop
from wspd_design.model.hertz import contact_from_radii
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import constants, load_entries, load_vehicle, steel, vehicle_of
from wspd_design.parameters.provenance import Entry, ParameterSet
from wspd_design.parameters.records import Vehicle
from wspd_design.parameters.schema import BuildUp
from wspd_design.parameters.units import KMH
from wspd_design.studies.new_vehicle_numbers import ANSWER, ruled, stated, taken

PIPE, ELECTRIC = get_args(BuildUp)
FULL = 0.95
"""Share of the full pressure at which a brake counts as built up."""

RATED_SPEEDS = {
    "coach": 160.0 / KMH,
    "metro": 80.0 / KMH,
    "freight-wagon": 100.0 / KMH,
    "two-axle-wagon": 100.0 / KMH,
    "co-co": 140.0 / KMH,
}
"""From which the deceleration of a shipped vehicle is stated [m/s]; of the others it is 120 km/h."""

_ANSWERS = ("laden.", "brake.build_up", "brake.supply_rate")
"""Beginnings of the numbers that are there only if the answers ask for them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wanted:
    """What a vehicle is to be, as a brake engineer knows it [SI units]."""

    kind: str  # shipped vehicle that gives what is not asked
    mass: float  # kg, empty
    laden_mass: float  # kg; 0 where the load does not count
    weighs: bool  # whether the brake takes the load into account
    wheelsets: int
    bogie_spacing: float  # m, of the bogie centres or of single axles
    wheelbase: float  # m, of a bogie, first to last axle; 0 for single axles
    wheel_diameter: float  # m
    rotating_mass: float  # kg, of the whole vehicle
    speed: float  # m/s, from which the deceleration holds
    deceleration: float  # m/s2, mean of the fully developed brake
    build_up: str  # main-pipe or electro-pneumatic
    build_up_delay: float  # s, of an electro-pneumatic brake
    build_up_time: float  # s, until 95 % of the pressure, or of the ramp of an electro-pneumatic brake
    fill_time: float  # s
    vent_time: float  # s
    answered: frozenset[str] = frozenset()  # what the user said; the rest is as of the kind


@cache
def wanted_like(kind: str) -> Wanted:
    """Return the answers that a shipped vehicle stands for."""
    vehicle, entries = load_vehicle(kind), load_entries("vehicle", kind).entries
    laden = load_vehicle(f"{kind}:laden") if "laden.mass" in entries else None
    speed = RATED_SPEEDS.get(kind, 120.0 / KMH)
    return Wanted(
        kind=kind,
        mass=vehicle.mass,
        laden_mass=0.0 if laden is None else laden.mass,
        weighs=laden is not None and laden.brake.max_torque > vehicle.brake.max_torque,
        wheelsets=vehicle.wheelsets,
        bogie_spacing=vehicle.bogie_spacing,
        wheelbase=vehicle.wheelbase,
        wheel_diameter=2.0 * vehicle.wheel_radius,
        rotating_mass=vehicle.wheelsets * vehicle.wheelset_inertia / vehicle.wheel_radius**2,
        speed=speed,
        deceleration=full_adhesion_stop(vehicle, speed).deceleration,
        build_up=vehicle.brake.build_up,
        build_up_delay=vehicle.brake.build_up_delay,
        build_up_time=vehicle.brake.build_up_ramp
        if vehicle.brake.build_up == ELECTRIC
        else -math.log(1.0 - FULL) / vehicle.brake.supply_rate,
        fill_time=vehicle.brake.fill_time,
        vent_time=vehicle.brake.vent_time,
    )


def derived_vehicle(name: str, wanted: Wanted) -> Vehicle:
    """Return the vehicle of some answers.

    Raises
    ------
    UserError
        If the answers contradict each other.
    """
    kept = {entry.name: entry for entry in derived_entries(wanted)}
    return vehicle_of(ParameterSet(kind="vehicle", name=name, title=name, entries=kept))


def derived_entries(wanted: Wanted) -> tuple[Entry, ...]:
    """Return all numbers of a vehicle, each with its rule, in the order of the shipped one.

    Raises
    ------
    UserError
        If the answers contradict each other.
    """
    base = load_entries("vehicle", wanted.kind)
    found = {
        **_answered(wanted, base),
        **_running_gear(wanted, base),
        **_resistance(wanted, base),
        **_contact(wanted),
    }
    found |= _torques(wanted, base, found)
    return tuple(
        found[name] if name in found else taken(entry, wanted.kind)
        for name, entry in base.entries.items()
        if name in found or not name.startswith(_ANSWERS)
    ) + tuple(entry for name, entry in found.items() if name not in base.entries)


def _answered(wanted: Wanted, base: ParameterSet) -> dict[str, Entry]:
    radius = wanted.wheel_diameter / 2.0
    said = partial(_said, wanted)
    answers = [
        said("mass", "mass", wanted.mass, "kg"),
        said("wheelsets", "wheelsets", float(wanted.wheelsets), "-"),
        said("wheel_radius", "wheel_diameter", radius, "mm"),
        said("bogie_spacing", "bogie_spacing", wanted.bogie_spacing, "m"),
        said("brake.fill_time", "fill_time", wanted.fill_time, "s"),
        said("brake.vent_time", "vent_time", wanted.vent_time, "s"),
        ruled(
            "wheelset_inertia",
            wanted.rotating_mass / wanted.wheelsets * radius**2,
            "kg m^2",
            f"rotating mass {wanted.rotating_mass:.4g} kg over {wanted.wheelsets} wheelsets, times radius^2",
        ),
        *_build_up(wanted),
    ]
    if "wheelbase" in base.entries:
        answers.append(said("wheelbase", "wheelbase", wanted.wheelbase, "m"))
    if wanted.laden_mass:
        answers.append(said("laden.mass", "laden_mass", wanted.laden_mass, "kg"))
    return {entry.name: entry for entry in answers}


def _build_up(wanted: Wanted) -> list[Entry]:
    if wanted.build_up == ELECTRIC:
        return [
            replace(_said(wanted, "brake.build_up", "build_up", 0.0, "-"), value=ELECTRIC),
            _said(wanted, "brake.build_up_delay", "build_up_delay", wanted.build_up_delay, "s"),
            _said(wanted, "brake.build_up_ramp", "build_up_time", wanted.build_up_time, "s"),
        ]
    rule = f"ln(20) over {wanted.build_up_time:g} s, in which the supply reaches 95 %"
    return [ruled("brake.supply_rate", -math.log(1.0 - FULL) / wanted.build_up_time, "1/s", rule)]


def _running_gear(wanted: Wanted, base: ParameterSet) -> dict[str, Entry]:
    """Masses and heights in proportion to those of the kind."""
    like = load_vehicle(wanted.kind)
    axles = like.axles_per_bogie
    if wanted.wheelsets % axles:
        raise UserError(
            f"axles = {wanted.wheelsets} must be a multiple of {axles}, the axles of a bogie of a {wanted.kind}; "
            "choose another kind or number"
        )
    if like.bodies > 1:
        raise UserError(f"the kind {wanted.kind} has several bodies; choose one with a single body")
    supports = wanted.wheelsets // axles
    share = like.bogie_mass * (like.wheelsets // axles) / like.mass
    bogie = float(round(wanted.mass * share / supports))
    scale = wanted.wheel_diameter / (2.0 * like.wheel_radius)
    what = "single axles" if axles == 1 else "bogies"
    found = [
        ruled(
            "bogie_mass",
            bogie,
            "kg",
            f"{what} are {100.0 * share:.1f} % of the empty mass, as of {wanted.kind}",
        ),
        ruled(
            "body_mass", wanted.mass - supports * bogie, "kg", f"empty mass less {supports} times bogie_mass"
        ),
    ]
    for name in ("bogie_height", "traction_rod_height"):
        rule = f"{base.number(name):.3g} m of {wanted.kind}, in proportion to the wheel radius"
        found.append(ruled(name, base.number(name) * scale, "m", rule))
    return {entry.name: entry for entry in found}


def _resistance(wanted: Wanted, base: ParameterSet) -> dict[str, Entry]:
    """FCalc's modern Davis equation; the drag area is that of the kind."""
    tonnes, drag = wanted.mass / 1e3, base.number("resistance_quadratic")
    found = [
        ruled(
            "resistance_constant",
            6.3743 * tonnes + 128.998 * wanted.wheelsets,
            "N",
            f"FCalc: 6.3743 N/t times {tonnes:.4g} t and 128.998 N for each of {wanted.wheelsets} axles",
        ),
        ruled(
            "resistance_linear",
            0.32905 * tonnes,
            "N s/m",
            f"FCalc: 0.32905 N s/m per tonne times {tonnes:.4g} t",
        ),
        ruled(
            "resistance_quadratic",
            drag,
            "N s^2/m^2",
            f"FCalc: 0.57501 times a drag area of {drag / 0.57501:.2g} m2, as of {wanted.kind}",
        ),
    ]
    return {entry.name: entry for entry in found}


def _contact(wanted: Wanted) -> dict[str, Entry]:
    """Hertz's ellipse and Kalker's coefficient at the empty wheel load."""
    load = wanted.mass * constants().gravity / (2 * wanted.wheelsets)
    radius = wanted.wheel_diameter / 2.0
    contact = contact_from_radii(
        wheel_load=load,
        wheel_radius=radius,
        rail_radius=steel().rail_crown,
        young=steel().young,
        poisson=steel().poisson,
    )
    hertz = f"Hertz: wheel of {radius:.4g} m on a crown of {1e3 * steel().rail_crown:g} mm, {load / 1e3:.4g} kN, steel"
    found = [
        ruled("contact.shear_modulus", contact.shear_modulus, "GPa", "E / (2 (1 + nu)), 210 GPa and 0.25"),
        ruled("contact.semi_axis_rolling", contact.semi_axis_rolling, "mm", hertz),
        ruled("contact.semi_axis_lateral", contact.semi_axis_lateral, "mm", hertz),
        ruled(
            "contact.kalker_c11",
            contact.kalker_c11,
            "-",
            "Kalker's table at this ratio of the axes, nu = 0.25",
        ),
        ruled("contact.reference_load", load, "N", "empty mass times gravity over all wheels"),
    ]
    return {entry.name: entry for entry in found}


def _torques(wanted: Wanted, base: ParameterSet, found: dict[str, Entry]) -> dict[str, Entry]:
    """Torque that gives the deceleration, empty and laden, by mean values after EN 14531-1."""
    braked = _braked_axles(wanted, base)
    torques = {"brake.max_torque": _torque(wanted, wanted.mass, braked, found, "brake.max_torque")}
    if wanted.laden_mass:
        torques["laden.body_height"] = _laden_height(wanted, base)
        if wanted.weighs:
            torques["laden.max_torque"] = _torque(
                wanted, wanted.laden_mass, braked, found, "laden.max_torque"
            )
    return torques


def _braked_axles(wanted: Wanted, base: ParameterSet) -> float:
    shares = base.entries.get("brake.axle_shares")
    if shares is None:
        return float(wanted.wheelsets)
    assert isinstance(shares.value, tuple)
    if len(shares.value) != wanted.wheelsets:
        raise UserError(
            f"axles = {wanted.wheelsets} does not suit {wanted.kind}, whose brake.axle_shares is for "
            f"{len(shares.value)}; choose as many or another kind"
        )
    return math.fsum(share for share in shares.value if isinstance(share, float))


def _torque(wanted: Wanted, mass: float, braked: float, found: dict[str, Entry], name: str) -> Entry:
    value = {key: entry.value for key, entry in found.items()}
    a0, a1, a2 = (value[f"resistance_{part}"] for part in ("constant", "linear", "quadratic"))
    assert isinstance(a0, float)
    assert isinstance(a1, float)
    assert isinstance(a2, float)
    running = a0 + a1 * wanted.speed * 2.0 / 3.0 + a2 * wanted.speed**2 / 2.0
    force = wanted.deceleration * (mass + wanted.rotating_mass) - running
    if force <= 0.0:
        raise UserError(
            f"deceleration = {wanted.deceleration:g} m/s2 needs no brake, since the running resistance alone gives "
            f"{running / (mass + wanted.rotating_mass):.3g} m/s2 from {wanted.speed * KMH:g} km/h; ask for more"
        )
    rule = (
        f"EN 14531 backwards: {wanted.deceleration:.4g} m/s2 from {wanted.speed * KMH:.4g} km/h times "
        f"{(mass + wanted.rotating_mass) / 1e3:.4g} t with rotating mass, less {running / 1e3:.3g} kN of resistance, "
        f"times the wheel radius over {braked:g} braked axles"
    )
    return ruled(name, force * wanted.wheel_diameter / 2.0 / braked, "kN m", rule)


def _laden_height(wanted: Wanted, base: ParameterSet) -> Entry:
    empty = base.number("body_height")
    known = "laden.body_height" in base.entries
    height = base.number("laden.body_height") if known else empty
    return ruled("laden.body_height", height, "m", f"as of {wanted.kind}{', laden' * known}")


def _said(wanted: Wanted, name: str, question: str, value: float, unit: str) -> Entry:
    """Return a number as the user said it, or as the kind has it."""
    if question in wanted.answered:
        at = "half of the diameter that was asked for" if question == "wheel_diameter" else "as asked"
        return stated(name, value, unit, ANSWER, at, "assumed")
    return stated(name, value, unit, f"vehicle {wanted.kind}", f"as of {wanted.kind}", "assumed")
