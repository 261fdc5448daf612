"""The theorems of the theory page rest on identities that SymPy confirms."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm

from derivations import map_files, recovery
from derivations.theorem import Identity
from derivations.theorems import THEOREMS
from wspd_design.certificates import suite
from wspd_design.certificates.suite import NAMES

CITATION = re.compile(r"docs/theory\.md#([a-z-]+)")


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


def test_theorems_name_the_checks_of_the_suite_and_no_others():
    told = {name for theorem in THEOREMS for name in theorem.certificates}
    assert told == set(NAMES)


def test_references_to_the_theory_page_exist():
    anchors = {theorem.anchor for theorem in THEOREMS}
    sources = Path(suite.__file__).parent.rglob("*.py")
    cited = {anchor for source in sources for anchor in CITATION.findall(source.read_text(encoding="utf-8"))}
    assert cited
    assert cited <= anchors


def test_largest_recoverable_deviation_against_the_matrix_exponential():
    """Linear plant, lag and the constant that venting tends to: the first component stays iff it starts below."""
    numbers = {recovery.p: 5, recovery.tau: sp.Rational(3, 5), recovery.g: 3}
    limit = float(recovery.largest.subs(numbers))
    matrix = np.array([[5.0, 3.0, 0.0], [0.0, -1 / 0.6, -1 / 0.6], [0.0, 0.0, 0.0]])
    after = expm(4.0 * matrix) @ np.array([[0.999 * limit, 1.001 * limit], [0.0, 0.0], [1.0, 1.0]])
    assert after[0, 0] < 0.0 < after[0, 1]
