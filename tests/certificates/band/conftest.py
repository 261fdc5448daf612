import json
from dataclasses import replace

import pytest

import wspd_design as wd
from wspd_design.certificates import suite
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.search.budget import Budget
from wspd_design.certificates.theorems.slip_band.statement import NAMES
from wspd_design.design.problem import stability_problem
from wspd_design.parameters.bounds import Bounds

LOCO, WET = wd.load_vehicle("er24pc"), wd.load_rail("polach-wet")
SLOW = 10.0 / 3.6, 14.4 / 3.6
"""Two windows: bounding the friction in each takes the most time of many a proof [m/s]."""


def problem_of(share, *, rail=WET, speeds=(10.0 / 3.6, 120.0 / 3.6), **tracking):
    """Closed loop of the designed law without dead band, on a part of the stated box."""
    specification = wd.Specification(sample_time=0.02, reference="constant", speeds=speeds)
    law = wd.design_controller(LOCO, rail, specification, law="observer-smc").build(LOCO, rail)
    numbers = replace(law.core.tracking, **{"dead_band": 0.0} | tracking)
    problem = stability_problem(
        LOCO, rail, replace(law, core=replace(law.core, tracking=numbers)), specification
    )
    ends = {}
    for name in NAMES:
        (low, high), middle = problem.span(name), problem.nominal(name)
        ends[name] = (middle + share * (low - middle), middle + share * (high - middle))
    return replace(problem, bounds=Bounds.of(ends))


def certificate_of(problem, effort=0.9):
    """Certificate of the band; below an effort of 1 nothing is sought about late pulses and noise."""
    (found,) = suite.verify(problem, only=["slip_band"], figures=False, budget=Budget(effort=effort))
    return found


@pytest.fixture(scope="session")
def half():
    """A half of each range of the wet rail."""
    return problem_of(0.5)


@pytest.fixture(scope="session")
def proved(half):
    return certificate_of(half)


@pytest.fixture
def document(proved):
    """The file as JSON, to be changed."""
    return json.loads(certificate_text(proved))
