import json
from dataclasses import replace
from fractions import Fraction

import pytest

import wspd_design as wd
from tests.certificates.band.courses import LOCO, WET, falling_problem
from wspd_design.certificates import suite
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.search.budget import Budget
from wspd_design.certificates.theorems.band import CELLS, contact_held
from wspd_design.certificates.theorems.slip_band.checker import checker
from wspd_design.certificates.theorems.slip_band.statement import NAMES, box_of
from wspd_design.design import certification

PLENTY = 10**9
SLOW = 10.0 / 3.6, 14.4 / 3.6
"""Two windows: bounding the friction in each takes the most time of many a proof [m/s]."""


def problem_of(share, *, rail=WET, speeds=(10.0 / 3.6, 120.0 / 3.6), sample_time=0.02, **tracking):
    """Closed loop of the designed law without dead band, on the stated box with a share of what cells divide."""
    specification = wd.Specification(sample_time=sample_time, reference="constant", speeds=speeds)
    design = wd.design_controller(LOCO, rail, specification, law="observer-smc")
    stated = certification.problem_of(design, vehicle=LOCO, rail=rail)
    core = stated.controller.core
    numbers = replace(core.tracking, **{"dead_band": 0.0} | tracking)
    divided = {
        name: (float(low), float(high))
        for name, (low, high) in zip(NAMES, box_of(stated, Fraction(share)), strict=True)
    }
    return replace(
        stated,
        controller=replace(stated.controller, core=replace(core, tracking=numbers)),
        bounds=stated.bounds | divided,
    )


def certificate_of(problem, effort=0.9):
    """Certificate of the band; below an effort of 1 nothing is sought about late pulses and noise."""
    (found,) = suite.verify(problem, only=["slip_band"], figures=False, budget=Budget(effort=effort))
    return found


def told_of(problem, proof, **asked):
    """What the checker tells of a proof, asked as the theorem asks it."""
    return checker(contact_held(problem), problem.controller, **asked)(proof, Work(PLENTY))


def refused(problem, proof):
    """Why the checker refuses a proof."""
    with pytest.raises(Refused) as reason:
        told_of(problem, proof)
    return str(reason.value)


@pytest.fixture(scope="session")
def half():
    """A half of each range of the wet rail, with supply rate and running resistance on all of theirs."""
    return problem_of(0.5)


@pytest.fixture(scope="session")
def proved(half):
    return certificate_of(half)


@pytest.fixture
def document(proved):
    """The file as JSON, to be changed."""
    return json.loads(certificate_text(proved))


@pytest.fixture
def proof(document):
    """The ellipsoids in it."""
    return document["findings"][CELLS]["proof"]


# --- trains on a falling slip that no proof comes near ----------------------------------------------------------------
@pytest.fixture(scope="session")
def plain():
    """The locomotive with its nominal numbers."""
    return falling_problem(WET, 0.0, slip=0.5, largest=0.5)


@pytest.fixture(scope="session")
def oiled(plain):
    """What slows the wheels down is most of what holds them."""
    return replace(plain, vehicle=replace(plain.vehicle, wheel_damping=1000.0))


@pytest.fixture(scope="session")
def damped(plain):
    """Wheels in oil and a train against the wind: what is negligible of the locomotive is not here."""
    vehicle = plain.vehicle
    return replace(
        plain,
        vehicle=replace(vehicle, wheel_damping=100.0, resistance_linear=0.03 * vehicle.mass),
        bounds=type(plain.bounds).of({name: ends for name, ends in plain.bounds.items() if name in NAMES}),
    )
