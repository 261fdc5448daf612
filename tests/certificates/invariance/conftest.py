"""Sets of the torque feedback on a small box, found once."""

import math

import pytest

from tests.certificates.invariance.loops import feedback_problem
from wspd_design.certificates.search.invariant_sets import document
from wspd_design.certificates.search.invariant_sets.search import search


@pytest.fixture(scope="session")
def problem():
    return feedback_problem()


@pytest.fixture(scope="session")
def found(problem):
    return search(problem, most_work=math.inf)


@pytest.fixture(scope="session")
def written(problem, found):
    return document.write(problem, found)
