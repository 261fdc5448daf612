"""Limits of the state: within them the law is the written one, and pulses, torque, room and friction are left.

With all of them at once, and where only one thing makes the difference.
"""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from tests.certificates.band.courses import (
    DRIFT,
    EXACT,
    NOISE,
    PULSE,
    WINDOW,
    Course,
    Stop,
    doubles,
    laws,
    loop_in,
    misjudged,
)

SUPPLY = Fraction(9, 10)
LEAST, ROOM = 0.002, 0.25  # of the full torque; of what the supply lacks


@pytest.mark.parametrize("settled", [-0.01, 0.05])
@pytest.mark.parametrize("kind", ["plain", "damped"])
def test_states_within_the_limits_are_those_of_the_written_law(request, kind, settled):
    """A state at each limit, whatever is held, measured and supplied: longest pulses, torque and room do."""
    problem = request.getfixturevalue(kind)
    law = replace(laws(problem)[0], vent_time=laws(problem)[0].vent_time / 2)
    course, h, inertia = Course(problem, law, None), float(law.sample_time), float(law.inertia)
    loop = loop_in(problem, law, settled, conditions=EXACT._replace(supply=SUPPLY, noise=NOISE))
    limits = [
        (each.what, [float(x.mid()) for x in each.row], float(each.bound.mid())) for each in loop.limits
    ]
    full, k, ahead, slew = map(float, (law.full_torque, law.approach_rate, law.ahead, law.torque_slew))
    times, radius = (float(law.fill_time), float(law.vent_time)), problem.vehicle.wheel_radius
    noise = []
    for sign, of_rim in product((-1.0, 1.0), repeat=2):
        off, rate = misjudged(law, problem, 0.0, [-sign * float(NOISE)] * 60 + [sign * float(NOISE)])
        noise.append((of_rim * float(NOISE) / radius - off, rate))
    slowing = [Stop(problem, law, None, x).braking(v, 0.18) for x in (-0.02, 0.04) for v in WINDOW]
    worst = {}
    for what, row, bound in limits:
        for place in (j for j in range(5) if row[j]):
            state = np.zeros(5)
            state[place] = (1.0 - 1e-6) * bound / row[place]
            e, _, n, y, lag = state
            for v, slow, supply, (misread, known) in product(
                WINDOW, (min(slowing), max(slowing)), (float(SUPPLY), 1.0), noise
            ):
                turning = -(1.0 - 0.18) / radius * slow
                held = course.holding(v, 0.18, settled) - problem.vehicle.wheelset_inertia * turning
                torque, observed = held + inertia * y / h, held + inertia * (n / h + turning)
                rate = turning - (lag + known) / h
                error = e + settled + misread + ahead * h * ((observed - torque) / inertia - rate)
                target = observed - inertia * (rate - k * error)
                room, least, longest = supply * full - torque, LEAST * full, float(PULSE) * h
                taken = torque * -math.expm1(-longest / times[1])
                added = room * -math.expm1(-longest / times[0])
                margin = {
                    "what filling adds in its longest pulse": torque + added - target,
                    "what venting takes off in its longest pulse": target - torque + taken,
                    "the observed friction above 0": observed,
                    "the torque that is left": torque - taken - least,
                    "the torque that the brake can add": room - added - least,
                    "the room that a rising supply asks for": room - ROOM * (1.0 - float(SUPPLY)) * full,
                    "the beginning of the braking curve": slew / inertia / k**2 - error,
                }[what]
                worst[what] = min(worst.get(what, math.inf), margin)
    assert len(worst) == 7
    assert all(margin >= -1e-9 for margin in worst.values()), worst


def limit_of(loop, what):
    """The row of a limit and its bound; the largest state in one of its directions at a time."""
    (found,) = (each for each in loop.limits if each.what == what)
    return [float(x.mid()) for x in found.row], float(found.bound.mid())


def test_friction_is_observed_above_0_by_a_law_that_takes_the_wheels_for_heavier(plain):
    """What turns them is taken off the observed friction with the inertia of the law, and was added with their own."""
    vehicle, law = plain.vehicle, laws(plain)[0]
    light = replace(plain, vehicle=replace(vehicle, wheelset_inertia=0.3 * vehicle.wheelset_inertia))
    row, bound = limit_of(loop_in(light, law), "the observed friction above 0")
    assert [k for k, each in enumerate(row) if each] == [2]
    h, inertia, course = float(law.sample_time), float(law.inertia), Course(light, law, None)
    slowing = [Stop(light, law, None, x).braking(v, 0.18) for x in (-0.02, 0.04) for v in WINDOW]
    seen = []
    for v, slow in product(WINDOW, (min(slowing), max(slowing))):
        rate = -(1.0 - 0.18) / vehicle.wheel_radius * slow
        held = course.holding(v, 0.18, 0.0) - light.vehicle.wheelset_inertia * rate
        seen.append(held + inertia * (bound / row[2] / h + rate))
    assert 0.0 <= min(seen) < 0.1 * max(seen) + 0.01 * float(law.full_torque)


@pytest.mark.parametrize("number", [1, 3])
def test_error_is_below_the_braking_curve_while_the_reference_drifts(plain, number):
    """The law knows nothing of that drift: it predicts the error with another rate of the reference."""
    law = laws(plain)[number]
    row, bound = limit_of(loop_in(plain, law), "the beginning of the braking curve")
    h, k, ahead, slew = (float(x) for x in (law.sample_time, law.approach_rate, law.ahead, law.torque_slew))
    drifted = h * float(DRIFT) / plain.vehicle.wheel_radius  # h times the rate that is not known
    error = bound / row[0]
    assert error + ahead * drifted <= slew / float(law.inertia) / k**2 + 1e-12


@pytest.mark.parametrize(
    ("what", "time"), [("the torque that is left", 1), ("the torque that the brake can add", 0)]
)
def test_longest_pulse_leaves_the_least_torque_and_room(plain, what, time):
    """Of what is there after it, not before."""
    law = replace(laws(plain)[0], vent_time=laws(plain)[0].vent_time / 2)
    supply = Fraction(9, 10)
    loop = loop_in(plain, law, conditions=EXACT._replace(supply=supply))
    row, bound = limit_of(loop, what)
    h, full = float(law.sample_time), float(law.sample_time * law.full_torque / law.inertia)
    venting = doubles(loop.pulses[1].height)
    kept = math.exp(-float(PULSE) * h / float((law.fill_time, law.vent_time)[time]))
    y = bound / row[3]
    there = venting[0] + y if time else float(supply) * full - venting[1] - y
    assert there * kept == pytest.approx(LEAST * full, rel=1e-6)
