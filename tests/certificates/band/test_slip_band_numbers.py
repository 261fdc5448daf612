"""Numbers of the loop in corners that no proof comes near: damped wheels, much resistance, noise, a wandering slip.

Each against a train and a law in equations of their own.
"""

import math
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise, product

import numpy as np
import pytest
from flint import ctx

from tests.certificates.band.conftest import WET, everywhere
from tests.certificates.band.sampled_runs import Law
from tests.certificates.band.test_slip_band_reference import EXACT, WINDOW, Course, falling_problem
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.setting import creep_slope
from wspd_design.certificates.theorems.slip_band import loop
from wspd_design.certificates.theorems.slip_band.friction import (
    FADINGS,
    REACHES,
    SLOPES,
    Friction,
    reached,
)
from wspd_design.certificates.theorems.slip_band.loop import loop_of
from wspd_design.certificates.theorems.slip_band.proof import Choice
from wspd_design.certificates.theorems.slip_band.reference import slip_at, slips_held, turning_at
from wspd_design.certificates.theorems.slip_band.statement import (
    JERK_FACTORS,
    NAMES,
    box_of,
    fastest_loss,
    halved,
    law_of,
    windows_of,
)
from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.loading import constants

PULSE = Fraction(1, 2)
SPEED = 8.0495  # m/s, at the beginning of a sample in the window
ERROR, DRIFT = Fraction(1, 100), Fraction(2, 5)  # -, m/s2, of a slip that wanders
NOISE = Fraction(1, 50)  # m/s


@pytest.fixture(scope="module")
def plain():
    return falling_problem(WET, 0.0, slip=0.5, largest=0.5)


@pytest.fixture(scope="module")
def oiled(plain):
    """What slows the wheels down is most of what holds them."""
    return replace(plain, vehicle=replace(plain.vehicle, wheel_damping=1000.0))


@pytest.fixture(scope="module")
def damped(plain):
    """Wheels in oil and a train against the wind: what is negligible of the locomotive is not here."""
    vehicle = plain.vehicle
    return replace(
        plain,
        vehicle=replace(vehicle, wheel_damping=100.0, resistance_linear=0.03 * vehicle.mass),
        bounds=type(plain.bounds).of({name: ends for name, ends in plain.bounds.items() if name in NAMES}),
    )


def friction_of(problem, law, window):
    """Bounds of the friction in each strip about the slips that are held, by differences."""
    course = Course(problem, law, None)
    full = problem.nominal("mass") * constants().gravity / 8.0 * problem.rail.mu0
    held, d = slips_held(law, window, (Fraction(problem.vehicle.wheel_radius),) * 2), 1e-5

    def ends(measured, strip):
        found = [
            measured(slip - x * problem.speeds[0] / v, v)
            for x, v, slip in product(np.linspace(*map(float, strip), 5), window, np.linspace(*held, 5))
        ]
        return min(found) - 1e-4, max(found) + 1e-4

    def slope(slip, v):
        return -(course.force(v, slip + d) - course.force(v, slip - d)) / (2 * d * v) / full

    def fading(slip, v):
        return (course.force(v + d, slip) - course.force(v - d, slip)) / (2 * d) / full / slip

    return Friction(
        tuple(ends(slope, strip) for strip in SLOPES),
        ends(lambda slip, v: course.force(v, slip) / full, (0.0, 0.0)),
        tuple(ends(fading, strip) for strip in FADINGS),
    )


def loop_in(problem, law, settled=0.0, *, friction=None, conditions=EXACT, window=WINDOW, near=0):
    with ctx.workprec(128):
        cell = tuple((Fraction(problem.nominal(name)),) * 2 for name in NAMES)
        parts = everywhere(friction or friction_of(problem, law, window))
        return loop_of(problem, law, cell, window, parts, Choice(PULSE, near, Fraction(settled)), conditions)


def doubles(ends):
    return tuple(float(end.mid()) for end in ends)


def within(value, ends, part=1e-9):
    return ends[0] - part <= value <= ends[1] + part


