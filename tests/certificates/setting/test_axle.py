"""The range of the axle load share: the gains of the pitch, the static transfer of the plant, and what it refuses."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from wspd_design.certificates.kernel.arb import above, below
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.setting import axle
from wspd_design.certificates.setting.axle import Pitching
from wspd_design.model.slip import resistance, static_wheel_load
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.gear import static_shares as static_axle_shares
from wspd_design.parameters.loading import constants
from wspd_design.plants.planar import Planar

GRAVITY = 9.81


@pytest.fixture
def problem(make_problem, make_controller):
    return make_problem(make_controller("smc", "polach-wet"), rail="polach-wet")


def damped(vehicle, ratio):
    return replace(
        vehicle, pitch_damping_ratio=ratio, bounds=vehicle.bounds | {"pitch_damping_ratio": (ratio, ratio)}
    )


def response(ratio, inputs, step):
    """Integrate y'' = u - y - 2 zeta y' exactly over steps with a constant input."""
    from scipy.linalg import expm

    transition = expm(np.array([[0.0, 1.0, 0.0], [-1.0, -2.0 * ratio, 1.0], [0.0, 0.0, 0.0]]) * step)
    state, found = np.zeros(2), []
    for u in inputs:
        state = transition[:2, :2] @ state + transition[:2, 2] * u
        found.append(state[0])
    return np.array(found)


@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.4, 0.9])
def test_worst_input_reaches_the_gain_for_any_input_and_a_step_that_for_a_rising_one(er24pc, ratio):
    half = math.pi / math.sqrt(1.0 - ratio**2)
    steps = 200
    halves = math.ceil(8.0 / (ratio * half))
    # Seen from the end, the worst input switches with the sign of the impulse response, every half period.
    signs = np.repeat([(-1) ** k for k in range(halves)], steps)[::-1]
    up, down = axle._gains(damped(er24pc, ratio), Pitching.ANY)
    most = response(ratio, (signs > 0).astype(float), half / steps)[-1]
    least = response(ratio, (signs < 0).astype(float), half / steps)[-1]
    assert most == pytest.approx(above(up), rel=1e-3)
    assert least == pytest.approx(below(down), rel=2e-3, abs=1e-3)
    assert most <= above(up)
    assert least >= below(down)
    up, down = axle._gains(damped(er24pc, ratio), Pitching.RISING)
    step = response(ratio, np.ones(steps * 4), half / steps)
    assert step.max() == pytest.approx(above(up), rel=1e-6)
    assert step.max() <= above(up) * (1.0 + 1e-12)
    assert above(down) == 0.0
    random = np.random.default_rng(1).random(steps * 20)
    assert response(ratio, np.sort(random), half / steps).max() <= above(up)
    most = above(axle._gains(damped(er24pc, ratio), Pitching.ANY)[0])
    assert response(ratio, np.round(random), half / steps).max() <= most


def test_overdamped_pitch_has_no_overshoot(er24pc):
    for pitching in Pitching:
        assert axle._gains(damped(er24pc, 1.0), pitching) == (1, 0)


def test_undamped_pitch_has_no_bound(problem):
    loose = replace(problem, vehicle=damped(problem.vehicle, 0.0))
    assert axle.load_share(loose, Pitching.RISING)[1] > axle.load_share(problem, Pitching.RISING)[1]
    with pytest.raises(OutsideModel, match="pitch_damping_ratio"):
        axle.load_share(loose, Pitching.ANY)


def static_shares(vehicle, adhesions, speed, grade=0.0):
    """Loads over the static load, and deceleration, with the pitch at rest where each axle uses some adhesion."""
    weight = vehicle.mass * constants().gravity
    static, plant = static_wheel_load(vehicle), Planar(vehicle)
    rest = (0.0,) * (2 * plant.transfers)
    loads = np.array(plant.wheel_loads(rest))
    frequencies = np.array([vehicle.body_pitch_frequency, *[vehicle.bogie_pitch_frequency] * plant.bogies])
    for _ in range(30):
        # With no pitch yet the second derivative over the squared frequency is the static transfer.
        motion = plant.train_motion(
            speed=speed,
            creep_forces=tuple(adhesions * loads),
            transfers=rest,
            grade_force=weight * grade,
        )
        transfers = np.array(motion.transfer_rates[plant.transfers :]) / (2.0 * math.pi * frequencies) ** 2
        loads = np.array(plant.wheel_loads((*transfers, *rest[plant.transfers :])))
    return loads / static, -motion.acceleration


@pytest.mark.parametrize("grade", [-0.1, 0.1])
def test_a_grade_changes_the_deceleration_and_no_load(problem, grade):
    adhesions = np.array([0.3, 0.1, 0.2, 0.0])
    level, slowing = static_shares(problem.vehicle, adhesions, 20.0)
    there, steeper = static_shares(problem.vehicle, adhesions, 20.0, grade)
    np.testing.assert_allclose(there, level, rtol=1e-12)
    assert steeper - slowing == pytest.approx(constants().gravity * grade, rel=1e-12)


