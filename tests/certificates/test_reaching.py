"""The reaching condition against the reference problem, whose supremum is known from an interval proof."""

from dataclasses import replace

import numpy as np
import pytest

from tests.certificates.round_trip import (
    keep,
    no_proof_can_be_missed,
    no_word_can_be_changed,
    not_for,
    refused,
)
from wspd_design.certificates.checks.sliding import reaching
from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.quantities import AXLE, PLANT, STATE
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.together import settle_together
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.domain import INERTIA, MASS, MU0, SLIP, SPEED
from wspd_design.certificates.setting.model_error import mismatch
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.edges import together
from wspd_design.certificates.theorems.sliding import gain_claims, largest_deceleration, reserve
from wspd_design.controllers.protocol import Command
from wspd_design.controllers.sliding_mode import SlidingMode, sliding_torque
from wspd_design.model.slip import slip_dynamics

pytestmark = pytest.mark.usefixtures("remembered")

KNOWN_SUPREMUM = 24.7935  # m/s2, enclosed by 24.793 and 24.794
PLACE = {"slip": 0.121, "speed": 2.0 * 3.6, "mass": 1.2 * 76841.0, "mu0": 0.6}


def _random_points(problem, count, seed=0):
    low, high = domain.box(problem)
    return np.random.default_rng(seed).uniform(low, high, (count, 5))


def _static(problem, tolerance=1e-3):
    """What is found about the axle at static load, as in the reference problem."""
    claims = gain_claims(problem, uses=PLANT)
    stated = settle_together(claims, tolerance=tolerance)
    work = Work()
    return together([each.decide(stated[each.key], work) for each in claims])


def test_supremum_of_the_reference_problem(make_reference_problem):
    problem = make_reference_problem()
    found = reaching.supremum(gain_claims(problem, uses=PLANT), tolerance=1e-3)
    eta = reserve(problem)
    assert 24.792 < found.value - eta <= found.upper - eta < 24.7945
    assert found.upper - found.value < 1e-3
    at = {point.name: point.value for point in found.point}
    for name, value in PLACE.items():
        assert at[name] == pytest.approx(value, rel=3e-3)


def test_gain_that_satisfies_100_000_random_points_is_refuted(make_reference_problem):
    """Sampling alone would certify a false bound; climbing from the samples finds the counterexample."""
    problem = make_reference_problem()
    sampled = np.abs(mismatch(problem, problem.controller, _random_points(problem, 100_000)).residual)
    assert sampled.max() < KNOWN_SUPREMUM - 0.5
    eta = reserve(problem)
    for gain in (sampled.max() + eta + 0.01, KNOWN_SUPREMUM + eta - 0.01):
        found = _static(make_reference_problem(gain))
        assert found.status is Status.REFUTED
        assert found.low > gain  # the inertia is known, so rho = 1
        assert found.margin.low < found.margin.high < 0.0
        assert found.margin.high == pytest.approx(gain - KNOWN_SUPREMUM - eta, abs=2e-3)


def test_gain_above_the_supremum_is_proved(make_reference_problem):
    gain = KNOWN_SUPREMUM + reserve(make_reference_problem()) + 0.01
    found = _static(make_reference_problem(gain))
    assert found.status is Status.PROVED
    assert 0.0 < found.margin.low < found.margin.high < 0.02


@pytest.fixture(scope="module")
def proved(make_problem, make_controller, narrow, er24pc):
    """The sliding mode on wet rail with enough gain for every axle, mass, inertia and friction."""
    law = make_controller("smc", "polach-wet")
    strong = replace(law, gains=replace(law.gains, switching_gain=20.0))
    bounds = narrow(er24pc, law.rail, mass=(70e3, 80e3), mu0=(0.28, 0.32)) | {
        "wheelset inertia": (740.0, 760.0),
        "axle load share": (0.85, 1.15),
    }
    problem = make_problem(strong, rail="polach-wet", bounds=bounds, speeds=(5.0, 30.0), slips=(0.05, 0.4))
    return keep(reaching.CHECK, problem)


def test_words_and_proofs(proved):
    assert proved.certificate.status is Status.PROVED
    assert all(each.status is Status.PROVED for each in proved.certificate.hypotheses)
    no_word_can_be_changed(proved)
    no_proof_can_be_missed(proved)


def test_the_claim_says_where_and_for_whom(proved):
    """Nothing is promised from everywhere: range and speed come first."""
    claim = proved.certificate.claim
    assert claim.startswith("While the slip stays between 0.05 and 0.4 and the speed above 18 km/h, ")
    assert "every axle" in claim
    assert "axle load share 0.85 to 1.15" in claim
    assert "verywhere" not in claim + proved.certificate.explanation
    assert set(AXLE) <= set(proved.certificate.varied)