def laws(problem):
    """A constant slip and a falling one, each alone and with one that wanders beside it."""
    falling = law_of(problem.controller)
    constant = replace(falling, falls=False, slip=Fraction(9, 50))
    return [
        replace(each, slip_error=error, slip_drift=drift)
        for each, (error, drift) in product((constant, falling), ((Fraction(0), Fraction(0)), (ERROR, DRIFT)))
    ]


class Stop(Course):
    """A train whose other wheels are off the reference by an error e R over the lowest speed."""

    def __init__(self, problem, law, slip, others=0.0):
        super().__init__(problem, law, slip)
        self.others = others

    def braking(self, speed, slip):
        return super().braking(speed, slip - self.others * self.problem.speeds[0] / speed)

    def sample(self, start, settled):
        """Times, speeds, the torque that holds over the inertia of the law, rate of the reference, slip aside."""
        radius, times = self.problem.vehicle.wheel_radius, np.linspace(0.0, float(self.law.sample_time), 41)
        speeds = self.speeds(SPEED, start + times)
        rows = []
        for t, v in zip(start + times, speeds, strict=True):
            slip = self.slip(t, v)
            aside = slip - slip_at(self.law, v, radius)
            rate = -self.braking(v, slip) * (turning_at(self.law, v, radius) - aside) / radius
            torque = self.holding(v, slip, settled) - self.problem.vehicle.wheelset_inertia * rate
            rows.append((torque / float(self.law.inertia), rate, aside))
        return times, speeds, *np.array(rows).T

    def disturbed(self, start, settled, secant):
        """What disturbs in a sample, by the number of the disturbance."""
        times, speeds, torque, rate, aside = self.sample(start, settled)
        h, radius = times[-1], self.problem.vehicle.wheel_radius
        weight = np.exp(secant * (h - times))
        moving = np.diff(aside) * (speeds[1:] + speeds[:-1]) / 2.0 / radius
        moved = float(np.sum(moving))
        turned = (1.0 - self.slip(start + h, speeds[-1])) * speeds[-1] - (
            1.0 - self.slip(start, speeds[0])
        ) * speeds[0]
        grown = (weight[1:] + weight[:-1]) / 2.0
        return {
            2: h * (torque[-1] - torque[0]),
            3: h * np.trapezoid(weight * (torque - torque[0]), times) / np.trapezoid(weight, times),
            4: h * (rate[-1] - rate[0]),
            5: turned / radius - h * rate[0] + moved,
            6: moved,
            7: float(np.sum((grown - 1.0) * moving)),
        }


def wandering(law, problem, wide=1.0):
    """A slip that moves beside that of the law as fast as it may."""
    radius, error, pace = problem.vehicle.wheel_radius, float(law.slip_error), 0.0
    if error:
        pace = wide * float(law.slip_drift) / WINDOW[1] / error
    return pace, lambda t, v: slip_at(law, v, radius) + error * math.sin(pace * t)


@pytest.mark.parametrize("settled", [-0.01, 0.05])
@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("kind", ["plain", "damped", "oiled"])
def test_what_disturbs_in_a_sample_is_within_its_bounds(request, kind, number, settled):
    """With errors that grow by either end of the secants, and other wheels at the ends of what is reached.

    Those that turn faster than the reference brake the train by another force: oiled wheels tell that.
    """
    problem = request.getfixturevalue(kind)
    law = laws(problem)[number]
    loop = loop_in(problem, law, settled)
    ends = [doubles(each) for each in loop.disturbances]
    pace, slip = wandering(law, problem)
    starts = np.linspace(0.0, 2.0 * math.pi / pace, 9) if pace else (0.0,)
    for others, start, secant in product((-0.02, 0.0, 0.04), starts, doubles(loop.ranges.secants)):
        stop = Stop(problem, law, slip, others)
        seen, steady, share = stop.disturbed(start, settled, secant), 0.0, float(loop.steady.share.mid())
        if not (law.falls or law.slip_error):
            steady, d = 0.0, 1e-4
            change = stop.holding(SPEED + d, 0.18, settled) - stop.holding(SPEED - d, 0.18, settled)
            h = float(law.sample_time)
            steady = -h * h * change / (2.0 * d) * stop.braking(SPEED, 0.18) / float(law.inertia)
            assert within(steady, doubles((loop.steady.low, loop.steady.high)))
        for k, value in seen.items():
            assert within(value - {2: steady, 3: share * steady}.get(k, 0.0), ends[k], 2e-8), k


