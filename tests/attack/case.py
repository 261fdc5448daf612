"""Read a design, a vehicle and a rail with tomllib alone, and what a certificate file states."""

import json
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from dataclasses import field as dataclass_field
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

from tests.attack.plant import Body, Plant

DATA = Path(__file__).resolve().parents[2] / "wspd_design" / "data"
UNITS = {
    "-": 1.0,
    "kg": 1.0,
    "t": 1e3,
    "m": 1.0,
    "mm": 1e-3,
    "kg m^2": 1.0,
    "N": 1.0,
    "kN": 1e3,
    "N s/m": 1.0,
    "N s^2/m^2": 1.0,
    "N m": 1.0,
    "kN m": 1e3,
    "N m s": 1.0,
    "s": 1.0,
    "ms": 1e-3,
    "1/s": 1.0,
    "s/m": 1.0,
    "GPa": 1e9,
}
VEHICLE = {
    "mass": "mass",
    "wheel_radius": "wheel_radius",
    "wheelset_inertia": "wheelset_inertia",
    "wheel_damping": "wheel_damping",
    "resistance_constant": "resistance_constant",
    "resistance_linear": "resistance_linear",
    "resistance_quadratic": "resistance_quadratic",
    "wheelsets": "wheelsets",
    "max_torque": "brake.max_torque",
    "supply_rate": "brake.supply_rate",
    "fill_time": "brake.fill_time",
    "vent_time": "brake.vent_time",
    "shear_modulus": "contact.shear_modulus",
    "semi_axis_rolling": "contact.semi_axis_rolling",
    "semi_axis_lateral": "contact.semi_axis_lateral",
    "kalker_c11": "contact.kalker_c11",
    "reference_load": "contact.reference_load",
}
RAIL = ("mu0", "friction_ratio", "friction_decay", "adhesion_reduction", "slip_reduction")
BODY = (
    "body_mass",
    "bogie_mass",
    "body_height",
    "bogie_height",
    "traction_rod_height",
    "bogie_spacing",
    "wheelbase",
)

