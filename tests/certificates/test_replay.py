"""Whatever the suite says about a loop is accepted again from its file, and nothing else is."""

import json
import subprocess
import sys
from dataclasses import replace

import pytest
from round_trip import Kept, forgeries, refused

from wspd_design.certificates import suite
from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.memory import remembering
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search import prover

QUICK = (
    "surface_hurwitz",
    "gain_positive",
    "open_loop_pole",
    "no_go",
    "sampling",
    "tracking",
    "conservation",
)
RADIUS = 1.001  # another locomotive


@pytest.fixture(scope="module")
def settled(make_problem, make_controller):
    problem = make_problem(make_controller("smc"))
    return problem, {each.name: each for each in suite.verify(problem, only=QUICK)}


@pytest.fixture(scope="module")
def files(settled):
    problem, certificates = settled
    return {
        name: Kept(problem=problem, certificate=each, content=json.loads(certificate_text(each)))
        for name, each in certificates.items()
    }


def test_statuses_of_all_kinds_are_among_them(settled):
    _, certificates = settled
    assert {each.status for each in certificates.values()} >= {Status.PROVED, Status.REFUTED, Status.EVIDENCE}


def test_files_are_accepted_word_for_word(settled):
    problem, certificates = settled
    for certificate in certificates.values():
        found = replay(problem, certificate_text(certificate))
        assert found.accepted, (certificate.name, found.reason)
        assert found.check == certificate.name
        for name in (
            "status",
            "claim",
            "explanation",
            "margin",
            "witness",
            "hypotheses",
            "assumptions",
            "varied",
        ):
            assert getattr(found.certificate, name) == getattr(certificate, name)


def test_only_what_is_decided_is_checked(settled):
    problem, certificates = settled
    for certificate in certificates.values():
        open_ = certificate.status in (Status.UNDECIDED, Status.EVIDENCE, Status.NOT_APPLICABLE)
        assert replay(problem, certificate_text(certificate)).unchecked is open_, certificate.name


@pytest.mark.parametrize("name", QUICK)
def test_no_entry_of_a_file_can_be_changed(files, name):
    kept = files[name]
    for changes in forgeries(kept):
        found = replay(kept.problem, json.dumps(kept.content | changes))
        assert not found.accepted, changes
        assert "is not what the proofs show about this design" in found.reason
    for entry in ("title", "explanation", "method", "reference", "claim"):
        for forged in ("", "All is proved.", kept.content[entry] + " ", None, [kept.content[entry]]):
            if forged != kept.content[entry]:
                assert refused(kept, **{entry: forged}), (entry, forged)


@pytest.mark.parametrize(
    "name", ["schema", "check", "status", "claim", "margin", "witness", "findings", "made_by"]
)
def test_no_entry_can_be_left_out_or_added(files, name):
    kept = files["gain_positive"]
    less = {key: entry for key, entry in kept.content.items() if key != name}
    assert not replay(kept.problem, json.dumps(less)).accepted
    assert refused(kept, **{f"{name} of somebody else": kept.content[name]})


@pytest.mark.parametrize("name", ["gain_positive", "surface_hurwitz"])
def test_a_proved_claim_cannot_be_refuted_by_a_forger(files, name):
    """Audit B1: the proofs of the file establish the claim."""
    kept = files[name]
    assert kept.certificate.status is Status.PROVED
    for witness in ([], [{"name": "speed", "value": 50.0, "unit": "km/h"}]):
        assert refused(kept, status="REFUTED", witness=witness)
        assert refused(kept, status="REFUTED", witness=witness, findings={})
        assert refused(kept, status="REFUTED", witness=witness, hypotheses=[], margin=None)


def test_a_refuted_claim_needs_its_place(files):
    """Without a place nothing denies the claim; another place gives another witness."""
    kept = files["open_loop_pole"]
    assert kept.certificate.status is Status.REFUTED
    findings = kept.content["findings"]
    places = {key: each["place"] for key, each in findings.items() if "place" in each}
    assert refused(kept, findings={key: each for key, each in findings.items() if key not in places})
    told = set()
    for key, place in places.items():
        for name, at in place.items():
            moved = findings[key] | {"place": place | {name: repr(0.999 * float(at) + 1e-9)}}
            if refused(kept, findings=findings | {key: moved}):
                told.add(name)
    assert told >= {point.name for point in kept.certificate.witness} & set(next(iter(places.values())))


BAD_NUMBERS = ("nan", "inf", "1e999", "０.３６", "0x1p-2", "", "1/0", 0.36, None, [], True, "1/3")


@pytest.mark.parametrize("number", BAD_NUMBERS, ids=repr)
def test_a_place_has_doubles_in_ascii(files, number):
    kept = files["open_loop_pole"]
    findings = kept.content["findings"]
    key = next(key for key, each in findings.items() if "place" in each)
    place = findings[key]["place"]
    for name in (next(iter(place)), "mph"):
        changed = findings[key] | {"place": place | {name: number}}
        assert refused(kept, findings=findings | {key: changed})


def test_a_place_names_each_free_quantity_once_within_the_domain(files):
    kept = files["open_loop_pole"]
    findings = kept.content["findings"]
    key = next(key for key, each in findings.items() if "place" in each)
    place = findings[key]["place"]
    first = next(iter(place))
    for wrong in (
        {name: at for name, at in place.items() if name != first}, place | {"slip of another": "0.1"},
        place | {first: "1e6"}, place | {first: "-1e6"}, {}, [], "slip 0.14",
    ):  # fmt: skip
        assert refused(kept, findings=findings | {key: findings[key] | {"place": wrong}}), wrong
    doubled = json.dumps(kept.content).replace('"place": {', f'"place": {{"{first}": "0.2", ', 1)
    assert replay(kept.problem, doubled).reason == "a name stands twice in the file"


