"""Cases: a controller on a vehicle and a rail, loaded from what a user writes."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path

from wspd_design.controllers.family import tunable_family
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.offers import slip_reference_of
from wspd_design.controllers.protocol import Law, acts_on_vehicle
from wspd_design.design.catalog import controller as build_controller
from wspd_design.design.catalog import controller_of, is_design_file
from wspd_design.design.file import read_design
from wspd_design.design.own_controller import is_own_controller, load_controller
from wspd_design.design.records import Design, Specification, seen_by
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available
from wspd_design.parameters.laden import LADEN
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import parse_quantity

VEHICLE = "er24pc"
RAIL = "polach-wet"
"""What holds where nothing was written."""

_CLOSE = 1e-9  # relative: the same number written in another unit


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """A controller on a vehicle and a rail, with the specification it was made for.

    ``design`` is there for a design file only. The names are what the loaders take: a shipped name or a path.
    """

    vehicle: Vehicle
    rail: Rail
    controller: Law
    specification: Specification
    design: Design | None
    vehicle_name: str
    rail_name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorWords:
    """What the user wrote about the sensors and the reference of a law; None where nothing was written."""

    speed: str | None = None
    accelerometer: bool | None = None
    pressures: bool | None = None
    grade: bool | None = None
    reference: str | None = None


UNSAID = SensorWords()


@dataclass(frozen=True, slots=True, kw_only=True)
class CaseOptions:
    """What the user wrote, each quantity with its unit; None where nothing was written.

    Vehicle and rail may be records, shipped names or paths.
    """

    vehicle: Vehicle | Path | str | None = None
    rail: Rail | Path | str | None = None
    slip: str | None = None
    speeds: tuple[str, str] | None = None
    tolerance: str | None = None
    sample_time: str | None = None
    sensors: SensorWords = UNSAID


NO_OPTIONS = CaseOptions()


def specification(options: CaseOptions, base: Specification | None = None) -> Specification:
    """Return the specification that the user asks for.

    Parameters
    ----------
    options : CaseOptions
        The options.
    base : Specification, optional
        What holds where nothing was written; by default the paper's case. Its slip range and tolerance give
        way to a slip reference that they do not suit.
    """
    base = base or Specification()
    slip = base.slip if options.slip is None else parse_quantity(options.slip, "ratio", what="slip")
    low, high = base.slips
    distance = 1.0 - slip
    return Specification(
        slip=slip,
        slips=(low if low < slip else slip / 2.0, high if high > slip else slip + distance / 2.0),
        speeds=base.speeds if options.speeds is None else _speeds(options.speeds),
        slip_tolerance=(
            (base.slip_tolerance if base.slip_tolerance < distance else distance / 2.0)
            if options.tolerance is None
            else parse_quantity(options.tolerance, "ratio", what="tolerance")
        ),
        sample_time=(
            base.sample_time
            if options.sample_time is None
            else parse_quantity(options.sample_time, "time", what="sample time")
        ),
        reference=base.reference if options.sensors.reference is None else options.sensors.reference,  # type: ignore[arg-type]
        sensors=_sensors(options.sensors, base.sensors),
    )


def _sensors(words: SensorWords, base: Sensors) -> Sensors:
    """Return the sensors that the user asks for, which refuse what does not go together."""
    written = {each.name: getattr(words, each.name) for each in fields(Sensors)}
    return replace(base, **{name: value for name, value in written.items() if value is not None})


def load_case(name: str, options: CaseOptions, base: Specification | None = None) -> Case:
    """Load everything that is to be known about one controller.

    Parameters
    ----------
    name : str
        Name of a controller, path of a design file, or ``FILE.py:NAME``.
    options : CaseOptions
        What the user wrote. For a design file, vehicle and rail default to its own.
    base : Specification, optional
        What holds for a named controller where nothing was written.

    Raises
    ------
    UserError
        If a name is unknown, a value is impossible or an option contradicts the design file.
    """
    if is_design_file(name):
        return case_of(read_design(name), options, where=name)
    vehicle, rail = _vehicle(options.vehicle or VEHICLE), _rail(options.rail or RAIL)
    wanted = specification(options, base)
    controller: Law
    if is_own_controller(name):
        controller = _own_controller(name, vehicle, rail, wanted, options)
        wanted = specification_of(controller, options, base)
    else:
        controller = build_controller(name, vehicle, rail, wanted)
    return Case(
        vehicle=vehicle,
        rail=rail,
        controller=controller,
        specification=wanted,
        design=None,
        vehicle_name=_name(options.vehicle or VEHICLE),
        rail_name=_name(options.rail or RAIL),
    )


def load_cases(names: Sequence[str], options: CaseOptions) -> tuple[Case, ...]:
    """Load several controllers for one comparison.

    Where no option says otherwise, all take vehicle, rail, slip reference, sample time and sensors of the first
    design file among them.
    """
    path = next(filter(is_design_file, names), None)
    if path is None:
        return tuple(load_case(name, options) for name in names)
    first = read_design(path)
    options = replace(
        options,
        vehicle=options.vehicle or _stated("vehicle", first.vehicle, first.vehicle_file, path),
        rail=options.rail or _stated("rail", first.rail, first.rail_file, path),
    )
    shared = replace(first.specification, reference=None)  # which is for the law of the design alone
    return tuple(load_case(name, options, shared) for name in names)


def case_of(made: Design, options: CaseOptions, *, where: str) -> Case:
    """Return the case of a design on a vehicle and a rail, its own where nothing was written.

    Parameters
    ----------
    made : Design
        The design. Its controller keeps the rail that it was made on as its design model, whatever the rail of the
        stop.
    options : CaseOptions
        What the user wrote.
    where : str
        Name of the design in sentences.

    Raises
    ------
    UserError
        If an option contradicts the design, or its vehicle or rail cannot be found.
    """
    own = made.specification
    wanted = specification(options)
    for option, given, value, stated in (
        ("--slip", options.slip, wanted.slip, own.slip),
        ("--sample-time", options.sample_time, wanted.sample_time, own.sample_time),
        ("--speeds", options.speeds, wanted.speeds, own.speeds),
    ):
        if given is not None and not _same(value, stated):
            raise UserError(
                f"{option} {_text(value)} contradicts {where}, which has {_text(stated)} (SI units); "
                f"leave {option} out or make another design"
            )
    _agree_about_sensors(options.sensors, made, where)
    vehicle_given = options.vehicle or _stated("vehicle", made.vehicle, made.vehicle_file, where)
    rail_given = options.rail or _stated("rail", made.rail, made.rail_file, where)
    vehicle, rail = _vehicle(vehicle_given), _rail(rail_given)
    return Case(
        vehicle=vehicle,
        rail=rail,
        controller=controller_of(made, vehicle, rail),
        specification=own,
        design=made,
        vehicle_name=_name(vehicle_given),
        rail_name=_name(rail_given),
    )


def _agree_about_sensors(words: SensorWords, made: Design, where: str) -> None:
    """Refuse sensors or a reference that are not those of the design."""
    own = made.specification
    for option, given, stated in (
        ("--speed-source", words.speed, own.sensors.speed),
        ("--accelerometer", words.accelerometer, own.sensors.accelerometer),
        ("--pressure-sensors", words.pressures, own.sensors.pressures),
        ("--estimate-grade", words.grade, own.sensors.grade),
        ("--reference", words.reference, own.reference_of(tunable_family(made.law))),
    ):
        if given is not None and given != stated:
            said = "it" if stated is True else "none" if stated is False else stated
            raise UserError(
                f"{option} contradicts {where}, which has {said}; leave it out or make another design"
            )


def _vehicle(given: Vehicle | Path | str) -> Vehicle:
    return given if isinstance(given, Vehicle) else load_vehicle(given)


def _rail(given: Rail | Path | str) -> Rail:
    return given if isinstance(given, Rail) else load_rail(given)


def _name(given: Vehicle | Rail | Path | str) -> str:
    return given.name if isinstance(given, Vehicle | Rail) else str(given)


def _own_controller(
    name: str, vehicle: Vehicle, rail: Rail, wanted: Specification, options: CaseOptions
) -> Law:
    """Load a controller from a Python file; it keeps its own slip and sample time unless the user wrote others."""
    made = load_controller(
        name,
        vehicle=vehicle,
        rail=rail,
        slip=wanted.slip if options.slip is not None else None,
        sample_time=wanted.sample_time if options.sample_time is not None else None,
    )
    if options.sample_time is not None and not _same(wanted.sample_time, made.sample_time):
        raise UserError(
            f"--sample-time {wanted.sample_time:g} contradicts {name}, which has {made.sample_time:g} (SI units); "
            "leave --sample-time out or let it take sample_time"
        )
    held = slip_reference_of(made)
    if options.slip is not None and held is not None and not _same(wanted.slip, held):
        raise UserError(
            f"--slip {wanted.slip:g} contradicts {name}, which holds {held:g}; leave --slip out or let it take slip"
        )
    if options.sensors.reference is not None or (acts_on_vehicle(made) and options.sensors != UNSAID):
        raise UserError(f"{name} has its own sensors and reference; leave the options about them out")
    return seen_by(wanted.sensors, made, vehicle)


def specification_of(
    made: Law, options: CaseOptions = NO_OPTIONS, base: Specification | None = None
) -> Specification:
    """Return the specification with the slip that a law holds, if it says which, and its sample time."""
    held = slip_reference_of(made)
    slip = options.slip if held is None else repr(held)
    return replace(specification(replace(options, slip=slip), base), sample_time=made.sample_time)


def _stated(kind: str, name: str, file: str, design: str) -> str:
    """Return the vehicle or rail that a design file states: a file beside it, or a shipped name."""
    if file:
        own = file.removesuffix(LADEN)
        path = Path(design).parent / own
        if not path.is_file():
            raise UserError(
                f"{design} was made for the {kind} of {path}, which is not there; give its file with --{kind}"
            )
        return str(path) + file.removeprefix(own)
    if name.removesuffix(LADEN) not in available(kind):  # type: ignore[arg-type]
        raise UserError(f"{design} was made for a {kind} of your own, {name}; give its file with --{kind}")
    return name


def _speeds(texts: tuple[str, str]) -> tuple[float, float]:
    low, high = (parse_quantity(text, "speed", what="speed") for text in texts)
    return low, high


def _same(a: float | tuple[float, ...], b: float | tuple[float, ...]) -> bool:
    pairs = zip(a, b, strict=True) if isinstance(a, tuple) and isinstance(b, tuple) else ((a, b),)
    return all(abs(x - y) <= _CLOSE * abs(y) for x, y in pairs)  # type: ignore[operator,arg-type]


def _text(value: float | tuple[float, ...]) -> str:
    return " ".join(f"{item:g}" for item in value) if isinstance(value, tuple) else f"{value:g}"
