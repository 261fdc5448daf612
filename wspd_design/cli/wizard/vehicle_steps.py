"""The questions that lead to a vehicle file, each with the range that railways have."""

from collections.abc import Callable, Collection
from dataclasses import replace

from wspd_design.analysis.stopping import demanded_adhesion
from wspd_design.cli.wizard.steps import AGAIN, SAVE, Answers, Option, Step
from wspd_design.parameters.entry import number_of
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.gear import gear_of
from wspd_design.parameters.loading import available, load_entries, load_vehicle
from wspd_design.parameters.schema import Quantity, schema_of
from wspd_design.parameters.units import Dimension, format_quantity, split_quantity
from wspd_design.studies.new_vehicle import Wanted, derived_vehicle, wanted_like

KIND = "coach"
NONE = "none"
YES, NO = "yes", "no"
_SCHEMA = schema_of("vehicle", "")
_LENGTH = Quantity(dimension="length", low=0.0, low_is_allowed=False, plausible=(0.2, 3.0))
_SPEED = Quantity(dimension="speed", low=0.0, low_is_allowed=False, plausible=(1.0, 150.0))
_DECELERATION = Quantity(dimension="acceleration", low=0.0, low_is_allowed=False, plausible=(0.1, 5.0))
_ROTATING = Quantity(dimension="mass", low=0.0, low_is_allowed=False, plausible=(10.0, 1e5))

Reader = Callable[[str, Answers], float | int | bool]


def vehicle_steps() -> tuple[Step, ...]:
    """Return all questions in their order."""
    kinds = tuple(
        Option(value=name, text=load_entries("vehicle", name).title)
        for name in available("vehicle")
        if name != "er24pc"  # whose brake no railway has
    )
    return (
        Step(
            key="kind",
            title="Kind",
            explanation="The shipped vehicle that yours is most like. It suggests the answers below, and gives what is "
            "not asked, such as heights and springs; the file says so at each number.",
            default=KIND,
            options=kinds,
        ),
        _line(
            "mass", "Empty mass", "Ready to run, without load.", lambda like: format_quantity(like.mass, "t")
        ),
        Step(
            key="laden_mass",
            title="Laden mass",
            explanation=f'With passengers or goods, or "{NONE}". "FILE:laden" is then the laden vehicle.',
            default=NONE,
            suggest=_suggested(
                lambda like: format_quantity(like.laden_mass, "t") if like.laden_mass else NONE
            ),
            check=_echo(
                "laden_mass", lambda wanted: f"{wanted.laden_mass:.6g} kg" if wanted.laden_mass else NONE
            ),
        ),
        Step(
            key="weighs",
            title="Load-dependent brake",
            explanation="Whether the brake weighs the load and gives the laden vehicle the same deceleration.",
            default=YES,
            options=(
                Option(value=YES, text="the same deceleration empty and laden"),
                Option(value=NO, text="the same torque empty and laden"),
            ),
            suggest=_suggested(lambda like: YES if like.weighs else NO),
            applies=lambda answers: answers.get("laden_mass", NONE) != NONE,
        ),
        Step(
            key="axles",
            title="Axles",
            explanation="Of the whole vehicle; how many stand in a bogie follows from the kind.",
            default="4",
            suggest=_suggested(lambda like: str(like.wheelsets)),
            check=_echo("axles", _gear),
        ),
        _line(
            "bogie_spacing",
            "Distance of the bogies",
            "From centre to centre; of single axles, their distance.",
            lambda like: format_quantity(like.bogie_spacing, "m"),
        ),
        Step(
            key="wheelbase",
            title="Wheelbase of a bogie",
            explanation="From its first to its last axle.",
            default="2.5 m",
            suggest=_suggested(lambda like: format_quantity(like.wheelbase, "m")),
            check=_echo("wheelbase", lambda wanted: f"{wanted.wheelbase:.4g} m"),
            applies=lambda answers: wanted_like(answers.get("kind", KIND)).wheelbase > 0.0,
        ),
        Step(
            key="wheel_diameter",
            title="Wheel diameter",
            explanation="Of new wheels; worn ones follow as the lower bound.",
            default="920 mm",
            suggest=_suggested(lambda like: format_quantity(like.wheel_diameter, "mm")),
            check=_echo("wheel_diameter", lambda wanted: f"radius {wanted.wheel_diameter / 2.0:.4g} m"),
        ),
        Step(
            key="rotating_mass",
            title="Rotating mass",
            explanation="What all that turns adds to the mass of the train, of the whole vehicle: a mass, or % of the "
            "empty one. Trailers have 4 to 8 %, driven vehicles 8 to 15 %.",
            default="5 %",
            suggest=_suggested(lambda like: f"{100.0 * like.rotating_mass / like.mass:.3g} %"),
            check=_echo(
                "rotating_mass",
                lambda wanted: (
                    f"{wanted.rotating_mass:.4g} kg, {100.0 * wanted.rotating_mass / wanted.mass:.3g} % of "
                    "the empty mass"
                ),
            ),
        ),
        _line(
            "speed",
            "Speed",
            "From which the deceleration holds: the resistance counts with its mean.",
            lambda like: format_quantity(like.speed, "km/h"),
        ),
        Step(
            key="deceleration",
            title="Deceleration",
            explanation="Mean of the fully developed brake, dry and level, after EN 14531: it gives the torque.",
            default="1.2 m/s^2",
            suggest=_suggested(lambda like: f"{like.deceleration:.3g} m/s^2"),
            check=_echo("deceleration", _torque),
        ),
        _line(
            "build_up_time",
            "Build-up of the brake",
            "Until the demand reaches 95 % of its pressure. Position P has 3 to 5 s, an electro-pneumatic brake 1 s.",
            lambda like: f"{like.build_up_time:.4g} s",
        ),
        _line(
            "fill_time",
            "Filling of the cylinder",
            "Time constant T_F with which the valve of the protection fills the cylinder, as a first-order lag.",
            lambda like: format_quantity(like.fill_time, "s"),
        ),
        _line(
            "vent_time",
            "Venting of the cylinder",
            "Time constant T_V with which it vents; dump valves vent faster than they fill.",
            lambda like: format_quantity(like.vent_time, "s"),
        ),
        Step(
            key="review",
            title="Review",
            explanation="Saving works out all other numbers and writes the vehicle file.",
            default=SAVE,
            options=(
                Option(value=SAVE, text="work out the rest and save"),
                Option(value=AGAIN, text="go through the questions again"),
            ),
        ),
    )