def test_the_file_is_of_this_design_alone(proved):
    problem, law = proved.problem, proved.problem.controller
    weaker = replace(law, gains=replace(law.gains, switching_gain=19.9))
    assert not_for(proved, replace(problem, controller=weaker))
    for name, ends in {"mass": (70e3, 81e3), "axle load share": (0.85, 1.16)}.items():
        assert not_for(proved, replace(problem, bounds=problem.bounds | {name: ends})), name
    assert not_for(proved, replace(problem, rail=replace(problem.rail, slip_reduction=0.11)))
    assert not_for(proved, replace(problem, slips=(0.05, 0.41)))


def test_no_random_point_needs_more_than_is_proved(proved):
    """Points of the whole box, its rail and contact included, not only of the edges that are searched."""
    _no_point_beyond(proved.problem, proved.certificate)


def test_a_heavier_axle_refutes_the_gain_of_the_static_load(make_problem, make_controller):
    """Audit A5: what was enough for the quarter locomotive repels an axle with 1.15 of its load."""
    law = make_controller("smc", "polach-wet")
    static = replace(law, gains=replace(law.gains, switching_gain=9.647))
    problem = make_problem(static, rail="polach-wet")
    kept = keep(reaching.CHECK, problem)
    assert kept.certificate.status is Status.REFUTED
    at = {point.name: point.value for point in kept.certificate.witness}
    assert at["(abs(r) + eta)/rho"] > 9.647
    assert at["axle load share"] > 1.15
    assert refused(kept, status="PROVED")
    # v sbar' at slip .222, 10 km/h on the side sbar > Phi, W0 = 9.647.
    point = np.array([[0.222, 10.0 / 3.6, 92209.0, 860.0, 0.36]])
    for share, expected in ((1.0, -0.37), (1.10, 2.09), (1.15, 3.31)):
        at = dict(zip(AXLE, (share, 3.1), strict=True))
        slowing = plant_with(problem, {"mass": 92209.0, "mu0": 0.36, "wheelset inertia": 860.0})
        at[AXLE[1]] = slip_dynamics(*slowing, 0.222, 10.0 / 3.6).deceleration
        known = mismatch(problem, static, point, at)
        rate = float(known.residual[0] - known.inertia_ratio[0] * 9.647)
        assert rate == pytest.approx(expected, abs=0.15)


def test_the_ranges_of_the_rail_file_count(make_problem, make_controller, narrow, er24pc):
    """Audit A7: with its own ranges of A, B, kA and kS the rail asks for 10.87, where 9.647 was chosen."""
    law = make_controller("smc", "polach-wet")
    static = replace(law, gains=replace(law.gains, switching_gain=9.647))
    problem = make_problem(static, rail="polach-wet")
    known = ("mass", "wheelset inertia", "mu0")
    only = (*known, "friction ratio", "friction decay", "adhesion reduction", "slip reduction")
    exact = narrow(er24pc, problem.rail, **{name: problem.span(name) for name in only})
    at_static_load = replace(problem, bounds=problem.bounds | exact)
    found = reaching.supremum(gain_claims(at_static_load, uses=PLANT))
    assert found.value >= 10.87
    without = replace(
        at_static_load,
        bounds=problem.bounds | narrow(er24pc, problem.rail, **{n: problem.span(n) for n in only[:3]}),
    )
    assert reaching.supremum(gain_claims(without, uses=PLANT)).upper < 9.647


def test_reserve_brings_a_wheel_to_the_surface_above_the_lowest_speed(make_problem, make_controller):
    """In sigma = integral of dt/v a rolling wheel needs slip/eta, in which the speed falls to the lowest at most."""
    problem = make_problem(make_controller("smc"))
    low, high = problem.speeds
    sigma = problem.slip / reserve(problem)
    assert high * np.exp(-largest_deceleration(problem) * sigma) == pytest.approx(low, rel=1e-12)
    # a_max is not beaten by any point of the domain at static load.
    points = _random_points(problem, 2000)
    slowing = [
        slip_dynamics(
            *plant_with(problem, {"mass": p[MASS], "wheelset inertia": p[INERTIA], "mu0": p[MU0]}),
            p[SLIP],
            p[SPEED],
        ).deceleration
        for p in points
    ]
    assert max(slowing) <= largest_deceleration(problem)


