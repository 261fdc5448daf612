"""The questions that lead to a rail file: from the peak of its adhesion, or from a measured creep curve."""

from dataclasses import replace
from pathlib import Path

from wspd_design.cli.wizard.steps import Answers, Option, Step, review_step
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.bounds import EXACT
from wspd_design.parameters.entry import number_of
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
from wspd_design.parameters.provenance import Entry
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.schema import Quantity, schema_of
from wspd_design.parameters.units import KMH, format_quantity, split_quantity
from wspd_design.studies.new_rail import Fit, fit_rail, rail_entries, rail_with_peak, read_curve

LIKE, VEHICLE, SPEED = "low-adhesion", "coach", "120 km/h"
NONE = "none"
_SCHEMA = schema_of("rail", "")
_SPEED = Quantity(dimension="speed", low=0.0, low_is_allowed=False, plausible=(0.1, 150.0))
_PEAK = Quantity(dimension="ratio", low=0.0, low_is_allowed=False, high=1.0, plausible=(0.005, 0.8))
_SHAPE = ("friction_ratio", "friction_decay", "adhesion_reduction", "slip_reduction")
_ASKED = {
    "friction_ratio": (
        "A, friction at high sliding speed",
        "Over the friction without sliding; 1 where it does not fall.",
    ),
    "friction_decay": ("B, how fast the friction falls", "Per sliding speed, in s/m."),
    "adhesion_reduction": (
        "kA, creep stiffness while adhering",
        "Over that of clean surfaces: 1 dry, about 0.3 wet.",
    ),
    "slip_reduction": (
        "kS, creep stiffness while sliding",
        "Over that of clean surfaces, usually below kA: 0.4 dry, 0.1 wet.",
    ),
}


def rail_steps() -> tuple[Step, ...]:
    """Return all questions in their order."""
    rails = tuple(Option(value=name, text=load_entries("rail", name).title) for name in uniform_rails())
    return (
        Step(
            key="curve",
            help="Tab completes the path. A line of headings may stand above the numbers.",
            title="Measured creep curve",
            explanation="A CSV file with slip and adhesion, both as shares, in its first two columns: the five numbers "
            f'of the rail are fitted to it. "{NONE}" where there is none.',
            default=NONE,
            check=_curve,
            files=".csv",
        ),
        Step(
            key="like",
            help="wspd sources NAME shows every number of a shipped rail with its source.",
            title="Kind",
            explanation="The shipped rail that yours is most like; it suggests the shape of the creep curve.",
            default=LIKE,
            options=rails,
            applies=_without_curve,
        ),
        Step(
            key="vehicle",
            help="Tab completes the path of a file. The size of the contact follows from it, and so does the curve.",
            title="Vehicle",
            explanation="Whose wheels and load belong to the curve or the peak: a shipped vehicle or a .toml file.",
            default=VEHICLE,
            files=".toml",
            check=lambda text, _answers: f"wheel load {_load(load_vehicle(text)) / 1e3:.4g} kN",
        ),
        Step(
            key="speed",
            dimension="speed",
            title="Speed",
            explanation="Of the vehicle in the measurement, or at which the peak is stated.",
            default=SPEED,
            check=lambda text, _answers: f"{_number(text, _SPEED, 'speed'):.4g} m/s",
        ),
        *(_shape(name) for name in _SHAPE),
        Step(
            key="peak",
            help="Suggested is the peak of the rail that yours is most like.",
            dimension="ratio",
            title="Adhesion at the peak",
            explanation="Of the creep curve at that speed, force over wheel load: what a test or a standard names. The "
            "friction coefficient follows from it.",
            default="0.07",
            suggest=lambda answers: f"{_peak_of(answers):.2g}",
            check=_peak,
            applies=_without_curve,
        ),
        review_step("Saving works out the numbers and writes the rail file.", "work out the rest and save"),
    )


