"""The command of a report over its own attachments: written beside them, read from there, and run in their folder."""

import shlex
from collections.abc import Callable, Sequence
from contextlib import chdir
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_type_hints

from wspd_design.cli import options
from wspd_design.cli.arguments import check_plant, initial_speed
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.stop_options import rail_names, scenario, with_rail_names
from wspd_design.controllers.family import FAMILIES
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.parameters.errors import UserError
from wspd_design.studies.inputs import COMMAND, DESIGN, file_of
from wspd_design.studies.provenance import InputFile

if TYPE_CHECKING:
    from wspd_design.studies.dossier import Dossier

_HEAD = ("wspd", "report", DESIGN)
_CALM = StopOptions()


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportCall:
    """What a report is asked for beside its design; None where nothing was written."""

    vehicle: str
    rail: str
    plant: str = options.PLANT
    speed: str | None = None
    seed: int = 0
    disturbances: StopOptions = _CALM

    @property
    def rails(self) -> tuple[str, ...]:
        """Names or paths of all rails of the stops."""
        return tuple(dict.fromkeys((self.rail, *rail_names(self.disturbances))))

    def named(self, name: Callable[[str], str]) -> "ReportCall":
        """Return the call with other names of the same vehicle and rails."""
        return replace(
            self,
            vehicle=name(self.vehicle),
            rail=name(self.rail),
            disturbances=with_rail_names(self.disturbances, name),
        )

    @property
    def text(self) -> str:
        """The command line; :func:`read_call` reads it."""
        plain = ReportCall(vehicle="", rail="")
        words = [*_HEAD]
        for record, default in ((self, plain), (self.disturbances, plain.disturbances)):
            for name, flag in _flags(type(record)).items():
                value = getattr(record, name)
                if value == getattr(default, name):
                    continue
                for each in value if isinstance(value, list) else [value]:
                    words += [flag] if each is True else [flag, str(each)]
        return shlex.join(words)


def _flags(record: type) -> dict[str, str]:
    """Return the flag of each option; a test holds that the command has just these."""
    names = [each.name for each in fields(record) if each.name != "disturbances"]
    return {name: f"--{name.replace('_', '-')}" for name in names}


def read_call(text: str) -> ReportCall:
    """Read a command line as :attr:`ReportCall.text` writes it, and nothing else: it may come from a stranger.

    Raises
    ------
    UserError
        If it is another one.
    """
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise UserError(
            f"{COMMAND} is not a command line ({error}); take a report as wspd wrote it"
        ) from None
    if tuple(words[:3]) != _HEAD:
        raise UserError(f'{COMMAND} must begin with "{" ".join(_HEAD)}"; take a report as wspd wrote it')
    own, stop = _read(words[3:])
    for needed in ("vehicle", "rail"):
        if needed not in own:
            raise UserError(f"{COMMAND} lacks --{needed}; take a report as wspd wrote it")
    call = ReportCall(**own, disturbances=StopOptions(**stop))
    check_plant(call.plant)
    return call


def _read(words: Sequence[str]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Sort the options by the two records; each has the form that it is written in."""
    found: dict[type, dict[str, Any]] = {ReportCall: {}, StopOptions: {}}
    known = {flag: (record, name) for record in found for name, flag in _flags(record).items()}
    rest = iter(words)
    for word in rest:
        if word not in known:
            raise UserError(
                f"{COMMAND} has {word!a}, which replay does not take; take a report as wspd wrote it"
            )
        record, name = known[word]
        form = str(get_type_hints(record)[name])
        given: Any = True if form == str(bool) else next(rest, None)
        if given is None:
            raise UserError(f"{COMMAND} has no value after {word}; take a report as wspd wrote it")
        if "int" in form:
            if not (given.isascii() and given.isdigit() and len(given) < 20):
                raise UserError(f"{word} {given!a} in {COMMAND} must be a whole number")
            given = int(given)
        if "list" in form:
            found[record].setdefault(name, []).append(given)
        else:
            found[record][name] = given
    return found[ReportCall], found[StopOptions]


def compute(
    call: ReportCall,
    inputs: Sequence[InputFile],
    folder: Path,
    *,
    stored: Path | None = None,
    progress: Callable[[str], None],
) -> "Dossier":
    """Write the input files into an empty folder and compute a report there, from them alone.

    Parameters
    ----------
    call : ReportCall
        With the names that the input files have.
    inputs : sequence of InputFile
        The design and what the call names.
    folder : Path
        Where to write them.
    stored : Path, optional
        Folder of certificates that were found before.
    progress : callable
        Told each stage before it starts.

    Raises
    ------
    UserError
        If the call names a file that is not there, or a file is wrong.
    """
    from wspd_design.studies.dossier import dossier

    for each in inputs:
        (folder / each.name).write_text(each.text, encoding="utf-8", newline="")
    stored = None if stored is None else stored.resolve()
    with chdir(folder):  # so that every name is that of an attachment
        there = {each.name for each in inputs}
        for name in (call.vehicle, *call.rails):
            path = file_of(name)
            if path is not None and str(path) not in there:
                raise UserError(
                    f"{COMMAND} names {name!a}, which is not attached; take a report as wspd wrote it"
                )
        case = load_case(DESIGN, CaseOptions(vehicle=call.vehicle, rail=call.rail))
        assert case.design is not None, "a design file gives a design"
        return dossier(
            case.design,
            vehicle_name=call.vehicle,
            rail_name=call.rail,
            scenario=scenario(
                case.rail,
                call.disturbances,
                initial_speed=initial_speed(call.speed, case.specification),
                seed=call.seed,
                vehicle=case.vehicle,
            ),
            baselines=[other for other in FAMILIES if other != case.design.name],
            command=call.text,
            inputs=inputs,
            plant=call.plant,
            stored=stored,
            progress=progress,
        )
