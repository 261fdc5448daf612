"""The slip that is held, wheels worn or not, the train speed told wrong or not; and what is asked about the friction.

Against the wheel speed at the reference, by differences over the train speed.
"""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from flint import ctx

from tests.certificates.band.conftest import WET
from tests.certificates.band.courses import falling_problem
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.setting.creep_slope import along_speed, fading_beside
from wspd_design.certificates.theorems.band import claims, key
from wspd_design.certificates.theorems.slip_band.friction import (
    FADINGS,
    NAMES,
    PARTS,
    SLOPES,
    Friction,
    fading_at,
    slope_at,
    strip_of,
)
from wspd_design.certificates.theorems.slip_band.reference import held_in, slips_beside, slips_held
from wspd_design.certificates.theorems.slip_band.statement import law_of, windows_of
from wspd_design.controllers.references import ConstantSlip

WINDOW = (8.0, 9.6)  # m/s
ERROR, DRIFT = 0.02, 0.4  # -, m/s2
D = 1e-3  # m/s, of differences


@pytest.fixture(scope="module")
def falling():
    return falling_problem(WET, 1.0, slip=0.5, largest=0.5)


def law_that(problem, *, falls):
    law = replace(law_of(problem.controller), slip_error=Fraction(ERROR), slip_drift=Fraction(DRIFT))
    return law if falls else replace(law, falls=False, slip=Fraction(9, 50))


def held(law, speed, radius, aside):
    """Slip that is held with worn wheels, which the law takes to roll faster."""
    own = float(law.slip)
    return (own / math.sqrt(speed * float(law.radius) / radius) if law.falls else own) + aside


@pytest.mark.parametrize("falls", [True, False])
def test_numbers_of_what_is_held_are_those_of_every_wheel_and_speed(falling, falls):
    law, radii = law_that(falling, falls=falls), falling.span("wheel radius")
    with ctx.workprec(128):
        found = held_in(law, WINDOW, tuple(map(Fraction, radii)))
    slips = []
    for speed, radius, aside in product(np.linspace(*WINDOW, 9), radii, (-ERROR, 0.0, ERROR)):

        def rim(v, radius=radius, aside=aside):
            return (1.0 - held(law, v, radius, aside)) * v

        slip, (low, high) = held(law, speed, radius, aside), (speed - D, speed + D)
        slips.append(slip)
        numbers = {
            "slip": slip,
            "fall": -(held(law, high, radius, 0.0) - held(law, low, radius, 0.0)) / (2.0 * D),
            "turning": (rim(high) - rim(low)) / (2.0 * D),
            "bend": (rim(high) - 2.0 * rim(speed) + rim(low)) / D**2,
        }
        for name, number in numbers.items():
            enclosure = getattr(found, name)
            assert enclosure.lower() <= number + 1e-7, name
            assert enclosure.upper() >= number - 1e-7, name
    ends = float(found.slip.lower()), float(found.slip.upper())
    assert ends == pytest.approx((min(slips), max(slips)))
    assert slips_held(law, WINDOW, tuple(map(Fraction, radii))) == pytest.approx(ends)
    assert (float(found.drift.lower()), float(found.drift.upper())) == pytest.approx((-DRIFT, DRIFT))


# --- what is asked about the friction ---------------------------------------------------------------------------------
def bounds_used(error):
    """Names of the bounds that count for a wheel with this error, e R over the lowest speed."""
    numbers = {name: (float(k), float(k)) for k, name in enumerate(NAMES)}
    friction, at = Friction.of(tuple(numbers.values())), point(Fraction(error))
    with ctx.workprec(128):
        found = [slope_at(friction, at)]
        if FADINGS[0][0] <= Fraction(error) <= FADINGS[-1][1]:
            found.append(fading_at(friction, at))
    used = [n for n, (k, _) in numbers.items() if any(each.contains(point(k)) for each in found)]
    return [*used, "level"] if not float(error) else used


