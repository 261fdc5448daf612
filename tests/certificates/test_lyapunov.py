"""The three Lyapunov functions along the loops that their proofs speak about."""

import json
from dataclasses import replace

import flint
import numpy as np
import pytest
from scipy.integrate import solve_ivp

from wspd_design.certificates.checks.adaptive import lyapunov_printed, lyapunov_repaired
from wspd_design.certificates.checks.sliding import lyapunov_surface
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.records import Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.setting.plant import exact_plant
from wspd_design.certificates.theorems.adaptive_error import Ideal, signals
from wspd_design.certificates.theorems.ideal_loop import adaptive_flow, exact_law, sliding_flow
from wspd_design.controllers import adaptive_fuzzy as law_module
from wspd_design.model.generated import adaptive_fuzzy as generated

RAILS = ("polach-dry", "polach-wet")


@pytest.fixture
def printed(make_problem, make_controller):
    return make_problem(make_controller("afsmc"), speeds=(2.0, 120.0 / 3.6))


@pytest.mark.parametrize("rail", RAILS)
def test_printed_v2_rises_while_the_slip_converges(make_problem, make_controller, rail):
    problem = make_problem(make_controller("afsmc"), rail=rail, speeds=(2.0, 120.0 / 3.6))
    verdict = lyapunov_printed.CHECK.run(problem)
    assert verdict.status is Status.REFUTED
    (values,) = (series for series in verdict.series if series.name == "V2 as printed")
    assert max(values.y) > 10.0 * min(values.y)
    assert values.y.index(min(values.y)) < values.y.index(max(values.y))
    slip = next(series for series in verdict.series if series.name == "slip")
    assert slip.y[-1] == pytest.approx(0.14, abs=2e-3)


@pytest.mark.parametrize("rail", RAILS)
def test_witness_of_the_printed_v2_rises_by_differences(make_problem, make_controller, rail):
    """A short step of the loop from the witness, by hand, with the weights and bound that the witness states."""
    problem = make_problem(make_controller("afsmc"), rail=rail, speeds=(2.0, 120.0 / 3.6))
    verdict = lyapunov_printed.CHECK.run(problem)
    at = {point.name: point.value for point in verdict.witness}
    gains = problem.controller.gains
    plant = (problem.vehicle, problem.rail, gains)
    weights = tuple(at[f"ideal weight {k}"] for k in range(1, 6))
    target = Ideal(weights=weights, bound=at["ideal bound"])
    state = np.array(
        [at["speed"] / 3.6, at["slip"], at["integral of the slip error"]]
        + [at[f"weight {k}"] for k in range(1, 6)]
        + [at["bound"]]
    )
    rates, step = np.array(adaptive_flow(*plant)(state.tolist())), 1e-7

    def v2(state):
        here = signals(*plant, state[:, None], target)
        errors = here.weight_error_squared[0] / 10e3 + here.bound_error[0] ** 2 / 850.0
        return here.surface[0] ** 2 / 3600.0 + here.gain[0] * errors / 2.0

    by_differences = (v2(state + step * rates) - v2(state - step * rates)) / (2.0 * step)
    assert by_differences == pytest.approx(at["least dV2/dt"], rel=1e-5)
    assert at["least dV2/dt"] > 0.0


@pytest.mark.parametrize("module", [lyapunov_printed, lyapunov_surface, lyapunov_repaired])
def test_a_rise_that_only_floats_see_is_undecided(make_problem, make_controller, monkeypatch, module):
    """The planted fault: no state of the run has a derivative that is positive for certain."""
    law = make_controller("smc" if module is lyapunov_surface else "afsmc")
    if module is lyapunov_surface:
        law = replace(law, gains=replace(law.gains, switching_gain=0.5))
    problem = make_problem(law)
    if module is lyapunov_repaired:
        monkeypatch.setattr(generated, "lyapunov_repaired", _without_speed)
    assert module.CHECK.run(problem).status is Status.REFUTED
    monkeypatch.setattr(
        "wspd_design.certificates.theorems.ideal_loop.exact_rate", lambda *_: flint.arb(0, 1e-9)
    )
    verdict = module.CHECK.run(problem)
    assert verdict.status is Status.UNDECIDED
    assert not verdict.witness
    assert "at no state" in verdict.explanation


def test_derivative_is_the_true_one_and_not_the_claimed_one(printed):
    claimed, true = lyapunov_printed.CHECK.run(printed).hypotheses
    assert claimed.status is Status.REFUTED
    assert true.status is Status.EVIDENCE


def test_printed_v2_falls_as_long_as_the_gain_hardly_changes(make_problem, make_controller):
    """The check can also find nothing: in the first tenth of a second the gain is nearly constant."""
    problem = make_problem(make_controller("afsmc"), speeds=(33.1, 120.0 / 3.6))
    assert lyapunov_printed.CHECK.run(problem).status is Status.EVIDENCE


