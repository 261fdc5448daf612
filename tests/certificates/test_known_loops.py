"""Loops with torque feedback of which the answer is known from elsewhere: equilibria, eigenvalues, poles."""

from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from tests.attack import linear as attacker
from tests.attack.case import read_data
from tests.attack.counterexamples import (
    EQUILIBRIA,
    FAST_VENT,
    FAST_VENT_SPEED,
    TORQUE_FEEDBACK,
    UNSTABLE_CORNER,
    UNSTABLE_RADIUS,
    coach,
    torque_feedback,
)
from tests.attack.plant import gain, holding_torque, slip_pole
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.setting.linear_loop import law_of, nominal, quartic, valve
from wspd_design.certificates.setting.plant import dynamics_at
from wspd_design.certificates.setting.pulsed_valve import Times, sample_of
from wspd_design.certificates.theorems import equilibrium, quadratic
from wspd_design.certificates.theorems.region import FUNCTION, LPV_LYAPUNOV
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import load_rail

BOX = {"mass": (61473.0, 92209.0), "wheelset inertia": (640.0, 860.0)}
NAMES = ("mass", "wheelset inertia", "mu0")


@pytest.fixture(scope="module")
def audited(make_problem, make_controller):
    """Make the design that was audited, on the box of mass, inertia and mu0."""

    def made(rail, **brake):
        law = make_controller("torque-feedback", rail)
        problem = make_problem(replace(law, gains=replace(law.gains, **TORQUE_FEEDBACK[rail])), rail=rail)
        vehicle = replace(problem.vehicle, brake=replace(problem.vehicle.brake, **brake))
        bounds = Bounds.of(BOX | {"mu0": load_rail(rail).bounds["mu0"]})
        return replace(problem, vehicle=vehicle, bounds=bounds)

    return made


def rate(problem, slip, at):
    """Rate of the torque that holds a slip, by the formula of the claim and by its arranged form [1/s]."""
    claim = equilibrium.rate_claim(problem, slip, "<=")
    values = {each.name: float(each.low) for each in claim.variables} | at
    found = float(claim.expression(values))
    assert float(claim.form(values)) == pytest.approx(found, rel=1e-9, abs=1e-12)
    return found


@pytest.mark.parametrize("point", EQUILIBRIA, ids=lambda each: f"{each.slip}")
def test_equilibria_off_the_nominal_numbers(audited, point):
    """Audit A2: the torque that holds a slip is at rest at 0.8175, 0.483 and 0.0275, far from 0.14."""
    problem = audited(point.rail)
    at = {
        "speed": point.speed,
        "mass": point.mass,
        "wheelset inertia": point.wheelset_inertia,
        "mu0": point.mu0,
    }
    sides = [rate(problem, point.slip + move, at) for move in (-1e-4, 1e-4)]
    assert sides[0] > 0.0 > sides[1]
    found = equilibrium.nowhere(problem, at, Work())["rate"]
    assert (found > 0.0) is (point.slip > 0.19)
    usual = {"speed": 5.0} | {name: problem.nominal(name) for name in NAMES}
    assert abs(rate(problem, 0.14, usual)) < 1e-9
    with pytest.raises(Refused):
        equilibrium.nowhere(problem, usual, Work())


def test_demand_at_the_upper_end_of_the_tolerance(audited):
    """Audit A2: (1 + K)(u_hat - u) - kappa v tol, which must be negative at slip 0.19, comes to +4.77."""
    problem, gains = audited("polach-wet"), TORQUE_FEEDBACK["polach-wet"]
    data = read_data("er24pc", "polach-wet").plant
    known = holding_torque(data, 0.14, problem.speeds[0])
    demands = {}
    for ends in product(*(problem.span(name) for name in NAMES)):
        at = dict(zip(NAMES, ends, strict=True)) | {"speed": problem.speeds[0]}
        numbers = {name.replace(" ", "_"): at[name] for name in NAMES}
        held = holding_torque(data.with_numbers(numbers), 0.19, at["speed"])
        moved = (1.0 + gains["torque_gain"]) * (known - held) / 60e3
        demands[float(moved - gains["sliding_gain"] * at["speed"] * 0.05)] = (at, float(held / 60e3))
    largest = max(demands)
    assert largest == pytest.approx(4.77, abs=0.01)
    at, share = demands[largest]
    assert share + largest > 1.0  # the valve fills all the time
    assert rate(problem, 0.19, at) == pytest.approx((1.0 - share) / 0.6, rel=1e-9)


def one_sample(problem, q, share, gamma):
    """Return M of a loop with known numbers at the duty that holds a share of T_max on average."""
    law, brake = quadratic.law_of(problem), problem.vehicle.brake
    duty = share * brake.fill_time / ((1.0 - share) * brake.vent_time + share * brake.fill_time)
    fill, vent, pole, u = (Fraction(float(x)) for x in (brake.fill_time, brake.vent_time, q, duty))
    sample = sample_of(Times((fill, fill), (vent, vent)), (pole, pole), law.sample_time, (u, u))
    inertia = Fraction(float(problem.vehicle.wheel_radius * brake.max_torque / gamma))
    top = Fraction(brake.max_torque)
    found = quadratic.one_sample(sample, law.slide * top / inertia, law.torque * top)
    return np.array([[float(each) for each in row] for row in found])


