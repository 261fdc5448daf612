"""Statements in a report: their domain by its name, their proofs, what they do not say, and the worst first."""

import inspect
import re
import sys
from dataclasses import replace

import pytest

from tests.unit.reporting.sample_dossier import certificate, sample_dossier
from wspd_design.certificates.kernel.finding import Finding, Stated
from wspd_design.certificates.records import Domain, Hypothesis, Interval, Status
from wspd_design.certificates.theorems.table import THEOREMS
from wspd_design.parameters.theory import load_theorems
from wspd_design.reporting.blocks import Definitions, Paragraph, Table
from wspd_design.reporting.sections.checks import checks, worst_first
from wspd_design.reporting.sections.theory import theorems_of, theory
from wspd_design.reporting.sections.words import symbols_in, terms_in, words
from wspd_design.reporting.statements import DOMAINS, linked, statements_of
from wspd_design.reporting.text import Link, Math, plain

pytestmark = pytest.mark.usefixtures("blank_figures")

SPEED = Interval(name="speed", low=10.0 / 3.6, high=120.0 / 3.6, unit="m/s")
MASS = Interval(name="mass", low=6e4, high=9e4, unit="kg")
MU0 = Interval(name="mu0", low=0.24, high=0.36, unit="-")
HEAVY = replace(MASS, low=9e4)
WIDE, NARROW = Domain(varied=(SPEED, MASS, MU0)), Domain(varied=(SPEED, MU0), held=(HEAVY,))


def claimed(name, domain, status=Status.PROVED, **changes):
    varied = tuple(each.name for each in domain.varied if each.name != "speed")
    held = tuple(each.name for each in domain.held)
    said = f"p <= 3 1/s on {domain.text}, always."
    return certificate(name, status, claim=said, domain=domain, varied=varied, held=held, **changes)


def proved(*ranges):
    proof = {"statement": {}}
    return Finding(
        status=Status.PROVED,
        asked="p",
        shown="p <= 2.5 1/s",
        ranges=ranges,
        leaves=3,
        stated=Stated(proof=proof),
    )


def test_a_domain_is_named_once_and_cited():
    one, two, three = claimed("one", WIDE), claimed("two", NARROW), claimed("three", WIDE)
    statements = statements_of((one, two, three))
    assert list(statements.domains.values()) == ["D1", "D2"]
    assert plain(statements.claim(three)) == "p at most 3 1/s on D1, always."
    assert Link(anchor=DOMAINS, text="D2") in statements.claim(two)
    (table,) = (
        each
        for each in checks(replace(sample_dossier(()), certificates=(one, two, three)))
        if isinstance(each, Table) and each.anchor == DOMAINS
    )
    rows = {plain(row[0]): tuple(map(plain, row[1:])) for row in table.rows}
    assert rows["mass"] == ("60000 to 90000", "kg", "●", "○")
    assert rows["speed"] == ("10 to 120", "km/h", "●", "●")


def test_a_proof_on_a_part_says_on_which():
    """Two bounds of one quantity, each on its own edge, would contradict each other without it."""
    part = replace(MU0, high=0.3)
    whole = claimed("one", WIDE, findings={"a": proved(SPEED, HEAVY, MU0), "b": proved(SPEED, MASS, part)})
    statements = statements_of((whole,))
    said = [plain(statements.proof(each, whole)) for each in whole.proofs]
    assert said == ["D1 with mass 90000 kg", "D1 with mu0 0.24 to 0.3"]
    assert [each.text for each in whole.proofs] == [
        "p <= 2.5 1/s on 10 to 120 km/h, mu0 0.24 to 0.36; held: mass 90000 kg",
        "p <= 2.5 1/s on 10 to 120 km/h, mass 60000 to 90000 kg, mu0 0.24 to 0.3",
    ]
    all_of_it = replace(whole, findings={"a": proved(SPEED, MASS, MU0)})
    assert plain(statements.proof(all_of_it.proofs[0], all_of_it)) == "D1"


def test_a_hypothesis_that_the_proofs_repeat_is_not_listed_twice():
    same = claimed("one", WIDE, hypotheses=(Hypothesis(text="p <= 2.5 1/s", status=Status.PROVED),))
    same = replace(same, findings={"a": proved(SPEED)})
    made = checks(replace(sample_dossier(()), certificates=(same,)))
    anchors = [each.anchor for each in made if isinstance(each, Table)]
    assert anchors == [DOMAINS, "check-one-proofs"]


def test_the_worst_stand_first():
    """Refuted before proved, nominal before somewhere in the bounds, the stop before the equations."""
    given = (
        certificate("equations", Status.PROVED),
        certificate("corner", Status.REFUTED, varied=("mass",)),
        certificate("loop", Status.REFUTED),
        certificate("stop", Status.REFUTED),
        certificate("open", Status.UNDECIDED),
    )
    assert [each.name for each in worst_first(given)] == ["stop", "loop", "corner", "open", "equations"]


def test_every_check_refers_to_a_theorem_of_the_report_and_repeats_what_it_does_not_say():
    anchors = {each.anchor for each in load_theorems()}
    made = certificate("one", Status.PROVED, reference="eq. (19); docs/theory.md#no-go; else")
    assert [each.anchor for each in theorems_of(made)] == ["no-go"]
    dossier = replace(sample_dossier(()), certificates=(made,))
    (details,) = (each for each in checks(dossier) if isinstance(each, Definitions))
    rows = {row.term: row.text for row in details.rows}
    assert Link(anchor="theory-no-go") in rows["Reference"]
    assert "docs/" not in plain(rows["Reference"])
    assert "Nor that the motion is unbounded" in plain(rows["Does not say"])
    why = " ".join(plain(each.text) for each in theory(dossier) if isinstance(each, Paragraph))
    assert "The sum of the poles" in why
    assert {"no-go", "hard-limits", "bound"} <= anchors


def test_no_check_refers_to_a_theorem_that_does_not_exist():
    """What follows docs/theory.md# in the source of a theorem is an anchor of the theory."""
    anchors = {each.anchor for each in load_theorems()}
    sources = (inspect.getsource(sys.modules[each.tell.__module__]) for each in THEOREMS.values())
    named = set(re.findall(r"docs/theory\.md#([a-z-]+)", " ".join(sources)))
    assert named | {"valve"} == anchors  # that of the valve stands behind two others


def test_names_of_checks_become_links():
    text = linked("see lyapunov_repaired, or pole.", {"pole": "check-pole", "lyapunov_repaired": "check-l"})
    first, second = Link(anchor="check-l", text="lyapunov_repaired"), Link(anchor="check-pole", text="pole")
    assert text == ("see ", first, ", or ", second, ".")


def test_symbols_and_terms_are_those_that_are_used():
    formula = Math(source='u^* <= T_"max" - eta\\/g', spoken="")
    blocks = (Paragraph(text=("at the adhesion peak ", formula)),)
    assert [each.symbol for each in symbols_in(blocks)] == ["g", 'T_"max"', "u^*", "eta"]
    assert [each.term for each in terms_in(blocks)] == ["adhesion", "adhesion peak"]
    assert [each.anchor for each in words(blocks) if isinstance(each, Table)] == ["symbols-table"]