def test_printed_v2_rises_in_a_run_that_shares_no_code(er24pc, printed_gains):
    """Equations (19), (22), (31), (36), (41)-(43) written out, another solver, other ideal weights."""
    gains = printed_gains()
    mass, inertia, radius, load = 76841.0, er24pc.wheel_inertia, er24pc.wheel_radius, 76841.0 * 9.81 / 8.0
    contact = er24pc.contact
    stiffness = np.pi * contact.shear_modulus * contact.semi_axis_rolling * contact.semi_axis_lateral
    stiffness *= contact.kalker_c11 / 4.0 * (load / contact.reference_load) ** (2.0 / 3.0)
    centres, widths = np.array(gains.centres), np.array(gains.widths)

    def plant(v, slip):
        mu = 0.55 * (0.6 * np.exp(-0.6 * slip * v) + 0.4)
        epsilon = stiffness * slip / (load * mu)
        force = 2.0 / np.pi * load * mu * (epsilon / (1.0 + epsilon**2) + np.arctan(0.4 * epsilon))
        resisting = 8.0 * force + er24pc.resistance_constant + er24pc.resistance_linear * v
        deceleration = (resisting + er24pc.resistance_quadratic * v**2) / mass
        drift = -(radius**2 * force / inertia + (1.0 - slip) * deceleration) / v
        drift += er24pc.wheel_damping * (1.0 - slip) / inertia
        return deceleration, drift, 1000.0 * radius / (2.0 * inertia * v)  # gain per kN m

    def weights_of(s):
        memberships = np.exp(-(((s - centres) / widths) ** 2))
        return memberships / memberships.sum()

    def rates(_, state):
        v, slip, integral, *b, psi = state
        s = 1800.0 * (0.14 - slip) + 550.0 * integral
        w = weights_of(s)
        deceleration, drift, gain = plant(v, slip)
        torque = w @ b + psi * np.clip(s, -1.0, 1.0)
        return [-deceleration, drift + gain * torque, 0.14 - slip, *(10.0 * s * w), 0.85 * abs(s)]

    def slow(_, state):
        return state[0] - 2.0

    slow.terminal = True
    start = [120.0 / 3.6, 0.0, 0.0, -1.0, -0.5, 0.0, 0.5, 1.0, 1.0]
    run = solve_ivp(rates, (0.0, 60.0), start, method="BDF", rtol=1e-7, atol=1e-9, events=slow)
    v, slip, integral = run.y[:3]
    surface = 1800.0 * (0.14 - slip) + 550.0 * integral
    _, drift, gain = plant(v, slip)
    ideal = (-drift + 550.0 / 1800.0 * (0.14 - slip)) / gain
    w = np.array([weights_of(s) for s in surface]).T
    for level in (0.0, ideal.min(), ideal.mean(), ideal.max()):
        bound = np.abs(ideal - level * w.sum(axis=0)).max() + 0.1
        weights = np.sum((level - run.y[3:8]) ** 2, axis=0)
        v2 = surface**2 / 3600.0 + gain * (weights / 10.0 + (bound - run.y[8]) ** 2 / 0.85) / 2.0
        assert v2.max() > 4.0 * v2.min()
        assert v2.argmax() > v2.argmin()
    assert slip[-1] == pytest.approx(0.14, abs=2e-3)


@pytest.mark.parametrize("rail", RAILS)
@pytest.mark.parametrize("name", ["afsmc", "afsmc-repaired"])
def test_repaired_v_does_not_rise(make_problem, make_controller, name, rail):
    verdict = lyapunov_repaired.CHECK.run(
        make_problem(make_controller(name), rail=rail, speeds=(2.0, 120.0 / 3.6))
    )
    assert verdict.status is Status.EVIDENCE
    assert all(hypothesis.status is Status.EVIDENCE for hypothesis in verdict.hypotheses)


