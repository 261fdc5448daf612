"""Everything that a report shows about a design, computed once."""

import hashlib
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

from wspd_design.analysis.brake_sheet import BrakeSheet, brake_sheet
from wspd_design.analysis.linearization import Linearization, linearize
from wspd_design.certificates.records import Certificate
from wspd_design.certificates.suite import verify
from wspd_design.controllers.family import FAMILIES
from wspd_design.controllers.offers import Surface
from wspd_design.controllers.protocol import Law
from wspd_design.design.adhesion_use import adhesion_sentence
from wspd_design.design.catalog import controller, controller_of, design_rail, is_design_file
from wspd_design.design.file import design_text, read_design
from wspd_design.design.industry import usual_table
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Design, Specification
from wspd_design.design.selection import named_design
from wspd_design.parameters.files import available, load_entries
from wspd_design.parameters.laden import LADEN
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import ParameterSet, Rail, Vehicle
from wspd_design.parameters.schema import PRESETS
from wspd_design.plants.names import DEFAULT_PLANT
from wspd_design.simulation.comparison import Trial, compare
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.records import Run, Scenario
from wspd_design.studies.faults import Robustness, robustness
from wspd_design.studies.judgment import Judgment, judgment
from wspd_design.studies.uncertainty import Uncertainty, uncertainty

POLE_SPEEDS = 60  # points of the pole map
PACKAGES = ("wspd-design", "numpy", "scipy", "sympy", "casadi", "control", "matplotlib", "typst")


@dataclass(frozen=True, slots=True, kw_only=True)
class Provenance:
    """How to compute a report again."""

    command: str
    versions: tuple[tuple[str, str], ...]
    seed: int
    input_hash: str


@dataclass(frozen=True, slots=True, kw_only=True)
class PhasePlane:
    """What the law of the first wheelset saw above the judging speed, and its surface e + c int e."""

    integral: tuple[float, ...]  # s, of the slip error, as the law remembers it
    error: tuple[float, ...]  # -, slip reference minus slip
    surface_rate: float  # 1/s, c
    layer: float  # -, boundary layer in slip


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnFile:
    """A vehicle or rail of the user's own, which no one else has."""

    kind: str  # vehicle or rail
    name: str  # of the file, without its folder
    variant: str  # what follows it in options, such as :laden
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Dossier:
    """A design, the numbers it rests on, its linearizations, certificates and simulated stops."""

    design: Design
    vehicle: ParameterSet
    rail: ParameterSet
    own_files: tuple[OwnFile, ...]  # of those two, where they do not ship with the program
    other_parameters: tuple[ParameterSet, ...]  # constants, the design rail if another, and the baselines
    compared_designs: tuple[Design, ...]  # of the laws among the baselines that have gains
    brake: BrakeSheet  # on full adhesion
    adhesion_use: str  # how much of what the rail gives the brake asks for, in the range of the design
    linearizations: tuple[Linearization, ...]  # over speed, at the slip reference
    certificates: tuple[Certificate, ...]
    trials: tuple[Trial, ...]  # the design's own stop first
    lag_distances: tuple[float, ...]  # m, of each trial: the part of the distance that the build-up costs
    phase_plane: PhasePlane | None  # of laws with a sliding surface
    judgment: Judgment | None  # of a design with requirements
    robustness: Robustness | None  # where wheelsets differ
    uncertainty: Uncertainty | None  # where numbers have bounds
    scenario: Scenario  # of the stops
    provenance: Provenance


