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


def printed_filling(t, t0, start, full, _rate, tau):
    """Eq. (10) with a supply that is there at once."""
    return start + (full - start) * (1 - brake.exp(-(t - t0) / tau))


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
    "energy without the speed": (adaptive_fuzzy, "lyapunov_repaired", energy_without_speed),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_wrong_function_is_refuted(problem, monkeypatch, fault):
    module, name, wrong = FAULTS[fault]
    monkeypatch.setattr(module, name, wrong)
    found = derivation.check(problem)
    assert found.status is Status.REFUTED
    assert sum(h.status is Status.REFUTED for h in found.hypotheses) >= 1
