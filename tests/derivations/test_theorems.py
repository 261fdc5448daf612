"""The theorems of the theory page rest on identities that SymPy confirms."""

from dataclasses import replace

import pytest
import sympy as sp

from derivations import map_files
from derivations.theorems import THEOREMS, Identity
from wspd_design.certificates.suite import NAMES


@pytest.mark.parametrize("theorem", THEOREMS, ids=lambda theorem: theorem.anchor)
def test_every_identity_holds(theorem):
    assert theorem.identities
    assert all(identity.residual == 0 for identity in theorem.identities)
    assert theorem.hypotheses
    assert theorem.not_said


def test_a_wrong_identity_stops_the_page(monkeypatch):
    wrong = replace(THEOREMS[0], identities=(Identity("1 = 2", sp.Integer(-1)),))
    monkeypatch.setattr(map_files, "THEOREMS", (wrong,))
    with pytest.raises(ValueError, match="1 = 2 has the residual -1"):
        map_files.theory()


def test_certificates_of_the_suite_have_a_theorem():
    told = {name for theorem in THEOREMS for name in theorem.certificates}
    own = {"surface_hurwitz", "sampling", "lyapunov_surface", "lpv_lyapunov", "sampled_invariance"}
    assert set(NAMES) <= told | own
