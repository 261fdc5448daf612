"""What a protection must reach, on which stops: limits, rails, draws and held-out sets, as a table of TOML files.

The table stands in a specification, and in the design that was made for it, so that every later reader can judge the
design by the same stops again.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from wspd_design.design.criteria import CRITERIA, Criterion
from wspd_design.design.draw_table import dimension_of, draws_text, flat, number_of, quantity_text, read_draws
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import beside, uniform_rails
from wspd_design.parameters.words import near_or_allowed
from wspd_design.simulation.draws import FILE_KINDS, Draw

_KEYS = ("rails", "within_bounds", "certificates", "stable_within", "held_out", "limits", "stop", "draw")
MOST_SETS = 1_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """A limit of one criterion."""

    criterion: str
    value: float  # SI
    source: str = ""  # where the limit comes from; empty: the author of the table chose it
    verified: bool = False  # whether somebody has compared it with that source

    @property
    def rule(self) -> Criterion:
        """What is limited."""
        return CRITERIA[self.criterion]

    def with_reserve(self) -> "Limit":
        """Return the limit that a search keeps so that stops that it has not seen keep this one."""
        return replace(self, value=self.rule.with_reserve(self.value))


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnSets:
    """How many drawn sets of vehicle, rail and stop there are, and the seed that they come from."""

    sets: int
    seed: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Requirements:
    """Limits, and the stops on which they must be met."""

    rails: tuple[str, ...]  # shipped names or paths; the sets take them in turn
    within_bounds: tuple[str, ...] = ()  # files whose bounds are drawn from: "vehicle", "rail"
    certificates: tuple[str, ...] = ()  # checks that must be proved
    stable_within: tuple[
        tuple[str, float], ...
    ] = ()  # rail, and share of the box on which quadratic functions must be found
    held_out: DrawnSets  # sets that no search has seen
    limits: tuple[Limit, ...]
    stop: tuple[tuple[str, float], ...]  # numbers of every stop by the names of the drawing, SI
    draws: tuple[Draw, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Judged:
    """What was reached of one requirement."""

    requirement: str  # name of the criterion, or of the key of the requirements
    title: str
    limit: float | None  # SI; None where there is none: the criterion is told, not limited
    reached: float | None  # SI; None where the law has no such figure
    met: bool | None  # None where there is no limit


def judged_by(limits: tuple[Limit, ...], reached: Mapping[str, float]) -> tuple[Judged, ...]:
    """Compare what was reached with the limits; criteria without a limit are told as well."""
    known = {limit.criterion: limit.value for limit in limits}
    return tuple(
        Judged(
            requirement=name,
            title=rule.title,
            limit=known.get(name),
            reached=reached.get(name),
            met=None
            if name not in known
            else name in reached and not rule.excess(reached[name], known[name]),
        )
        for name, rule in CRITERIA.items()
        if name in known or name in reached
    )


def read_requirements(table: object, where: str) -> Requirements:
    """Read the table [requirements] of a file.

    Parameters
    ----------
    table : object
        What TOML gives for it.
    where : str
        The file, in sentences.

    Raises
    ------
    UserError
        If a key is unknown or missing, or a value impossible.
    """
    stated = table_of(table, "requirements", where)
    check_keys(stated, _KEYS, "requirements.", where, needed=("rails", "held_out", "limits", "stop"))
    rails = texts(stated["rails"], "requirements.rails", where)
    bounded = texts(stated.get("within_bounds", []), "requirements.within_bounds", where, empty=True)
    for kind in bounded:
        if kind not in FILE_KINDS:
            raise UserError(
                f'requirements.within_bounds in {where} names "{kind}"; it may name {" and ".join(FILE_KINDS)}'
            )
    stop = _stop(table_of(stated["stop"], "requirements.stop", where), where)
    draws = read_draws(table_of(stated.get("draw", {}), "requirements.draw", where), where)
    for name, _ in stop:
        if any(draw.name == name for draw in draws):
            raise UserError(
                f"{name} stands in requirements.stop and in requirements.draw of {where}; leave one out"
            )
    return Requirements(
        rails=rails,
        within_bounds=bounded,
        certificates=texts(stated.get("certificates", []), "requirements.certificates", where, empty=True),
        stable_within=_stable(
            table_of(stated.get("stable_within", {}), "requirements.stable_within", where), where
        ),
        held_out=read_sets(stated["held_out"], "requirements.held_out", where),
        limits=read_limits(table_of(stated["limits"], "requirements.limits", where), where, over_many=True),
        stop=stop,
        draws=draws,
    )


def requirements_text(requirements: Requirements) -> str:
    """Return the TOML text of the table; reading it gives the same requirements back."""
    held_out = requirements.held_out
    lines = [
        "[requirements]",
        f"rails = {_listed(requirements.rails)}",
        f"within_bounds = {_listed(requirements.within_bounds)}",
        f"certificates = {_listed(requirements.certificates)}",
        f"held_out = {{ sets = {held_out.sets}, seed = {held_out.seed} }}",
        "",
        "[requirements.limits]",
        *(_limit_text(limit) for limit in requirements.limits),
        "",
        "[requirements.stop]",
    ]
    for name, value in requirements.stop:
        dimension = dimension_of(name)
        assert dimension is not None, "a number of a stop that was read has a dimension"
        lines.append(f"{name.removeprefix('stop.')} = {quantity_text(value, dimension)}")
    if requirements.stable_within:
        lines += ["", "[requirements.stable_within]"]
        lines += [
            f"{json.dumps(rail, ensure_ascii=False)} = {quantity_text(share, 'ratio')}"
            for rail, share in requirements.stable_within
        ]
    if requirements.draws:
        lines += ["", "[requirements.draw]", draws_text(requirements.draws)]
    return "\n".join(lines) + "\n"


def seen_from_here(requirements: Requirements, folder: Path) -> Requirements:
    """Return requirements of a file in a folder with the paths of rails as they are seen from here."""
    return replace(
        requirements,
        rails=tuple(beside(name, folder) for name in requirements.rails),
        stable_within=tuple((beside(name, folder), share) for name, share in requirements.stable_within),
    )


def read_sets(table: object, what: str, where: str) -> DrawnSets:
    """Read how many sets there are and their seed."""
    stated = table_of(table, what, where)
    check_keys(stated, ("sets", "seed"), f"{what}.", where, needed=("sets", "seed"))
    return DrawnSets(
        sets=whole(stated["sets"], f"{what}.sets", where, least=1, most=MOST_SETS),
        seed=whole(stated["seed"], f"{what}.seed", where, least=0, most=2**62),
    )


def _limit_text(limit: Limit) -> str:
    """Return the line of a limit, short where nothing is known about its source."""
    value = quantity_text(limit.value, limit.rule.dimension)
    if not limit.source and not limit.verified:
        return f"{limit.criterion} = {value}"
    source, verified = json.dumps(limit.source, ensure_ascii=False), str(limit.verified).lower()
    return f"{limit.criterion} = {{ limit = {value}, source = {source}, verified = {verified} }}"


def read_limits(table: dict[str, Any], where: str, *, over_many: bool) -> tuple[Limit, ...]:
    """Read the limits by their criteria, each a quantity or a table with the source of the limit.

    Parameters
    ----------
    table : dict
        What TOML gives.
    where : str
        The file, in sentences.
    over_many : bool
        Whether they are limits of many drawn stops: some criteria are known of the stop of a report alone.

    Raises
    ------
    UserError
        If a criterion is unknown or a limit impossible.
    """
    known = tuple(name for name, rule in CRITERIA.items() if not (over_many and rule.of_report))
    for name in table:
        if name in CRITERIA and name not in known:
            raise UserError(
                f"requirements.limits.{name} in {where} is known of a single stop alone; leave it out, or leave out "
                "rails, held_out and stop, so that the stop of a report is judged"
            )
    check_keys(table, known, "requirements.limits.", where)
    limits = []
    for name, written in table.items():
        rule = CRITERIA[name]
        place = f"requirements.limits.{name} in {where}"
        given, source, verified = _sourced(written, f"requirements.limits.{name}", where)
        value = number_of(given, rule.dimension, place)
        least = 0.0 if rule.dimension != "ratio" or not rule.at_least else 1e-3
        if not least <= value < float("inf") or (rule.at_least and value >= 1.0):
            allowed = "lie in (0, 1), such as 0.95 or 95 %" if rule.at_least else "be finite and not negative"
            raise UserError(f"{place} = {given} must {allowed}")
        limits.append(Limit(criterion=name, value=value, source=source, verified=verified))
    return tuple(limits)


def _sourced(written: object, name: str, where: str) -> tuple[Any, str, bool]:
    """Part a limit into its quantity, the source of it, and whether that was verified."""
    if not isinstance(written, dict):
        return written, "", False
    check_keys(written, ("limit", "source", "verified"), f"{name}.", where, needed=("limit",))
    source, verified = written.get("source", ""), written.get("verified", False)
    if not isinstance(source, str) or not isinstance(verified, bool) or (verified and not source.strip()):
        raise UserError(
            f"{name} in {where} must have a source in quotes and verified = true or false, and what is verified has a "
            'source, such as { limit = "0.4 s", source = "contract 12, section 3", verified = true }'
        )
    return written["limit"], source, verified


def _stable(table: dict[str, Any], where: str) -> tuple[tuple[str, float], ...]:
    found = []
    for rail, given in table.items():
        place = f"requirements.stable_within.{rail} in {where}"
        share = number_of(given, "ratio", place)
        if not 0.0 < share <= 1.0:
            raise UserError(
                f"{place} = {given} must lie in (0, 1]; 100 % is the box that vehicle and rail state"
            )
        found.append((rail, share))
    return tuple(found)


def _stop(table: dict[str, Any], where: str) -> tuple[tuple[str, float], ...]:
    found = []
    for short, given in flat(table):
        name = f"stop.{short}"
        dimension = dimension_of(name)
        place = f"requirements.stop.{short} in {where}"
        if dimension is None:
            raise UserError(
                f"{place} is not a number of a stop; write for example initial_speed or sensing.dead_time"
            )
        if isinstance(given, bool):
            given = float(given)
        value = number_of(given, dimension, place)
        if value != value or abs(value) == float("inf"):
            raise UserError(f"{place} = {given} must be a finite number")
        found.append((name, value))
    if "stop.initial_speed" not in dict(found):
        raise UserError(f'requirements.stop in {where} lacks initial_speed; add initial_speed = "120 km/h"')
    return tuple(found)


def table_of(value: object, name: str, where: str) -> dict[str, Any]:
    """Refuse what is not a table."""
    if not isinstance(value, dict):
        raise UserError(f"{name} = {value!r} in {where} must be a table; write [{name}]")
    return value


def check_keys(
    table: Mapping[str, Any], known: tuple[str, ...], prefix: str, where: str, *, needed: tuple[str, ...] = ()
) -> None:
    """Refuse keys that are not known, and tables that lack one that is needed."""
    for key in table:
        if key not in known:
            raise UserError(f"unknown key {prefix}{key} in {where}; {near_or_allowed(key, known, prefix)}")
    for key in needed:
        if key not in table:
            raise UserError(f"{prefix}{key} is missing in {where}; add it (wspd docs design-to-requirements)")


def texts(value: object, name: str, where: str, *, empty: bool = False) -> tuple[str, ...]:
    """Read a list of texts, each once."""
    listed = [each for each in value if isinstance(each, str)] if isinstance(value, list) else None
    if listed is None or listed != value or (not listed and not empty) or len(set(listed)) < len(listed):
        example = f'["{uniform_rails()[0]}"]'
        raise UserError(
            f"{name} = {value!r} in {where} must be a list of texts, each once, such as {example}"
        )
    return tuple(listed)


def whole(value: object, name: str, where: str, *, least: int, most: int) -> int:
    """Read a whole number within limits."""
    if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
        raise UserError(f"{name} = {value!r} in {where} must be a whole number from {least} to {most}")
    return value


def _listed(names: tuple[str, ...]) -> str:
    return f"[{', '.join(json.dumps(name, ensure_ascii=False) for name in names)}]"
