"""The rules that choose gains: what they promise, how they respond, and what they say for themselves."""

import math
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.analysis.linearization import linearize
from wspd_design.certificates.checks.sliding import reaching
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.axle import deceleration, load_share
from wspd_design.controllers.family import designed_family
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller, paper_design
from wspd_design.design.sliding_gains import deceleration_limit
from wspd_design.parameters.bounds import EXACT
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_paper_gains, load_rail

pytestmark = pytest.mark.usefixtures("remembered")

RAILS = ("polach-dry", "polach-wet", "table10-dry", "eurosprinter127")


@pytest.fixture(scope="module")
def rail():
    return load_rail("polach-wet")


def gain(name, vehicle, rail, law="smc", **specification):
    return design_controller(vehicle, rail, Specification(**specification), law=law).gain(name)


@pytest.mark.parametrize("law", ["afsmc", "smc", "torque-feedback", "printed"])
def test_every_gain_has_a_reason_and_a_unit(er24pc, rail, law):
    made = (
        paper_design(er24pc, rail, Specification())
        if law == "printed"
        else design_controller(er24pc, rail, Specification(), law=law)
    )
    assert tuple(g.name for g in made.gains) == tuple(form.name for form in designed_family(made.law).forms)
    for each in made.gains:
        assert len(each.why.split()) >= 3, each.name
        assert each.unit
        assert "nan" not in each.why


def test_reasons_repeat_the_numbers(er24pc, rail):
    made = design_controller(er24pc, rail, Specification(sample_time=0.05, slip_tolerance=0.08), law="smc")
    why = {g.name: g.why for g in made.gains}
    assert "h = 0.05 s" in why["surface_rate"]
    assert "tau = 0.6 s" in why["surface_rate"]
    assert "0.08" in why["boundary_layer"]
    assert "sup (abs(r) + eta)/rho" in why["switching_gain"]


def test_surface_rate_is_slower_than_valve_and_sampling(er24pc, rail):
    assert gain("surface_rate", er24pc, rail) == pytest.approx(1.0 / (4.0 * 0.65))
    slow = replace(er24pc, brake=replace(er24pc.brake, fill_time=1.2, vent_time=1.2))
    assert gain("surface_rate", slow, rail) < 0.6 * gain("surface_rate", er24pc, rail)
    assert gain("surface_rate", er24pc, rail, sample_time=0.5) < gain("surface_rate", er24pc, rail)


def test_boundary_layer_keeps_the_error_within_the_tolerance(er24pc, rail):
    # abs(e) <= 2 Phi/K_P inside the layer.
    for tolerance in (0.02, 0.05, 0.2):
        assert 2.0 * gain("boundary_layer", er24pc, rail, slip_tolerance=tolerance) == pytest.approx(
            tolerance
        )


@pytest.mark.parametrize(
    "change",
    ["mu0", "mass", "wheelset_inertia"],
)
def test_more_uncertainty_needs_a_larger_switching_gain(er24pc, rail, change):
    small, large = gain("switching_gain", er24pc, rail), None
    if change == "mu0":
        large = gain("switching_gain", er24pc, replace(rail, bounds=rail.bounds | {"mu0": (0.1, 0.55)}))
    elif change == "mass":
        large = gain("switching_gain", replace(er24pc, bounds=er24pc.bounds | {"mass": (50e3, 110e3)}), rail)
    else:
        large = gain(
            "switching_gain",
            replace(er24pc, bounds=er24pc.bounds | {"wheelset_inertia": (500.0, 1100.0)}),
            rail,
        )
    assert large > 1.05 * small


def test_without_uncertainty_only_the_reserve_and_the_load_of_the_axle_are_left(er24pc, rail):
    known = replace(er24pc, bounds=EXACT)
    slips = (0.1, 0.2)
    certain = gain("switching_gain", known, replace(rail, bounds=EXACT), slips=slips)
    assert 0.0 < certain < 0.4 * gain("switching_gain", er24pc, rail, slips=slips)