@pytest.mark.parametrize("falls", [True, False])
def test_every_bound_is_asked_for_the_slips_of_the_errors_that_it_counts_for(falling, falls):
    """In each window, for new and worn wheels, whatever the slip beside that of the law, and in each part."""
    problem = falling if falls else replace(falling, controller=constant(falling))
    law, windows = law_of(problem.controller), windows_of(problem)
    asked, slowest = claims(problem), problem.speeds[0]
    ranges = {}
    for name, k, part, relation in product(NAMES, (0, 4, len(windows) - 1), range(PARTS), (">=", "<=")):
        (sliding,) = (x for x in asked[key(name, part, k, relation)].variables if x.name == "sliding speed")
        ranges.setdefault((name, k), []).append((float(sliding.low), float(sliding.high)))
    seen = {each: [] for each in ranges}
    errors = np.array(
        [*np.linspace(-0.019999, 0.039999, 61), -0.002, 0.0, 0.004, 0.01, 0.018, -0.012999, 0.012, 0.026999]
    )
    for error in errors:
        for name in bounds_used(str(error)):
            for k, speed, radius in product((0, 4, len(windows) - 1), (0, 1), problem.span("wheel radius")):
                v = windows[k][speed]
                # The wheel slides e R slower than the reference, whatever the speed.
                slides = held(law, v, radius, 0.0) * v - error * slowest
                seen[name, k].append(slides)
                assert all(low - 1e-9 <= slides <= high + 1e-9 for low, high in ranges[name, k])
    assert set(ranges) == {each for each, slides in seen.items() if slides}


def constant(problem, slip=0.14):
    """The law of a problem with a constant slip in place of its own."""
    return replace(problem.controller, reference=ConstantSlip(slip=slip))


@pytest.mark.parametrize("slip", [0.006, 0.01, 0.02, 0.04])
def test_wheels_that_turn_faster_than_the_train_are_asked_about_as_those_that_slide_as_much(falling, slip):
    """Where little slip is held, some errors that are reached are those of wheels that drive the train."""
    problem = replace(falling, slip=slip, controller=constant(falling, slip))
    asked, windows = claims(problem), windows_of(problem)
    driving = 0
    for name, error in product(NAMES, (-0.02, -0.01, -0.002, 0.004, 0.01, 0.012, 0.018, 0.027, 0.04)):
        strip = strip_of(name)
        if strip is None or not float(strip[0]) <= error <= float(strip[1]):
            continue
        (sliding,) = (each for each in asked[key(name, 0, 0, ">=")].variables if each.name == "sliding speed")
        for v in (*windows[0], 0.5 * sum(windows[0])):
            slides = slip * v - error * problem.speeds[0]
            driving += slides < 0.0
            assert float(sliding.low) - 1e-9 <= abs(slides) <= float(sliding.high) + 1e-9
    assert driving


def test_courses_of_wheels_that_may_turn_faster_than_the_train_are_refused(falling):
    """What is enclosed along them holds for wheels that slide."""
    there = replace(falling, speeds=(8.0, 8.1))
    for enclosed in (along_speed, fading_beside):
        assert np.all(np.isfinite(enclosed(there, 0.02, (0.14, 0.15))))
        with pytest.raises(Refused, match="faster than the train"):
            enclosed(there, 0.02, (0.14, 0.17))


@pytest.mark.parametrize("slip", [0.14, 0.02])
def test_slips_of_a_strip_are_rounded_outwards(slip):
    """Against exact fractions, also where wheels turn faster than the train."""
    law = replace(law_of(falling_problem(WET, 0.5).controller), slip=Fraction(slip), falls=False)
    window, slowest, radius = (2.7, 3.3), 10.0 / 3.6, (Fraction(11, 20),) * 2
    for strip in SLOPES:
        exact = [law.slip - end * Fraction(slowest) / Fraction(speed) for end in strip for speed in window]
        sizes = [abs(each) for each in exact]
        least = 0 if min(exact) < 0 < max(exact) else min(sizes)
        low, high = slips_beside(law, window, radius, slowest, strip)
        assert low <= least
        assert high >= max(sizes)
        assert (low, high) == pytest.approx((float(least), float(max(sizes))), rel=1e-15)
