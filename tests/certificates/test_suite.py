"""The whole set: order, completeness, honesty and what it refuses."""

import math
import re
from dataclasses import replace

import pytest

from tests.certificates.symbols import used
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.budget import Budget
from wspd_design.certificates.setting import domain
from wspd_design.certificates.suite import CHECKS, NAMES, verify
from wspd_design.parameters.errors import UserError
from wspd_design.reporting.blocks import Status as Shown


@pytest.fixture(scope="session")
def printed(make_problem, make_controller):
    """The adaptive law as printed, on dry rail."""
    return verify(make_problem(make_controller("afsmc")))


@pytest.fixture(scope="session")
def sliding(make_problem, make_controller):
    """The sliding mode on wet rail."""
    return verify(make_problem(make_controller("smc", "polach-wet"), rail="polach-wet"))


@pytest.fixture(scope="session", params=["printed", "sliding"])
def certificates(request):
    return request.getfixturevalue(request.param)


def test_order(certificates):
    assert NAMES == (
        "derivation",
        "feedback",
        "surface_hurwitz",
        "gain_positive",
        "well_posed",
        "holding_torque",
        "sliding_exists",
        "reaching",
        "boundary_layer",
        "lyapunov_surface",
        "lyapunov_printed",
        "lyapunov_repaired",
        "afsmc_energy",
        "barbalat",
        "open_loop_pole",
        "no_go",
        "hard_limits",
        "sampling",
        "routh_lag",
        "margins",
        "traced_loop",
        "lpv_lyapunov",
        "sampled_invariance",
        "slip_band",
        "slip_limit",
        "fuzzy_sector",
        "tracking",
        "overshoot",
        "conservation",
        "stop_bound",
    )
    assert tuple(certificate.name for certificate in certificates) == NAMES


def test_only_a_checker_proves(certificates):
    for certificate in certificates:
        if certificate.status is Status.PROVED:
            assert certificate.proved
            assert all(h.status is not Status.UNDECIDED for h in certificate.hypotheses)
        for finding in certificate.proved.values():
            assert finding.leaves > 0
            assert finding.shown
        assert len(certificate_text(certificate)) < 1_000_000


def test_the_domain_of_a_claim_stands_in_its_sentence(certificates):
    """So that a report may name it once; a claim without one varies nothing, or says itself what it is about."""
    for each in certificates:
        if each.domain is not None:
            assert f"n {each.domain.text}" in each.claim  # on it, or On it
            named = {interval.name for interval in each.domain.held}
            assert named == set(each.held) or "numbers of vehicle and rail nominal" in each.claim, each.name
        elif each.status is not Status.NOT_APPLICABLE:
            assert not each.varied, each.name


def test_proofs_say_what_they_hold_on(sliding):
    """Two bounds of one quantity must not contradict each other: each has its own part of the domain."""
    for each in sliding:
        for proof in each.proofs:
            if proof.domain is None:
                continue
            assert proof.text == f"{proof.statement} on {proof.domain.text}"
            if each.domain is None:
                continue
            whole = {interval.name: interval for interval in (*each.domain.varied, *each.domain.held)}
            for part in (*proof.domain.varied, *proof.domain.held):
                if part.name in whole:
                    assert whole[part.name].low <= part.low <= part.high <= whole[part.name].high
    edges = [proof.text for each in sliding if each.name == "sliding_exists" for proof in each.proofs]
    assert len(set(edges)) == len(edges) > 3
    assert "mu0 0.24" in edges[0]


def test_what_the_claims_vary_and_hold_stands_in_the_sentence(sliding, make_problem, make_controller):
    """The names in a sentence are typed, those in its inequalities are read from their symbols."""
    problem = make_problem(make_controller("smc", "polach-wet"), rail="polach-wet")
    uncertain, compared = domain.uncertain(problem), 0
    for certificate in sliding:
        theorem = CHECKS[certificate.name].theorem
        if theorem.speaks_about(problem):
            continue
        for each in theorem.obligations(problem):
            if isinstance(each, Inequality):
                names = set(used(each.claim)) & set(uncertain)
                free = {v.name for v in each.claim.free} & names
                inside = {
                    v.name
                    for v in each.claim.variables
                    if v.name in names and not v.free and float(v.low) not in domain.span(problem, v.name)
                }
                assert free <= set(certificate.varied), (certificate.name, each.key)
                said = inside <= set(certificate.held) or "with nominal parameters" in certificate.claim
                assert said, (certificate.name, each.key)
                compared += len(free | inside)
    assert compared > 100


def test_every_certificate_is_complete(certificates):
    for certificate in certificates:
        assert certificate.title
        assert certificate.claim.endswith(".")
        assert certificate.explanation.endswith(".")
        assert certificate.method
        assert len(certificate.model_hash) == 64
        assert certificate.seconds >= 0.0
        if certificate.status in (Status.EVIDENCE, Status.REFUTED, Status.VACUOUS):
            assert certificate.assumptions
            assert certificate.reference
            assert certificate.findings
        if certificate.status is Status.REFUTED:
            assert certificate.witness or certificate.margin is None
            assert (
                certificate.margin is None
                or certificate.margin.high is None
                or certificate.margin.high <= 0.0
            )
        if certificate.status is Status.EVIDENCE:
            assert not certificate.witness
            assert certificate.margin is None or certificate.margin.high >= 0.0
        for series in certificate.series:
            assert 2 <= len(series.x) == len(series.y) <= 502


