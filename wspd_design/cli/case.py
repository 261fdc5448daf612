"""From the words of a command line to the records that the package takes."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches

from wspd_design.cli.options import CONTROLLER, QUARTER, RAIL, VEHICLE
from wspd_design.cli.own_controller import is_own_controller, load_own_controller
from wspd_design.controllers.protocol import Controller
from wspd_design.design.catalog import controller as build_controller
from wspd_design.design.catalog import is_design_file
from wspd_design.design.file import read_design
from wspd_design.design.laws import GAINS_OF, law_of
from wspd_design.design.records import Design, Law, Specification
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import parse_quantity
from wspd_design.plants.names import PLANTS

_CLOSE = 1e-9  # relative: the same number written in another unit


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A controller on a vehicle and a rail, with the specification it was made for.

    ``design`` is there for a design file only. The names are what the loaders take: a shipped name or a path.
    """

    vehicle: Vehicle
    rail: Rail
    controller: Controller
    specification: Specification
    design: Design | None
    vehicle_name: str
    rail_name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Wishes:
    """What the user wrote; None where nothing was written."""

    vehicle: str | None = None
    rail: str | None = None
    slip: str | None = None
    speeds: tuple[str, str] | None = None
    tolerance: str | None = None
    sample_time: str | None = None


def parse_speed(text: str) -> float:
    """Read a speed [m/s]."""
    return parse_quantity(text, "speed", what="speed")


def specification(wishes: Wishes, base: Specification | None = None) -> Specification:
    """Return the specification that the user asks for.

    Parameters
    ----------
    wishes : Wishes
        The options.
    base : Specification, optional
        What holds where nothing was written; by default the paper's case. Its slip range and tolerance give
        way to a slip reference that they do not suit.
    """
    base = base or Specification()
    slip = base.slip if wishes.slip is None else parse_quantity(wishes.slip, "ratio", what="slip")
    low, high = base.slips
    distance = 1.0 - slip
    return Specification(
        slip=slip,
        slips=(low if low < slip else slip / 2.0, high if high > slip else slip + distance / 2.0),
        speeds=base.speeds if wishes.speeds is None else _speeds(wishes.speeds),
        slip_tolerance=(
            (base.slip_tolerance if base.slip_tolerance < distance else distance / 2.0)
            if wishes.tolerance is None
            else parse_quantity(wishes.tolerance, "ratio", what="tolerance")
        ),
        sample_time=(
            base.sample_time
            if wishes.sample_time is None
            else parse_quantity(wishes.sample_time, "time", what="sample time")
        ),
    )


def chosen(argument: str | None, option: str | None) -> str:
    """Return the controller, which may stand as an argument or after ``--controller``."""
    if argument is not None and option is not None and argument != option:
        raise UserError(f'two controllers are given, "{argument}" and --controller "{option}"; leave one out')
    return argument or option or CONTROLLER


def check_plant(name: str) -> None:
    """Refuse a plant that does not exist."""
    if name not in PLANTS:
        near = get_close_matches(name, PLANTS, n=1)
        offer = f', did you mean "{near[0]}"?' if near else ""
        raise UserError(f'unknown plant "{name}"{offer}; available: {", ".join(PLANTS)}')


def check_quarter(name: str, command: str) -> None:
    """Refuse a plant other than the quarter locomotive, which the analysis at a point speaks about."""
    check_plant(name)
    if name != QUARTER:
        raise UserError(
            f"{command} speaks about the quarter locomotive, whose wheelsets are alike, not about {name}; "
            f"leave --plant out or write --plant {QUARTER}"
        )


def check_law(name: str) -> Law:
    """Return the law of a name that can be designed."""
    law = law_of(name)
    if law is not None:
        return law
    near = get_close_matches(name, GAINS_OF, n=1)
    offer = f' (did you mean "{near[0]}"?)' if near else ""
    raise UserError(f'--law "{name}" cannot be designed{offer}; choose {" or ".join(GAINS_OF)}')