def dossier(
    made: Design,
    *,
    vehicle_name: str,
    rail_name: str,
    scenario: Scenario,
    baselines: Sequence[str],
    command: str,
    stop_command: str = "",
    plant: str = DEFAULT_PLANT,
    stored: Path | None = None,
    folder: Path = Path(),
    progress: Callable[[str], None] = lambda _stage: None,
) -> Dossier:
    """Compute everything about a design.

    Parameters
    ----------
    made : Design
        The design.
    vehicle_name, rail_name : str
        Names or paths of the vehicle and of the rail of the stops.
    scenario : Scenario
        The stops, on this rail; its seed is that of the sampled checks, too.
    baselines : sequence of str
        Controllers to compare with.
    command : str
        The command line, for the record.
    stop_command : str
        ``wspd simulate`` with what the command line says about the stop, so that drawn ones can be simulated again.
    plant : {"planar", "quarter"}
        Of the stops; the certificates speak about the quarter model.
    stored : Path, optional
        Folder of certificate files; what the checkers accept of it for this design is not searched again.
    folder : Path
        Of the design file, from which the rails of its requirements are seen.
    progress : callable, optional
        Told each stage before it starts.

    Returns
    -------
    Dossier
        Records only.
    """
    import numpy as np

    vehicle, rail = load_vehicle(vehicle_name), load_rail(rail_name)
    own = controller_of(made, vehicle, rail)
    specification = made.specification
    progress("linearization")
    speeds = np.geomspace(1.0, max(specification.speeds[1], scenario.initial_speed), POLE_SPEEDS)
    linearizations = tuple(linearize(vehicle, rail, slip=specification.slip, speed=float(v)) for v in speeds)
    problem = stability_problem(vehicle, rail, own, specification, seed=scenario.seed)
    certificates = verify(problem, progress=progress, stored=stored)
    shared = replace(specification, reference=None)  # which is for the law of the design alone
    others = [_baseline(name, vehicle, rail, shared) for name in baselines]
    controllers = [own, *(law for law, _ in others)]
    trials = compare(
        vehicle,
        controllers,
        scenario,
        slip_reference=specification.slip,
        plant=plant,
        progress=progress,
    )
    entries = load_entries("vehicle", vehicle_name), load_entries("rail", rail_name)
    inputs = "\n".join((design_text(made), repr(vehicle), repr(rail), repr(scenario), plant))
    return Dossier(
        design=made,
        vehicle=entries[0],
        rail=entries[1],
        own_files=(*_own_file("vehicle", vehicle_name), *_own_file("rail", rail_name)),
        other_parameters=_other_parameters(made, vehicle, rail, baselines),
        compared_designs=tuple(design for _, design in others if design is not None),
        brake=brake_sheet(vehicle),
        adhesion_use=adhesion_sentence(vehicle, rail, specification.speeds),
        linearizations=linearizations,
        certificates=certificates,
        trials=trials,
        lag_distances=tuple(scenario.initial_speed * each.metrics.lag for each in trials),
        phase_plane=phase_plane(trials[0].run, own) if isinstance(own, Surface) else None,
        judgment=judgment(made, design_rail(made, rail), certificates, folder=folder, progress=progress),
        robustness=robustness(vehicle, own, scenario, plant=plant, progress=progress),
        uncertainty=uncertainty(
            vehicle,
            own,
            scenario,
            trials[0],
            slip_reference=specification.slip,
            parameters=entries,
            laden=load_vehicle(f"{vehicle_name}{LADEN}") if "laden.mass" in entries[0].entries else None,
            plant=plant,
            command=stop_command,
            progress=progress,
        ),
        scenario=scenario,
        provenance=Provenance(
            command=command,
            versions=versions(),
            seed=scenario.seed,
            input_hash=hashlib.sha256(inputs.encode()).hexdigest(),
        ),
    )


def _own_file(kind: str, written: str) -> tuple[OwnFile, ...]:
    path = Path(written.removesuffix(LADEN))
    if path.suffix != ".toml":
        return ()
    text = path.read_text(encoding="utf-8-sig")
    return (OwnFile(kind=kind, name=path.name, variant=written.removeprefix(str(path)), text=text),)


def versions() -> tuple[tuple[str, str], ...]:
    """Return the versions of Python and of the packages that numbers depend on."""
    return (("Python", platform.python_version()), *((name, version(name)) for name in PACKAGES))


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
    made: Design, vehicle: Vehicle, rail: Rail, baselines: Sequence[str]
) -> tuple[ParameterSet, ...]:
    found = [load_entries("constants", "constants")]
    if not made.made_on(rail):
        found.append(load_entries("rail", made.rail))
    for written in baselines:
        name, _, preset = written.partition(":")
        if name in available("controller"):
            parameters = load_entries("controller", name)
            unused = tuple(f"{each}." for each in PRESETS if each != (preset or usual_table(vehicle)))
            used = {key: entry for key, entry in parameters.entries.items() if not key.startswith(unused)}
            found.append(replace(parameters, entries=used))
    return tuple(found)