@pytest.mark.parametrize("settled", [-0.06, 0.0, 0.13])
@pytest.mark.parametrize("number", [0, 1])
@pytest.mark.parametrize("kind", ["plain", "damped"])
def test_secants_from_where_errors_are_counted_are_within_their_bounds(request, kind, number, settled):
    """Friction and damping of a wheel at any error that is reached, over its inertia."""
    problem = request.getfixturevalue(kind)
    law = laws(problem)[2 * number]
    low, high = doubles(loop_in(problem, law, settled).ranges.secants)
    radius, inertia = problem.vehicle.wheel_radius, problem.vehicle.wheelset_inertia
    course = Course(problem, law, None)
    for v, x in product(WINDOW, np.linspace(-0.0199, 0.0399, 40)):
        slip, error = slip_at(law, v, radius), x * problem.speeds[0] / radius
        if abs(error - settled) > 1e-4:
            torque = course.holding(v, slip, error) - course.holding(v, slip, settled)
            assert low <= torque / inertia / (error - settled) <= high


def test_mean_of_the_drift_counts_for_errors_that_grow_and_for_those_that_fade(plain):
    """With a slope that may be anything in a wide range."""
    law = laws(plain)[0]
    friction = friction_of(plain, law, WINDOW)
    loop = loop_in(plain, law, friction=friction._replace(slopes=((-1.0, 1.0),) * len(SLOPES)))
    stop, share, h = Stop(plain, law, lambda *_: 0.18), float(loop.steady.share.mid()), float(law.sample_time)
    before, after = (stop.holding(SPEED + d, 0.18, 0.0) for d in (-1e-4, 1e-4))
    steady = -h * h * (after - before) / 2e-4 * stop.braking(SPEED, 0.18) / float(law.inertia)
    for secant in doubles(loop.ranges.secants):
        assert abs(secant) > 5.0
        value = stop.disturbed(0.0, 0.0, secant)[3]
        assert within(value - share * steady, doubles(loop.disturbances[3]), 1e-9)


def test_share_of_the_pressure_that_holds_is_no_more_than_it_is(damped):
    law = laws(damped)[0]
    course = Course(damped, law, None)
    held = [course.holding(v, 0.18, 0.0) / float(law.full_torque) for v in WINDOW]
    told = loop_in(damped, law).holding
    assert 0.98 * min(held) < told <= min(held)


@pytest.mark.parametrize("number", [1, 3])
def test_lag_of_the_filter_behind_a_slip_that_wanders_is_within_its_bounds(damped, number):
    law, window = laws(damped)[number], (8.0, 8.1)
    pace, slip = wandering(law, damped, 0.99)
    ends = doubles(loop_in(damped, law, window=window).disturbances[9])
    h, radius = float(law.sample_time), damped.vehicle.wheel_radius
    kept = math.exp(-float(law.sample_time / law.acceleration_time))
    stop, seen = Stop(damped, law, slip), []
    for start, first in product(np.linspace(0.0, 2.0 * math.pi / pace, 9), (8.5, 8.51, 8.52)):
        speeds, filtered, lags, times = [first], -stop.braking(first, slip(start, first)), [], [start]
        while speeds[-1] >= window[0]:
            speed, t = speeds[-1], times[-1]
            turning = turning_at(law, speed, radius) - (slip(t, speed) - slip_at(law, speed, radius))
            lags.append(h * turning / radius * (-stop.braking(speed, slip(t, speed)) - filtered))
            if len(lags) > 1 and speeds[-2] <= window[1]:
                seen.append(lags[-1] - kept * lags[-2])
            speeds.append(stop.speeds(speed, t + np.linspace(0.0, h, 11))[-1])
            times.append(t + h)
            filtered += (1.0 - kept) * ((speeds[-1] - speed) / h - filtered)
    assert len(seen) >= 9
    assert all(within(each, ends) for each in seen)


