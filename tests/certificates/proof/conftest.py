"""A proved claim about the reference problem, and what forgers make of it."""

import json

import pytest

from wspd_design.certificates.checks.sliding import reaching
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.settle import settle


@pytest.fixture(scope="session")
def reference_claim(make_reference_problem):
    """(abs(r) + eta)/rho <= 30 m/s2; its supremum is 25.094."""
    problem = make_reference_problem(30.0)
    return reaching.claims(problem, problem.controller)[0]


@pytest.fixture(scope="session")
def proved(reference_claim):
    found = settle(reference_claim, tolerance=0.01)
    assert found.status is Status.PROVED
    return found


@pytest.fixture
def forge():
    """Write a certificate that names a claim as its own, with any tree."""

    def forged(claim, tree, **changes):
        content = {
            "format": "wspd-proof/1",
            "claim_sha256": claim.digest(),
            "bound": repr(float(claim.bound)),
            "tree": tree,
        }
        return json.dumps({**content, **changes})

    return forged
