"""From the answers about a train to what its vehicle file is made of; each number in the range that railways have."""

from collections.abc import Callable, Collection
from dataclasses import replace

from wspd_design.cli.wizard.steps import Answers
from wspd_design.parameters.entry import number_of
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.schema import Quantity, schema_of
from wspd_design.parameters.units import Dimension, split_quantity
from wspd_design.studies.new_vehicle import Wanted, wanted_like

KIND = "coach"
NONE = "none"
YES, NO = "yes", "no"
_SCHEMA = schema_of("vehicle", "")
_LENGTH = Quantity(dimension="length", low=0.0, low_is_allowed=False, plausible=(0.2, 3.0))
_SPEED = Quantity(dimension="speed", low=0.0, low_is_allowed=False, plausible=(1.0, 150.0))
_DECELERATION = Quantity(dimension="acceleration", low=0.0, low_is_allowed=False, plausible=(0.1, 5.0))
_ROTATING = Quantity(dimension="mass", low=0.0, low_is_allowed=False, plausible=(10.0, 1e5))

Reader = Callable[[str, Answers], float | int | bool | str]


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
    for key, read in READERS.items():
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
READERS: dict[str, Reader] = {
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
    "build_up": lambda text, _answers: text,
    "build_up_delay": _read("build_up_delay", _SCHEMA["brake.build_up_delay"]),
    "build_up_time": _read("build_up_time", Quantity(dimension="time", low=0.0, plausible=(0.05, 60.0))),
    "fill_time": _read("fill_time", _SCHEMA["brake.fill_time"]),
    "vent_time": _read("vent_time", _SCHEMA["brake.vent_time"]),
}
"""How each answer is read, in the order of the questions."""
