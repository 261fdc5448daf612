"""The questions that lead to a design."""

from wspd_design.cli import options
from wspd_design.cli.wizard import advice
from wspd_design.cli.wizard.asked_design import (
    FASTEST,
    OWN,
    TOLD,
    WHEELS,
    WHEELS_ACCELEROMETER,
    check_requirements,
    is_of_whole_vehicle,
    tried,
)
from wspd_design.cli.wizard.steps import Answers, Option, Step, review_step
from wspd_design.controllers.family import designed
from wspd_design.design.case import RAIL, VEHICLE
from wspd_design.design.stop_requirements import PAPER, TEMPLATES
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import uniform_rails
from wspd_design.parameters.loading import available, load_entries, load_rail, load_vehicle
from wspd_design.parameters.schema import Kind

_TEMPLATES = {
    PAPER: "what the paper asks: a slip within the tolerance, no lock of 0.5 s",
    "en-15595-like": "limits of the kind that tests ask for; none of them verified",
}


def design_steps() -> tuple[Step, ...]:
    """Return all questions in their order."""
    return (
        _parameter_set(
            "vehicle",
            "Vehicle",
            VEHICLE,
            f"{VEHICLE} is the paper's locomotive.",
            "A file of your own comes from wspd new vehicle; wspd sources NAME shows every number of a shipped one.",
        ),
        _own_file("vehicle", 'The same format as the shipped vehicles; it may start with base = "er24pc".'),
        _parameter_set(
            "rail",
            "Rail",
            RAIL,
            "The controller is designed for this rail and can be tried on all others. "
            f"{RAIL} is the paper's harder case.",
            "A file of your own comes from wspd new rail. A protection has work only where the brake asks for more "
            "adhesion than the rail gives.",
        ),
        _own_file("rail", 'The same format as the shipped rails; it may start with base = "polach-wet".'),
        Step(
            key="law",
            title="Control law",
            explanation="The adaptive fuzzy law is the paper's, with the repaired proof; it needs no friction model. "
            "The laws of the whole vehicle observe friction and command the valve through its lag.",
            help="afsmc, smc and torque-feedback sit on one wheelset each and are told the train speed; smc and "
            "torque-feedback use the friction of the design rail, torque feedback also the cylinder pressure. With a "
            "sample time of 20 ms or less the laws of the whole vehicle hold the slip best. A law of your own needs no "
            "wizard: wspd docs own-controller.",
            default=options.LAW,
            options=tuple(Option(value=family.name, text=family.title) for family in designed()),
            note=advice.of_law,
        ),
        Step(
            key="sensors",
            title="Train speed",
            explanation="A law of the whole vehicle can do without a radar: it lets one wheelset roll now and then and "
            "works the train speed out from its wheels.",
            help="An accelerometer makes that speed better. The fastest wheelset alone is wrong as soon as all of them "
            "slide.",
            default=TOLD,
            options=(
                Option(value=TOLD, text="told by a source of its own, such as a radar"),
                Option(value=WHEELS_ACCELEROMETER, text="from the wheels, with an accelerometer"),
                Option(value=WHEELS, text="from the wheels alone"),
                Option(value=FASTEST, text="the fastest wheelset"),
            ),
            applies=is_of_whole_vehicle,
        ),
        Step(
            key="slip",
            dimension="ratio",
            title="Slip reference",
            explanation=f"The slip that the controller holds. The paper takes {options.SLIP} at all speeds; on rails "
            "whose friction falls with sliding speed the best slip falls as the train gets faster.",
            help=f"A share or %: 0.14, 14 %. Suggested is {options.SLIP} for the paper's case, elsewhere the whole "
            "percent with the shortest stop of a brake that holds it all the way.",
            default=options.SLIP,
            suggest=advice.suggested_slip,
            check=lambda text, answers: f"{tried(answers, slip=text).slip:g}",
            note=advice.of_slip,
        ),
        Step(
            key="speeds",
            dimension="speed",
            title="Speed range",
            explanation="Speeds for which the gains are chosen and the claims are checked. Below 10 km/h "
            "a wheel slide costs next to nothing.",
            help="Two speeds: 10 km/h to 120 km/h, 10-160 km/h, 5 to 75 mph, 3 to 40 m/s.",
            default=options.SPEEDS,
            check=_check_speeds,
        ),
        Step(
            key="sample_time",
            dimension="time",
            title="Sample time",
            explanation="How often the controller reads the wheel speeds and sets the valves. "
            f"The paper uses {options.SAMPLE_TIME}.",
            help="From 1 ms to 1 s. Shorter samples leave a slide less time to grow; valves switch more often.",
            default=options.SAMPLE_TIME,
            check=lambda text, answers: f"{tried(answers, sample_time=text).sample_time:g} s",
            note=advice.of_sample_time,
        ),
        Step(
            key="tolerance",
            dimension="ratio",
            title="Slip tolerance",
            explanation="Width of the band about the reference. A narrow one asks for more switching than "
            "a valve with a lag can give.",
            help="A share or %. Reports judge the slip by it, and claims about the reference hold within it.",
            default=options.TOLERANCE,
            suggest=advice.suggested_tolerance,
            check=_check_tolerance,
        ),
        Step(
            key="requirements",
            title="Requirements",
            explanation="The table of limits by which a report accepts or rejects the design.",
            help="The design names it, and wspd report --requirements takes another one. A table of your own has "
            "limits with their sources: wspd docs requirements. Limits on drawn stops, and gains that are searched for "
            "them, are stated in a specification: wspd docs design-to-requirements.",
            default=PAPER,
            options=(
                *(Option(value=name, text=_TEMPLATES[name]) for name in TEMPLATES),
                Option(value=OWN, text="a requirements file of your own"),
            ),
        ),
        Step(
            key="requirements_file",
            help="Tab completes the path. wspd docs requirements says what the table holds.",
            title="File of the requirements",
            explanation="A .toml file with a table [requirements].",
            default="",
            check=check_requirements,
            applies=lambda answers: answers.get("requirements") == OWN,
            files=".toml",
        ),
        review_step("Saving chooses the gains and writes the design file.", "choose the gains and save"),
    )


def _check_speeds(text: str, answers: Answers) -> str:
    low, high = tried(answers, speeds=text).speeds
    return f"{low:.4g} m/s to {high:.4g} m/s"


def _check_tolerance(text: str, answers: Answers) -> str:
    made = tried(answers, tolerance=text)
    return f"slip {max(made.slip - made.slip_tolerance, 0.0):g} to {made.slip + made.slip_tolerance:g}"


def _parameter_set(kind: Kind, title: str, default: str, explanation: str, more: str) -> Step:
    names = uniform_rails() if kind == "rail" else available(kind)  # a design is for one adhesion
    shipped = [Option(value=name, text=load_entries(kind, name).title) for name in names]
    return Step(
        key=kind,
        title=title,
        explanation=explanation,
        help=more,
        default=default,
        options=(*shipped, Option(value=OWN, text=f"a {kind} file of your own")),
        note=advice.of_rail if kind == "rail" else lambda _text, _answers: "",
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
        help=f"Tab completes the path. wspd new {kind} writes such a file; wspd docs vehicle-files says what it holds.",
        default="",
        check=check,
        applies=lambda answers: answers.get(kind) == OWN,
        note=advice.of_rail if kind == "rail" else lambda _text, _answers: "",
        files=".toml",
    )