class Steered(Stop):
    """A train whose deceleration rises by a factor of what it does with all wheels at the reference."""

    def __init__(self, problem, law, slip, factor):
        super().__init__(problem, law, slip)
        self.factor, d = factor, 1e-4
        held = slip_at(law, SPEED, problem.vehicle.wheel_radius)
        self.most = super().braking(SPEED, held)
        fall = [super(Steered, self).braking(v, slip(0.0, v)) for v in (SPEED - d, SPEED + d)]
        self.jerk = factor * self.most * (fall[1] - fall[0]) / (2.0 * d)

    def speeds(self, speed, times):
        t = np.asarray(times) - times[0]
        return speed - self.most * t + self.jerk * t**2 / 2.0

    def braking(self, speed, _slip):
        """At a speed of the sample that begins with the speed of the class."""
        return math.sqrt(self.most**2 - 2.0 * self.jerk * (SPEED - speed))


@pytest.mark.parametrize("settled", [-0.06, 0.0, 0.13])
@pytest.mark.parametrize("factor", JERK_FACTORS)
@pytest.mark.parametrize("number", [0, 2])
def test_drift_of_a_train_whose_deceleration_rises_faster_or_slower_is_within_its_bounds(
    plain, number, factor, settled
):
    law = laws(plain)[number]
    loop, h = loop_in(plain, law, settled), float(law.sample_time)
    ends, share = [doubles(each) for each in loop.disturbances], float(loop.steady.share.mid())
    _, slip = wandering(law, plain)
    stop, steady = Steered(plain, law, slip, float(factor)), [0.0, 0.0]
    if not law.falls:
        for k, v in enumerate((SPEED, stop.speeds(SPEED, (0.0, h))[1])):
            change = stop.holding(v + 1e-4, 0.18, settled) - stop.holding(v - 1e-4, 0.18, settled)
            steady[k] = -h * h * change / 2e-4 * stop.braking(v, 0.18) / float(law.inertia)
        assert within(steady[1] - steady[0], doubles(loop.steady.change))
    for secant in doubles(loop.ranges.secants):
        for k, value in stop.disturbed(0.0, settled, secant).items():
            assert within(value - {2: 1.0, 3: share}.get(k, 0.0) * steady[0], ends[k]), k


@pytest.mark.parametrize("factor", JERK_FACTORS)
@pytest.mark.parametrize("number", [0, 1])
def test_filter_of_a_speed_that_is_told_wrong_lags_within_its_bounds(plain, number, factor):
    """What the law takes for its reference moves by the train and by the slip: the filter shows the one late.

    The other one is all wrong.
    """
    law = laws(plain)[number]
    ends = [doubles(each) for each in loop_in(plain, law).disturbances]
    pace, slip = wandering(law, plain)
    h, radius = float(law.sample_time), plain.vehicle.wheel_radius
    kept = math.exp(-float(law.sample_time / law.acceleration_time))
    seen, rates = [], []
    for start in np.linspace(0.0, 2.0 * math.pi / pace, 17) if pace else (0.0,):
        stop = Steered(plain, law, slip, float(factor))
        sub = np.linspace(0.0, h, 41)
        speeds = stop.speeds(SPEED, sub)
        # Long before, the train lost speed in the same way, and slip and share of the rims were nearly the same.
        of_train = of_slip = 0.0

        def turning(t, v):
            return turning_at(law, v, radius) - (slip(t, v) - slip_at(law, v, radius))

        for j in range(200, 0, -1):
            t, v = start - j * h, SPEED + stop.most * j * h + stop.jerk * (j * h) ** 2 / 2.0
            rate = stop.most + stop.jerk * j * h
            of_train += (1.0 - kept) * (
                -(rate - stop.jerk * h / 2.0) * turning(t + h / 2.0, v) / radius - of_train
            )
            moved = (slip(t + h, SPEED) - slip(t, SPEED)) / h * SPEED / radius
            of_slip += (1.0 - kept) * (moved - of_slip)
        lag = h * (-stop.most * turning(start, SPEED) / radius - of_train)
        _, _, _, rate, _ = stop.sample(start, 0.0)
        mean = np.trapezoid(rate, sub) / h
        of_train += (1.0 - kept) * (mean - of_train)
        seen.append(h * (rate[-1] - of_train) - kept * lag)
        rates.append(h * of_slip)
        assert speeds[-1] >= WINDOW[0]
    assert all(within(each, ends[9]) for each in seen)
    assert all(within(each, ends[0]) for each in rates)


