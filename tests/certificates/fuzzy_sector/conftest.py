from dataclasses import replace

import pytest

import wspd_design as wd
from wspd_design.certificates import suite
from wspd_design.design.problem import stability_problem
from wspd_design.parameters.bounds import Bounds

LOCO = wd.load_vehicle("er24pc")


def problem_of(rail, sample_time, *, bounds=True, **gains):
    """Closed loop of the designed law with a constant reference, with the stated box or with known numbers."""
    rail = wd.load_rail(rail)
    specification = wd.Specification(
        sample_time=sample_time, reference="constant", speeds=(10.0 / 3.6, 120.0 / 3.6)
    )
    law = wd.design_controller(LOCO, rail, specification, law="afsmc-mended").build(LOCO, rail)
    law = replace(law, core=replace(law.core, gains=replace(law.core.gains, **gains)))
    problem = stability_problem(LOCO, rail, law, specification)
    return problem if bounds else replace(problem, bounds=Bounds.of({}))


def certificate_of(problem):
    (found,) = suite.verify(problem, only=["fuzzy_sector"], figures=False)
    return found


@pytest.fixture(scope="session")
def known():
    """Wet rail at 20 ms with known numbers."""
    return problem_of("polach-wet", 0.02, bounds=False)


@pytest.fixture(scope="session")
def proved(known):
    return certificate_of(known)


@pytest.fixture(scope="session")
def boxed():
    """The same with the stated box."""
    return problem_of("polach-wet", 0.02)


@pytest.fixture(scope="session")
def slow():
    """Sampled every 100 ms."""
    return problem_of("polach-wet", 0.1)
