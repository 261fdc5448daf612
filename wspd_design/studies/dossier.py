"""Everything that a report shows about a design, computed once."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from wspd_design.analysis.brake_sheet import BrakeSheet, brake_sheet
from wspd_design.analysis.linearization import Linearization, linearized
from wspd_design.analysis.stopping import full_adhesion_stop
from wspd_design.certificates.memory import remembering
from wspd_design.certificates.records import Certificate
from wspd_design.certificates.suite import verify
from wspd_design.controllers.family import FAMILIES
from wspd_design.controllers.offers import Surface
from wspd_design.controllers.protocol import Law
from wspd_design.design.adhesion_use import adhesion_sentence, used_adhesion
from wspd_design.design.case import specification_of
from wspd_design.design.catalog import controller, controller_of, is_design_file
from wspd_design.design.file import read_design
from wspd_design.design.industry import usual_table
from wspd_design.design.own_controller import is_own_controller
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Design, Specification
from wspd_design.design.requirements import Requirements, seen_from_here
from wspd_design.design.selection import named_design
from wspd_design.design.stop_requirements import StopRequirements, named_requirements, paper_requirements
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available, beside, load_entries
from wspd_design.parameters.given import given_entries
from wspd_design.parameters.laden import laden
from wspd_design.parameters.loading import load_rail, load_vehicle, vehicle_of
from wspd_design.parameters.provenance import ParameterSet
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.schema import PRESETS, Kind
from wspd_design.parameters.taken import check_record
from wspd_design.plants.names import DEFAULT_PLANT
from wspd_design.simulation.comparison import Trial, compare
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Run
from wspd_design.simulation.taken import check_law
from wspd_design.studies.faults import Robustness, robustness
from wspd_design.studies.inputs import design_input, law_inputs, parameter_inputs, python_input, side_by_side
from wspd_design.studies.judgment import Judgment, judgment
from wspd_design.studies.ladder import Ladder, models_of
from wspd_design.studies.ladder import ladder as climb
from wspd_design.studies.loop_growth import Growth, growth_of
from wspd_design.studies.next_step import NextStep, next_step
from wspd_design.studies.previous import Previous
from wspd_design.studies.provenance import InputFile, Provenance, provenance
from wspd_design.studies.reported_law import ReportedLaw, reported_law
from wspd_design.studies.uncertainty import Uncertainty, uncertainty

POLE_SPEEDS = 60  # points of the pole map


@dataclass(frozen=True, slots=True, kw_only=True)
class PhasePlane:
    """What the law of the first wheelset saw above the judging speed, and its surface e + c int e."""

    integral: tuple[float, ...]  # s, of the slip error, as the law remembers it
    error: tuple[float, ...]  # -, slip reference minus slip
    surface_rate: float  # 1/s, c
    layer: float  # -, boundary layer in slip


@dataclass(frozen=True, slots=True, kw_only=True)
class Dossier:
    """A law, the numbers it rests on, its linearizations, certificates and simulated stops."""

    law: ReportedLaw
    specification: Specification  # what is asked of it
    design: Design | None  # None for a law without gains that were chosen
    vehicle: ParameterSet
    rail: ParameterSet
    other_parameters: tuple[ParameterSet, ...]  # constants, the design rail if another, and the baselines
    compared_designs: tuple[Design, ...]  # of the laws among the baselines that have gains
    brake: BrakeSheet  # on full adhesion
    adhesion_use: str  # how much of what the rail gives the brake asks for, in the range of the design
    idle: bool  # the brake asks for less than the rail gives, and no wheel slides in the design's own stop
    linearizations: tuple[Linearization, ...]  # over speed, at the slip reference
    certificates: tuple[Certificate, ...]
    trials: tuple[Trial, ...]  # the design's own stop first
    phase_plane: PhasePlane | None  # of laws with a sliding surface
    growth: Growth | None  # near the reference; None where no check of the loop speaks about the law
    judgment: Judgment  # by its requirements
    next_step: NextStep | None  # of a law that is not accepted and had something to do
    robustness: Robustness | None  # where wheelsets differ
    uncertainty: Uncertainty | None  # where numbers have bounds
    ladder: Ladder | None  # where it was asked for
    scenario: Scenario  # of the stops
    previous: Previous | None  # report to compare with
    provenance: Provenance


@remembering()  # laws to compare with are alternatives, too
def dossier(
    made: Design | Law,
    *,
    vehicle: Vehicle | Path | str,
    rail: Rail | Path | str,
    scenario: Scenario,
    specification: Specification | None = None,
    baselines: Sequence[str] = (),
    command: str = "",
    inputs: Sequence[InputFile] = (),
    stop_command: str = "",
    previous: Previous | None = None,
    written: str = "",
    plant: str = DEFAULT_PLANT,
    stored: Path | None = None,
    folder: Path = Path(),
    requirements: StopRequirements | Requirements | None = None,
    ladder: bool = False,
    progress: Callable[[str], None] = lambda _stage: None,
) -> Dossier:
    """Compute everything about a law.

    Parameters
    ----------
    made : Design or Law
        The design; or any controller of a wheelset or of a vehicle, which needs no design.
    vehicle, rail : Vehicle, Rail, Path or str
        Of the stops: records, shipped names or files.
    scenario : Scenario
        The stops, on this rail; its seed is that of the sampled checks, too.
    specification : Specification, optional
        What is asked of a law that is no design; by default the paper's case with the slip and the sample time of the
        law.
    baselines : sequence of str
        Controllers to compare with.
    command : str
        That makes the report from the input files; empty for a report that was made in Python.
    inputs : sequence of InputFile
        What the command makes it from; without a command, the design and the vehicle, rail and law of one's own.
    stop_command : str
        ``wspd simulate`` with what the command says about the stop, so that drawn ones can be simulated again.
    previous : Previous, optional
        An older report; the changes since then are told.
    written : str
        What the user called a law that is no design: its name, or ``FILE.py:NAME``, and then the file travels with the
        report.
    plant : {"planar", "quarter", "locomotive", "locomotive-linear"}
        Of the stops; the certificates speak about the quarter model.
    stored : Path, optional
        Folder of certificate files; what the checkers accept of it for this design is not searched again.
    folder : Path
        Of the design file, from which the rails of its requirements are seen.
    requirements : StopRequirements or Requirements, optional
        That the law is judged by: those of the design by default, and what the paper asks for of one without.
    ladder : bool
        Whether to simulate the stop on every model of the vehicle.
    progress : callable, optional
        Told each stage before it starts.

    Returns
    -------
    Dossier
        Records only.

    Raises
    ------
    UserError
        If a name is unknown, a number of vehicle or rail is impossible, or the law fails.
    """
    import numpy as np

    design = made if isinstance(made, Design) else None
    if design is None:
        check_law(made, by="dossier")
    check_record(
        scenario, Scenario, by="dossier", remedy="make one with Scenario.stop(from_kmh=120, rail=rail)"
    )
    vehicle_set, rail_set = _stated("vehicle", vehicle), _stated("rail", rail)
    of_vehicle = vehicle_of(vehicle_set) if isinstance(vehicle, Vehicle) else load_vehicle(vehicle)
    of_rail = rail if isinstance(rail, Rail) else load_rail(rail)
    own = controller_of(made, of_vehicle, of_rail) if isinstance(made, Design) else made
    asked = _asked(made, specification)
    progress("linearization")
    speeds = np.geomspace(1.0, max(asked.speeds[1], scenario.initial_speed), POLE_SPEEDS)
    linearizations = tuple(linearized(of_vehicle, of_rail, slip=asked.slip, speed=float(v)) for v in speeds)
    problem = stability_problem(of_vehicle, of_rail, own, asked, seed=scenario.seed)
    certificates = verify(problem, progress=progress, stored=stored)
    growth = growth_of(problem, certificates)
    shared = replace(asked, reference=None)  # which is for the law of the report alone
    others = [_baseline(name, of_vehicle, of_rail, shared) for name in baselines]
    controllers = [own, *(law for law, _ in others)]
    trials = compare(
        of_vehicle,
        controllers,
        scenario,
        slip_reference=asked.slip,
        plant=plant,
        progress=progress,
    )
    # No other law can do better in a stop that leaves it nothing to do; drawn stops have rails of their own.
    idle = used_adhesion(of_vehicle, of_rail, asked.speeds)[0] < 1.0 and math.isnan(
        trials[0].metrics.slip_reached
    )
    vehicle_name = "" if isinstance(vehicle, Vehicle) else str(vehicle)
    full_adhesion = _full_adhesion(of_vehicle, scenario)
    judged = judgment(
        own,
        requirements or _own_requirements(design, folder, asked),
        vehicle=of_vehicle,
        vehicle_name=vehicle_name,
        speeds=asked.speeds,
        own=trials[0],
        certificates=certificates,
        growth=growth,
        full_adhesion=full_adhesion,
        progress=progress,
    )
    told = reported_law(own, design, written=written)
    if not command:
        inputs = side_by_side(
            (
                *([] if design is None else [design_input(design)]),
                *parameter_inputs("vehicle", vehicle),
                *parameter_inputs("rail", rail),
                *law_inputs(written),
                python_input(own, scenario, plant),
            )
        )
    named = [written] if written and design is None and not is_own_controller(written) else []
    return Dossier(
        law=told,
        specification=asked,
        design=design,
        vehicle=vehicle_set,
        rail=rail_set,
        other_parameters=_other_parameters(design, of_vehicle, of_rail, [*named, *baselines]),
        compared_designs=tuple(each for _, each in others if each is not None),
        brake=brake_sheet(of_vehicle),
        adhesion_use=adhesion_sentence(of_vehicle, of_rail, asked.speeds),
        idle=idle,
        linearizations=linearizations,
        certificates=certificates,
        trials=trials,
        phase_plane=phase_plane(trials[0].run, own) if isinstance(own, Surface) else None,
        growth=growth,
        judgment=judged,
        next_step=None
        if judged.accepted or (idle and isinstance(judged.wanted, StopRequirements))
        else next_step(
            judged,
            law=None if design is None else design.law,
            vehicle=of_vehicle,
            vehicle_name=vehicle_name,
            rail=of_rail,
            asked=shared,
            scenario=scenario,
            plant=plant,
            certificates=certificates,
            full_adhesion=full_adhesion,
            compared=list(zip(controllers, trials, strict=True)),
            progress=progress,
        ),
        robustness=robustness(of_vehicle, own, scenario, plant=plant, progress=progress),
        uncertainty=uncertainty(
            of_vehicle,
            own,
            scenario,
            trials[0],
            slip_reference=asked.slip,
            parameters=(vehicle_set, rail_set),
            laden=vehicle_of(laden(vehicle_set)) if "laden.mass" in vehicle_set.entries else None,
            plant=plant,
            command=stop_command,
            progress=progress,
        ),
        ladder=climb(
            of_vehicle,
            own,
            scenario,
            slip_reference=asked.slip,
            models=models_of(of_vehicle),
            progress=lambda model: progress(f"ladder of models: {model}"),
        )
        if ladder
        else None,
        scenario=scenario,
        previous=previous,
        provenance=provenance(command=command, seed=scenario.seed, inputs=inputs, certificates=certificates),
    )


def _full_adhesion(vehicle: Vehicle, scenario: Scenario) -> float:
    """Return the distance while no wheel slides [m]; NaN on a grade that the brake does not hold."""
    try:
        return full_adhesion_stop(vehicle, scenario.initial_speed, grade=scenario.grade).distance
    except UserError:
        return math.nan


def _own_requirements(
    design: Design | None, folder: Path, asked: Specification
) -> StopRequirements | Requirements:
    """Return the table that a design holds or names, and what the paper asks where it does neither."""
    if design is None or not (design.requirements or design.judged_by):
        return paper_requirements(asked)
    if design.requirements is not None:
        return seen_from_here(design.requirements, folder)
    return named_requirements(beside(design.judged_by, folder), asked)


def _asked(made: Design | Law, specification: Specification | None) -> Specification:
    """Return what is asked of a law."""
    if not isinstance(made, Design):
        return specification or specification_of(made)
    if specification is not None:
        raise UserError(f"design {made.name} has its own specification; leave specification out")
    return made.specification


def _stated(kind: Kind, given: Vehicle | Rail | Path | str) -> ParameterSet:
    """Return what is stated about a vehicle or rail."""
    return given_entries(given) if isinstance(given, Vehicle | Rail) else load_entries(kind, given)


def phase_plane(run: Run, law: Surface) -> PhasePlane:
    """Return the path of a stop in the plane of the slip error and its integral."""
    import numpy as np

    times = [sample.time for sample in run.samples]
    judged = np.interp(times, run.time, run.speed) > JUDGING_SPEED
    errors = law.slip_reference - np.interp(times, run.time, run.slip[:, run.first_braked])
    # A sample remembers the state after its step; the law decided by the integral before it.
    integrals = np.array([0.0, *(sample.state[0] for sample in run.samples[:-1])])
    return PhasePlane(
        integral=tuple(integrals[judged].tolist()),
        error=tuple(errors[judged].tolist()),
        surface_rate=law.surface_rate,
        layer=law.layer,
    )


def _baseline(
    name: str, vehicle: Vehicle, rail: Rail, specification: Specification
) -> tuple[Law, Design | None]:
    """Build a controller to compare with, and return the design behind it if it has one."""
    if is_design_file(name):
        found = read_design(name)
    elif name in FAMILIES and FAMILIES[name].gains is not None:
        found = named_design(name, vehicle, rail, specification)
    else:
        return controller(name, vehicle, rail, specification), None
    return controller_of(found, vehicle, rail), found


def _other_parameters(
    made: Design | None, vehicle: Vehicle, rail: Rail, laws: Sequence[str]
) -> tuple[ParameterSet, ...]:
    """Return the constants, the design rail if it is another one, and the tables of laws."""
    found = [load_entries("constants", "constants")]
    if made is not None and not made.made_on(rail):
        found.append(load_entries("rail", made.rail))
    for written in dict.fromkeys(laws):
        name, _, preset = written.partition(":")
        if name in available("controller"):
            parameters = load_entries("controller", name)
            unused = tuple(f"{each}." for each in PRESETS if each != (preset or usual_table(vehicle)))
            used = {key: entry for key, entry in parameters.entries.items() if not key.startswith(unused)}
            found.append(replace(parameters, entries=used))
    return tuple(found)
