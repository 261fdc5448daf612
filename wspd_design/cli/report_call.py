"""The command of a report over its own attachments: written beside them, read from there, and run in their folder."""

import shlex
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import chdir
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_type_hints

from wspd_design.cli import options
from wspd_design.cli.arguments import check_plant, initial_speed
from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.cli.stop_options import rail_names, scenario, with_rail_names
from wspd_design.controllers.family import FAMILIES
from wspd_design.controllers.protocol import Law
from wspd_design.design.case import Case, CaseOptions, load_case
from wspd_design.design.catalog import is_design_file
from wspd_design.design.records import Design
from wspd_design.design.requirements import Requirements
from wspd_design.design.selection import named_design
from wspd_design.design.stop_requirements import StopRequirements, named_requirements
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import beside
from wspd_design.studies.inputs import (
    COMMAND,
    DESIGN,
    attached_design,
    attached_name,
    command_input,
    design_input,
    file_of,
    law_inputs,
    parameter_inputs,
    required_rails,
    requirement_inputs,
    side_by_side,
)
from wspd_design.studies.previous import PREVIOUS, Previous, previous
from wspd_design.studies.provenance import InputFile

if TYPE_CHECKING:
    from wspd_design.studies.dossier import Dossier

_HEAD = ("wspd", "report")
_CALM, _UNSAID = StopOptions(), SensorOptions()
_AS_WRITTEN = "take a report as wspd wrote it"


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportCall:
    """What a report is asked for; None where nothing was written."""

    law: str = DESIGN  # or a name, or FILE.py:NAME
    vehicle: str
    rail: str
    plant: str = options.PLANT
    speed: str | None = None
    slip: str | None = None  # of a law that is no design, as the sample time and the sensors
    sample_time: str | None = None
    seed: int = 0
    template: str | None = None
    diff: str | None = None  # record of an older report
    requirements: str | None = None  # name of a template of requirements, or a file
    ladder: bool = False  # the stop on every model of the vehicle
    sensors: SensorOptions = _UNSAID
    disturbances: StopOptions = _CALM

    @property
    def rails(self) -> tuple[str, ...]:
        """Names or paths of all rails of the stops."""
        return tuple(dict.fromkeys((self.rail, *rail_names(self.disturbances))))

    @property
    def case_options(self) -> CaseOptions:
        """What the case of the law is made with."""
        return CaseOptions(
            vehicle=self.vehicle,
            rail=self.rail,
            slip=self.slip,
            sample_time=self.sample_time,
            sensors=self.sensors.words,
        )

    def named(self, name: Callable[[str], str]) -> "ReportCall":
        """Return the call with other names of the same law, vehicle and rails."""
        return replace(
            self,
            law=name(self.law),
            vehicle=name(self.vehicle),
            rail=name(self.rail),
            requirements=None if self.requirements is None else name(self.requirements),
            disturbances=with_rail_names(self.disturbances, name),
        )

    @property
    def text(self) -> str:
        """The command line; :func:`read_call` reads it."""
        return self._after(*_HEAD)

    @property
    def simulation(self) -> str:
        """The command line that simulates the stop of the report."""
        return replace(self, template=None, diff=None, requirements=None, ladder=False)._after(
            "wspd", "simulate"
        )

    def _after(self, *head: str) -> str:
        plain = ReportCall(vehicle="", rail="")
        pairs = ((self, plain), (self.sensors, plain.sensors), (self.disturbances, plain.disturbances))
        words = [word for record, default in pairs for word in _words(record, default)]
        return shlex.join([*head, self.law, *words])


def _words(record: object, default: object) -> Iterator[str]:
    for flag, name in _flags(type(record)).items():
        value = getattr(record, name)
        if value == getattr(default, name):
            continue
        if isinstance(value, bool):
            yield flag if value else flag.replace("--", "--no-", 1)
            continue
        for each in value if isinstance(value, list) else [value]:
            yield from (flag, str(each))


def _flags(record: type) -> dict[str, str]:
    """Return the name of the field behind each flag; a test holds that the command has just these."""
    names = [each.name for each in fields(record) if each.name not in ("law", "sensors", "disturbances")]
    return {f"--{name.replace('_', '-')}": name for name in names}


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
        raise UserError(f"{COMMAND} is not a command line ({error}); {_AS_WRITTEN}") from None
    if len(words) < 3 or tuple(words[:2]) != _HEAD or words[2].startswith("-"):
        raise UserError(f'{COMMAND} must begin with "{" ".join(_HEAD)}" and a law; {_AS_WRITTEN}')
    found = _read(words[3:])
    for needed in ("vehicle", "rail"):
        if needed not in found[ReportCall]:
            raise UserError(f"{COMMAND} lacks --{needed}; {_AS_WRITTEN}")
    call = ReportCall(
        law=words[2],
        **found[ReportCall],
        sensors=SensorOptions(**found[SensorOptions]),
        disturbances=StopOptions(**found[StopOptions]),
    )
    check_plant(call.plant)
    return call


