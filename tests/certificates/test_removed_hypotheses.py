"""A file that lacks a hypothesis, or brings another one in its place, proves nothing."""

import json
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest
from round_trip import keep, refused

from wspd_design.certificates import suite
from wspd_design.certificates.kernel.checker import Work, decide
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search.settle import settle
from wspd_design.certificates.theorems.sliding import gain_claims

NAMES = ("gain_positive", "reaching", "well_posed")


@pytest.fixture(scope="module")
def problem(make_reference_problem):
    return make_reference_problem(100.0)


@pytest.fixture(scope="module")
def kept(problem):
    """Certificates of the reference problem with their files, by name."""
    found = {name: keep(suite.CHECKS[name], problem) for name in NAMES}
    assert {each.certificate.status for each in found.values()} == {Status.PROVED}
    return found


@pytest.mark.parametrize("name", NAMES)
def test_every_single_proof_is_needed(kept, name):
    findings = kept[name].content["findings"]
    proofs = [key for key, each in findings.items() if "proof" in each]
    assert len(proofs) > 1
    for key in proofs:
        assert refused(kept[name], findings={other: each for other, each in findings.items() if other != key})
        bare = {entry: each for entry, each in findings[key].items() if entry != "proof"}
        assert refused(kept[name], findings=findings | {key: bare})


def test_weaker_bounds_do_not_meet_what_is_needed(problem, kept):
    """A true statement with a looser bound, with its own proof, in place of the needed one."""
    asked = gain_claims(problem)[-1]
    loose = settle(replace(asked.claim, bound=Fraction(200)), tolerance=1e3).proof
    loose["statement"]["bound"] = "150/1"
    assert decide(loose, Work()).leaves >= 1
    findings = kept["reaching"].content["findings"]
    found = findings | {asked.key: {"proof": loose}}
    assert replay(problem, json.dumps(kept["reaching"].content)).accepted
    assert refused(kept["reaching"], findings=found)


def test_findings_do_not_speak_for_other_checks(kept):
    for name, one in kept.items():
        for other, stranger in kept.items():
            if other != name:
                both = one.content["findings"] | stranger.content["findings"]
                assert refused(one, findings=stranger.content["findings"]), (name, other)
                assert refused(one, findings=both), (name, other)
                assert refused(one, check=other), (name, other)


@pytest.mark.parametrize("entry", ["statement", "format", "tree"])
def test_proofs_and_their_parts_cannot_be_exchanged(kept, entry):
    """The statement of one proof under the name of another; another format; a tree that is cut or goes on."""
    findings = kept["reaching"].content["findings"]
    proofs = {key: each["proof"] for key, each in findings.items() if "tree" in each.get("proof", {})}
    for one, other in pairwise(proofs):
        tree = proofs[one]["tree"]
        for given in {
            "statement": (proofs[other]["statement"],),
            "format": ("wspd-proof/1",),
            "tree": (tree[:-1], tree + "."),
        }[entry]:
            forged = findings[one] | {"proof": proofs[one] | {entry: given}}
            assert refused(kept["reaching"], findings=findings | {one: forged}), (one, other)


@pytest.mark.parametrize("key", ["tree", "bound", "statement", "findings", "claim", "status"])
def test_no_key_stands_twice(problem, kept, key):
    """What the reader of the file and the checker of the proof see is the same."""
    text = json.dumps(kept["reaching"].content)
    for value in ('"."', '"1.0"', "{}"):
        doubled = text.replace(f'"{key}": ', f'"{key}": {value}, "{key}": ', 1)
        assert doubled != text
        found = replay(problem, doubled)
        assert not found.accepted
        assert "twice" in found.reason