def test_repaired_law_is_not_judged_by_the_printed_v2(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc-repaired"))
    assert lyapunov_printed.CHECK.run(problem).status is Status.NOT_APPLICABLE


def _wrong_sign_of_the_weights(s_d, speed, gain_speed, weights, bound, alpha1, alpha2):
    return bound**2 / (2.0 * alpha2) + s_d**2 * speed / (2.0 * gain_speed) - weights / (2.0 * alpha1)


def _without_speed(s_d, _, gain_speed, weights, bound, alpha1, alpha2):
    return bound**2 / (2.0 * alpha2) + s_d**2 / (2.0 * gain_speed) + weights / (2.0 * alpha1)


@pytest.mark.parametrize("wrong", [_wrong_sign_of_the_weights, _without_speed])
def test_wrong_v_is_refuted(printed, monkeypatch, wrong):
    monkeypatch.setattr(generated, "lyapunov_repaired", wrong)
    verdict = lyapunov_repaired.CHECK.run(printed)
    assert Status.REFUTED in {verdict.status, *(hypothesis.status for hypothesis in verdict.hypotheses)}
    assert verdict.status is Status.REFUTED


@pytest.mark.parametrize(("weights", "bound"), [(-0.05, 1.0), (1.0, -1.0)])
def test_wrong_sign_of_the_adaptation_is_refuted(printed, monkeypatch, weights, bound):
    """The weights unlearn slowly, so that the run has states at which the hypotheses of the repair hold."""
    right = law_module.adaptation

    def wrong(gains, surface, speed):
        rates = right(gains, surface, speed)
        return rates._replace(
            weights=tuple(weights * rate for rate in rates.weights), bound=bound * rates.bound
        )

    monkeypatch.setattr("wspd_design.certificates.theorems.ideal_loop.adaptation", wrong)
    assert lyapunov_repaired.CHECK.run(printed).status is Status.REFUTED


def test_sliding_mode_with_enough_gain_reaches_its_layer(make_problem, make_controller):
    law = make_controller("smc")
    strong = replace(law, gains=replace(law.gains, switching_gain=25.0))
    verdict = lyapunov_surface.CHECK.run(make_problem(strong))
    assert verdict.status is Status.EVIDENCE
    assert {series.name for series in verdict.series} >= {"V from slip 0.02", "V from slip 0.6"}


def test_sliding_mode_with_too_little_gain_is_refuted(make_problem, make_controller):
    law = make_controller("smc")
    weak = replace(law, gains=replace(law.gains, switching_gain=0.5))
    verdict = lyapunov_surface.CHECK.run(make_problem(weak))
    assert verdict.status is Status.REFUTED
    at = {point.name: point.value for point in verdict.witness}
    assert at["least dV/dt"] > 0.0
    error = 0.14 - at["slip"]
    surface = error + weak.gains.surface_rate * at["integral of the slip error"]
    assert abs(surface) > weak.gains.boundary_layer


def test_each_v_speaks_about_its_own_law(make_problem, make_controller):
    sliding, adaptive = make_problem(make_controller("smc")), make_problem(make_controller("afsmc"))
    assert lyapunov_surface.CHECK.run(adaptive).status is Status.NOT_APPLICABLE
    assert lyapunov_printed.CHECK.run(sliding).status is Status.NOT_APPLICABLE
    assert lyapunov_repaired.CHECK.run(sliding).status is Status.NOT_APPLICABLE


def test_exact_flows_enclose_those_of_the_runs(er24pc, make_controller, make_problem):
    problem = make_problem(make_controller("smc"))
    law = problem.controller
    rng = np.random.default_rng(7)
    for _ in range(20):
        state = [rng.uniform(3.0, 33.0), rng.uniform(0.03, 0.5), rng.uniform(-0.1, 0.1)]
        floats = sliding_flow(er24pc, problem.rail, law)(state)
        exact = sliding_flow(*exact_plant(problem), exact_law(law))([flint.arb(x) for x in state])
        for ball, number in zip(exact, floats, strict=True):
            assert abs(float(ball.mid()) - number) <= 1e-11 * (1.0 + abs(number))
            assert float(ball.rad()) <= 1e-11 * (1.0 + abs(number))


ROUND_TRIPS = {
    lyapunov_surface: "smc",
    lyapunov_printed: "afsmc",
    lyapunov_repaired: "afsmc",
}


@pytest.mark.parametrize("module", ROUND_TRIPS, ids=lambda module: module.CHECK.name)
def test_a_file_is_what_the_design_gives(make_problem, make_controller, module):
    """Evidence stays evidence; no word, no number of it can be changed into another verdict."""
    problem = make_problem(make_controller(ROUND_TRIPS[module]))
    kept = certificate_text(module.CHECK.run(problem))
    found = replay(problem, kept)
    assert found.accepted, found.reason
    content = json.loads(kept)
    for changes in (
        {"status": "PROVED"},
        {"claim": "Every stop is stable."},
        {"assumptions": []},
        {"margin": {"low": 1.0, "high": 2.0, "unit": "-"}},
        {"hypotheses": []},
        {"findings": {}},
    ):
        forged = content | changes
        if any(content[key] != entry for key, entry in changes.items()):
            assert not replay(problem, json.dumps(forged)).accepted, changes


@pytest.mark.parametrize("change", ["speed", "bound", "ideal bound", "slip"])
def test_a_witness_that_denies_nothing_is_refused(make_problem, make_controller, change):
    """The state of a refuted V2 is evaluated again: moved to where V2 falls, or (34) fails, it is refused."""
    problem = make_problem(make_controller("afsmc"))
    content = json.loads(certificate_text(lyapunov_printed.CHECK.run(problem)))
    place = content["findings"]["rise"]["place"]
    moved = {"speed": "100.0", "bound": "1e6", "ideal bound": "0.0", "slip": "0.9"}[change]
    found = replay(problem, json.dumps(_with(content, place | {change: moved})))
    assert not found.accepted
    missing = {name: at for name, at in place.items() if name != change}
    assert not replay(problem, json.dumps(_with(content, missing))).accepted


def _with(content, place):
    rise = content["findings"]["rise"] | {"place": place}
    return content | {"findings": content["findings"] | {"rise": rise}}
