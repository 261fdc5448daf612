"""The questions of the wizard as data: what is asked, why the default is as it is, what is accepted."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

from wspd_design.cli import options
from wspd_design.controllers.family import FAMILIES, designed
from wspd_design.design.case import RAIL, VEHICLE, CaseOptions, SensorWords, specification
from wspd_design.design.records import Specification
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import available, load_entries, load_rail, load_vehicle
from wspd_design.parameters.schema import Kind

Answers: TypeAlias = Mapping[str, str]
"""What the user wrote, by the key of the step."""

OWN = "own file"
TOLD, WHEELS, WHEELS_ACCELEROMETER, FASTEST = "told", "wheels", "wheels and accelerometer", "fastest-axle"
_SENSORS = {
    TOLD: SensorWords(),
    WHEELS: SensorWords(speed="wheels"),
    WHEELS_ACCELEROMETER: SensorWords(speed="wheels", accelerometer=True),
    FASTEST: SensorWords(speed="fastest-axle"),
}
SAVE, AGAIN = "save", "again"


@dataclass(frozen=True, slots=True, kw_only=True)
class Option:
    """One line of a list."""

    value: str
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One question.

    With ``options`` it is a list to choose from, otherwise a line to write. ``check`` returns what the
    program understands, and raises :class:`UserError` for what it does not accept. ``suggest`` takes the place of the
    default where that follows from the answers before.
    """

    key: str
    title: str
    explanation: str
    default: str
    check: Callable[[str, Answers], str] = lambda text, _answers: text
    options: tuple[Option, ...] = ()
    applies: Callable[[Answers], bool] = lambda _answers: True
    suggest: Callable[[Answers], str] | None = None

    def suggestion(self, answers: Answers) -> str:
        """Return the answer of the user who went through here before, or what the program suggests."""
        if self.key in answers:
            return answers[self.key]
        return self.default if self.suggest is None else self.suggest(answers)


def steps() -> tuple[Step, ...]:
    """Return all questions in their order."""
    return (
        _parameter_set("vehicle", "Vehicle", VEHICLE, f"{VEHICLE} is the paper's locomotive."),
        _own_file("vehicle", 'The same format as the shipped vehicles; it may start with base = "er24pc".'),
        _parameter_set(
            "rail",
            "Rail",
            RAIL,
            "The controller is designed for this rail and can be tried on all others. "
            f"{RAIL} is the paper's harder case.",
        ),
        _own_file("rail", 'The same format as the shipped rails; it may start with base = "polach-wet".'),
        Step(
            key="law",
            title="Control law",
            explanation="The adaptive fuzzy law is the paper's, with the repaired proof; it needs no "
            "friction model. The other two laws of one wheelset use the friction of the design rail; torque feedback "
            "also needs the cylinder pressure. The laws of the whole vehicle observe friction and command the valve "
            "through its lag; with a sample time of 20 ms or less they hold the slip best.",
            default=options.LAW,
            options=tuple(Option(value=family.name, text=family.title) for family in designed()),
        ),
        Step(
            key="sensors",
            title="Train speed",
            explanation="A law of the whole vehicle can do without a radar: it lets one wheelset roll now and then and "
            "works the train speed out from its wheels. An accelerometer makes that speed better. The fastest wheelset "
            "alone is wrong as soon as all of them slide.",
            default=TOLD,
            options=(
                Option(value=TOLD, text="told by a source of its own, such as a radar"),
                Option(value=WHEELS_ACCELEROMETER, text="from the wheels, with an accelerometer"),
                Option(value=WHEELS, text="from the wheels alone"),
                Option(value=FASTEST, text="the fastest wheelset"),
            ),
            applies=_of_whole_vehicle,
        ),
        Step(
            key="slip",
            title="Slip reference",
            explanation=f"The slip that the controller holds. The paper takes {options.SLIP} at all speeds; "
            "on rails whose friction falls with sliding speed the best slip falls as the train gets faster.",
            default=options.SLIP,
            check=lambda text, answers: f"{_with(answers, slip=text).slip:g}",
        ),
        Step(
            key="speeds",
            title="Speed range",
            explanation="Speeds for which the gains are chosen and the claims are checked. Below 10 km/h "
            "a wheel slide costs next to nothing.",
            default=options.SPEEDS,
            check=_check_speeds,
        ),
        Step(
            key="sample_time",
            title="Sample time",
            explanation="How often the controller reads the wheel speeds and sets the valves. "
            f"The paper uses {options.SAMPLE_TIME}.",
            default=options.SAMPLE_TIME,
            check=lambda text, answers: f"{_with(answers, sample_time=text).sample_time:g} s",
        ),
        Step(
            key="tolerance",
            title="Slip tolerance",
            explanation="Width of the band about the reference. A narrow one asks for more switching than "
            "a valve with a lag can give.",
            default=options.TOLERANCE,
            check=_check_tolerance,
        ),
        Step(
            key="review",
            title="Review",
            explanation="Saving chooses the gains and writes the design file.",
            default=SAVE,
            options=(
                Option(value=SAVE, text="choose the gains and save"),
                Option(value=AGAIN, text="go through the questions again"),
            ),
        ),
    )


