"""Everything that a report shows about a design, computed once."""

import hashlib
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib.metadata import version

from wspd_design.analysis.linearization import Linearization, linearize
from wspd_design.certificates.records import Certificate
from wspd_design.certificates.suite import verify
from wspd_design.design.catalog import controller
from wspd_design.design.file import design_text
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Design
from wspd_design.parameters.files import load_entries
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.parameters.records import ParameterSet
from wspd_design.simulation.comparison import Trial, compare
from wspd_design.simulation.records import Scenario

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
class Dossier:
    """A design, the numbers it rests on, its linearizations, certificates and simulated stops."""

    design: Design
    vehicle: ParameterSet
    rail: ParameterSet
    linearizations: tuple[Linearization, ...]  # over speed, at the slip reference
    certificates: tuple[Certificate, ...]
    trials: tuple[Trial, ...]  # the design's own stop first
    initial_speed: float  # m/s
    provenance: Provenance


def dossier(
    made: Design,
    *,
    vehicle_name: str,
    rail_name: str,
    initial_speed: float,
    baselines: Sequence[str],
    command: str,
    seed: int = 0,
    progress: Callable[[str], None] = lambda stage: None,
) -> Dossier:
    """Compute everything about a design.

    Parameters
    ----------
    made : Design
        The design.
    vehicle_name, rail_name : str
        Names or paths of the vehicle and of the rail of the stops.
    initial_speed : float
        Of the stops [m/s].
    baselines : sequence of str
        Controllers to compare with.
    command : str
        The command line, for the record.
    seed : int
        Of the sampled checks.
    progress : callable, optional
        Told each stage before it starts.

    Returns
    -------
    Dossier
        Records only.
    """
    import numpy as np

    vehicle, rail = load_vehicle(vehicle_name), load_rail(rail_name)
    own = made.build(vehicle, load_rail(made.rail))
    specification = made.specification
    progress("linearization")
    speeds = np.geomspace(1.0, max(specification.speeds[1], initial_speed), POLE_SPEEDS)
    linearizations = tuple(linearize(vehicle, rail, slip=specification.slip, speed=float(v)) for v in speeds)
    problem = stability_problem(vehicle, rail, own, specification, seed=seed)
    certificates = verify(problem, progress=progress)
    laws = [own, *(controller(name, vehicle, rail, specification) for name in baselines)]
    scenario = Scenario(rail=rail, initial_speed=initial_speed, seed=seed)
    trials = compare(vehicle, laws, scenario, slip_reference=specification.slip, progress=progress)
    inputs = "\n".join((design_text(made), repr(vehicle), repr(rail), repr(scenario)))
    return Dossier(
        design=made,
        vehicle=load_entries("vehicle", vehicle_name),
        rail=load_entries("rail", rail_name),
        linearizations=linearizations,
        certificates=certificates,
        trials=trials,
        initial_speed=initial_speed,
        provenance=Provenance(
            command=command,
            versions=(("Python", platform.python_version()), *((name, version(name)) for name in PACKAGES)),
            seed=seed,
            input_hash=hashlib.sha256(inputs.encode()).hexdigest(),
        ),
    )
