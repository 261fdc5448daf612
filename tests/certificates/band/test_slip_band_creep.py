"""What is asked and enclosed of the friction of a box, against Polach's formula by differences for wheels of the box.

All numbers of contact and friction that may vary do so, each at an end of its range or in between.
"""

from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from tests.certificates.band.conftest import LOCO, SLOW, WET, problem_of
from tests.certificates.band.courses import polach
from wspd_design.certificates.setting.creep_slope import (
    NORMAL_MASS,
    RATIO,
    SLIDING,
    STEEPNESS,
    along_speed,
    fading_beside,
    fading_claim,
    level_claim,
    poles,
    slope_claim,
    steepness_of,
)
from wspd_design.certificates.theorems.band import claims, contact_held, key
from wspd_design.certificates.theorems.slip_band.friction import PARTS, parts_of
from wspd_design.certificates.theorems.slip_band.statement import law_of, windows_of
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import constants

SLIP, BESIDE = 0.14, (-0.02, 0.03)  # -, m/s
SPEEDS = (8.0, 8.6)  # m/s
CONTACT = ("shear modulus", "semi axis rolling", "semi axis lateral", "kalker c11", "reference load")
RAIL = ("adhesion reduction", "slip reduction")
WHEELS = 40


@pytest.fixture(scope="module")
def box():
    """Some of each range: what is left of them would show in enclosures over parts."""
    problem = replace(problem_of(1.0), speeds=SPEEDS)
    names = ("mass", "mu0", *CONTACT, *RAIL)
    wide = {name: 0.06 if name in ("mass", "mu0", *RAIL) else 0.01 for name in names}
    ends = {
        name: ((1.0 - d) * problem.nominal(name), (1.0 + d) * problem.nominal(name))
        for name, d in wide.items()
    }
    return replace(problem, bounds=Bounds.of(ends))


class Wheel:
    """A wheel with some numbers of the box: force over mu0 Q at a slip and a speed."""

    def __init__(self, problem, numbers):
        self.numbers = numbers
        self.load = numbers["mass"] * constants().gravity / 8.0
        carried = self.load
        if not problem.contact_grows_with_load:
            carried = LOCO.mass * constants().gravity / 8.0
        contact = {name.replace(" ", "_"): numbers[name] for name in CONTACT}
        # Both half axes grow with the load; the area of another one stands for an area that does not.
        contact["semi_axis_rolling"] *= (carried / self.load) ** (2.0 / 3.0)
        self.vehicle = replace(LOCO, contact=replace(LOCO.contact, **contact))
        self.rail = replace(WET, **{name.replace(" ", "_"): numbers[name] for name in RAIL})

    def force(self, slip, speed):
        mu0 = self.numbers["mu0"]
        return polach(self.rail, self.vehicle, mu0, slip, speed, self.load) / (mu0 * self.load)

    @property
    def stiffness(self):
        """Slope of the force at no slip, of the area of adhesion, over mu0 Q: from the force at a small slip."""
        small, rest = 1e-9, replace(self.rail, slip_reduction=1e-12)
        mu0 = self.numbers["mu0"]
        force = polach(rest, self.vehicle, mu0, small, 1e-3, self.load) / (mu0 * self.load)
        return force / small


@pytest.fixture(scope="module")
def wheels(box):
    return wheels_of(box)


def wheels_of(problem, count=WHEELS):
    random = np.random.default_rng(4)
    found = []
    for _ in range(count):
        shares = random.random(len(problem.bounds))
        shares = np.where(random.random(len(shares)) < 0.7, np.round(shares), shares)
        numbers = {
            name: low + (high - low) * share
            for (name, (low, high)), share in zip(problem.bounds.items(), shares, strict=True)
        }
        found.append(Wheel(problem, numbers))
    return found


def inside(value, ends, part=1e-9):
    return ends[0] - part <= value <= ends[1] + part


# What is wide, with all else nearly known: an enclosure that goes by one end of it alone would miss the other one.
ALONE = {
    "speed": ((20.0, 33.0), (0.02, 0.02), {}),
    "beside": (SPEEDS, (-0.3, 0.4), {}),
    "steepness": (SPEEDS, (0.3, 0.3), {"mu0": 0.5}),
    "ratio": (SPEEDS, (0.02, 0.02), {"slip reduction": 0.8}),
    "nothing": ((8.0, 8.001), (0.02, 0.02), {}),
}