def accept(step: Step, text: str, answers: Answers) -> str:
    """Return what the program understands of an answer; what it does not accept raises :class:`UserError`."""
    values = [option.value for option in step.options]
    if values and text not in values:
        raise UserError(f'{step.key} = "{text}" must be one of {", ".join(values)}')
    return step.check(text, answers)


def wanted(answers: Answers) -> Specification:
    """Return the specification that the answers ask for; what was not asked yet keeps its default."""
    return specification(
        CaseOptions(
            slip=answers.get("slip"),
            speeds=split_speeds(answers["speeds"]) if "speeds" in answers else None,
            tolerance=answers.get("tolerance"),
            sample_time=answers.get("sample_time"),
            sensors=_SENSORS[answers.get("sensors", TOLD)],
        )
    )


def vehicle_and_rail(answers: Answers) -> tuple[str, str]:
    """Return names or paths of the vehicle and the rail."""
    vehicle, rail = (
        answers[f"{kind}_file"] if answers[kind] == OWN else answers[kind] for kind in ("vehicle", "rail")
    )
    return vehicle, rail


def split_speeds(text: str) -> tuple[str, str]:
    """Split ``10 km/h to 120 km/h``; ``10 to 120 km/h`` means the same."""
    low, separator, high = (part.strip() for part in text.partition(" to "))
    if not separator:
        raise UserError(f'speed range = "{text}" must be two speeds, for example "{options.SPEEDS}"')
    if low[-1:].isdigit():
        low += " " + high.lstrip("0123456789., ")
    return low, high


def _of_whole_vehicle(answers: Answers) -> bool:
    return FAMILIES[answers["law"]].reference is not None


def _with(answers: Answers, **new: str) -> Specification:
    """Return the specification with one answer tried out; later answers give way to it."""
    keys = ("slip", "speeds", "sample_time", "tolerance")
    earlier = keys[: keys.index(next(iter(new)))]
    return wanted({key: value for key, value in answers.items() if key in earlier} | new)


def _check_speeds(text: str, answers: Answers) -> str:
    low, high = _with(answers, speeds=text).speeds
    return f"{low:.4g} m/s to {high:.4g} m/s"


def _check_tolerance(text: str, answers: Answers) -> str:
    made = _with(answers, tolerance=text)
    return f"slip {max(made.slip - made.slip_tolerance, 0.0):g} to {made.slip + made.slip_tolerance:g}"


def _parameter_set(kind: Kind, title: str, default: str, explanation: str) -> Step:
    names = uniform_rails() if kind == "rail" else available(kind)  # a design is for one adhesion
    shipped = [Option(value=name, text=load_entries(kind, name).title) for name in names]
    return Step(
        key=kind,
        title=title,
        explanation=explanation,
        default=default,
        options=(*shipped, Option(value=OWN, text=f"a {kind} file of your own")),
    )


def _own_file(kind: Kind, explanation: str) -> Step:
    def check(text: str, _answers: Answers) -> str:
        if not text.endswith(".toml"):
            raise UserError(f'file = "{text}" must be the path of a .toml file')
        return f"{kind} {(load_vehicle if kind == 'vehicle' else load_rail)(text).name}"

    return Step(
        key=f"{kind}_file",
        title=f"File of the {kind}",
        explanation=explanation,
        default="",
        check=check,
        applies=lambda answers: answers.get(kind) == OWN,
    )
