"""The file of a specification: law, vehicle, rails, requirements and effort, as TOML with units."""

from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path
from typing import Any

from wspd_design.controllers.family import tunable_family
from wspd_design.design.case import RAIL, CaseOptions, specification
from wspd_design.design.file import how_seen
from wspd_design.design.records import Specification
from wspd_design.design.requirements import (
    DrawnSets,
    Requirements,
    check_keys,
    read_requirements,
    read_sets,
    seen_from_here,
    table_of,
    whole,
)
from wspd_design.design.search.methods import METHODS
from wspd_design.design.search.sets import disjoint
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import beside, data_file, read_toml
from wspd_design.parameters.versions import check_schema
from wspd_design.parameters.words import did_you_mean

SCHEMA = "wspd-specification/1"
_FOLDER = "specifications"
STABLE_LAW = "observer-smc"  # whose sampled loop is known as a matrix
_OF_THE_DESIGN = ("slip", "tolerance", "sample_time")
_WORDS = ("name", "law", "vehicle", "design_rail")
_KEYS = (
    *("schema", *_WORDS, *_OF_THE_DESIGN),
    *("speeds", "reference", "sensors", "requirements", "search"),
)
_MOST_EVALUATIONS = 1_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How a search is made."""

    method: str
    evaluations: int
    sets: DrawnSets
    final: DrawnSets | None = None  # sets on which the best points are judged again before one is chosen


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """A design that is asked for; names of files are as seen from here."""

    name: str
    law: str
    vehicle: str
    design_rail: str
    specification: Specification
    requirements: Requirements
    effort: Effort


def shipped_specifications() -> list[str]:
    """Return the names of the specifications that ship with the program, sorted."""
    return sorted(entry.name.removesuffix(".toml") for entry in data_file(_FOLDER).iterdir())


def read_task(name_or_path: str) -> Task:
    """Read a specification.

    Parameters
    ----------
    name_or_path : str
        Name of a shipped one, or the path of a ``.toml`` file; files that it names are looked up beside it.

    Raises
    ------
    UserError
        If there is none, a key is unknown or missing, or a value impossible.
    """
    if name_or_path.endswith(".toml"):
        path = Path(name_or_path)
        return _beside(_task(read_toml(path, str(path)), str(path)), path.parent)
    names = shipped_specifications()
    if name_or_path not in names:
        raise UserError(
            f'unknown specification "{name_or_path}"{did_you_mean(name_or_path, names)}; available: '
            f"{', '.join(names)}, or the path of a .toml file"
        )
    file = f"{name_or_path}.toml"
    return _task(read_toml(data_file(_FOLDER, file), file), file)


def _task(document: dict[str, Any], where: str) -> Task:
    try:
        return _read(document, where)
    except UserError as error:  # of a quantity, a distribution or a law, which know no file
        raise error if where in str(error) else UserError(f"{where}: {error}") from None


def _read(document: dict[str, Any], where: str) -> Task:
    remedy = "wspd docs design-to-requirements"
    check_schema(document.get("schema"), SCHEMA, where, what="a specification", remedy=remedy)
    check_keys(document, _KEYS, "", where, needed=("name", "law", "vehicle", "requirements", "search"))
    words = {key: _text(document[key], key, where) for key in _WORDS if key in document}
    law = tunable_family(words["law"]).name
    requirements = read_requirements(document["requirements"], where)
    effort = _effort(table_of(document["search"], "search", where), where)
    series = {"search": effort.sets, "requirements.held_out": requirements.held_out}
    if effort.final is not None:
        series["search.final"] = effort.final
    for (one, some), (other, others) in combinations(series.items(), 2):
        if not disjoint(some, others):
            raise UserError(
                f"{one}.seed = {some.seed} and {other}.seed = {others.seed} in {where} share stops; keep the seeds "
                "farther apart than the numbers of sets, such as 1000 and 900000"
            )
    if requirements.stable_within and law != STABLE_LAW:
        raise UserError(
            f"requirements.stable_within in {where} is known for {STABLE_LAW}, not for {law}; leave it out, or "
            "take that law"
        )
    return Task(
        name=words["name"],
        law=law,
        vehicle=words["vehicle"],
        design_rail=words.get("design_rail", RAIL),
        specification=replace(specification(_options(document, where)), **how_seen(document, where, "")),
        requirements=requirements,
        effort=effort,
    )


def _options(document: dict[str, Any], where: str) -> CaseOptions:
    slip, tolerance, sample_time = (
        _text(document[key], key, where) if key in document else None for key in _OF_THE_DESIGN
    )
    speeds = document.get("speeds")
    pair = None
    if speeds is not None:
        if not isinstance(speeds, list) or len(speeds) != 2 or not all(isinstance(x, str) for x in speeds):
            raise UserError(
                f'speeds = {speeds!r} in {where} must be two speeds with units, such as ["10 km/h", "120 km/h"]'
            )
        pair = speeds[0], speeds[1]
    return CaseOptions(slip=slip, tolerance=tolerance, sample_time=sample_time, speeds=pair)


def _effort(table: dict[str, Any], where: str) -> Effort:
    known = ("method", "evaluations", "sets", "seed", "final")
    check_keys(table, known, "search.", where, needed=("evaluations", "sets", "seed"))
    method = table.get("method", "cma")
    if method not in METHODS:
        raise UserError(f"search.method = {method!r} in {where} must be one of {', '.join(METHODS)}")
    evaluations = whole(table["evaluations"], "search.evaluations", where, least=1, most=_MOST_EVALUATIONS)
    drawn = read_sets({key: table[key] for key in ("sets", "seed")}, "search", where)
    final = read_sets(table["final"], "search.final", where) if "final" in table else None
    return Effort(method=method, evaluations=evaluations, sets=drawn, final=final)


def _beside(task: Task, folder: Path) -> Task:
    return replace(
        task,
        vehicle=beside(task.vehicle, folder),
        design_rail=beside(task.design_rail, folder),
        requirements=seen_from_here(task.requirements, folder),
    )


def _text(value: object, key: str, where: str) -> str:
    if not isinstance(value, str):
        raise UserError(f"{key} = {value!r} in {where} must be text in quotes, with its unit if it has one")
    return value