def resolve(name: str, wishes: Wishes, base: Specification | None = None) -> Case:
    """Load everything that a command needs to know about one controller.

    Parameters
    ----------
    name : str
        Name of a controller, path of a design file, or ``FILE.py:NAME``.
    wishes : Wishes
        The options. For a design file, vehicle and rail default to its own.
    base : Specification, optional
        What holds for a named controller where nothing was written.

    Raises
    ------
    UserError
        If a name is unknown, a value is impossible or an option contradicts the design file.
    """
    if is_design_file(name):
        return _from_file(name, wishes)
    vehicle_name, rail_name = wishes.vehicle or VEHICLE, wishes.rail or RAIL
    vehicle, rail, wanted = load_vehicle(vehicle_name), load_rail(rail_name), specification(wishes, base)
    if is_own_controller(name):
        controller = _own_controller(name, vehicle, rail, wanted, wishes)
    else:
        controller = build_controller(name, vehicle, rail, wanted)
    return Case(
        vehicle=vehicle,
        rail=rail,
        controller=controller,
        specification=wanted,
        design=None,
        vehicle_name=vehicle_name,
        rail_name=rail_name,
    )


def resolve_all(names: Sequence[str], wishes: Wishes) -> tuple[Case, ...]:
    """Load several controllers for one comparison.

    Where no option says otherwise, all take vehicle, rail, slip reference and sample time of the first design
    file among them.
    """
    path = next(filter(is_design_file, names), None)
    if path is None:
        return tuple(resolve(name, wishes) for name in names)
    first = read_design(path)
    wishes = replace(
        wishes,
        vehicle=wishes.vehicle or _shipped("vehicle", first.vehicle, path),
        rail=wishes.rail or _shipped("rail", first.rail, path),
    )
    return tuple(resolve(name, wishes, first.specification) for name in names)


def _from_file(path: str, wishes: Wishes) -> Case:
    made = read_design(path)
    own = made.specification
    wanted = specification(wishes)
    for option, given, value, stated in (
        ("--slip", wishes.slip, wanted.slip, own.slip),
        ("--sample-time", wishes.sample_time, wanted.sample_time, own.sample_time),
        ("--speeds", wishes.speeds, wanted.speeds, own.speeds),
    ):
        if given is not None and not _same(value, stated):
            raise UserError(
                f"{option} {_text(value)} contradicts {path}, which has {_text(stated)} (SI units); "
                f"leave {option} out or make another design"
            )
    vehicle_name = wishes.vehicle or _shipped("vehicle", made.vehicle, path)
    rail_name = wishes.rail or _shipped("rail", made.rail, path)
    vehicle, rail = load_vehicle(vehicle_name), load_rail(rail_name)
    return Case(
        vehicle=vehicle,
        rail=rail,
        controller=made.build(vehicle, rail if rail.name == made.rail else load_rail(made.rail)),
        specification=own,
        design=made,
        vehicle_name=vehicle_name,
        rail_name=rail_name,
    )


def _own_controller(
    name: str, vehicle: Vehicle, rail: Rail, wanted: Specification, wishes: Wishes
) -> Controller:
    """Load a controller from a Python file; it keeps its own slip and sample time unless the user wrote others."""
    options = {"vehicle": vehicle, "rail": rail, "slip": wanted.slip, "sample_time": wanted.sample_time}
    said = {"slip": wishes.slip, "sample_time": wishes.sample_time}
    written = {key: value for key, value in options.items() if said.get(key, key) is not None}
    made = load_own_controller(name, options=options, written=written)
    if wishes.sample_time is not None and not _same(wanted.sample_time, made.sample_time):
        raise UserError(
            f"--sample-time {wanted.sample_time:g} contradicts {name}, which has {made.sample_time:g} (SI units); "
            "leave --sample-time out or let it take sample_time"
        )
    return made


def _shipped(kind: str, name: str, path: str) -> str:
    """Return the name that a design file states, if it can be loaded by that name."""
    if name not in available(kind):  # type: ignore[arg-type]
        raise UserError(f"{path} was made for a {kind} of your own, {name}; give its file with --{kind}")
    return name


def _speeds(texts: tuple[str, str]) -> tuple[float, float]:
    return parse_speed(texts[0]), parse_speed(texts[1])


def _same(a: float | tuple[float, ...], b: float | tuple[float, ...]) -> bool:
    pairs = zip(a, b, strict=True) if isinstance(a, tuple) and isinstance(b, tuple) else ((a, b),)
    return all(abs(x - y) <= _CLOSE * abs(y) for x, y in pairs)  # type: ignore[operator,arg-type]


def _text(value: float | tuple[float, ...]) -> str:
    return " ".join(f"{item:g}" for item in value) if isinstance(value, tuple) else f"{value:g}"
