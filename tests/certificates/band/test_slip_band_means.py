"""What a change of a way counts in both means of a sample, against integrals over pulses of true valves.

The law is one whose time share is 1: what it works out of a change is then the change itself, and covers for nothing
that a bound of the true torque leaves out.
"""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from flint import ctx
from scipy.integrate import quad

from tests.certificates.band.conftest import problem_of
from tests.certificates.band.courses import EXACT, everywhere
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.setting.slip_loop import DISTURBANCES, STATES, shares_together
from wspd_design.certificates.theorems.band import contact_held
from wspd_design.certificates.theorems.slip_band import center
from wspd_design.certificates.theorems.slip_band.center import Lengths, about, way_at
from wspd_design.certificates.theorems.slip_band.friction import FADINGS, SLOPES, Friction
from wspd_design.certificates.theorems.slip_band.loop import loop_of
from wspd_design.certificates.theorems.slip_band.proof import Choice
from wspd_design.certificates.theorems.slip_band.statement import box_of, law_of, windows_of

PULSE = Fraction(1, 2)
BRIEF, SHORT, LONG = (
    Lengths(*map(Fraction, each), PULSE) for each in (("1/100", "1/20"), ("1/20", "1/4"), ("2/5", "1/2"))
)
WAYS = (0.003, -0.003)  # rad/s, at the center
SPEEDUPS = (0.5, 1.0, 2.0)  # assumed over true times of the valve
ROUNDING = 1e-6
ANY = Friction(((-0.2, 0.02),) * len(SLOPES), (0.86, 0.91), ((-0.3, 0.0),) * len(FADINGS))


@pytest.fixture(scope="module")
def problem():
    return contact_held(problem_of(0.0))


class Sample:
    """The loop about a center, and pulses of a true valve in a sample in which errors grow."""

    def __init__(self, problem, *, way, speedup, lengths, growth, delay, added, least_growth=None, torques=0):
        self.law = replace(law_of(problem.controller), time_share=Fraction(1))
        self.growth, self.delay = growth, delay
        self.kind, self.h, self.told = (0 if way > 0.0 else 1), float(self.law.sample_time), []
        assumed = self.law.fill_time, self.law.vent_time
        times = [each / Fraction(speedup) for each in assumed]
        (full, _) = box_of(problem, Fraction(0))[4]
        cell = (
            *box_of(problem, Fraction(0))[:4],
            (full, (1 + torques) * full),
            *((each,) * 2 for each in times),
        )
        self.assumed, self.times = tuple(map(float, assumed)), tuple(map(float, times))
        with ctx.workprec(128), pytest.MonkeyPatch.context() as patch:
            patch.setattr(
                center, "shares_together", lambda *asked: self.told.append(asked) or shares_together(*asked)
            )
            conditions = EXACT._replace(delay=Fraction(delay))
            window, choice = windows_of(problem)[6], Choice(PULSE, 0)
            loop = self.plain = loop_of(problem, self.law, cell, window, everywhere(ANY), choice, conditions)
            growths = growth if least_growth is None else least_growth, growth
            secants = tuple(point(Fraction(each)) / point(self.law.sample_time) for each in growths)
            ranges, added = replace(loop.ranges, secants=secants), point(Fraction(added))
            pulses = tuple(
                replace(each, parts=(each.parts[0], each.parts[1] * (1 + added))) for each in loop.pulses
            )
            self.before = replace(
                loop, ranges=ranges, delay=point(Fraction(delay)), added=added, pulses=pulses
            )
            rest = [point(0)] * STATES
            one = [point(int(k == 2)) for k in range(STATES)]
            none, some = (way_at(self.before, each) for each in (rest, one))
            at = [each * (point(Fraction(way)) - none) / (some - none) for each in one]
            self.after = about(self.law, self.before, at, lengths)

    def gone(self, length, kind):
        """Parts of a height: wanted, gone, in the mean that counts later changes as errors grow, in that of the law."""
        time, nominal = self.times[kind], self.assumed[kind]

        def part(t, over):
            return -math.expm1(-min(max(t, 0.0), length) * self.h / over)

        def weighed(t):
            return part(t - self.delay, time) * math.exp(self.growth * (1.0 - t))

        breaks = sorted({min(each, 1.0) for each in (self.delay, self.delay + length, length)})
        weight = self.growth / math.expm1(self.growth) if self.growth else 1.0
        return (
            part(length, nominal),
            part(length, time),
            quad(weighed, 0.0, 1.0, points=breaks, epsabs=1e-14)[0] * weight,
            quad(lambda t: part(t, nominal), 0.0, 1.0, points=breaks, epsabs=1e-14)[0],
        )

    def beside(self, name):
        """By how much less and more a disturbance may be because of the way at the center."""
        place = DISTURBANCES.index(name)
        both = zip(self.after.disturbances[place], self.before.disturbances[place], strict=True)
        return tuple(float((after - before).mid()) for after, before in both)


def missing(told, true, law):
    """By how much there is no part l of the change that both counts have, each with a number of its own."""
    (low, high), (a_low, a_high), (b_low, b_high) = ([float(end.mid()) for end in ends] for ends in told)
    return max(low, true / a_high, law / b_high) - min(high, true / a_low, law / b_low)


CASES = list(product(WAYS, SPEEDUPS, (BRIEF, SHORT, LONG)))
# Growth of errors over a sample, lateness of pulses, and what a rising supply adds to a way at most; it may come last
WHEN = [(1e-9, 0.0, 0.0), (1e-9, 0.0, 0.2), (0.3, 0.0, 0.0), (-0.3, 0.0, 0.0), (0.2, 0.3, 0.2)]