@pytest.mark.parametrize("name", RAILS)
def test_the_switching_gain_outweighs_the_model_error_at_random_points(er24pc, name):
    # abs(r) <= rho W0 written out from (19) and the corrected (23), at points that the search did not choose.
    rail, specification = load_rail(name), Specification()
    made = design_controller(er24pc, rail, specification, law="smc")
    w0, c = made.gain("switching_gain"), made.gain("surface_rate")
    law = made.build(er24pc, rail)
    problem = stability_problem(er24pc, rail, law, specification)
    rng = np.random.default_rng(5)
    n = 20_000

    def ends(low_high):
        """Most errors are largest where every number is at an end of its range."""
        return rng.choice(np.asarray([float(end) for end in low_high]), n)

    slip, v = rng.uniform(*specification.slips, n), rng.uniform(*specification.speeds, n)
    vehicle = {key: ends(er24pc.bounds[key]) for key in ("mass", "wheelset_inertia")}
    names = ("mu0", "friction_ratio", "friction_decay", "adhesion_reduction", "slip_reduction")
    nominal = {key: getattr(rail, key) for key in names}
    on_rail = {key: ends(rail.bounds.get(key, (value, value))) for key, value in nominal.items()}

    def psi(mass, wheelset_inertia, share, deceleration, **friction):
        """Psi = v F of eq. (19), of an axle with a share of the mean load in a train with a deceleration."""
        contact, radius, wheel = er24pc.contact, er24pc.wheel_radius, wheelset_inertia / 2
        load = share * mass * 9.81 / 8
        k, b = friction["friction_ratio"], friction["friction_decay"]
        mu = friction["mu0"] * ((1 - k) * np.exp(-b * v * slip) + k)
        axes = (
            contact.semi_axis_rolling * contact.semi_axis_lateral * (load / contact.reference_load) ** (2 / 3)
        )
        eps = 0.25 * np.pi * contact.shear_modulus * axes * contact.kalker_c11 * slip / (load * mu)
        x = friction["adhesion_reduction"] * eps
        f = 2 * load * mu / np.pi * (x / (1 + x**2) + np.arctan(friction["slip_reduction"] * eps))
        if deceleration is None:  # of the design model: the mean axle brakes the train
            deceleration = (2000 + 20 * v + 3 * v**2 + 8 * f) / mass
        return -(radius**2 * f / wheel + (1 - slip) * deceleration) + v * 0.25 * (1 - slip) / wheel

    rho = er24pc.wheelset_inertia / vehicle["wheelset_inertia"]
    true = psi(
        **vehicle, share=ends(load_share(problem)), deceleration=ends(deceleration(problem)), **on_rail
    )
    model = psi(er24pc.mass, er24pc.wheelset_inertia, 1.0, None, **nominal)
    r = (1 - rho) * v * c * (specification.slip - slip) - true + rho * model
    assert np.all(np.abs(r) <= rho * w0)
    assert np.max(np.abs(r) / rho) > 0.4 * w0  # and it is not chosen out of all proportion
    assert np.any(np.abs(r) > rho * 0.5 * w0)  # half of it would not do


@pytest.mark.parametrize("name", [pytest.param("polach-dry", marks=pytest.mark.reference), "polach-wet"])
def test_the_design_passes_its_own_certificate(er24pc, name):
    rail, specification = load_rail(name), Specification()
    controller = design_controller(er24pc, rail, specification, law="smc").build(er24pc, rail)
    problem = stability_problem(er24pc, rail, controller, specification)
    assert reaching.CHECK.run(problem).status is Status.PROVED
    weak = replace(
        controller, gains=replace(controller.gains, switching_gain=0.6 * controller.gains.switching_gain)
    )
    assert reaching.CHECK.run(replace(problem, controller=weak)).status is Status.REFUTED


def test_adaptive_law_starts_at_the_equilibrium(er24pc, rail):
    made = design_controller(er24pc, rail, Specification(), law="afsmc")
    middle = math.sqrt(10.0 * 120.0) / 3.6
    point = linearize(er24pc, rail, slip=0.14, speed=middle)
    torque = [made.gain("torque_unit") * b for b in made.gain("initial_weights")]
    assert torque == pytest.approx([point.equilibrium_torque] * 5, rel=1e-9)