Bounds = dict[str, tuple[float, float]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Data:
    """A vehicle on a rail: the nominal plant and the bounds of its numbers, in SI units."""

    plant: Plant
    body: Body
    bounds: Bounds


@dataclass(frozen=True, kw_only=True)
class Case:
    """A design with its model, and the plant that it is to be attacked on."""

    law: str
    gains: Mapping[str, Any]
    slip: float
    speeds: tuple[float, float]  # m/s
    slips: tuple[float, float]
    tolerance: float
    sample_time: float  # s
    model: Plant  # of the law
    data: Data  # of the plant

    @cached_property
    def varied(self) -> tuple[str, ...]:
        """Names of all numbers with bounds."""
        return tuple(self.data.bounds)


def read_data(vehicle: str | Path, rail: str | Path) -> Data:
    """Read a vehicle and a rail: shipped names or paths."""
    words = _tables(vehicle, "vehicles")
    track = _tables(rail, "rails")
    values, bounds = {}, {}
    for name, key in (*VEHICLE.items(), *((each, each) for each in RAIL)):
        table = _entry(track if name in RAIL else words, key)
        scale = UNITS[table["unit"]]
        values[name] = table["value"] * scale
        if "bounds" in table:
            low, high = table["bounds"]
            bounds[name] = (low * scale, high * scale)
    body = {each: _entry(words, each)["value"] * UNITS[_entry(words, each)["unit"]] for each in BODY}
    return Data(plant=Plant(**values), body=Body(**body), bounds=bounds)


def read_case(
    design: str | Path,
    *,
    vehicle: str | Path | None = None,
    rail: str | Path | None = None,
    free: Bounds | None = None,
) -> Case:
    """Read a design for a plant, by default the vehicle and the rail that it was made for.

    ``free`` gives other bounds to numbers of the plant, load share and deceleration of the train among them.
    """
    content = tomllib.loads(Path(design).read_text(encoding="utf-8"))
    stated = content["specification"]
    near = Path(design).resolve().parent

    def found(name: str) -> str | Path:
        return near / f"{name}.toml" if (near / f"{name}.toml").exists() else name

    own = read_data(found(content["vehicle"]), found(content["rail"]))
    plant = read_data(vehicle or found(content["vehicle"]), rail or found(content["rail"]))
    return Case(
        law=content["law"],
        gains={name: entry["value"] for name, entry in content["gains"].items()},
        slip=stated["slip"],
        speeds=tuple(stated["speeds"]),
        slips=tuple(stated["slips"]),
        tolerance=stated["slip_tolerance"],
        sample_time=stated["sample_time"],
        model=own.plant,
        data=replace(plant, bounds=plant.bounds | (free or {})),
    )


def bounds_of(case: Case, names: Iterable[str]) -> Bounds:
    """Return the bounds of the numbers that are varied; an unknown name or one without bounds is an error."""
    return {name: case.data.bounds[name] for name in names}


def _tables(name: str | Path, folder: str) -> Mapping[str, Any]:
    """Read a file; one with a base takes from it what it does not state."""
    path = Path(name) if str(name).endswith(".toml") else DATA / folder / f"{name}.toml"
    content = tomllib.loads(path.read_text(encoding="utf-8"))
    if "base" not in content:
        return content
    return _merged(_tables(content["base"], folder), content)


def _merged(base: Mapping[str, Any], over: Mapping[str, Any]) -> Mapping[str, Any]:
    merged = dict(base)
    for key, value in over.items():
        nested = isinstance(value, dict) and "value" not in value
        merged[key] = _merged(base.get(key, {}), value) if nested else value
    return merged


def _entry(content: Mapping[str, Any], key: str) -> Mapping[str, Any]:
    for part in key.split("."):
        content = content[part]
    return content


# --- what a certificate file states

NAMES = {"axle load share": "load_share"}  # of the plant, where they are not the words of the file
AXLE = ("load_share", "train_deceleration")


def field(name: str) -> str:
    """Return the name of a number of the plant from the words of a file."""
    return NAMES.get(name, name.replace(" ", "_"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Inequality:
    """What proofs in a file state together about a quantity: the loosest of their bounds on all of their ranges."""

    quantity: str
    relation: str
    bound: float
    ranges: Bounds  # of what varies
    known: Mapping[str, float] = dataclass_field(default_factory=dict)  # the rest


@dataclass(frozen=True, slots=True, kw_only=True)
class Stated:
    """What a file says; nothing of it is believed, all of it is attacked."""

    check: str
    status: str
    claim: str
    inequalities: tuple[Inequality, ...] = ()
    points: Mapping[str, float] = dataclass_field(
        default_factory=dict
    )  # numbers that the file states beside the margin
    quadratics: tuple[Mapping[str, Any], ...] = ()  # proofs with matrices of V
    sets: tuple[Any, ...] = ()  # windows of invariant sets, one list per proof
    varied: tuple[str, ...] = ()  # numbers of the plant that the claim says it varies


def read_stated(path: Path) -> Stated:
    """Read a certificate file."""
    content = json.loads(path.read_text(encoding="utf-8"))
    proofs = {key: each["proof"] for key, each in content["findings"].items() if "proof" in each}
    varied = tuple(field(name) for name in content["varied"])
    parts: dict[str, list[Mapping[str, Any]]] = {}
    for key, proof in proofs.items():
        statement = proof.get("statement", {})
        if statement.get("kind") == "inequality":
            parts.setdefault(key.split(",")[0] if content["varied"] else key, []).append(statement)
    return Stated(
        check=content["check"],
        status=content["status"],
        claim=content["claim"],
        inequalities=tuple(_together(each, content["claim"], varied) for each in parts.values()),
        points={each["name"]: each["value"] for each in content["worst_point"]},
        quadratics=tuple(each for each in proofs.values() if "pieces" in each),
        sets=tuple(each["windows"] for each in proofs.values() if "windows" in each),
        varied=varied,
    )


def _together(statements: list[Mapping[str, Any]], claim: str, varied: tuple[str, ...]) -> Inequality:
    """Join the parts of a domain; a number that all parts hold at an end is left to what the claim varies."""
    upper = statements[0]["relation"] == "<="
    ranges: Bounds = {}
    known: dict[str, float] = {}
    for statement in statements:
        for name, low, high, _ in statement["variables"]:
            ends = float(Fraction(low)), float(Fraction(high))
            if ends[0] < ends[1]:
                old = ranges.get(field(name), ends)
                ranges[field(name)] = min(old[0], ends[0]), max(old[1], ends[1])
            else:
                known[field(name)] = ends[0]
    axle = {name: ends for name, ends in axle_ranges(claim).items() if name in varied}
    bounds = [float(Fraction(each["bound"])) for each in statements]
    return Inequality(
        quantity=statements[0]["name"],
        relation=statements[0]["relation"],
        bound=max(bounds) if upper else min(bounds),
        ranges={**{name: axle[name] for name in axle if name in known}, **ranges},
        known={name: each for name, each in known.items() if name not in ranges},
    )


def axle_ranges(claim: str) -> Bounds:
    """Return the ranges of load share and deceleration of the train that a claim speaks about."""
    number = r"([0-9.e+-]+)"
    found = {}
    for words, name in (("axle load share", "load_share"), ("train deceleration", "train_deceleration")):
        said = re.search(rf"{words} {number} to {number}", claim)
        if said:
            found[name] = float(said[1]), float(said[2])
    return found


def with_axles(case: Case, stated: Stated) -> Case:
    """Return the case with the ranges of the axles that a file states, unless it has others."""
    data = case.data
    return replace(case, data=replace(data, bounds=axle_ranges(stated.claim) | data.bounds))
