"""What the supply has when the train gets to a slower window: against trains that are braked as hard as they may be."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import quad

from tests.certificates.band.conftest import problem_of
from tests.certificates.band.test_slip_band_read import an_ellipsoid
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.theorems.slip_band.friction import NAMES, PARTS, SLOPES, Friction, Part
from wspd_design.certificates.theorems.slip_band.proof import Proof, write
from wspd_design.certificates.theorems.slip_band.statement import windows_of
from wspd_design.certificates.theorems.slip_band.way_in import around, supply_rises
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import constants

SUPPLY, SPEED = 0.6, 31.0  # -, m/s, at the end of what is followed
FARTHEST = 0.04  # error that the slope is bounded for, e R over the lowest speed
RATES = (0.1, 0.4)  # 1/s


@pytest.fixture(scope="module")
def problem():
    """Trains that much holds back beside the brake, the lightest one more than the nominal one."""
    whole = problem_of(1.0)
    vehicle = replace(whole.vehicle, resistance_constant=60e3, resistance_quadratic=0.1)
    ends = {name: whole.span(name) for name in ("mass", "mu0")} | {"supply rate": RATES}
    return around(replace(whole, vehicle=vehicle, bounds=Bounds.of(ends), speeds=(10.0, 33.0)))


def friction_of(k, part):
    """Bounds that differ in each window and part; the slope of one strip is the steepest, on either side of 0."""
    slopes = [(-0.01, 0.01)] * len(SLOPES)
    slopes[2 + part] = (-0.15 + 0.01 * k, 0.02) if part == 1 else (-0.01, 0.1)
    level = 0.2 + 0.02 * k + 0.01 * part
    bounds = (*slopes, (level - 0.1, level), *[(-0.1, -0.09)] * 3)
    assert len(bounds) == len(NAMES)
    return Friction.of(bounds)


def most_used(k):
    """Friction over mu0 Q that a wheel has at most in a window, at the farthest error."""
    steepest = max(0.15 - 0.01 * k, 0.1)
    return 0.2 + 0.02 * k + 0.01 * (PARTS - 1) + steepest * FARTHEST * 10.0


def proof_of(problem, supplies):
    one = an_ellipsoid(1)
    return write(
        Proof(
            share=Fraction(1),
            delay=Fraction(0),
            noise=Fraction(0),
            reserve=Fraction(1),
            friction=tuple(
                tuple(Part((1.0 + part, 2.0 + part), friction_of(k, part)) for part in range(PARTS))
                for k in range(len(windows_of(problem)))
            ),
            steps=".",
            cells=(tuple(replace(one, supply=Fraction(each), near=0) for each in supplies),),
        )
    )


def supplied(problem, window):
    """Share of the full pressure when the hardest braked train gets to the top of a window, its supply the slowest."""
    vehicle, windows, mass = problem.vehicle, windows_of(problem), problem.span("mass")[0]
    assert mass < 0.995 * vehicle.mass
    time, tops = 0.0, [0.0, *(top for _, top in windows)]
    for k in range(window + 1, len(windows)):
        most = constants().gravity * problem.span("mu0")[1] * most_used(k)

        def slowness(speed, most=most):
            held = vehicle.resistance_constant + vehicle.resistance_linear * speed
            return 1.0 / (most + (held + vehicle.resistance_quadratic * speed**2) / mass)

        time += quad(slowness, min(tops[k], SPEED), min(tops[k + 1], SPEED))[0]
    return 1.0 - (1.0 - SUPPLY) * np.exp(-RATES[0] * time)


def test_supply_that_the_hardest_braked_train_does_not_have_is_refused(problem):
    """In each window alone; what is refused is not far more than that."""
    count = len(windows_of(problem))
    assert count > 3
    for k in range(count - 1):
        there = supplied(problem, k)
        for share, refused in ((there + 1e-6, True), (SUPPLY + 0.8 * (there - SUPPLY), False)):
            supplies = [0.0] * count
            supplies[k] = share
            proof = proof_of(problem, supplies)
            if refused:
                with pytest.raises(Refused, match="the supply may have"):
                    supply_rises(problem, proof, SUPPLY, SPEED)
            else:
                supply_rises(problem, proof, SUPPLY, SPEED)


def test_time_counts_from_the_speed_at_which_the_train_is(problem):
    """One that has come into the slowest window has no more time."""
    count, slow = len(windows_of(problem)), windows_of(problem)[0][1] - 0.1
    asked = proof_of(problem, [SUPPLY + 1e-6] * count)
    with pytest.raises(Refused, match="the supply may have"):
        supply_rises(problem, asked, SUPPLY, slow)
    supply_rises(problem, proof_of(problem, [SUPPLY - 1e-6] * count), SUPPLY, slow)