def test_adaptive_law_does_not_start_above_a_weak_brake(er24pc, rail):
    """A coach on a wet rail began with twice its largest torque (users.md A7)."""
    weak = replace(er24pc, brake=replace(er24pc.brake, max_torque=7e3, bounds=EXACT))
    made = design_controller(weak, rail, Specification(), law="afsmc")
    assert made.gain("initial_weights") == (7.0,) * 5
    why = next(gain.why for gain in made.gains if gain.name == "initial_weights")
    assert why.startswith("b_hat(0) = T_max: ")
    assert "more than the brake has" in why


def test_initial_bound_is_the_switching_torque(er24pc, rail):
    adaptive = design_controller(er24pc, rail, Specification(), law="afsmc")
    w0 = gain("switching_gain", er24pc, rail)
    assert adaptive.gain("torque_unit") * adaptive.gain("initial_bound") == pytest.approx(w0 * 752.0 / 0.55)


def test_membership_functions_span_the_reference_and_cross_at_one_half(er24pc, rail):
    for slip in (0.1, 0.3):
        made = design_controller(er24pc, rail, Specification(slip=slip), law="afsmc")
        centres, widths = made.gain("centres"), made.gain("widths")
        assert (centres[0], centres[2], centres[-1]) == pytest.approx((-slip, 0.0, slip))
        between = 0.5 * (centres[0] + centres[1])
        assert math.exp(-(((between - centres[0]) / widths[0]) ** 2)) == pytest.approx(0.5)


def test_adaptation_moves_a_tenth_of_the_brake_torque_in_a_time_constant(er24pc, rail):
    made = design_controller(er24pc, rail, Specification(), law="afsmc")
    moved = made.gain("weight_rate") * made.gain("boundary_layer") / made.gain("integral_gain")
    assert moved * made.gain("torque_unit") == pytest.approx(0.1 * er24pc.brake.max_torque)
    weak = replace(er24pc, brake=replace(er24pc.brake, max_torque=15e3))
    assert gain("weight_rate", weak, rail, "afsmc") == pytest.approx(made.gain("weight_rate") / 4.0)


def test_repairs_are_on_in_a_design_and_off_in_the_printed_one(er24pc, rail):
    for made, on in (
        (design_controller(er24pc, rail, Specification(), law="afsmc"), True),
        (paper_design(er24pc, rail, Specification()), False),
    ):
        assert made.gain("dead_zone") is on
        assert made.gain("hold_when_saturated") is on
        assert made.gain("scheduled_rates") is False


def test_printed_design_is_section_7_of_the_paper(er24pc, rail):
    made = paper_design(er24pc, rail, Specification())
    assert (made.gain("proportional_gain"), made.gain("integral_gain")) == (1800.0, 550.0)
    assert (made.gain("weight_rate"), made.gain("bound_rate")) == (10.0, 0.85)
    assert (made.gain("initial_weights"), made.gain("initial_bound")) == ((-1.0, -0.5, 0.0, 0.5, 1.0), 1.0)
    assert made.gain("centres") == load_paper_gains().centres


def test_deceleration_limit_is_a_bound(er24pc, rail):
    # mu0 g plus resistance over mass.
    assert deceleration_limit(er24pc, rail, 20.0) == pytest.approx(0.30 * 9.81 + (2000 + 400 + 1200) / 76841)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"slip": 14.0}, "must lie in"),
        ({"slip": math.nan}, "must lie in"),
        ({"slip": 0.0}, "must lie in"),
        ({"speeds": (20.0, 10.0)}, "must rise"),
        ({"speeds": (0.0, 10.0)}, "above 0"),
        ({"speeds": (3.0, math.nan)}, "must rise"),
        ({"slips": (0.2, 0.6)}, "contain the slip reference"),
        ({"slips": (0.02, 1.2)}, "must lie in"),
        ({"slip_tolerance": 0.0}, "slip tolerance"),
        ({"slip_tolerance": 0.9}, "slip tolerance"),
        ({"sample_time": 0.0}, "sample time"),
        ({"sample_time": math.nan}, "sample time"),
        ({"sample_time": 100.0}, "between 1 ms and 1 s"),
    ],
)
def test_impossible_specifications_are_refused(changes, words):
    with pytest.raises(UserError, match=words):
        Specification(**changes)