def test_plot_shows_the_needed_gain_below_its_supremum(proved):
    needed, chosen = proved.certificate.series
    margin = proved.certificate.margin
    assert max(needed.y) <= 20.0 - margin.low
    assert max(needed.y) == pytest.approx(20.0 - margin.high, rel=0.03)
    assert chosen.y == (20.0, 20.0)


def test_mismatch_is_what_the_plant_does_under_the_law(make_problem, make_controller):
    """v sbar' = r - rho W0 sat(sbar / layer), with sbar' from the plant under the torque of the law."""
    law = make_controller("smc")
    problem = make_problem(law)
    points = _random_points(problem, 50, seed=4)
    known = mismatch(problem, law, points)
    for row, residual, ratio in zip(points, known.residual, known.inertia_ratio, strict=True):
        values = {"mass": row[MASS], "wheelset inertia": row[INERTIA], "mu0": row[MU0]}
        plant = slip_dynamics(*plant_with(problem, values), row[SLIP], row[SPEED])
        error = 0.14 - row[SLIP]
        for surface in (0.5, 0.01, -0.3):
            integral = (surface - error) / law.gains.surface_rate
            torque = sliding_torque(law, row[SLIP], row[SPEED], integral)
            surface_rate = -(plant.drift + plant.gain * torque) + law.gains.surface_rate * error
            switching = (
                ratio * law.gains.switching_gain * np.clip(surface / law.gains.boundary_layer, -1.0, 1.0)
            )
            assert row[SPEED] * surface_rate == pytest.approx(residual - switching, rel=1e-9, abs=1e-9)


def test_unknown_inertia_asks_for_more_gain(proved):
    problem = proved.problem
    inertia = problem.controller.vehicle.wheelset_inertia
    known = replace(problem, bounds=problem.bounds | {"wheelset inertia": (inertia, inertia)})
    assert reaching.required_gain(problem).value > reaching.required_gain(known).value


class AlwaysFills(SlidingMode):
    """Audit A3: a law that brakes fully, with the gains and the class of another."""

    __slots__ = ()

    def step(self, state, measurement):  # noqa: ARG002 - it measures nothing
        return state, Command(fill=1.0, vent=0.0)


def test_a_law_inherits_nothing(proved):
    law = proved.problem.controller
    evil = AlwaysFills(
        name="evil", sample_time=law.sample_time, vehicle=law.vehicle, rail=law.rail, gains=law.gains
    )
    problem = replace(proved.problem, controller=evil)
    assert reaching.CHECK.run(problem).status is Status.NOT_APPLICABLE
    assert not_for(proved, problem)


def test_laws_without_friction_model_have_no_reaching_condition(make_problem, make_controller):
    problem = make_problem(make_controller("afsmc"))
    assert reaching.CHECK.run(problem).status is Status.NOT_APPLICABLE


def test_another_wheel_radius_leaves_it_open(proved):
    vehicle = replace(proved.problem.vehicle, wheel_radius=0.54)
    bounds = proved.problem.bounds | {"wheel radius": (0.54, 0.54)}
    found = reaching.CHECK.run(replace(proved.problem, vehicle=vehicle, bounds=bounds))
    assert found.status is Status.UNDECIDED


def _no_point_beyond(problem, certificate):
    names = tuple(name for name in domain.uncertain(problem) if name in (*PLANT, *AXLE))
    spans = {name: domain.span(problem, name) for name in (*STATE, *names)}
    rng = np.random.default_rng(1)
    points = np.array([rng.uniform(*ends, 4000) for ends in spans.values()])
    values = dict(zip(spans, points, strict=True))
    known = [values[n] if n in values else np.full(4000, problem.nominal(n)) for n in domain.BASIC]
    basic = np.array(known).T
    others = {name: values[name] for name in names if name not in domain.BASIC}
    known = mismatch(problem, problem.controller, basic, others)
    needed = (np.abs(known.residual) + reserve(problem)) / known.inertia_ratio
    gain = problem.controller.gains.switching_gain
    assert needed.max() <= gain - certificate.margin.low


def test_edges_hold_the_extremes_of_a_box_with_all_bounds(make_problem, make_controller):
    """The largest and the least adhesion of 40 000 random plants lie inside those of the edges."""
    problem = make_problem(make_controller("smc", "polach-wet"), rail="polach-wet")
    found = reaching.supremum(gain_claims(problem))
    strong = replace(problem.controller, gains=replace(problem.controller.gains, switching_gain=found.upper))
    problem = replace(problem, controller=strong)

    class Told:
        margin = type("M", (), {"low": 0.0})

    _no_point_beyond(problem, Told)