def wanted_vehicle(answers: Answers, said: Collection[str] = ()) -> Wanted:
    """Return what the answers ask for; what was not asked yet is as of the kind.

    Parameters
    ----------
    answers : mapping
        Texts by the keys of the questions.
    said : collection of str
        Questions that the user answered; the other answers are suggestions of the program.

    Raises
    ------
    UserError
        If an answer is not acceptable.
    """
    made = wanted_like(answers.get("kind", KIND))
    for key, read in _READERS.items():
        if key in answers:
            field = _FIELDS.get(key, key)
            answered = {field} if key in said else set()
            made = replace(made, **{field: read(answers[key], answers)}, answered=made.answered | answered)  # type: ignore[arg-type]
    if made.laden_mass and made.laden_mass <= made.mass:
        if "laden_mass" in answers:
            raise UserError(
                f'laden_mass = "{answers["laden_mass"]}" must be above the empty mass of {made.mass:g} kg; write '
                f'"{NONE}" where the load does not count'
            )
        made = replace(made, laden_mass=0.0)
    return made


def _read(key: str, quantity: Quantity) -> Reader:
    def read(text: str, _answers: Answers) -> float:
        number, unit = split_quantity(text, quantity.dimension, what=key)
        return number_of(number, quantity, unit, key)

    return read


def _laden(text: str, answers: Answers) -> float:
    return 0.0 if text == NONE else float(_read("laden_mass", _SCHEMA["mass"])(text, answers))


def _axles(text: str, _answers: Answers) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 32:
        raise UserError(f'axles = "{text}" must be a whole number from 1 to 32')
    return int(text)


