"""The file of a campaign: laws, vehicle, rails, stop and what each stop draws, as TOML with units."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from types import UnionType
from typing import Any, get_args, get_type_hints

from wspd_design.cli.arguments import check_plant, initial_speed
from wspd_design.cli.campaign import Series
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.options import CONTROLLER, PLANT
from wspd_design.cli.stop_options import along_the_track, scenario
from wspd_design.design.case import RAIL, VEHICLE, CaseOptions, load_case
from wspd_design.design.draw_table import read_draws
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import load_entries, read_toml
from wspd_design.parameters.words import did_you_mean
from wspd_design.simulation.campaign import CHECK_EVERY
from wspd_design.simulation.description import rails_of
from wspd_design.simulation.draws import FILE_KINDS, within_bounds


@dataclass(frozen=True, slots=True, kw_only=True)
class CampaignFile:
    """What a campaign is; its laws and rails draw the same numbers, so that they can be compared stop by stop."""

    series: tuple[Series, ...]  # each law on each rail
    plant: str
    stops: int  # of each series
    check_every: int


@dataclass(frozen=True, slots=True, kw_only=True)
class _Words:
    """The keys of the file with what holds where they are left out."""

    stops: int
    controllers: list[str]
    vehicle: str = VEHICLE
    rails: list[str]
    plant: str = PLANT
    speed: str | None = None
    slip: str | None = None
    sample_time: str | None = None
    seed: int = 0
    check_every: int = CHECK_EVERY
    within_bounds: list[str]
    disturbances: dict[str, Any]
    draw: dict[str, Any]


_DEFAULTS: dict[str, Callable[[], Any]] = {
    "controllers": lambda: [CONTROLLER],
    "rails": lambda: [RAIL],
    "within_bounds": list,
    "disturbances": dict,
    "draw": dict,
}


def read_campaign(path: Path) -> CampaignFile:
    """Read the file of a campaign; names of files in it are looked up beside it.

    Raises
    ------
    UserError
        If a key is unknown, a value is impossible or a name cannot be loaded.
    """
    where = str(path)
    words = _words(read_toml(path, where), where)
    check_plant(words.plant)
    for kind in words.within_bounds:
        if kind not in FILE_KINDS:
            raise UserError(
                f'within_bounds in {where} names "{kind}"; it may name {" and ".join(FILE_KINDS)}'
            )
    given = _disturbances(words.disturbances, where)
    drawn = read_draws(words.draw, where)
    series = []
    for law in words.controllers:
        for rail in words.rails:
            first, along = along_the_track(_beside(rail, path), given)
            options = CaseOptions(
                vehicle=_beside(words.vehicle, path),
                rail=first,
                slip=words.slip,
                sample_time=words.sample_time,
            )
            case = load_case(_beside(law, path), options)
            bounded = within_bounds(
                *(
                    load_entries(FILE_KINDS[kind], name)
                    for kind, name in (("vehicle", case.vehicle_name), ("rail", case.rail_name))
                    if kind in words.within_bounds
                )
            )
            named = {draw.name for draw in drawn}
            series.append(
                Series(
                    case=case,
                    scenario=scenario(
                        case.rail,
                        along,
                        initial_speed=initial_speed(words.speed, case.specification),
                        seed=words.seed,
                        vehicle=case.vehicle,
                    ),
                    draws=(*(draw for draw in bounded if draw.name not in named), *drawn),
                )
            )
    told = {rails_of(each.scenario) for each in series}
    if len(told) < len(words.rails):
        raise UserError(
            f"two rails of {where} are told alike, and their rows could not be told apart: {', '.join(sorted(told))}; "
            "run them in campaigns of their own"
        )
    return CampaignFile(
        series=tuple(series), plant=words.plant, stops=words.stops, check_every=words.check_every
    )


def _beside(name: str, path: Path) -> str:
    """Name of a file as seen from here; other names stay."""
    file, colon, law = name.rpartition(":") if ".py:" in name else (name, "", "")
    return f"{path.parent / file}{colon}{law}" if file.endswith((".toml", ".py")) else name


def _words(document: dict[str, Any], where: str) -> _Words:
    hints = get_type_hints(_Words)
    for key, value in document.items():
        _known(key, list(hints), f"key in {where}")
        _check_type(key, value, hints[key], where)
    if "stops" not in document:
        raise UserError(f"{where} does not say how many stops; add a line such as stops = 1000")
    words = _Words(**{key: make() for key, make in _DEFAULTS.items() if key not in document}, **document)
    for key, least in (("stops", 1), ("seed", 0), ("check_every", 0)):
        if getattr(words, key) < least:
            raise UserError(f"{key} = {getattr(words, key)} in {where} must be at least {least}")
    for key in ("controllers", "rails"):
        names = getattr(words, key)
        if not names or len(set(names)) < len(names):
            raise UserError(f"{key} = {names} in {where} must name one or more, each once")
    return words


def _check_type(key: str, value: Any, hint: Any, where: str) -> None:
    kinds = get_args(hint) if isinstance(hint, UnionType) else (hint,)
    for kind, said in (
        (bool, "true or false"),
        (int, "a whole number"),
        (str, "text with its unit, in quotes"),
    ):
        if kind in kinds:
            good = isinstance(value, kind) and (kind is bool or not isinstance(value, bool))
            if not good:
                raise UserError(f"{key} = {value!r} in {where} must be {said}")
            return
    if any(getattr(kind, "__origin__", None) is list for kind in kinds):
        if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
            raise UserError(f'{key} = {value!r} in {where} must be a list of texts, such as ["{RAIL}"]')
    elif not isinstance(value, dict):
        raise UserError(f"{key} = {value!r} in {where} must be a table; write [{key}]")


def _disturbances(table: dict[str, Any], where: str) -> StopOptions:
    hints = get_type_hints(StopOptions)
    for key, value in table.items():
        _known(key, [each.name for each in fields(StopOptions)], f"key of [disturbances] in {where}")
        _check_type(key, value, hints[key], where)
    return StopOptions(**table)


def _known(key: str, names: list[str], what: str) -> None:
    if key not in names:
        raise UserError(f'unknown {what}: "{key}"{did_you_mean(key, names)}; it may have {", ".join(names)}')
