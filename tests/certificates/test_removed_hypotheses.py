"""A file that lacks a hypothesis, or brings another one in its place, proves nothing."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

from wspd_design.certificates.checks.foundations import well_posed
from wspd_design.certificates.checks.sliding import reaching
from wspd_design.certificates.checks.valve import open_loop_pole
from wspd_design.certificates.kernel.checker import check
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay


@pytest.fixture(scope="module")
def problem(make_reference_problem):
    return make_reference_problem(30.0)


@pytest.fixture(scope="module")
def files(problem):
    """Certificates of the reference problem as they are kept, by name."""
    found = [module.check(problem) for module in (reaching, well_posed, open_loop_pole)]
    assert found[0].status is found[1].status is Status.PROVED
    return {each.name: json.loads(certificate_text(each)) for each in found}


@pytest.mark.parametrize("name", ["reaching", "well_posed"])
def test_every_single_proof_is_needed(problem, files, name):
    content = files[name]
    assert replay(problem, json.dumps(content)).accepted
    assert len(content["proofs"]) > 1
    for k in range(len(content["proofs"])):
        less = content["proofs"][:k] + content["proofs"][k + 1 :]
        for proofs in (less, less + less, [*less, less[0]]):
            found = replay(problem, json.dumps(content | {"proofs": proofs}))
            assert not found.accepted
            assert found.missing


def test_weaker_bounds_do_not_meet_what_is_needed(problem, files):
    """A true statement with a looser bound, with its own fingerprint, in place of the needed one."""
    gain, _ = reaching.claims(problem, problem.controller)
    loose = replace(gain, bound=Fraction(60))
    content = files["reaching"]
    first, second = content["proofs"]
    weaker = {**first, "bound": "60.0", "claim_sha256": loose.digest()}
    assert check(loose, json.dumps(weaker)).accepted
    assert not check(gain, json.dumps(weaker)).accepted
    found = replay(problem, json.dumps(content | {"proofs": [weaker, second]}))
    assert not found.accepted
    assert found.missing


def test_proofs_do_not_speak_for_other_checks(problem, files):
    for name, content in files.items():
        for other, stranger in files.items():
            if other != name:
                mixed = content | {"status": "PROVED", "proofs": stranger["proofs"]}
                assert not replay(problem, json.dumps(mixed)).accepted, (name, other)
                mixed = content | {"proofs": content["proofs"] + stranger["proofs"]}
                assert not replay(problem, json.dumps(mixed)).accepted, (name, other)


@pytest.mark.parametrize("key", ["claim", "relation", "tree", "bound", "claim_sha256", "format"])
def test_names_and_trees_cannot_be_exchanged(problem, files, key):
    """The tree, hash, bound or name of one proof under those of another."""
    content = files["reaching"]
    first, second = content["proofs"]
    if first[key] == second[key]:
        second = {**second, key: "x"}
    for proofs in ([{**first, key: second[key]}, content["proofs"][1]], [first, {**second, key: first[key]}]):
        if proofs != content["proofs"]:
            assert not replay(problem, json.dumps(content | {"proofs": proofs})).accepted


def test_of_two_values_of_a_key_the_last_counts_everywhere(problem, files):
    """What the reader of the file and the checker of the proof see is the same."""
    text = json.dumps(files["reaching"])
    doubled = text.replace('"tree": "', '"tree": ".", "tree": "')
    doubled = doubled.replace('"bound": "', '"bound": "1.0", "bound": "')
    assert replay(problem, doubled).shown == replay(problem, text).shown
    for forged in (
        text.replace('"prover": ', '"tree": ".", "prover": '),
        text.replace('"prover": ', '"bound": "1.0", "prover": '),
        text.replace('"prover": ', '"claim": "abs(r)", "prover": '),
    ):
        assert forged != text
        assert not replay(problem, forged).accepted