def test_printed_law_on_dry_rail(printed):
    """The statuses that are known by other means."""
    verdicts = {c.name: c.status for c in printed}
    assert verdicts == {
        "derivation": Status.PROVED,
        "feedback": Status.PROVED,
        "surface_hurwitz": Status.PROVED,
        "gain_positive": Status.PROVED,
        "well_posed": Status.PROVED,
        "holding_torque": Status.PROVED,
        "sliding_exists": Status.REFUTED,  # of some axle, with the weakest brake of the bounds
        "reaching": Status.NOT_APPLICABLE,
        "boundary_layer": Status.NOT_APPLICABLE,
        "lyapunov_surface": Status.NOT_APPLICABLE,
        "lyapunov_printed": Status.REFUTED,
        "lyapunov_repaired": Status.EVIDENCE,
        "afsmc_energy": Status.REFUTED,
        "barbalat": Status.VACUOUS,
        "open_loop_pole": Status.REFUTED,
        "no_go": Status.LIMITATION,
        "hard_limits": Status.REFUTED,
        "sampling": Status.REFUTED,
        "routh_lag": Status.REFUTED,
        "margins": Status.REFUTED,
        "traced_loop": Status.REFUTED,
        "lpv_lyapunov": Status.NOT_APPLICABLE,
        "sampled_invariance": Status.NOT_APPLICABLE,
        "slip_band": Status.NOT_APPLICABLE,
        "slip_limit": Status.PROVED,
        "fuzzy_sector": Status.NOT_APPLICABLE,
        "tracking": Status.REFUTED,
        "overshoot": Status.REFUTED,
        "conservation": Status.EVIDENCE,
        "stop_bound": Status.PROVED,
    }


def test_selected_checks_and_progress(make_problem, make_controller):
    told = []
    problem = make_problem(make_controller("none"))
    found = verify(problem, only=("gain_positive", "surface_hurwitz"), progress=told.append)
    assert [certificate.name for certificate in found] == ["surface_hurwitz", "gain_positive"]
    assert told == [certificate.title for certificate in found]


def test_progress_while_boxes_are_split(make_problem, make_controller):
    told = []
    (found,) = verify(make_problem(make_controller("smc")), only=("reaching",), progress=told.append)
    assert told[0] == found.title
    shares = [line.removeprefix(f"{found.title}: ") for line in told[1:]]
    assert shares[-1] == "100% of the box decided"
    assert len(set(shares)) > 2


SEARCHED = ("well_posed", "sliding_exists", "reaching", "open_loop_pole", "sampling", "routh_lag")


@pytest.mark.parametrize("name", ["afsmc-repaired", "smc"])
def test_a_search_without_effort_says_nothing_infinite_and_nothing_false(make_problem, make_controller, name):
    """One look at the whole box is all there is; what was not shown is open."""
    problem = make_problem(make_controller(name, "polach-wet"), rail="polach-wet")
    found = verify(problem, only={*SEARCHED, "afsmc_energy"}, budget=Budget(effort=1e-9))
    for certificate in found:
        assert certificate.status is not Status.PROVED, certificate.name
        ends = (certificate.margin.low, certificate.margin.high) if certificate.margin else ()
        assert all(end is None or math.isfinite(end) for end in ends), certificate.name
        words = " ".join([certificate.explanation, *(each.text for each in certificate.hypotheses)])
        assert "inf" not in words.replace("-", " ").split(), certificate.name


def test_unknown_check_is_refused_with_the_nearest_name(make_problem, make_controller):
    with pytest.raises(UserError, match=r'"reching" \(did you mean "reaching"\?\)'):
        verify(make_problem(make_controller("none")), only=("reching",))


def test_problem_about_another_loop_is_refused(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc"))
    with pytest.raises(UserError, match="sample time"):
        verify(replace(problem, sample_time=0.02))
    with pytest.raises(UserError, match="slip reference"):
        verify(replace(problem, slip=0.2))
    with pytest.raises(UserError, match="wheel radius"):
        verify(replace(problem, vehicle=replace(problem.vehicle, wheel_radius=0.5)))


@pytest.mark.parametrize("name", ["afsmc", "smc"])
@pytest.mark.parametrize("changes", [{"bounds": {"wheelset inertia": (0.0, 860.0)}}, {"speeds": (0.0, 30.0)}])
def test_box_outside_the_model_leaves_the_rest_undecided(make_problem, make_controller, name, changes):
    found = {c.name: c for c in verify(make_problem(make_controller(name), **changes))}
    assert found["gain_positive"].status is Status.REFUTED
    for undecided in ("well_posed", "sliding_exists", "no_go", "open_loop_pole", "sampling", "routh_lag"):
        assert found[undecided].status is Status.UNDECIDED
        assert "not positive" in found[undecided].explanation


BAD_NEWS = re.compile(
    r"unstable|cannot|no gain|no law|violated|diverge|not stable|no margin|strays|swings|drifts|leaves its|locks"
)


def _green_on_bad_news(certificate):
    """Whether a report shows a good sign over a sentence that is bad news about the design."""
    sentences = re.split(r"\. (?=[A-Z])", f"{certificate.claim} {certificate.explanation}")
    said = [each for each in sentences if not each.startswith("Where it is not")]  # what is not the case here
    return Shown[certificate.status.name].tone == "good" and any(map(BAD_NEWS.search, said))


def test_no_green_sign_stands_over_bad_news(certificates):
    assert [each.name for each in certificates if _green_on_bad_news(each)] == []
    for each in certificates:
        assert (Shown[each.status.name].tone == "bad") == (each.status in (Status.REFUTED, Status.LIMITATION))


def test_bad_news_with_a_green_sign_is_seen(certificates):
    refuted = [each for each in certificates if each.status in (Status.REFUTED, Status.LIMITATION)]
    planted = [replace(each, status=Status.PROVED) for each in refuted]
    assert any(map(_green_on_bad_news, planted))