@pytest.mark.parametrize("factor", JERK_FACTORS)
@pytest.mark.parametrize("smoothing", [Fraction(3, 10), Fraction(20), Fraction(1000)])
def test_lag_that_has_settled_shrinks_with_what_the_rims_take_part_in(plain, smoothing, factor):
    """A slip that falls takes the rims less along at lower speeds, and a filter that is slow lags far behind."""
    law = replace(laws(plain)[2], acceleration_time=smoothing)
    ends = doubles(loop_in(plain, law).disturbances[9])
    _, slip = wandering(law, plain)
    stop = Steered(plain, law, slip, float(factor))
    h, radius = float(law.sample_time), plain.vehicle.wheel_radius
    kept = math.exp(-float(law.sample_time / law.acceleration_time))
    speeds = stop.speeds(SPEED, (0.0, h))
    turned = [h * turning_at(law, v, radius) / radius for v in speeds]

    def later(lag):
        """The lag after a sample."""
        filtered = -stop.braking(speeds[0], None) - lag / turned[0]
        filtered += (1.0 - kept) * ((speeds[1] - speeds[0]) / h - filtered)
        return turned[1] * (-stop.braking(speeds[1], None) - filtered)

    # What it is after a sample goes in proportion to what it was.
    settled = later(0.0) / (1.0 - (later(1.0) - later(0.0)))
    assert later(settled) == pytest.approx(settled)
    for lag in (0.0, settled):
        assert within(later(lag) - kept * lag, ends)


def test_train_that_may_lose_more_speed_than_windows_overlap_or_gain_some_is_refused(plain):
    law = laws(plain)[0]
    friction = friction_of(plain, law, WINDOW)
    windy = replace(plain, vehicle=replace(plain.vehicle, resistance_linear=0.2 * plain.vehicle.mass))
    windy = replace(
        windy, bounds=type(plain.bounds).of({n: e for n, e in plain.bounds.items() if n in NAMES})
    )
    pushed = friction._replace(level=(-friction.level[1], friction.level[1]))
    for problem, bounds in ((windy, friction), (plain, pushed)):
        with pytest.raises(Refused, match="lose more speed in a sample than the windows overlap, or gain"):
            loop_in(problem, law, friction=bounds)


def test_windows_overlap_by_what_a_sample_takes_off(plain):
    windows, loss = (
        windows_of(plain),
        float(fastest_loss(plain)) * float(law_of(plain.controller).sample_time),
    )
    rail, course = plain.rail, Course(plain, None, None)
    most = max(course.braking(v, s) for v, s in product(plain.speeds, np.linspace(0.01, 0.5, 50)))
    assert plain.span("mu0")[1] >= rail.mu0
    assert most < float(fastest_loss(plain))
    assert windows[0][0] <= plain.speeds[0] - loss
    assert windows[-1][1] >= plain.speeds[1]
    for (_, fast), (slow, _) in pairwise(windows):
        assert slow <= fast - (1.0 - 1e-9) * loss


