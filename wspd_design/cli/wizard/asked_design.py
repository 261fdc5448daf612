"""From the answers of the wizard to a specification, and to vehicle, rail and requirements by their names."""

import re

from wspd_design.cli import options
from wspd_design.cli.wizard.steps import Answers
from wspd_design.controllers.family import FAMILIES
from wspd_design.design.case import RAIL, VEHICLE, CaseOptions, SensorWords, specification
from wspd_design.design.records import Specification
from wspd_design.design.stop_requirements import PAPER, named_requirements
from wspd_design.parameters.errors import UserError

OWN = "own file"
TOLD, WHEELS, WHEELS_ACCELEROMETER, FASTEST = "told", "wheels", "wheels and accelerometer", "fastest-axle"
_SENSORS = {
    TOLD: SensorWords(),
    WHEELS: SensorWords(speed="wheels"),
    WHEELS_ACCELEROMETER: SensorWords(speed="wheels", accelerometer=True),
    FASTEST: SensorWords(speed="fastest-axle"),
}
_KEYS = ("slip", "speeds", "sample_time", "tolerance")
_BETWEEN = re.compile(r"\s+to\s+|(?<=[\w])\s*[-\u2013\u2014]\s*(?=[\d.,])")
"""What stands between two speeds: ``to``, a hyphen or a dash."""


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


def tried(answers: Answers, **new: str) -> Specification:
    """Return the specification with one answer tried out; later answers give way to it."""
    earlier = _KEYS[: _KEYS.index(next(iter(new)))]
    return wanted({key: value for key, value in answers.items() if key in earlier} | new)


def vehicle_and_rail(answers: Answers) -> tuple[str, str]:
    """Return names or paths of the vehicle and the rail; what was not asked yet is the paper's."""
    return _named(answers, "vehicle", VEHICLE), _named(answers, "rail", RAIL)


def requirements_of(answers: Answers) -> str:
    """Return the template or the file of the requirements."""
    return _named(answers, "requirements", PAPER)


def is_of_whole_vehicle(answers: Answers) -> bool:
    """Whether the law acts on all wheelsets together."""
    return FAMILIES[answers.get("law", options.LAW)].reference is not None


def check_requirements(text: str, answers: Answers) -> str:
    """Read a file of requirements, and say which limits it states."""
    if not text.endswith(".toml"):
        raise UserError(f'file = "{text}" must be the path of a .toml file')
    found = named_requirements(text, wanted(answers))
    count = len(found.limits)
    return f"{count} limit{'s' * (count != 1)}: {', '.join(limit.criterion for limit in found.limits)}"


def split_speeds(text: str) -> tuple[str, str]:
    """Split ``10 km/h to 120 km/h``; ``10 to 120 km/h`` and ``10-120 km/h`` mean the same."""
    parts = _BETWEEN.split(text.strip())
    if len(parts) != 2:
        raise UserError(f'speed range = "{text}" must be two speeds, for example "{options.SPEEDS}"')
    low, high = (part.strip() for part in parts)
    if low[-1:].isdigit():
        low += " " + high.lstrip("0123456789., ")
    return low, high


def _named(answers: Answers, kind: str, default: str) -> str:
    name = answers.get(kind, default)
    return answers.get(f"{kind}_file", default) if name == OWN else name
