"""(19) at one axle of several: as at static load where it has to be, arranged as the kernels, known answers."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.kernel.checker import FORMAT, Refused, Work, decide
from wspd_design.certificates.kernel.claim import Claim, formula
from wspd_design.certificates.search.prover import extreme
from wspd_design.certificates.setting import domain
from wspd_design.certificates.setting.model_error import (
    inertia_ratio,
    mismatch,
    residual,
    residual_over_ratio,
)
from wspd_design.certificates.setting.plant import (
    AXLE_PLANT,
    OTHERS,
    complete,
    dynamics_at,
    model_variables,
    plant_dynamics,
    plant_forces,
    plant_variables,
)
from wspd_design.certificates.theorems.sliding import reserve
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.loading import load_rail


def on_wet_rail(vehicle):
    rail = load_rail("polach-wet")
    law = design_controller(vehicle, rail, Specification(), law="smc").build(vehicle, rail)
    return stability_problem(vehicle, rail, law, Specification())


@pytest.fixture(scope="module")
def wet(er24pc):
    return on_wet_rail(er24pc)


@pytest.fixture(scope="module")
def six(er24pc):
    """Two three-axle bogies: 12 wheels, of which no eighth is a whole number."""
    return on_wet_rail(
        replace(
            er24pc,
            wheelsets=6,
            axles_per_bogie=3,
            body_mass=er24pc.body_mass - 100.0,
            mass=er24pc.mass - 100.0,
        )
    )


@pytest.fixture(params=["wet", "six", "reference"])
def problem(request, wet, make_reference_problem):
    return (
        make_reference_problem(20.0)
        if request.param == "reference"
        else wet
        if request.param == "wet"
        else request.getfixturevalue("six")
    )


def points(problem, count=200):
    low, high = domain.box(problem)
    return np.random.default_rng(4).uniform(low, high, (count, len(low)))


def test_axle_at_static_load_is_the_quarter_locomotive(problem):
    at = points(problem)
    usual = dynamics_at(problem, at)
    names = (*domain.BASIC, "axle load share", "train deceleration")
    one = dynamics_at(problem, np.column_stack([at, np.ones(len(at)), usual.deceleration]), names)
    for name in ("drift", "gain", "creep_force", "deceleration"):
        np.testing.assert_allclose(getattr(one, name), getattr(usual, name), rtol=1e-12)


def test_drift_is_the_equation_of_one_axle_and_its_pole_the_slope(problem):
    at = points(problem)
    names = (*domain.BASIC, "axle load share", "train deceleration")
    generator = np.random.default_rng(5)
    full = np.column_stack([at, generator.uniform(0.7, 1.3, len(at)), generator.uniform(0.0, 4.0, len(at))])
    found = dynamics_at(problem, full, names)
    slip, speed, _, inertia, _, _, slowing = full.T
    vehicle = problem.vehicle
    per_inertia = 2.0 / inertia
    expected = -(
        vehicle.wheel_radius**2 * found.creep_force * per_inertia + (1.0 - slip) * slowing
    ) / speed + vehicle.wheel_damping * per_inertia * (1.0 - slip)
    np.testing.assert_allclose(found.drift, expected, rtol=1e-10, atol=1e-12)
    step = 1e-6
    up, down = full.copy(), full.copy()
    up[:, 0] += step
    down[:, 0] -= step
    slope = (dynamics_at(problem, up, names).drift - dynamics_at(problem, down, names).drift) / (2.0 * step)
    np.testing.assert_allclose(found.pole, slope, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("which", ["creep_force", "deceleration", "pole"])
@pytest.mark.parametrize("every_axle", [True, False])
def test_arranged_form_is_the_function_of_the_kernels(problem, which, every_axle):
    uses = {"uses": AXLE_PLANT} if every_axle else {}
    claim = Claim(
        name=which,
        variables=plant_variables(problem, **uses),
        expression=lambda x: getattr(plant_dynamics(problem, x), which),
        form=lambda x: getattr(plant_forces(problem, x), which),
        relation="<=",
        bound=Fraction(0),
        unit="-",
    )
    assert agrees(claim)
    # A planted fault is seen: the load share left out of the arranged form.
    if every_axle and which != "deceleration":
        wrong = Claim(
            name=which,
            variables=claim.variables,
            expression=claim.expression,
            form=lambda x: getattr(plant_forces(problem, {**x, "axle load share": 1.0}), which),
            relation="<=",
            bound=Fraction(0),
            unit="-",
        )
        assert not agrees(wrong)


def agrees(claim):
    """Whether the arranged form is the function of the expression."""
    sides = {"left": claim.expression, "right": claim.form}
    written = {name: [list(step) for step in formula(side, claim.variables)] for name, side in sides.items()}
    try:
        decide({"format": FORMAT, "statement": {"kind": "identity", "name": claim.name, **written}}, Work())
    except Refused:
        return False
    return True


def need(problem, share, slowing):
    """Smallest W0 of the wet sliding mode at one axle, mass, inertia and mu0 varied, within 1e-2 m/s2."""
    law, eta = problem.controller, reserve(problem)
    ranges = {"axle load share": share, "train deceleration": slowing}
    plant = plant_variables(problem, uses=AXLE_PLANT, hold=OTHERS, ranges=ranges)

    def needed(x):
        return abs(residual(problem, law, x) / inertia_ratio(x)) + eta / inertia_ratio(x)

    def arranged(x):
        return (
            abs(residual_over_ratio(problem, law, x))
            + eta * x["wheelset inertia"] / x["model wheelset inertia"]
        )

    claim = Claim(
        name="need",
        variables=plant + model_variables(law.vehicle, law.rail),
        expression=needed,
        form=arranged,
        relation="<=",
        bound=Fraction(0),
        unit="m/s2",
    )
    return extreme(claim, tolerance=1e-2)


@pytest.mark.parametrize(
    ("share", "slowing", "expected"),
    [
        ((1.0, 1.0), (0.5, 3.6), 9.89),
        ((0.85, 1.15), (0.5, 3.6), 14.10),
        ((0.8, 1.2), (0.3, 3.6), 15.50),
    ],
)
def test_gain_that_the_axles_need_is_that_of_the_audit(wet, share, slowing, expected):
    found = need(wet, share, slowing)
    assert found.undecided == 0.0
    assert found.low - 0.01 <= expected <= found.high + 0.01
    low, high = domain.box(wet)
    some = np.random.default_rng(2).uniform(
        [*low, share[0], slowing[0]], [*high, share[1], slowing[1]], (20_000, 7)
    )
    others = {"axle load share": some[:, 5], "train deceleration": some[:, 6]}
    error = mismatch(wet, wet.controller, some[:, :5], others)
    tried = (abs(error.residual) + reserve(wet)) / error.inertia_ratio
    assert tried.max() <= found.high


def test_every_number_with_bounds_varies_by_default(wet):
    free = {v.name for v in plant_variables(wet, uses=AXLE_PLANT) if v.free}
    assert free == {"slip", "speed"} | (set(domain.uncertain(wet)) & set(AXLE_PLANT))
    held = {v.name for v in plant_variables(wet, hold=OTHERS) if v.free}
    assert held == set(domain.BASIC)


@pytest.mark.parametrize("fault", [{"hold": ("vent time",)}, {"ranges": {"wheel_radius": 0.5}}])
def test_names_that_the_claim_does_not_use_are_refused(wet, fault):
    with pytest.raises(ValueError, match="not among the quantities"):
        plant_variables(wet, **fault)


def test_missing_numbers_are_the_nominal_ones(wet):
    values = complete(wet, {"slip": 0.1, "speed": 5.0})
    at = np.array([[0.1, 5.0, wet.vehicle.mass, wet.vehicle.wheelset_inertia, wet.rail.mu0]])
    assert plant_dynamics(wet, values).pole == pytest.approx(dynamics_at(wet, at).pole[0], rel=1e-14)