@pytest.fixture(params=ALONE)
def alone(request, box):
    """A box, what its wheels slide less, and wheels and speeds in it."""
    speeds, beside, wide = ALONE[request.param]
    ends = {
        name: (
            (1.0 - wide.get(name, 0.0)) * box.nominal(name),
            (1.0 + wide.get(name, 0.0)) * box.nominal(name),
        )
        for name in dict(box.bounds.items())
    }
    problem = replace(box, speeds=speeds, bounds=Bounds.of(ends))
    return (
        problem,
        beside,
        list(product(wheels_of(problem, 8), np.geomspace(*speeds, 9), np.linspace(*beside, 3))),
    )


def test_derivative_along_a_course_beside_the_reference_is_enclosed(box, wheels, alone):
    """Of a wheel that slides slower by a speed that does not change."""

    def seen(wheel, speed, less):
        d = 1e-5 * speed
        forces = [wheel.force(SLIP - less / v, v) for v in (speed - d, speed + d)]
        return (forces[1] - forces[0]) / (2.0 * d)

    problem, beside, places = alone
    found = [seen(*each) for each in places]
    ends = along_speed(problem, SLIP, beside)[0]
    assert all(inside(each, ends, 1e-7) for each in found)
    if problem.speeds[1] < 8.01:
        assert ends[1] - ends[0] < 0.05 * abs(found[0])
    ends = along_speed(box, SLIP, BESIDE)[0]
    assert all(inside(seen(*each), ends, 1e-7) for each in product(wheels, SPEEDS, (*BESIDE, 0.0)))


def test_second_derivative_along_a_course_beside_the_reference_is_enclosed(box, wheels, alone):
    """Of a wheel that slides slower by a speed that does not change."""

    def seen(wheel, speed, less):
        d = 5e-4 * speed
        forces = [wheel.force(SLIP - less / v, v) for v in (speed - d, speed, speed + d)]
        return (forces[0] - 2.0 * forces[1] + forces[2]) / d**2

    problem, beside, places = alone
    found = [seen(*each) for each in places]
    low, high = along_speed(problem, SLIP, beside)[1]
    assert all(inside(each, (low, high), 1e-7) for each in found)
    if problem.speeds[1] < 8.01:
        assert high - low < 0.2 * abs(found[0])
    ends = along_speed(box, SLIP, BESIDE)[1]
    assert all(inside(seen(*each), ends, 1e-7) for each in product(wheels, SPEEDS, (*BESIDE, 0.0)))


def test_what_fades_more_along_the_reference_than_beside_it_is_enclosed(box, wheels, alone):
    def seen(wheel, speed, less):
        d = 1e-5 * speed
        own, other = (
            (wheel.force(SLIP - x / (speed + d), speed + d) - wheel.force(SLIP - x / (speed - d), speed - d))
            / (2.0 * d)
            for x in (0.0, less)
        )
        return own - other

    problem, beside, places = alone
    found = [seen(*each) for each in places]
    low, high = fading_beside(problem, SLIP, beside)
    assert all(inside(each, (low, high)) for each in found)
    if problem.speeds[1] < 8.01:
        assert high - low < 0.2 * abs(found[0])
    ends = fading_beside(box, SLIP, BESIDE)
    assert all(inside(seen(*each), ends) for each in product(wheels, SPEEDS, BESIDE))


@pytest.mark.parametrize("grows", [True, False])
def test_claims_are_about_every_wheel_of_the_box(box, grows):
    """Each wheel is a normal one of which the numbers lie in the ranges, with the same force, slope and fading."""
    problem, slips, d = replace(box, contact_grows_with_load=grows), (0.12, 0.15), 1e-5
    asked = [claim(problem, slips, ">=", Fraction(0)) for claim in (level_claim, slope_claim, fading_claim)]
    for wheel, slip, speed in product(wheels_of(problem), slips, SPEEDS):
        force = wheel.force(slip, speed)
        slope = -(wheel.force(slip + d, speed) - wheel.force(slip - d, speed)) / (2.0 * d * speed)
        fading = (wheel.force(slip, speed + d) - wheel.force(slip, speed - d)) / (2.0 * d * slip)
        ratio = wheel.numbers["slip reduction"] / wheel.numbers["adhesion reduction"]
        for claim, exact in zip(asked, (force, slope, fading), strict=True):
            ranges = {each.name: (float(each.low), float(each.high)) for each in claim.variables}
            values = {name: low for name, (low, high) in ranges.items() if low == high}
            values |= {RATIO: ratio, SLIDING: slip * speed}
            values[STEEPNESS] = modulus(wheel.stiffness * slip)
            assert values.keys() == ranges.keys()
            assert all(inside(values[name], ends, 1e-9 * abs(ends[1])) for name, ends in ranges.items()), (
                values
            )
            assert float(claim.expression(values)) == pytest.approx(exact, rel=1e-6, abs=1e-7)