@pytest.mark.parametrize(("rail", "radius"), UNSTABLE_RADIUS.items())
def test_a_fast_strong_brake_inside_the_bounds_is_unstable(audited, rail, radius):
    """Audit A7: T_F = T_V = 0.3 s and 68.7 kN m; at least 1.22 on the wet rail and 1.25 on the dry one."""
    problem = audited(rail, **UNSTABLE_CORNER)
    case = torque_feedback(rail)
    ends = [(3.0, 10.0, 30.0), *(problem.span(name) for name in NAMES)]
    points = np.array([(0.14, *each) for each in product(*ends)])
    at = dynamics_at(problem, points, ("slip", "speed", *NAMES))
    largest = 0.0
    for k, (slip, speed, mass, inertia, mu0) in enumerate(points):
        numbers = {"mass": mass, "wheelset_inertia": inertia, "mu0": mu0}
        plant = case.data.plant.with_numbers(numbers | UNSTABLE_CORNER)
        share = float(holding_torque(plant, slip, speed)) / plant.max_torque
        if not 0.0 < share < 1.0:
            continue
        gamma = plant.wheel_radius * plant.max_torque / inertia
        found = one_sample(problem, at.pole[k] - at.deceleration[k] / speed, share, gamma)
        duty = attacker.duty_of(plant, share, case.sample_time)
        known = attacker.sampled_map(case, plant, slip, speed, duty)
        size = np.abs(np.linalg.eigvals(found)).max()
        assert size == pytest.approx(float(attacker.spectral_radius(known)), rel=2e-3)
        largest = max(largest, size)
    assert largest >= radius
    place = {"slip": 0.14, "speed": 10.0} | {name: problem.nominal(name) for name in NAMES}
    place = {name: each for name, each in place.items() if name in functions_of(problem).within}
    assert functions_of(problem).evaluate(place, Work())["pole"] > 0.0
    with pytest.raises(Refused):  # on the brake for which the gains were made
        functions_of(audited(rail)).evaluate(place, Work())


def functions_of(problem):
    (found,) = (each for each in LPV_LYAPUNOV.obligations(problem) if each.key == FUNCTION)
    return found


@pytest.mark.parametrize(("vent_time", "eigenvalue"), FAST_VENT.items())
def test_eigenvalue_of_a_coach_that_vents_fast(audited, vent_time, eigenvalue):
    """Audit H: -0.949, -1.13 and -1.36 at 40 km/h for T_V 0.10, 0.09 and 0.08 s beside T_F 0.3 s."""
    case, speed = coach(vent_time), FAST_VENT_SPEED
    plant = case.data.plant
    slip, duty = attacker.equilibrium(case, plant, np.array([speed]))
    share = float(holding_torque(plant, slip[0], speed)) / plant.max_torque
    shape = audited("polach-wet", fill_time=0.3, vent_time=vent_time, max_torque=plant.max_torque)
    vehicle = replace(shape.vehicle, wheel_radius=plant.wheel_radius)
    law = replace(shape.controller, vehicle=vehicle)
    law = replace(law, gains=replace(law.gains, **TORQUE_FEEDBACK["coach"]))
    problem = replace(shape, vehicle=vehicle, controller=law)
    gamma = plant.wheel_radius * plant.max_torque / plant.wheelset_inertia
    found = one_sample(problem, float(slip_pole(plant, slip[0], speed)), share, gamma)
    assert np.linalg.eigvals(found).min() == pytest.approx(eigenvalue, abs=2e-2)
    assert 0.0 < duty[0] < 1.0


def test_poles_of_the_printed_law_with_its_adaptation(make_problem, make_controller):
    """Audit M1: +2.63 +- 15.8j at 10 m/s on table10-dry, where held weights give -0.31."""
    problem = make_problem(make_controller("afsmc", "table10-dry"), rail="table10-dry")
    plant, gains = nominal(problem.vehicle, problem.rail, 0.14, 10.0), law_of(problem).linear_form(10.0)
    poles = np.roots([1.0, *quartic(plant, valve(0.6, 0.6, 0.5), gains)])
    leading = poles[np.argmax(poles.real)]
    assert leading.real == pytest.approx(2.63, abs=0.01)
    assert abs(leading.imag) == pytest.approx(15.8, abs=0.05)
    held = gains._replace(integral=gains.proportional * problem.controller.surface_rate, twice=0.0)
    three = quartic(plant, valve(0.6, 0.6, 0.5), held)[:3]
    assert np.roots([1.0, *three]).real.max() == pytest.approx(-0.31, abs=0.01)
    data = read_data("er24pc", "table10-dry").plant
    assert plant.pole == pytest.approx(float(slip_pole(data, 0.14, 10.0)), rel=1e-9)
    assert plant.gain == pytest.approx(float(gain(data, 10.0)), rel=1e-9)