def test_late_pulses_end_in_their_sample_and_noise_is_less_than_half_of_a_speed(plain):
    law = laws(plain)[0]
    friction = friction_of(plain, law, WINDOW)
    with pytest.raises(Refused, match="into the next sample"):
        loop_in(plain, law, friction=friction, conditions=EXACT._replace(delay=Fraction(3, 5)))
    with pytest.raises(Refused, match="more than half of a speed"):
        loop_in(plain, law, friction=friction, conditions=EXACT._replace(noise=Fraction(5)))


@pytest.mark.parametrize("near", range(len(REACHES)))
def test_errors_are_kept_where_the_slope_is_bounded_for_every_wheel(plain, near):
    worn = replace(
        plain, bounds=type(plain.bounds).of(dict(plain.bounds.items()) | {"wheel radius": (0.5, 0.55)})
    )
    for low, high in (doubles(each) for each in (loop_in(worn, laws(plain)[0], near=near).widest,)):
        for radius in (0.5, 0.55):
            ends = (low * radius / plain.speeds[0], high * radius / plain.speeds[0])
            assert float(reached(near)[0]) - 1e-12 <= ends[0] < ends[1] <= float(reached(near)[1]) + 1e-12


# --- noise ------------------------------------------------------------------------------------------------------------
def misjudged(law, problem, aside, sequence):
    """How the law misjudges its reference and h times the rate of it, by errors of the train speed in a stop."""
    radius, h = problem.vehicle.wheel_radius, float(law.sample_time)
    kept = math.exp(-float(law.sample_time / law.acceleration_time))
    speeds = WINDOW[1] + 1.3 * h * np.arange(len(sequence))[::-1]
    told, exact, noisy = speeds + np.array(sequence), -1.3, -1.3
    for k in range(1, len(speeds)):
        exact += (1.0 - kept) * ((speeds[k] - speeds[k - 1]) / h - exact)
        noisy += (1.0 - kept) * ((told[k] - told[k - 1]) / h - noisy)

    def reference(v):
        return (1.0 - slip_at(law, v, radius) - aside) * v / radius

    def rate(v, acceleration):
        return (turning_at(law, v, radius) - aside) / radius * acceleration

    return reference(told[-1]) - reference(speeds[-1]), h * (rate(speeds[-1], exact) - rate(told[-1], noisy))


@pytest.mark.parametrize("smoothing", [Fraction(1, 10), Fraction(1000)])
@pytest.mark.parametrize("number", [0, 2])
def test_noise_shows_in_error_and_acceleration_as_far_as_is_told(plain, number, smoothing):
    """Errors of one sign all the time, then of the other, of wheel and train; and slips beside those of the law."""
    law = replace(laws(plain)[number], acceleration_time=smoothing, slip_error=Fraction(3, 20))
    conditions, noise = EXACT._replace(noise=NOISE), float(NOISE)
    friction = friction_of(plain, replace(law, slip_error=Fraction(0)), WINDOW)
    loop = loop_in(plain, law, friction=friction, conditions=conditions)
    known, command, measured = (doubles(loop.disturbances[k]) for k in (0, 1, 8))
    rim = noise / plain.vehicle.wheel_radius
    gain = float(law.approach_rate * law.sample_time)
    seen = []
    for sign, aside, turns in product((-1.0, 1.0), (-0.15, 0.15), (-1.0, 1.0)):
        off, rate = misjudged(law, plain, aside, [sign * noise] * 400 + [turns * sign * noise])
        for of_rim in (-rim, rim):
            assert within(gain * (of_rim - off), command)
            assert within(of_rim, measured)
            seen.append(gain * abs(of_rim - off))
        assert within(rate, known)
        asked = (1.0 + gain * float(law.ahead)) * rate + gain * (-math.copysign(rim, off) - off)
        assert within(asked, doubles(loop.wants[0].beside))
    assert max(seen) > 0.8 * command[1]