FINDINGS = (
    None, [], 5, {"x": {}}, {"\x1b[2J": {}}, {"gain": None}, {"gain": {"proof": 5}}, {"gain": {"words": "true"}},
    {"gain": {"effort": {"boxes": -1, "undecided": 0, "cut": False}}}, {str(k): {} for k in range(101)},
)  # fmt: skip


@pytest.mark.parametrize("findings", FINDINGS, ids=lambda each: repr(each)[:30])
def test_malformed_findings_are_refused(files, findings):
    for kept in files.values():
        found = replay(kept.problem, json.dumps(kept.content | {"findings": findings}))
        assert not found.accepted
        assert found.reason.isprintable()


def test_a_file_holds_for_its_own_loop_alone(files):
    for name, kept in files.items():
        vehicle = kept.problem.vehicle
        other = replace(kept.problem, vehicle=replace(vehicle, wheel_radius=RADIUS * vehicle.wheel_radius))
        assert not replay(other, json.dumps(kept.content)).accepted, name
        slower = replace(kept.problem, speeds=(kept.problem.speeds[0], 0.99 * kept.problem.speeds[1]))
        assert not replay(slower, json.dumps(kept.content)).accepted, name


def test_a_file_cannot_stand_for_another_check(files):
    for name, kept in files.items():
        for other in QUICK:
            if other != name:
                assert refused(kept, check=other), (name, other)
                assert refused(kept, findings=files[other].content["findings"]), (name, other)


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "null", "{}", '{"schema": "wspd-certificate/3"}', "[" * 100_000, "\x00"]
)
def test_what_is_not_a_certificate_is_refused(settled, text):
    problem, _ = settled
    found = replay(problem, text)
    assert not found.accepted
    assert found.certificate is None
    assert found.reason.isprintable()


@pytest.mark.parametrize(
    "check", [None, 5, "", "reach", "gain_positive\x1b[2J", "ｇain_positive", "../gain_positive"]
)
def test_a_check_that_does_not_exist_is_refused(files, check):
    kept = files["gain_positive"]
    found = replay(kept.problem, json.dumps(kept.content | {"check": check}))
    assert not found.accepted
    assert found.reason.isprintable()


def test_no_search_is_needed(files, monkeypatch):
    """Whatever could search again fails, and the files are accepted all the same."""

    def search(*_given, **_named):
        raise AssertionError("the checker searches")

    for name in ("extreme", "prove"):
        monkeypatch.setattr(prover, name, search)
    monkeypatch.setattr(prover._Search, "run", search)
    for kept in files.values():
        assert replay(kept.problem, json.dumps(kept.content)).accepted


def test_the_work_of_a_file_is_limited(files, monkeypatch):
    """Audit B5: one budget for all that a file states; it is counted, so that a busy machine comes to the same."""
    kept = files["open_loop_pole"]
    monkeypatch.setattr("wspd_design.certificates.replay.Work", lambda: Work(100))
    found = replay(kept.problem, json.dumps(kept.content))
    assert not found.accepted
    assert found.reason == "the proof asks for more work than the checker may do"


def test_a_file_of_twenty_megabytes_is_refused(files):
    kept = files["no_go"]
    findings = kept.content["findings"]
    key = next(key for key, each in findings.items() if "tree" in each.get("proof", {}))
    proof = findings[key]["proof"]
    long = json.dumps(
        kept.content | {"findings": findings | {key: {"proof": proof | {"tree": "a" * checker.MOST_BYTES}}}}
    )
    assert replay(kept.problem, long).reason == "the file is too long"
    deep = proof | {"tree": "a" * (checker.MOST_BYTES - 100_000)}
    found = replay(kept.problem, json.dumps(kept.content | {"findings": findings | {key: {"proof": deep}}}))
    assert "halved more than" in found.reason


def test_what_nothing_decides_cannot_be_called_proved(files):
    kept = files["conservation"]
    assert kept.certificate.status is Status.EVIDENCE
    assert refused(kept, status="PROVED")
    found = replay(kept.problem, json.dumps(kept.content))
    assert found.accepted
    assert found.unchecked


def test_replay_loads_neither_search_nor_checks():
    code = (
        "import sys; import wspd_design.certificates.replay; "
        "print([name for name in sys.modules if name.startswith(('wspd_design.certificates.search', "
        "'wspd_design.certificates.checks')) or name in ('casadi', 'cvxpy', 'scipy', 'ival')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_verification_decides_about_a_proof_once_and_about_another_proof_again(settled, monkeypatch):
    """What is remembered is the same statement with the same proof; a changed tree is looked at, and refused."""
    problem, _ = settled
    (certificate,) = suite.verify(problem, only=["well_posed"], figures=False)
    text, calls = certificate_text(certificate), []
    honest = checker.decide
    monkeypatch.setattr(checker, "decide", lambda *given: calls.append(given) or honest(*given))
    changed = json.loads(text)
    proof = changed["findings"]["deceleration, semi axis rolling"]["proof"]
    assert proof["tree"] != "."
    proof["tree"] = "."
    with remembering():
        assert replay(problem, text).accepted
        once = len(calls)
        assert replay(problem, text).accepted
        signs = len(calls) - once  # are compared again, which costs nothing
        assert signs < once / 2
        assert not replay(problem, json.dumps(changed)).accepted
        assert any(given["tree"] == "." for given, _ in calls[-signs - 1 :] if "tree" in given)
    calls.clear()
    assert replay(problem, text).accepted
    assert len(calls) == once