@pytest.mark.parametrize(("growth", "delay", "added"), WHEN)
@pytest.mark.parametrize(("way", "speedup", "lengths"), CASES)
def test_one_part_of_a_change_counts_in_both_means(problem, way, speedup, lengths, growth, delay, added):
    """From a pulse at the center to any on its side, and from none to any back."""
    numbers = {"way": way, "speedup": speedup, "lengths": lengths}
    run = Sample(problem, **numbers, growth=growth, delay=delay, added=added)
    own, opposite = run.told
    for shortest in map(float, lengths[:2]):
        here = run.gone(shortest, run.kind)
        for length in np.linspace(0.01, float(PULSE), 15):
            if abs(length - shortest) < 1e-3:
                continue
            wanted, gone, weighed, mean = run.gone(length, run.kind)
            further = wanted - here[0]
            true, law = (weighed - here[2]) / (gone / wanted * further), (mean - here[3]) / further
            assert all(missing(own, true / more, law) <= ROUNDING for more in (1.0, 1.0 + added))
    for length in np.linspace(0.01, float(lengths.back), 8):
        wanted, gone, weighed, mean = run.gone(length, 1 - run.kind)
        assert all(
            missing(opposite, weighed / gone / more, mean / wanted) <= ROUNDING for more in (1.0, 1.0 + added)
        )


@pytest.mark.parametrize(("growth", "delay", "added"), WHEN)
@pytest.mark.parametrize("least", [0.0, 0.2])
@pytest.mark.parametrize(("way", "speedup", "lengths"), CASES)
def test_error_sees_of_the_way_at_the_center_what_is_told(
    problem, way, speedup, lengths, growth, delay, added, least
):
    """The way at the center goes the part of any way on its side; what it does beside that disturbs the error."""
    numbers = {"way": way, "speedup": speedup, "lengths": lengths, "growth": growth, "delay": delay}
    run = Sample(problem, **numbers, added=added, least_growth=growth - least, torques=Fraction(1, 3))
    known = float(run.after.ranges.shares_center[0].mid())
    low, high = run.beside("uneven slip drift")
    effect = float(run.after.ranges.effects[1].mid())
    grown = math.expm1(growth) / growth  # of what is added evenly to an error over the sample
    for at_center in np.linspace(*map(float, lengths[:2]), 3):
        wanted, _, weighed, _ = run.gone(at_center, run.kind)
        for length, more in product(np.linspace(0.01, float(PULSE), 8), (1.0, 1.0 + added)):
            other, gone, *_ = run.gone(length, run.kind)
            aside = effect * grown * way * (more * gone / other * (1.0 - known) - weighed / wanted)
            assert low - ROUNDING * abs(way) <= aside <= high + ROUNDING * abs(way)


@pytest.mark.parametrize(("way", "speedup", "lengths"), CASES)
def test_mean_of_the_law_sees_of_the_way_at_the_center_what_is_told(problem, way, speedup, lengths):
    run = Sample(problem, way=way, speedup=speedup, lengths=lengths, growth=1e-9, delay=0.0, added=0.0)
    known = float(run.after.ranges.shares_center[1].mid())
    low, high = run.beside("mean reference drift")
    for at_center in np.linspace(*map(float, lengths[:2]), 5):
        wanted, *_, mean = run.gone(at_center, run.kind)
        assert low - ROUNDING * abs(way) <= (mean / wanted - known) * way <= high + ROUNDING * abs(way)


def test_way_at_a_center_is_the_wanted_change_with_what_disturbs_in_its_middle(problem):
    """The acceleration counts as its lag does, and the command as itself."""
    run = Sample(problem, way=0.003, speedup=1.0, lengths=SHORT, growth=1e-9, delay=0.0, added=0.0)
    law, (e, _, n, y, lag) = run.law, (0.01, 0.0, 0.02, -0.01, 0.004)
    acceleration, command = (0.001, 0.003), (-0.006, 0.002)
    with ctx.workprec(128):
        ends = [tuple(map(point, each)) for each in (acceleration, command)]
        loop = replace(run.before, disturbances=(*ends, *run.before.disturbances[2:]))
        found = float(way_at(loop, [point(each) for each in (e, 0.5, n, y, lag)]).mid())
    gain, lag = float(law.approach_rate * law.sample_time), lag + sum(acceleration) / 2.0
    wanted = n + gain * (e + float(law.ahead) * (n - y + lag)) + lag
    assert found == pytest.approx(wanted - y + sum(command) / 2.0, rel=1e-9)


@pytest.mark.parametrize("delay", [0.0, 0.3])
@pytest.mark.parametrize("speedup", SPEEDUPS)
def test_ways_from_none_on_are_between_the_corners(problem, speedup, delay):
    """Any pulse that begins at any time until the latest one, by parts, and by what counts in both means."""
    numbers = {"speedup": speedup, "lengths": SHORT, "added": 0.0}
    loop = Sample(problem, way=0.003, growth=0.0, delay=delay, **numbers).plain
    corners = np.array([[float(end.mid()) for end in each] for each in loop.ranges.ways])
    low, high = corners.min(axis=0) - ROUNDING, corners.max(axis=0) + ROUNDING
    for secant, begun, way in product(loop.ranges.secants, {0.0, delay}, WAYS):
        growth = float(secant.mid()) * float(law_of(problem.controller).sample_time)
        run = Sample(problem, way=way, growth=growth, delay=begun, **numbers)
        for length in np.linspace(1e-3, float(PULSE), 6):
            wanted, gone, weighed, mean = run.gone(length, run.kind)
            found = np.array([gone / wanted, gone / wanted, 1.0 - weighed / gone, mean / wanted])
            assert (low <= found).all()
            assert (found <= high).all()