def test_claims_of_a_part_of_the_steepness_are_about_every_wheel_that_lies_in_it():
    """Light or heavy, and with the force, the slope and the fading that their names say."""
    problem = contact_held(problem_of(1.0, speeds=SLOW))
    asked, law, (slow, _) = claims(problem), law_of(problem.controller), windows_of(problem)[0]
    masses, frictions = (np.linspace(*problem.span(name), 7) for name in ("mass", "mu0"))
    slip, d, met = float(law.slip), 1e-5, set()
    contact = {name: problem.nominal(name) for name in (*CONTACT, *RAIL)}
    for mass, mu0 in product(map(float, masses), map(float, frictions)):
        alone = replace(problem, bounds=Bounds.of({"mass": (mass, mass), "mu0": (mu0, mu0)}))
        low, high = steepness_of(alone)
        parts = [
            k
            for k, (least, most) in enumerate(parts_of(steepness_of(problem)))
            if least <= high and low <= most
        ]
        assert parts
        met |= {*parts}
        wheel = Wheel(problem, contact | {"mu0": mu0, "mass": mass})
        exact = {
            "level": wheel.force(slip, slow),
            "slope 3": -(wheel.force(slip + d, slow) - wheel.force(slip - d, slow)) / (2.0 * d * slow),
            "fading 1": (wheel.force(slip, slow + d) - wheel.force(slip, slow - d)) / (2.0 * d * slip),
        }
        for part, (name, value) in product(parts, exact.items()):
            claim = asked[key(name, part, 0, "<=")]
            ranges = {each.name: (float(each.low), float(each.high)) for each in claim.variables}
            values = {each: low for each, (low, _) in ranges.items()}
            values |= {STEEPNESS: modulus(wheel.stiffness * slip), SLIDING: slip * slow}
            assert all(inside(values[each], at, 1e-9 * abs(at[1])) for each, at in ranges.items())
            assert float(claim.expression(values)) == pytest.approx(value, rel=1e-6, abs=1e-7)
    assert met == set(range(PARTS))


def modulus(steepness):
    """Modulus for which the area of adhesion of a wheel of 1 kg gives this slope over mu0 Q, with all else 1."""
    load = constants().gravity / 8.0
    contact = replace(
        LOCO.contact,
        shear_modulus=1.0,
        semi_axis_rolling=1.0,
        semi_axis_lateral=1.0,
        kalker_c11=1.0,
        reference_load=load,
    )
    rail = replace(WET, adhesion_reduction=1.0, slip_reduction=1e-12)
    small = 1e-9
    return steepness / (polach(rail, replace(LOCO, contact=contact), 1.0, small, 1e-3, load) / load / small)


def test_normal_wheel_is_held_at_what_is_no_range(box):
    """Shape of the friction, which no claim varies."""
    for claim in (level_claim, slope_claim, fading_claim):
        asked = {each.name: each for each in claim(box, (0.12, 0.15), "<=", Fraction(0)).variables}
        assert asked["friction ratio"].low == asked["friction ratio"].high == Fraction(WET.friction_ratio)
        assert asked["friction decay"].low == asked["friction decay"].high == Fraction(WET.friction_decay)
        assert asked[NORMAL_MASS].low == asked[NORMAL_MASS].high == 1


def test_poles_of_all_wheels_lie_between_those_of_the_bounds_of_the_slope(box):
    """Eq. (19) with a slope between two numbers, wheels damped much or little, and slips in a wide range."""
    ranges = {
        "mass": (6e4, 9e4),
        "wheelset inertia": (600.0, 900.0),
        "wheel radius": (0.5, 0.55),
        "wheel damping": (1.0, 300.0),
        "mu0": (0.05, 0.3),
    }
    problem, slips = replace(box, bounds=Bounds.of(ranges)), (0.01, 0.6)
    for slopes in ((-0.2, -0.1), (-0.1, 0.3), (0.2, 0.3)):
        low, high = poles(problem, slips, *slopes)
        seen = []
        for mass, inertia, radius, damping, mu0 in product(*ranges.values()):
            for slip, slope in product(slips, slopes):
                load = mass * constants().gravity / 8.0
                # Of a wheel, with half of the inertia of its set; the train is slowed down by all of them.
                moved = load * radius**2 / (inertia / 2.0) + (1.0 - slip) * 8.0 * load / mass
                seen.append(mu0 * slope * moved - damping / (inertia / 2.0))
        assert low <= min(seen) < low + 0.1 * (high - low)
        assert high - 0.1 * (high - low) < max(seen) <= high
