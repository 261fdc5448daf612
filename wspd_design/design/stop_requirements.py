"""What the stop of a report must reach and which checks must not be refuted: a table of one's own, or a template.

A design that was made for drawn stops is judged by those (:mod:`wspd_design.design.requirements`). Every other one is
judged by such a table; without one of its own, by what the paper asks for.
"""

from dataclasses import dataclass
from importlib.resources.abc import Traversable
from pathlib import Path

from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.design.records import Specification
from wspd_design.design.requirements import (
    Limit,
    Requirements,
    check_keys,
    read_limits,
    read_requirements,
    seen_from_here,
    table_of,
    texts,
)
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import data_file, read_toml
from wspd_design.parameters.versions import check_schema

SCHEMA = "wspd-requirements/1"
PAPER = "paper"
TEMPLATES = (PAPER, "en-15595-like")
LONGEST_LOCK = 0.5  # s, above 10 km/h, that a wheelset may be locked for
MODEL = ("derivation", "gain_positive", "well_posed", "conservation")
"""Checks without which no other evidence counts."""
LOOPS = ("margins", "traced_loop")
"""Checks that tell whether the loop is stable near its reference, sampled and with its valve; the first that speaks."""
_OURS = "ours; the paper states none"


@dataclass(frozen=True, slots=True, kw_only=True)
class StopRequirements:
    """Limits of one stop, and checks."""

    name: str
    not_refuted: tuple[str, ...]  # checks
    certificates: tuple[str, ...] = ()  # checks that must be proved
    limits: tuple[Limit, ...]


def paper_requirements(specification: Specification) -> StopRequirements:
    """Return what the paper asks of a controller: a slip that is held at its reference, with a sampled loop.

    It states the reference and the sample time; how far the slip may stray, and how long a wheel may be locked, it does
    not say.
    """
    tolerance = f"tolerance of the specification; {_OURS}"
    return StopRequirements(
        name=PAPER,
        not_refuted=(*MODEL, *LOOPS),
        limits=(
            Limit(criterion="slip_rms", value=specification.slip_tolerance, source=tolerance),
            Limit(criterion="slip_overshoot", value=specification.slip_tolerance, source=tolerance),
            Limit(criterion="longest_lock", value=LONGEST_LOCK, source=_OURS),
        ),
    )


def named_requirements(written: str, specification: Specification) -> StopRequirements | Requirements:
    """Return the requirements of a template, or of a file with a table [requirements].

    Parameters
    ----------
    written : str
        Name of a template or path of a TOML file; one that states held-out sets is judged on those.
    specification : Specification
        Of the design, whose tolerance the template of the paper takes.

    Raises
    ------
    UserError
        If there is neither, or the file is wrong.
    """
    if written == PAPER:
        return paper_requirements(specification)
    if written in TEMPLATES:
        return read_stop_requirements(data_file("requirements", f"{written}.toml"), written)
    if not written.endswith(".toml"):
        raise UserError(
            f'requirements "{written}" are neither a template ({", ".join(TEMPLATES)}) nor a .toml file; write a table '
            "[requirements] into a file (wspd docs requirements)"
        )
    path = Path(written)
    document = read_toml(path, written)
    table = document.get("requirements")
    if isinstance(table, dict) and "held_out" in table:
        return seen_from_here(read_requirements(table, written), path.parent)
    return read_stop_requirements(path, written)


def read_stop_requirements(path: Traversable | Path, where: str) -> StopRequirements:
    """Read a file of requirements on one stop.

    Raises
    ------
    UserError
        If a key is unknown or missing, or a value impossible.
    """
    document = read_toml(path, where)
    check_keys(document, ("schema", "name", "requirements"), "", where, needed=("requirements",))
    stated, remedy = document.get("schema", SCHEMA), "wspd docs requirements"
    check_schema(stated, SCHEMA, where, what="a table of requirements", remedy=remedy)
    name = document.get("name", Path(where).stem)
    if not isinstance(name, str):
        raise UserError(f"name = {name!r} in {where} must be a text in quotes")
    stated = table_of(document["requirements"], "requirements", where)
    keys = ("not_refuted", "certificates", "limits")
    check_keys(stated, keys, "requirements.", where, needed=("limits",))
    checks = {key: texts(stated.get(key, []), f"requirements.{key}", where, empty=True) for key in keys[:2]}
    for key, names in checks.items():
        for each in names:
            if each not in THEOREMS:
                raise UserError(
                    f'requirements.{key} in {where} names "{each}"; the checks are {", ".join(THEOREMS)}'
                )
    return StopRequirements(
        name=name,
        not_refuted=checks["not_refuted"] or MODEL,
        certificates=checks["certificates"],
        limits=read_limits(table_of(stated["limits"], "requirements.limits", where), where, over_many=False),
    )