# --- small changes that the law leaves out ----------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("band", "share", "least"), [(400.0, 1e3, 0.0), (4e3, 0.2, 0.0), (0.0, 0.0, 0.004), (300.0, 0.01, 0.004)]
)
def test_changes_that_are_left_out_are_no_larger_than_told(plain, band, share, least):
    protection = plain.controller
    brake = replace(protection.valve.brake, vent_time=0.5 * protection.valve.brake.vent_time)
    valve = replace(protection.valve, brake=brake, least_pulse=least)
    tracking = replace(protection.core.tracking, dead_band=band, dead_band_share=share, valve=valve)
    protection = replace(protection, valve=valve, core=replace(protection.core, tracking=tracking))
    law = replace(law_of(protection), falls=False, slip=Fraction(9, 50))
    low, high = doubles(loop_in(plain, law, conditions=EXACT._replace(noise=NOISE)).disturbances[1])
    simple, radius = Law(protection, 0.18), plain.vehicle.wheel_radius
    told = WINDOW[1] + float(NOISE)
    wheel = (1.0 - 0.18) * told / radius
    still = np.zeros(1)

    def left_out(torque, way):
        """Whether neither valve opens for a wanted change: the observed friction, where the predicted error is none."""
        memory = simple.rolling(np.array([told]), radius)
        memory = replace(memory, told=np.array([told]), acceleration=still, friction=np.array([torque + way]))
        error = simple.tracking.ahead * simple.h * way / simple.inertia
        fill, vent, _ = simple.pulses(memory, np.array([wheel - error]), np.array([torque]), simple.full)
        return fill[0] == vent[0] == 0.0

    seen = []
    for torque, sign in product(simple.full * np.array([0.02, 0.3, 0.6, 0.98]), (-1.0, 1.0)):
        least, most = 0.0, 0.999 * (torque if sign < 0.0 else simple.full - torque)
        for _ in range(30):
            middle = (least + most) / 2.0
            least, most = (middle, most) if left_out(torque, sign * middle) else (least, middle)
        seen.append(simple.h / simple.inertia * sign * least)
    noise = float(law.approach_rate * law.sample_time) * float(NOISE) / radius
    assert low + noise <= min(seen) <= max(seen) <= high - noise
    assert max(np.abs(seen)) > 0.5 * (high - 2.0 * noise)


# --- limits -----------------------------------------------------------------------------------------------------------
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
    slowing = max(Stop(problem, law, None, x).braking(v, 0.18) for x in (-0.02, 0.04) for v in WINDOW)
    worst = {}
    for what, row, bound in limits:
        for place in (j for j in range(5) if row[j]):
            state = np.zeros(5)
            state[place] = (1.0 - 1e-6) * bound / row[place]
            e, _, n, y, lag = state
            for v, slow, supply, (misread, known) in product(
                WINDOW, (0.0, slowing), (float(SUPPLY), 1.0), noise
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


@pytest.mark.parametrize("letters", ["", "m", "u", "mu", "i"])
def test_cell_takes_the_bounds_for_the_steepness_of_its_masses_and_frictions(monkeypatch, letters):
    """Wheels are the steeper, the lighter they are and the less friction there is."""
    problem = falling_problem(WET, 1.0)
    cells = [box_of(problem, Fraction(1))]
    for letter in letters:
        cells = [half for each in cells for half in halved(each, letter)]
    asked = []
    monkeypatch.setattr(loop, "bounds_for", lambda _, steepness: asked.append(steepness) or 1 / 0)
    for cell in cells:
        with pytest.raises(ZeroDivisionError):
            loop_of(problem, law_of(problem.controller), cell, WINDOW, (), Choice(PULSE, 0), EXACT)
    nominal = creep_slope.steepness_of(replace(problem, bounds=Bounds.of({})))[0]
    for cell, (low, high) in zip(cells, asked, strict=True):
        mass, mu0 = ([float(end) for end in cell[NAMES.index(name)]] for name in ("mass", "mu0"))
        ends = [
            nominal * (problem.nominal("mass") / m) ** (1.0 / 3.0) * problem.nominal("mu0") / u
            for m, u in zip(mass, mu0, strict=True)
        ]
        assert (high, low) == pytest.approx(ends, rel=1e-9)