def wanted_rail(name: str, answers: Answers) -> tuple[Rail, tuple[Entry, ...], Fit | None]:
    """Return the rail that the answers ask for, its numbers with their histories, and the fit where there is one."""
    vehicle, speed = load_vehicle(answers["vehicle"]), _number(answers["speed"], _SPEED, "speed")
    where = f"{answers['vehicle']} at {speed * KMH:.4g} km/h"
    if not _without_curve(answers):
        path = Path(answers["curve"])
        fit = fit_rail(
            name, *read_curve(path), speed=speed, wheel_load=_load(vehicle), contact=vehicle.contact
        )
        at = f"fit to {fit.points} points of {path.name}, {where}, rms {fit.rms:.2g}"
        return (
            fit.rail,
            rail_entries(fit.rail, dict.fromkeys(("mu0", *_SHAPE), ("own curve", at, "calibrated"))),
            fit,
        )
    rail = _shaped(name, answers)
    peak = _number(answers["peak"], _PEAK, "peak")
    made = rail_with_peak(rail, peak, vehicle=vehicle, speed=speed)
    like = load_rail(answers["like"])
    history = {
        each: ("own answer", "as asked", "assumed")
        if getattr(like, each) != getattr(rail, each)
        else (f"rail {like.name}", f"as of {like.name}", "assumed")
        for each in _SHAPE
    }
    history["mu0"] = ("wspd new rail", f"gives an adhesion of {peak:g} at the peak, {where}", "derived")
    return made, rail_entries(made, history), None


def _shape(name: str) -> Step:
    title, explanation = _ASKED[name]
    quantity = _SCHEMA[name]
    unit = "s/m" if name == "friction_decay" else "-"
    return Step(
        key=name,
        title=title,
        explanation=explanation,
        default="",
        dimension=quantity.dimension,
        suggest=lambda answers: format_quantity(getattr(load_rail(answers.get("like", LIKE)), name), unit),
        check=lambda text, _answers: format_quantity(_number(text, quantity, name), unit),
        applies=_without_curve,
    )


def _without_curve(answers: Answers) -> bool:
    return answers.get("curve", NONE) == NONE


def _curve(text: str, _answers: Answers) -> str:
    if text == NONE:
        return NONE
    slips, adhesions = read_curve(Path(text))
    return f"{len(slips)} points, slip {slips[0]:g} to {slips[-1]:g}, adhesion up to {max(adhesions):g}"


def _peak(text: str, answers: Answers) -> str:
    vehicle = load_vehicle(answers.get("vehicle", VEHICLE))
    speed = _number(answers.get("speed", SPEED), _SPEED, "speed")
    made = rail_with_peak(
        _shaped("yours", answers), _number(text, _PEAK, "peak"), vehicle=vehicle, speed=speed
    )
    return f"mu0 = {made.mu0:g}"


def _peak_of(answers: Answers) -> float:
    """Peak of the shipped rail that it is most like."""
    import numpy as np

    from wspd_design.simulation.peak import peak_adhesion

    vehicle = load_vehicle(answers.get("vehicle", VEHICLE))
    speed = _number(answers.get("speed", SPEED), _SPEED, "speed")
    return float(peak_adhesion(vehicle, load_rail(answers.get("like", LIKE)), np.array([speed]))[1][0])


def _shaped(name: str, answers: Answers) -> Rail:
    """Return the rail of the shape that the answers ask for; its friction is not decided yet."""
    like = load_rail(answers.get("like", LIKE))
    numbers = {
        each: _number(answers[each], _SCHEMA[each], each) if each in answers else getattr(like, each)
        for each in _SHAPE
    }
    return replace(like, name=name, bounds=EXACT, **numbers)


def _number(text: str, quantity: Quantity, what: str) -> float:
    number, unit = split_quantity(text, quantity.dimension, what=what)
    return number_of(number, quantity, unit, what)


def _load(vehicle: Vehicle) -> float:
    return float(static_wheel_load(vehicle))
