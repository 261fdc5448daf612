"""The kernels on intervals enclose what they compute on numbers, also with outward rounding at the last digit."""

import math

import flint
import ival
import numpy as np
import pytest

from wspd_design.controllers.adaptive_fuzzy import firing_strengths, torque_demand
from wspd_design.model import adhesion, brake, slip
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.quarter import quarter

SLIPS, SPEEDS = (0.1, 0.18), (8.0, 11.0)


def midpoint_and_radius(low, high):
    """Return a ball that covers the interval."""
    return flint.arb(0.5 * (low + high), 0.5 * (high - low) * (1.0 + 1e-12))


def kernels(vehicle, rail, gains):
    """Functions of slip and speed from every module that runs on intervals."""
    plant = quarter(vehicle, rail)
    weights = tuple(float(k) for k in range(len(gains.centres)))
    return {
        "creep force": lambda s, v: adhesion.creep_force(s, s * v, plant.wheel_load, rail, plant.stiffness),
        "stiffness": lambda _s, v: adhesion.contact_stiffness(vehicle.contact, 1e4 * v),
        "resistance": lambda _s, v: slip.resistance(vehicle, v),
        "drift": lambda s, v: slip.slip_dynamics(vehicle, rail, s, v).drift,
        "gain": lambda s, v: slip.slip_dynamics(vehicle, rail, s, v).gain,
        "pole": lambda s, v: slip.slip_dynamics(vehicle, rail, s, v).pole,
        "slip ratio": lambda s, v: slip.slip_ratio(v, (1.0 - s) * v / 0.55, 0.55),
        "motion": lambda s, v: plant.motion(s, v, (1.0 - s) * v / 0.55, 2e4 * s).wheel_acceleration,
        "filling": lambda s, v: brake.pressure_after(vehicle.brake, brake.Valve.FILL, 0.1 * v, 0.4 + s, 1e5),
        "venting": lambda s, v: brake.pressure_after(vehicle.brake, brake.Valve.VENT, 0.1 * v, 0.4 + s, 1e5),
        "firing": lambda s, v: firing_strengths(gains, 500.0 * s + v)[3],
        "demand": lambda s, v: torque_demand(gains, 500.0 * s + v, weights, 1.0),
    }


NAMES = (
    *("creep force", "stiffness", "resistance", "drift", "gain", "pole", "slip ratio", "motion"),
    *("filling", "venting", "firing", "demand"),
)


@pytest.fixture(scope="module", params=["polach-dry", "table10-wet", "eurosprinter127"])
def functions(request, er24pc, printed_gains):
    found = kernels(er24pc, load_rail(request.param), printed_gains())
    assert tuple(found) == NAMES
    return found


def box_samples(slips, speeds):
    rng = np.random.default_rng(1)
    for s in (*slips, *rng.uniform(*slips, 6)):
        for v in (*speeds, *rng.uniform(*speeds, 6)):
            yield float(s), float(v)


@pytest.mark.parametrize("name", NAMES)
def test_intervals_enclose_samples(functions, name):
    function = functions[name]
    interval = function(ival.Interval(*SLIPS), ival.Interval(*SPEEDS))
    for s, v in box_samples(SLIPS, SPEEDS):
        value = float(function(s, v))
        slack = 1e-12 * abs(value)  # rounding of the value itself
        assert interval.inf - slack <= value <= interval.sup + slack
    # An enclosure that says nothing would pass: it must be finite.
    assert math.isfinite(interval.inf)
    assert math.isfinite(interval.sup)


@pytest.mark.parametrize("name", NAMES)
def test_balls_enclose_samples(functions, name):
    # Balls lose the sign of 1 + x^2 on a wide box, so this one is small.
    slips, speeds = (0.139, 0.141), (9.9, 10.1)
    function = functions[name]
    ball = function(midpoint_and_radius(*slips), midpoint_and_radius(*speeds))
    for s, v in box_samples(slips, speeds):
        value = float(function(s, v))
        assert ball.overlaps(flint.arb(value, 1e-12 * abs(value)))
    assert ball.is_finite()


@pytest.mark.parametrize("name", NAMES)
def test_thin_intervals_contain_the_exact_value(functions, name):
    # Rounding towards the inside survives random samples; only a thin interval against many digits shows it.
    function = functions[name]
    rng = np.random.default_rng(2)
    with flint.ctx.workprec(300):
        for s, v in zip(rng.uniform(*SLIPS, 25), rng.uniform(*SPEEDS, 25), strict=True):
            exact = function(flint.arb(float(s)), flint.arb(float(v)))
            thin = function(ival.Interval(float(s), float(s)), ival.Interval(float(v), float(v)))
            assert flint.arb(thin.inf) <= exact <= flint.arb(thin.sup)
            assert thin.sup - thin.inf < 1e-10 * (1e-3 + abs(thin.sup))


def test_inward_rounding_would_be_seen(er24pc):
    # The planted fault: the next double inside the enclosure no longer contains the exact value.
    with flint.ctx.workprec(300):
        exact = slip.resistance(er24pc, flint.arb(0.1))
        value = float(slip.resistance(er24pc, ival.Interval(0.1, 0.1)).sup)
        inside = math.nextafter(math.nextafter(math.nextafter(value, 0.0), 0.0), 0.0)
        assert exact <= flint.arb(value)
        assert not exact <= flint.arb(inside)
