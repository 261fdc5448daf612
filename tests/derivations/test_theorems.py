"""The theorems of the theory page rest on identities that SymPy confirms."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm

from derivations.theorem import Identity
from tests.lazily import Lazily
from wspd_design.certificates import suite
from wspd_design.certificates.suite import NAMES
from wspd_design.certificates.theorems import quadratic
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import load_rail

adaptive_loop, recovery, sampled_loop = map(Lazily, ("adaptive_loop", "recovery", "sampled_loop"))
stop_limit, valve_limit, valve_map = map(Lazily, ("stop_limit", "valve_limit", "valve_map"))
map_files, theorems = Lazily("map_files"), Lazily("theorems")
CITATION = re.compile(r"docs/theory\.md#([a-z-]+)")


def test_every_identity_holds():
    assert theorems.THEOREMS
    for theorem in theorems.THEOREMS:
        assert theorem.identities, theorem.anchor
        assert all(identity.residual == 0 for identity in theorem.identities), theorem.anchor
        assert theorem.hypotheses, theorem.anchor
        assert theorem.not_said, theorem.anchor


def test_a_wrong_identity_stops_the_page(monkeypatch):
    wrong = replace(theorems.THEOREMS[0], identities=(Identity("1 = 2", sp.Integer(-1)),))
    monkeypatch.setattr("derivations.map_files.THEOREMS", (wrong,))
    with pytest.raises(ValueError, match="1 = 2 has the residual -1"):
        map_files.theory()


def test_theorems_name_the_checks_of_the_suite_and_no_others():
    told = {name for theorem in theorems.THEOREMS for name in theorem.certificates}
    assert told == set(NAMES)


def test_references_to_the_theory_page_exist():
    anchors = {theorem.anchor for theorem in theorems.THEOREMS}
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


def theorem_of(anchor):
    return next(theorem for theorem in theorems.THEOREMS if theorem.anchor == anchor)


@pytest.mark.parametrize("pole", [2.0, 5.0, 11.0])  # all beyond 1/tau
def test_no_go_does_not_speak_about_a_lead_filter_or_a_copy_of_the_valve(pole):
    tau, numbers = 0.6, {valve_limit.p: pole, valve_limit.tau: 0.6, valve_limit.G: 73.1e-6}
    poles = np.linalg.eigvals(np.array(valve_limit.lead.subs(numbers), dtype=float))
    assert np.sort_complex(poles) == pytest.approx([-6.0, -6.0, -1 / tau], abs=1e-3)
    gains = {valve_limit.kappa: 2e6, valve_limit.back: 12.0}
    poles = np.linalg.eigvals(np.array(valve_limit.copy.subs(numbers | gains), dtype=float))
    assert poles.real.max() < 0
    assert poles.sum().real == pytest.approx(pole - 1 / tau - 13.0 / tau)  # p - 1/tau + trace(A_c)


@pytest.mark.parametrize("pole", [1.7, 5.0])
def test_law_with_integrals_alone_is_unstable_beyond_one_over_tau(pole):
    """Random gains on slip and two integrals of it: never stable; with p below 1/tau some are."""
    tau, random = 0.6, np.random.default_rng(2)

    def unstable(p, gains):
        matrix = np.zeros((4, 4))
        matrix[0, :2], matrix[1, 1], matrix[2, 0], matrix[3, 2] = (p, -1.0), -1 / tau, 1.0, 1.0
        matrix[1, [0, 2, 3]] = gains
        return np.linalg.eigvals(matrix).real.max() >= 0

    draws = 10.0 ** random.uniform(-3, 4, (300, 3))
    assert all(unstable(pole, gains) for gains in draws)
    assert not all(unstable(-pole, gains) for gains in draws)


def test_no_go_states_its_class_first():
    statement = theorem_of("no-go").statement
    assert statement.startswith(
        "If a law does not read the torque (du/dT = 0) and its memory holds nothing but"
    )
    assert "trace(A_c)" in statement
    assert "lead filter" in theorem_of("no-go").not_said


@pytest.mark.parametrize(
    ("anchor", "first"),
    [
        ("barbalat", "If the rates of adaptation are alpha/v"),
        ("energy", "While T = u, or else the adaptation is held and eta <= u* <= T_max - eta"),
        ("reaching", "As long as the slip stays inside the range"),
        ("routh", "If the estimates of an adaptive law are frozen"),
        ("lpv", "If an equilibrium of the actual parameters lies within the tolerance"),
        ("existence", "If T = u"),
    ],
)
def test_conditions_stand_before_the_conclusion(anchor, first):
    statement = theorem_of(anchor).statement
    place = statement.index(first)
    for conclusion in (
        "does not increase",
        "tends to zero",
        "falls",
        "is stable",
        "attractive",
        "is reached",
    ):
        assert statement.find(conclusion, 0, place) == -1


def test_reaching_does_not_claim_every_start():
    text = map_files.theory()
    assert "everywhere the slip" not in text
    assert "from everywhere" not in text
    assert "only if v_0 exp(-a_max abs(sbar_0)/eta) > v_low" in theorem_of("reaching").statement


@pytest.mark.parametrize("anchor", ["routh", "lpv"])
def test_existence_of_the_equilibrium_is_a_hypothesis(anchor):
    assert any(
        hypothesis.startswith("an equilibrium lies within the tolerance")
        for hypothesis in theorem_of(anchor).hypotheses
    )


def test_poles_of_the_printed_law_with_and_without_adaptation(er24pc):
    """Audit M1: table10-dry at 10 m/s, -0.31 with frozen estimates, +2.63 +- 15.8j with the adaptation (41)."""
    dynamics = slip_dynamics(er24pc, load_rail("table10-dry"), 0.14, 10.0)
    centres, width, weights = np.array([-252.0, -126.0, 0.0, 126.0, 252.0]), 75.6707, [-1, -0.5, 0, 0.5, 1]
    membership = np.exp(-((centres / width) ** 2))
    basis = membership / membership.sum()
    slope = 1e3 * (1.0 + (np.array(weights) * basis * 2 * centres / width**2).sum())  # N m per s, psi_hat = 1
    numbers = {
        adaptive_loop.p: float(dynamics.pole),
        adaptive_loop.G: float(dynamics.gain),
        adaptive_loop.tau: 0.6,
        adaptive_loop.K_P: 1800.0,
        adaptive_loop.K_I: 550.0,
        adaptive_loop.k_s: slope,
    }
    kappa = 10.0 * 1e3 * basis @ basis

    def poles(rate):
        found = [
            float(sp.sympify(c).subs(numbers | {adaptive_loop.kappa: rate}))
            for c in adaptive_loop.characteristic
        ]
        return np.roots(found)

    # Frozen: the fourth root is the zero of the integral w^T (b_hat - b_0), which then stands still.
    assert sorted(poles(0.0).real)[-2:] == pytest.approx([-0.31, 0.0], abs=0.01)
    worst = max(poles(kappa), key=lambda root: root.real)
    assert worst.real == pytest.approx(2.63, abs=0.02)
    assert abs(worst.imag) == pytest.approx(15.8, abs=0.1)


def test_adaptive_polynomial_against_finite_differences():
    """The Jacobian of the nonlinear loop of five rules, by central differences, has the roots of the quartic."""
    p, gain, tau, k_p, k_i, alpha = 1.3, 0.8, 0.5, 2.0, 0.7, 0.9
    centres, weights, psi, layer = np.linspace(-2, 2, 5), np.array([-1.0, -0.4, 0.3, 0.5, 1.2]), 0.6, 0.5

    def basis(s):
        mu = np.exp(-((s - centres) ** 2))
        return mu / mu.sum()

    def rates(x):
        e, torque, integral, *moved = x
        s = k_p * e + k_i * integral
        u = (weights + moved) @ basis(s) + psi * s / layer - weights @ basis(0.0)
        return np.array([p * e - gain * torque, (u - torque) / tau, e, *(alpha * s * basis(s))])

    step, rest = 1e-6, np.zeros(8)
    jacobian = np.column_stack(
        [(rates(rest + step * x) - rates(rest - step * x)) / (2 * step) for x in np.eye(8)]
    )
    slope = (weights @ (basis(step) - basis(-step))) / (2 * step) + psi / layer
    numbers = {
        adaptive_loop.p: p,
        adaptive_loop.G: gain,
        adaptive_loop.tau: tau,
        adaptive_loop.K_P: k_p,
        adaptive_loop.K_I: k_i,
        adaptive_loop.k_s: slope,
        adaptive_loop.kappa: alpha * basis(0.0) @ basis(0.0),
    }
    quartic = [float(sp.sympify(c).subs(numbers)) for c in adaptive_loop.characteristic]
    expected = np.concatenate([np.array(quartic) / tau, np.zeros(4)])  # four directions that s does not see
    assert np.poly(jacobian) == pytest.approx(expected, rel=1e-6, abs=1e-6)


def test_one_sample_map_of_the_valve_against_an_integration():
    from scipy.integrate import solve_ivp

    fill_time, vent_time, period, supply, torque = 0.3, 0.1, 0.02, 6e4, 2.5e4
    filled, vented = 0.6, 0.3  # shares of the sample; it holds in between
    first = solve_ivp(
        lambda _, y: (supply - y) / fill_time, (0, filled * period), [torque], rtol=1e-10, atol=1e-6
    )
    last = solve_ivp(lambda _, y: -y / vent_time, (0, vented * period), first.y[:, -1], rtol=1e-10, atol=1e-6)
    numbers = {
        valve_map.T: torque,
        valve_map.T_in: supply,
        valve_map.T_F: fill_time,
        valve_map.T_V: vent_time,
        valve_map.h: period,
        valve_map.a: filled,
        valve_map.b: vented,
    }
    assert float(valve_map.sampled.subs(numbers)) == pytest.approx(last.y[0, -1], rel=1e-8)


def test_slower_valve_time_is_not_the_safe_side():
    """Pulses of 20 ms, K = 14: a deviation of the torque dies out with .3 s for both, and grows with .08 s to vent."""
    assert abs(valve_map.factor_of_slower) < 1 < abs(valve_map.factor_of_valve)

    def torque_after(samples, vent_time):
        def sample(torque, duty):
            torque = 1 - (1 - torque) * np.exp(-duty * 0.02 / 0.3)
            return torque * np.exp(-(1 - duty) * 0.02 / vent_time)

        low, high = 0.0, 1.0  # the duty that holds 1/2
        for _ in range(60):
            low, high = (
                ((low + high) / 2, high) if sample(0.5, (low + high) / 2) < 0.5 else (low, (low + high) / 2)
            )
        torque = 0.501
        for _ in range(samples):
            torque = sample(torque, min(max(low - 14.0 * (torque - 0.5), 0.0), 1.0))
        return abs(torque - 0.5)

    assert torque_after(15, 0.3) < 1e-6
    assert torque_after(15, 0.08) > 5e-3


def test_load_transfer_may_raise_the_sum_of_the_peaks():
    assert stop_limit.load_transfer_example > 0.004
    polach = {"mu0": 0.55, "friction_ratio": 0.4, "friction_decay": 0.6}
    polach |= {"adhesion_reduction": 1.0, "slip_reduction": 0.4}
    force = [stop_limit.largest_force(share * 94_226.0, 57 / 3.6, **polach) for share in (1.3, 0.7, 1.0)]
    assert force[0] + force[1] < 2 * force[2]  # on the published dry rail it lowers it


def test_checker_evaluates_the_derived_formulas():
    """The functions of the certificates on symbols are those that stand on the theory page."""
    tau, slide, torque, top, inertia, q = (sp.Rational(n, 7) for n in (2, 3, 5, 11, 13, 17))
    law = quadratic.Law(slide=slide, torque=torque, sample_time=sp.Integer(1))
    (coded,) = set(quadratic.averaged(law, ((tau, tau), (tau, tau), (top, top), (inertia, inertia), (q, q))))
    numbers = {sampled_loop.q: q, sampled_loop.forgetting: 1 / tau, sampled_loop.driving: 1 / tau}
    numbers |= {
        sampled_loop.gamma * sampled_loop.kappa: slide * top / inertia,
        sampled_loop.back: torque * top,
    }
    assert sp.Matrix(coded) == sampled_loop.rates.subs(numbers)
    any_matrix = sampled_loop.any_matrix.tolist()
    pairs = (
        (quadratic.decays(sampled_loop.entries, any_matrix, sampled_loop.decay), sampled_loop.decrease),
        (quadratic.contracts(sampled_loop.entries, any_matrix, sampled_loop.kept), sampled_loop.contraction),
    )
    for found, derived in pairs:
        assert [sp.expand(a - b) for a, b in zip(found, derived, strict=True)] == [0, 0, 0]
