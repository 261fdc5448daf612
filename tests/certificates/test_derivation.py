"""The certificate of the equations runs the installed functions on symbols; a planted fault in any is found."""

import json

import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed
from wspd_design.certificates.checks.foundations import derivation
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.theorems import equations
from wspd_design.model.generated import adaptive_fuzzy, brake, motion, sliding_surface, slip
from wspd_design.parameters.equations import load_equations


@pytest.fixture
def problem(make_problem, make_controller):
    return make_problem(make_controller("smc"))


def test_the_installed_functions_are_proved(problem):
    kept = keep(derivation.CHECK, problem)
    assert kept.certificate.status is Status.PROVED
    assert len(kept.content["findings"]) == len(kept.certificate.hypotheses) == len(equations.IDENTITIES)
    no_word_can_be_changed(kept)
    no_proof_can_be_missed(kept)


def test_sympy_simplifies_the_same_differences_to_zero(problem):
    """Another way of deciding: no prime field."""
    import sympy as sp

    for claim in equations.identities(problem):
        assert sp.simplify(sp.nsimplify(claim.left - claim.right)) == 0, claim.text


def test_misprints_are_listed_with_what_they_leave_over(problem, monkeypatch):
    explanation = derivation.CHECK.run(problem).explanation
    listed = [entry for entry in load_equations() if "misprint" in entry.verdicts]
    assert {"14", "23", "28", "39"} <= {entry.number for entry in listed}
    assert "(14): -ū*T_max + ū'*T" in explanation
    assert all(entry.residual in explanation for entry in listed)
    monkeypatch.setattr(equations, "load_equations", lambda: listed[:1])
    assert equations.misprints().endswith(f"leaves over: B_W: {listed[0].residual}.")


def printed_filling(t, t0, start, full, _rate, tau):
    """Eq. (10) with a supply that is there at once."""
    return start + (full - start) * (1 - brake.exp(-(t - t0) / tau))


def printed_rate(s, gain, _gain_rate, xi, psi, *_rest, true=adaptive_fuzzy.lyapunov_printed_rate_claimed):
    """Eq. (44) without the terms of G'."""
    return true(s, gain, xi, psi)


def energy_without_speed(s, v, g, *rest, true=adaptive_fuzzy.lyapunov_repaired):
    return true(s, v / v, g, *rest)


def drift_without_slip(slip_ratio, *rest, true=slip.slip_drift):
    return true(0 * slip_ratio, *rest)


FAULTS = {
    "sign of the torque": (slip, "slip_gain", lambda v, i, r, true=slip.slip_gain: -true(v, i, r)),
    "number of wheels": (motion, "train_acceleration", lambda f, f_d, m: (-f_d - 4 * f) / m),
    "drift without the slip": (slip, "slip_drift", drift_without_slip),
    "lag": (brake, "torque_rate", lambda t, u, most, tau, true=brake.torque_rate: true(t, u, most, 2 * tau)),
    "printed filling": (brake, "filled_pressure", printed_filling),
    "equivalent torque": (sliding_surface, "equivalent_torque", lambda f, g, d, e, c: (f + d + c * e) / g),
    "rate of V2 as printed": (adaptive_fuzzy, "lyapunov_printed_rate_true", printed_rate),
    "energy without the speed": (adaptive_fuzzy, "lyapunov_repaired", energy_without_speed),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_wrong_function_is_refuted(problem, monkeypatch, fault):
    kept = keep(derivation.CHECK, problem)
    module, name, wrong = FAULTS[fault]
    monkeypatch.setattr(module, name, wrong)
    found = derivation.CHECK.run(problem)
    assert found.status is Status.REFUTED
    assert sum(h.status is Status.REFUTED for h in found.hypotheses) >= 1
    assert "a function of the model is wrong" in found.explanation
    # The file of the right function is not for the wrong one, whoever writes the wrong statement into it.
    assert not replay(problem, json.dumps(kept.content)).accepted
    content = dict(kept.content, findings={})
    for each in equations.identities(problem):
        proof = {
            "format": kept.content["findings"][each.key]["proof"]["format"],
            "statement": each.statement(),
        }
        content["findings"][each.key] = {"proof": proof}
    assert "not the same function" in replay(problem, json.dumps(content)).reason