def test_static_range_contains_and_nearly_reaches_the_loads_of_the_plant(problem):
    nominal = problem.vehicle
    low, high = axle.load_share(problem)
    slow, fast = axle.deceleration(problem)
    generator = np.random.default_rng(7)
    names = [n for n in nominal.bounds if n not in ("wheel_radius", "wheelset_inertia")]
    shares = []
    for trial in range(300):
        corner = trial % 2 == 0
        draw = (lambda a, b: generator.choice([a, b])) if corner else generator.uniform
        values = {name: float(draw(*nominal.bounds[name])) for name in names}
        body = nominal.body_mass + values["mass"] - nominal.mass
        vehicle = replace(nominal, **values, body_mass=body)
        adhesions = generator.choice([0.0, 0.36], 4) if corner else generator.uniform(0.0, 0.36, 4)
        found, slowing = static_shares(vehicle, adhesions, generator.uniform(*problem.speeds))
        shares.append(found)
        assert slow <= slowing <= fast
    # The outermost loads: a light vehicle, high centers, all wheels at their friction or those of one bogie.
    for mass, rod, front, rear in product(
        nominal.bounds["mass"], np.linspace(0.4, 0.6, 5), (0.0, 0.36), (0.0, 0.36)
    ):
        known = {
            "mass": mass,
            "body_mass": nominal.body_mass + mass - nominal.mass,
            "traction_rod_height": rod,
        }
        vehicle = replace(nominal, **known, body_height=2.1, bogie_height=0.85)
        shares.append(static_shares(vehicle, np.array([front, front, rear, rear]), problem.speeds[1])[0])
    assert low <= np.min(shares)
    assert np.max(shares) <= high
    assert high - np.max(shares) < 0.1 * (high - 1.0)
    assert np.min(shares) - low < 0.1 * (1.0 - low)


GEARS = {
    "two single axles": {"axles_per_bogie": 1, "wheelsets": 2, "bogie_mass": 1.6e3, "body_mass": 22e3},
    "three single axles": {"axles_per_bogie": 1, "wheelsets": 3, "bogie_mass": 1.6e3, "body_mass": 30e3},
    "four two-axle bogies": {"wheelsets": 8, "body_mass": 60e3},
    "two three-axle bogies": {"axles_per_bogie": 3, "wheelsets": 6, "body_mass": 80e3, "wheelbase": 4.0},
    "two bodies on three bogies": {"wheelsets": 6, "bodies": 2, "body_mass": 20e3, "bogie_mass": 9e3},
    "two bodies on three axles": {"axles_per_bogie": 1, "wheelsets": 3, "bodies": 2, "body_mass": 12e3},
}


@pytest.mark.parametrize("name", GEARS)
def test_the_range_of_any_gear_contains_and_nearly_reaches_the_loads_of_the_plant(problem, name):
    nominal = replace(problem.vehicle, **{"bogie_mass": 5e3, **GEARS[name]})
    supports = nominal.wheelsets // nominal.axles_per_bogie
    mass = nominal.bodies * nominal.body_mass + supports * nominal.bogie_mass
    bounds = Bounds.of({"mass": (0.9 * mass, 1.1 * mass), "traction_rod_height": (0.4, 0.6)})
    nominal = replace(nominal, mass=mass, bounds=bounds)
    stated = replace(problem, vehicle=nominal, bounds=problem.bounds | {"mass": bounds["mass"]})
    low, high = axle.load_share(stated)
    shares, generator = [], np.random.default_rng(11)
    for trial in range(120):
        heavy, rod = (generator.choice(bounds[each]) for each in ("mass", "traction_rod_height"))
        body = nominal.body_mass + (heavy - mass) / nominal.bodies
        vehicle = replace(nominal, mass=heavy, traction_rod_height=rod, body_mass=body)
        everywhere = np.full(nominal.wheelsets, 0.36)
        some = generator.choice([0.0, 0.36], nominal.wheelsets)
        shares.append(static_shares(vehicle, everywhere if trial % 2 else some, problem.speeds[1])[0])
    middle = np.array(static_axle_shares(nominal))
    assert low <= np.min(shares)
    assert np.max(shares) <= high
    assert high - np.max(shares) < 0.12 * (high - middle.max())
    assert np.min(shares) - low < 0.12 * (middle.min() - low)


def test_ranges_widen_with_the_motions_they_cover(problem):
    vehicle = damped(problem.vehicle, 0.5)
    mild = replace(problem, vehicle=vehicle, bounds=problem.bounds | {"mu0": (0.1, 0.1)})
    static, rising, arbitrary = (axle.load_share(mild, each) for each in Pitching)
    assert arbitrary[0] < rising[0] < static[0] < 1.0 < static[1] < rising[1] < arbitrary[1]


def test_without_heights_the_load_stays(problem):
    known = dict.fromkeys(("body_height", "bogie_height", "traction_rod_height"), 0.0)
    flat = replace(problem.vehicle, **known, bounds=Bounds.of({"mass": problem.vehicle.bounds["mass"]}))
    low, high = axle.load_share(replace(problem, vehicle=flat))
    assert low == pytest.approx(1.0, abs=1e-12)
    assert high == pytest.approx(1.0, abs=1e-12)


def test_axle_that_may_lift_is_refused(problem):
    with pytest.raises(OutsideModel, match="leaves an axle between"):
        axle.load_share(problem, Pitching.ANY)


def test_deceleration_lies_between_the_resistance_and_full_friction(problem):
    low, high = axle.deceleration(problem)
    vehicle = problem.vehicle
    most = replace(vehicle, resistance_constant=3e3, resistance_linear=30.0, resistance_quadratic=6.0)
    assert high == pytest.approx(0.36 * GRAVITY + resistance(most, problem.speeds[1]) / 61473.0, rel=1e-12)
    least = replace(vehicle, resistance_constant=1e3, resistance_linear=10.0, resistance_quadratic=1.5)
    assert low == pytest.approx(resistance(least, problem.speeds[0]) / 92209.0, rel=1e-12)


def test_law_that_may_exceed_the_friction_is_bounded_by_more(problem):
    steep = replace(problem, bounds=problem.bounds | {"slip reduction": (0.08, 0.3)})
    assert axle.deceleration(steep)[1] > 1.25 * axle.deceleration(problem)[1]