def _read(words: Sequence[str]) -> dict[type, dict[str, Any]]:
    """Sort the options by their records; each has the form that it is written in."""
    found: dict[type, dict[str, Any]] = {ReportCall: {}, SensorOptions: {}, StopOptions: {}}
    known = {flag: (record, name) for record in found for flag, name in _flags(record).items()}
    rest = iter(words)
    for word in rest:
        flag = word.replace("--no-", "--", 1)
        record, name = known.get(flag, (ReportCall, ""))
        form = str(get_type_hints(record)[name]) if name else ""
        if not name or (flag != word and form != "bool | None"):
            raise UserError(f"{COMMAND} has {word!a}, which replay does not take; {_AS_WRITTEN}")
        if "bool" in form:
            found[record][name] = flag == word
            continue
        given = next(rest, None)
        if given is None:
            raise UserError(f"{COMMAND} has no value after {word}; {_AS_WRITTEN}")
        if "int" in form and not (given.isascii() and given.isdigit() and len(given) < 20):
            raise UserError(f"{word} {given!a} in {COMMAND} must be a whole number; {_AS_WRITTEN}")
        if "list" in form:
            found[record].setdefault(name, []).append(given)
        else:
            found[record][name] = int(given) if "int" in form else given
    return found


def reported(name: str, case: Case) -> Design | Law:
    """Return the design that a report is about, or the law where no rule chose its gains."""
    if case.design is not None:
        return case.design
    if name in FAMILIES and FAMILIES[name].gains is not None:
        return named_design(name, case.vehicle, case.rail, case.specification)
    return case.controller


def over_attachments(
    case: Case, call: ReportCall, older: Previous | None = None
) -> tuple[ReportCall, tuple[InputFile, ...]]:
    """Return a call over the files that it needs side by side, and these files, the command among them.

    Parameters
    ----------
    case : Case
        The law on its vehicle and rail.
    call : ReportCall
        As it was written, but for vehicle and rail.
    older : Previous, optional
        The report to compare with.

    Raises
    ------
    UserError
        If two different files have the same name.
    """
    name = call.law
    made = reported(name, case)
    call = replace(call, vehicle=case.vehicle_name, rail=case.rail_name)
    rails, law_files = call.rails, law_inputs(name)
    if isinstance(made, Design):
        folder = Path(name).parent if is_design_file(name) else Path()
        rails = (*rails, *required_rails(made, folder))
        attached = attached_design(
            made, vehicle_name=case.vehicle_name, rail_name=case.rail_name, rail=case.rail
        )
        call = replace(call, law=DESIGN, slip=None, sample_time=None, sensors=SensorOptions())
        if call.requirements is None and made.requirements is None and made.judged_by:
            call = replace(call, requirements=beside(made.judged_by, folder))
        law_files = (design_input(attached),)
    wanted = None if call.requirements is None else named_requirements(call.requirements, case.specification)
    files = (
        *law_files,
        *requirement_inputs(call.requirements, wanted),
        *parameter_inputs("vehicle", case.vehicle_name),
        *(file for rail in rails for file in parameter_inputs("rail", rail)),
    )
    if older is not None:
        call, files = replace(call, diff=PREVIOUS), (*files, older.input)
    call = call.named(attached_name)
    return call, side_by_side((command_input(call.text), *files))


def check_names(call: ReportCall, inputs: Sequence[InputFile]) -> None:
    """Refuse a call for a file that is not among the inputs, which stand in the folder that this runs in."""
    there = {each.name for each in inputs}
    if call.diff is not None and call.diff not in there:
        raise UserError(f"{COMMAND} names {call.diff!a}, which is not attached; {_AS_WRITTEN}")
    _check_attached((call.law, call.vehicle, *call.rails, *filter(None, [call.requirements])), inputs)


def _check_attached(names: Iterable[str], inputs: Sequence[InputFile]) -> None:
    there = {each.name for each in inputs}
    for name in names:
        path = file_of(name)
        if path is not None and str(path) not in there:
            raise UserError(f"{COMMAND} names {name!a}, which is not attached; {_AS_WRITTEN}")


def _wanted(
    written: str | None, case: Case, inputs: Sequence[InputFile]
) -> StopRequirements | Requirements | None:
    """Read the requirements that a call names; their rails are shipped or attached, too."""
    if written is None:
        return None
    found = named_requirements(written, case.specification)
    if isinstance(found, Requirements):
        _check_attached((*found.rails, *(rail for rail, _ in found.stable_within)), inputs)
    return found


def compute(
    call: ReportCall,
    inputs: Sequence[InputFile],
    folder: Path,
    *,
    case: Case | None = None,
    stored: Path | None = None,
    progress: Callable[[str], None],
) -> "Dossier":
    """Write the input files into an empty folder and compute a report there, from them alone.

    Parameters
    ----------
    call : ReportCall
        With the names that the input files have.
    inputs : sequence of InputFile
        The design, and what the call names.
    folder : Path
        Where to write them.
    case : Case, optional
        With a law that is no design, where it was loaded before; by default it is loaded from the files.
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
        check_names(call, inputs)
        case = case or load_case(call.law, call.case_options)
        made = reported(call.law, case)
        older = None if call.diff is None else previous(Path(call.diff).read_text("utf-8"), call.diff)
        return dossier(
            made,
            vehicle=call.vehicle,
            rail=call.rail,
            scenario=scenario(
                case.rail,
                call.disturbances,
                initial_speed=initial_speed(call.speed, case.specification),
                seed=call.seed,
                vehicle=case.vehicle,
            ),
            specification=None if isinstance(made, Design) else case.specification,
            baselines=[other for other in FAMILIES if other not in (made.name, call.law)],
            command=call.text,
            stop_command=call.simulation,
            previous=older,
            inputs=inputs,
            written="" if isinstance(made, Design) else call.law,
            plant=call.plant,
            stored=stored,
            requirements=_wanted(call.requirements, case, inputs),
            ladder=call.ladder,
            progress=progress,
        )
