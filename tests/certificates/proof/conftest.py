"""A proved claim about the reference problem, and what forgers make of it."""

import json

import pytest

from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.quantities import PLANT
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.settle import settle
from wspd_design.certificates.theorems.sliding import gain_claims


@pytest.fixture(scope="session")
def reference_claim(make_reference_problem):
    """(r + eta)/rho <= 30 m/s2 for the axle at static load; its supremum is 25.094."""
    return gain_claims(make_reference_problem(30.0), uses=PLANT)[0].claim


@pytest.fixture(scope="session")
def proved(reference_claim):
    obligation = Inequality(key="gain", claim=reference_claim)
    found = obligation.decide(settle(reference_claim, tolerance=0.01), Work())
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