def _rotating(text: str, answers: Answers) -> float:
    share: Dimension = "ratio"
    if text.rstrip().endswith("%"):
        number, unit = split_quantity(text, share, what="rotating_mass")
        limits = Quantity(dimension=share, low=0.0, low_is_allowed=False, plausible=(0.005, 0.5))
        mass = wanted_vehicle({key: answers[key] for key in ("kind", "mass") if key in answers}).mass
        return number_of(number, limits, unit, "rotating_mass") * mass
    return float(_read("rotating_mass", _ROTATING)(text, answers))


_FIELDS = {"axles": "wheelsets"}
_READERS: dict[str, Reader] = {
    "mass": _read("mass", _SCHEMA["mass"]),
    "laden_mass": _laden,
    "weighs": lambda text, _answers: text == YES,
    "axles": _axles,
    "bogie_spacing": _read("bogie_spacing", _SCHEMA["bogie_spacing"]),
    "wheelbase": _read("wheelbase", _SCHEMA["wheelbase"]),
    "wheel_diameter": _read("wheel_diameter", _LENGTH),
    "rotating_mass": _rotating,
    "speed": _read("speed", _SPEED),
    "deceleration": _read("deceleration", _DECELERATION),
    "build_up_time": _read("build_up_time", Quantity(dimension="time", low=0.0, plausible=(0.05, 60.0))),
    "fill_time": _read("fill_time", _SCHEMA["brake.fill_time"]),
    "vent_time": _read("vent_time", _SCHEMA["brake.vent_time"]),
}


def _suggested(text: Callable[[Wanted], str]) -> Callable[[Answers], str]:
    """Suggest what the kind has, in proportion to the mass where that is another one."""

    def suggest(answers: Answers) -> str:
        like = wanted_like(answers.get("kind", KIND))
        mass = wanted_vehicle({key: answers[key] for key in ("kind", "mass") if key in answers}).mass
        if like.laden_mass and mass != like.mass:
            like = replace(like, laden_mass=float(f"{like.laden_mass / like.mass * mass:.3g}"))
        return text(like)

    return suggest


def _echo(key: str, say: Callable[[Wanted], str]) -> Callable[[str, Answers], str]:
    """Say what the program understands of an answer; later answers give way to it."""

    def check(text: str, answers: Answers) -> str:
        earlier = list(_READERS)[: list(_READERS).index(key)]
        kept = {each: answers[each] for each in ("kind", *earlier) if each in answers}
        return say(wanted_vehicle(kept | {key: text}))

    return check


def _line(key: str, title: str, explanation: str, text: Callable[[Wanted], str]) -> Step:
    """Return a question for a quantity, which is echoed in SI units."""

    def say(wanted: Wanted) -> str:
        value = getattr(wanted, key)
        return f"{value:.6g} {_UNITS[key]}"

    return Step(
        key=key,
        title=title,
        explanation=explanation,
        default="",
        suggest=_suggested(text),
        check=_echo(key, say),
    )


_UNITS = {
    "mass": "kg",
    "bogie_spacing": "m",
    "speed": "m/s",
    "build_up_time": "s",
    "fill_time": "s",
    "vent_time": "s",
}


def _gear(wanted: Wanted) -> str:
    axles = gear_of(load_vehicle(wanted.kind)).axles
    if wanted.wheelsets % axles:
        raise UserError(
            f"axles = {wanted.wheelsets} must be a multiple of {axles}, the axles of a bogie of a {wanted.kind}"
        )
    if axles == 1:
        return f"{wanted.wheelsets} single axles"
    if wanted.wheelsets == axles:
        raise UserError(
            f"axles = {wanted.wheelsets} make one bogie, on which no body stands; write {2 * axles}"
        )
    return f"{wanted.wheelsets} axles in {wanted.wheelsets // axles} bogies of {axles}"


def _torque(wanted: Wanted) -> str:
    made = derived_vehicle("yours", wanted)
    return (
        f"a torque of {made.brake.max_torque / 1e3:.4g} kN m at each braked wheelset, which asks for an adhesion of "
        f"{demanded_adhesion(made):.3f}"
    )
