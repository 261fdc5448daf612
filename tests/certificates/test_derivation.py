"""The certificate of the equations runs the installed functions on symbols; a planted fault in any is found."""

import pytest

from wspd_design.certificates import derivation
from wspd_design.certificates.records import Status
from wspd_design.model.generated import adaptive_fuzzy, brake, motion, sliding_surface, slip


@pytest.fixture
def problem(make_problem, make_controller):
    return make_problem(make_controller("smc"))


def test_the_installed_functions_are_proved(problem):
    found = derivation.check(problem)
    assert found.status is Status.PROVED
    assert len(found.hypotheses) == len(derivation.IDENTITIES)
    assert "14" in found.explanation


FAULTS = {
    "sign of the torque": (slip, "slip_gain", lambda true: lambda *a: -true(*a)),
    "number of wheels": (motion, "train_acceleration", lambda true: lambda f, f_d, m: (-f_d - 4 * f) / m),
    "drift without the train": (slip, "slip_drift", lambda true: lambda lam, *a: true(0 * lam, *a)),
    "lag": (brake, "torque_rate", lambda true: lambda torque, u, most, tau: true(torque, u, most, 2 * tau)),
    "printed filling": (
        brake,
        "filled_pressure",
        lambda true: lambda t, t0, p0, full, r, tau: p0 + (full - p0) * (1 - brake.exp(-(t - t0) / tau)),
    ),
    "equivalent torque": (
        sliding_surface,
        "equivalent_torque",
        lambda true: lambda f, g, d, e, c: (f + d + c * e) / g,
    ),
    "energy without the speed": (
        adaptive_fuzzy,
        "lyapunov_repaired",
        lambda true: lambda s, v, g, *a: true(s, v / v, g, *a),
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_wrong_function_is_refuted(problem, monkeypatch, fault):
    module, name, wrong = FAULTS[fault]
    monkeypatch.setattr(module, name, wrong(getattr(module, name)))
    found = derivation.check(problem)
    assert found.status is Status.REFUTED
    assert sum(h.status is Status.REFUTED for h in found.hypotheses) >= 1
