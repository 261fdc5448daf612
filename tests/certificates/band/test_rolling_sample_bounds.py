"""Bounds of the way in against random numbers of the box and dense simulation, in equations of their own."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import wspd_design as wd
from tests.attack.plant import creep_force, filled, resistance, static_load, vented
from tests.certificates.band.conftest import problem_of
from tests.certificates.band.sampled_runs import BESIDE, BOX, Law, plant_of, rolling, sampled
from wspd_design.model.generated import rolling_bounds

H, SLIP, FULL = 0.02, 0.14, 60e3 * 0.02 / 752.0
INVERSION = 0.36  # s, the time that the inversion takes for those of the valve
SAMPLE_OF_INVERSION = -math.expm1(-H / INVERSION)  # of the room, for a pulse of the whole sample
RAILS = ("low-adhesion", "polach-wet")
THETA = 0.5527864
COUNT, STEP = 120, 1.0 / 30.0  # members, and part of a sample
TINY = 1e-20


def members(rail, seed, count=COUNT):
    """Plants of the box, half of the numbers at ends of their ranges."""
    problem, random = problem_of(1.0, rail=wd.load_rail(rail)), np.random.default_rng(seed)
    points = {}
    for name in (*BOX, *BESIDE):
        low, high = problem.span(name)
        share = random.random(count)
        points[name] = low + np.where(random.random(count) < 0.5, np.round(share), share) * (high - low)
    points["speed"] = random.uniform(20.0, 120.0 / 3.6, count)
    return problem, points, plant_of(problem, points)


# --- (a), (g): slip and friction; q = s' v/R, per sample ------------------------------------------------------------
class Wheel:
    """Friction of a wheel at a slip and a speed, per sample in rad/s, with derivatives by complex steps."""

    def __init__(self, plant):
        self.plant, self.R = plant, plant.wheel_radius
        self.kappa = (1.0 - SLIP) * plant.wheelsets * plant.wheelset_inertia / (self.R**2 * plant.mass)
        self.g = plant.max_torque / 60e3 * 752.0 / plant.wheelset_inertia
        self.damping = 2.0 * plant.wheel_damping * H / plant.wheelset_inertia

    def f(self, s, v):
        gripped = 2.0 * self.R * creep_force(self.plant, s, v, static_load(self.plant))
        return gripped * H / self.plant.wheelset_inertia - self.damping * (1.0 - s) * v / self.R

    def drag(self, s, v):
        held = (1.0 - SLIP) * H * resistance(self.plant, v) / (self.R * self.plant.mass)
        return self.kappa * self.damping * (1.0 - s) * v / self.R + held

    def steepness(self, s, v):
        return self.R / v * self.f(s + 1j * TINY, v).imag / TINY

    def motion(self, s, v, torque):
        """q, loss of the reference and rates of slip and speed."""
        f, drag = self.f(s, v), self.drag(s, v)
        lost, aside = self.kappa * f + drag, (SLIP - s) / (1.0 - SLIP)
        q = self.g * torque - (1.0 + self.kappa) * f - drag - aside * lost
        return q, lost, self.R * q / v, -self.R * lost / (1.0 - SLIP)

    def seen(self, s, v, torque, torque_rate):
        """What the bound on S q speaks about."""
        q, _, slip_rate, speed_rate = self.motion(s, v, torque)
        slowing, aside, S = -speed_rate / v, (SLIP - s) / (1.0 - SLIP), self.steepness(s, v)
        step = 1e-5
        S_l = -(self.steepness(s, v * (1.0 + step)) - self.steepness(s, v * (1.0 - step))) / (2.0 * step)
        bend = (self.steepness(s + 1e-6, v) - self.steepness(s - 1e-6, v)) / 2e-6
        drag_rate = self.drag(s + 1j * TINY * slip_rate, v + 1j * TINY * speed_rate).imag / TINY
        fixed = self.f(s, v + 1j * TINY).imag / TINY * speed_rate
        growth = (
            self.g * torque_rate
            - (1.0 + self.kappa * (1.0 + aside)) * (S * q + fixed)
            - (1.0 + aside) * drag_rate
            + slowing * q
        )
        numbers = np.where(S > 0.0, S, np.inf), np.maximum(S_l, 0.0), slowing, fixed, drag_rate
        return SimpleNamespace(
            q=q,
            S=S,
            kappa=self.kappa,
            level=(1.0 + self.kappa) * S * q,
            most=rolling_bounds.level_bound(self.g * torque_rate, q, *numbers, self.kappa, aside),
            growth=growth,
            holds=(s >= 0.0) & (s <= SLIP) & (bend <= 0.0) & (S >= 0.0),
            least=((1.0 + self.kappa * (1.0 + aside)) * fixed + (1.0 + aside) * drag_rate) / self.g,
        )

    def stepped(self, s, v, torque, torque_rate, step=STEP):
        """Slip, speed and torque a part of a sample later."""

        def rates(s, v, t):
            return np.array(self.motion(s, v, torque + torque_rate * t)[2:])

        x = np.array([s, v])
        first = rates(*x, 0.0)
        second = rates(*(x + step / 2 * first), step / 2)
        third = rates(*(x + step / 2 * second), step / 2)
        last = rates(*(x + step * third), step)
        s, v = x + step / 6 * (first + 2.0 * second + 2.0 * third + last)
        return s, v, torque + torque_rate * step


def courses(rail, seed, rate_of, samples=60):
    """What is seen on the way of random wheels, whose torque changes at rates that a function gives."""
    _, points, plant = members(rail, seed)
    random, wheel = np.random.default_rng(seed), Wheel(plant)
    v, s = points["speed"], random.choice([0.0, 1e-4, 1e-3, 0.01], COUNT)
    torque = ((1.0 + wheel.kappa) * wheel.f(s, v) + wheel.drag(s, v)) / wheel.g
    torque = torque + SLIP / (1.0 - SLIP) * (wheel.kappa * wheel.f(s, v) + wheel.drag(s, v)) / wheel.g
    found = []
    for n in range(round(samples / STEP)):
        rate = rate_of(random, n, wheel, s, v)
        found.append(wheel.seen(s, v, torque, rate))
        s, v, torque = wheel.stepped(s, v, torque, rate)
        s = np.minimum(s, 0.9)
    return SimpleNamespace(
        **{name: np.array([getattr(each, name) for each in found]) for name in vars(found[0])}
    )


class Filling:
    """Rates of the torque that change from sample to sample: of filling, of none, a few of venting."""

    def __init__(self, scale):
        self.scale, self.rate = scale, 0.0

    def __call__(self, random, n, *_):
        if n % round(1.0 / STEP) == 0:
            drawn = self.scale * random.random(COUNT) ** 2
            self.rate = np.where(random.random(COUNT) < 0.2, -0.3 * drawn, drawn)
        return self.rate


def highest(stop, bound):
    """For each wheel the largest level while the conditions hold, and the largest bound at levels near it.

    The rate of the torque jumps where many a level is largest: the bound counts a step before as well.
    """
    holds = np.logical_and.accumulate(stop.holds)
    level = np.where(holds & (stop.q > 0.0), stop.level, -np.inf)
    peak = level.max(axis=0)
    near = level >= peak - 0.02 * np.abs(peak)
    near[:-1] |= near[1:]
    return peak, np.where(near, bound, -np.inf).max(axis=0), holds.sum(axis=0)


@pytest.mark.parametrize("rail", RAILS)
@pytest.mark.parametrize("scale", [0.002, 0.02, 0.1])
def test_friction_grows_no_faster_than_the_torque(rail, scale):
    stop = courses(rail, 5, Filling(scale), samples=24)
    peak, most, held = highest(stop, stop.most)
    begun = (stop.level[0] >= 0.98 * peak) | ~np.isfinite(peak)
    assert np.all((peak <= most + 1e-6) | begun)
    assert np.max(peak[~begun] / most[~begun]) > 0.8
    assert np.count_nonzero(~begun & (held > 100)) > 30
    decays = np.exp(-(1.0 + stop.kappa[:-1]) * stop.S[:-1] * STEP)  # the level follows the bound, with a lag
    follows = stop.level[:-1] * decays + np.maximum(stop.most[:-1], stop.most[1:]) * (1.0 - decays)
    told = stop.holds[:-1] & stop.holds[1:] & (stop.q[:-1] > 1e-4) & (stop.q[1:] > 1e-4)
    assert np.all(stop.level[1:][told] <= follows[told] + 5e-7)


def test_friction_gets_steeper_while_the_train_slows_down():
    """At a slip that grows, where the curve is concave: hardly, but what says that it never does is wrong."""
    stop = courses("low-adhesion", 5, Filling(0.002), samples=6)
    rises = (np.diff(stop.S, axis=0) > 0.0) & stop.holds[:-1] & (stop.q[:-1] > 0.0) & (stop.q[1:] > 0.0)
    assert np.count_nonzero(rises) > 100


@pytest.mark.parametrize("rail", RAILS)
def test_generated_friction_is_that_of_the_attack(rail):
    """Friction, its steepness and how they change with the speed, by complex steps and differences."""
    problem, points, plant = members(rail, 12)
    wheel, v, s = Wheel(plant), points["speed"], np.random.default_rng(12).uniform(0.0, 0.14, COUNT)
    load, made = static_load(plant), problem.rail
    grip = 2.0 * plant.wheel_radius * load * plant.mu0 * H / plant.wheelset_inertia
    adhering = (
        creep_force(plant, 1e-30j, v, load).imag / 1e-30
    )  # the curve begins with the slope of both parts
    both = 2.0 / np.pi * (made.adhesion_reduction + made.slip_reduction)
    gradient = adhering / (both * load * plant.mu0)
    laws = made.friction_ratio, made.friction_decay, made.adhesion_reduction, made.slip_reduction
    f, S, S_l, fixed = rolling_bounds.friction_on_the_way(
        s, v, plant.wheel_radius, grip, gradient, *laws, wheel.damping
    )
    np.testing.assert_allclose(f, wheel.f(s, v), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(S, wheel.steepness(s, v), rtol=1e-8, atol=1e-10)
    step = 1e-5
    falls = -(wheel.steepness(s, v * (1.0 + step)) - wheel.steepness(s, v * (1.0 - step))) / (2.0 * step)
    np.testing.assert_allclose(S_l, falls, rtol=1e-5, atol=1e-7)
    np.testing.assert_allclose(fixed, -v * wheel.f(s, v + 1j * TINY).imag / TINY, rtol=1e-8, atol=1e-10)


def test_growth_of_the_slip_is_that_of_the_identity():
    stop = courses("polach-wet", 6, Filling(0.05), samples=6)
    rates = np.diff(stop.q, axis=0) / STEP
    middle = (stop.growth[1:] + stop.growth[:-1]) / 2.0
    within = np.ones(len(rates), dtype=bool)
    within[round(1.0 / STEP) - 1 :: round(1.0 / STEP)] = False  # there the rate of the torque jumps
    assert np.abs(rates - middle)[within].max() < 1e-2 * np.abs(middle).max()


@pytest.mark.parametrize("rail", RAILS)
@pytest.mark.parametrize(("more", "falls"), [(1e-6, False), (-2e-5, True)])
def test_slip_grows_while_the_torque_rises_enough(rail, more, falls):
    """A torque that rises by the threshold and a bit; with a bit less some wheels slip less and less."""

    def rate_of(random, _, wheel, s, v):
        torque = ((1.0 + wheel.kappa) * wheel.f(s, v) + wheel.drag(s, v)) / wheel.g
        beside = (SLIP - s) / (1.0 - SLIP) * (wheel.kappa * wheel.f(s, v) + wheel.drag(s, v)) / wheel.g
        bursts = 0.03 * (random.random(COUNT) < 0.02) if more > 0.0 else 0.0
        return wheel.seen(s, v, torque + beside, 0.0).least + more + bursts

    stop = courses(rail, 7, rate_of, samples=20)
    begins = stop.q[0] >= -1e-12
    # A wheel whose slip begins to fall has one that grows as soon as the torque rises by more than the threshold.
    lowest = stop.q.min(axis=0)
    assert np.any(lowest < -1e-7) if falls else np.all(lowest[begins] > -1e-9)


# --- (b), (c), (d): pulses ------------------------------------------------------------------------------------------
class Pulse:
    """Pulses of the inversion for parts of the room, by valves of the box under a supply that rises."""

    def __init__(self, seed, count=3000):
        random = np.random.default_rng(seed)

        def drawn(low, high):
            share = random.random(count)
            return low + (high - low) * np.where(random.random(count) < 0.4, np.round(share), share)

        self.T_F, self.rate = drawn(0.3, 0.9), drawn(0.375, 1.125)
        self.since = H * np.maximum(np.floor(random.exponential(40.0, count)), 1.0)
        supply = -np.expm1(-self.rate * self.since)
        first = -np.expm1(-self.rate * H)
        self.torque = np.where(random.random(count) < 0.3, 0.0, random.random(count)) * (supply - first)
        self.room = supply - self.torque
        self.rise = self.rate * H * np.exp(-self.rate * self.since)
        self.u = np.minimum(drawn(0.002, 1.2 * SAMPLE_OF_INVERSION), SAMPLE_OF_INVERSION)
        self.l = -INVERSION / H * np.log1p(-self.u)
        self.rho, self.eta = INVERSION / self.T_F, H / self.T_F
        self.valve = SimpleNamespace(max_torque=1.0, fill_time=self.T_F, supply_rate=self.rate)

    def at(self, part):
        """Torque a part of the pulse after its beginning."""
        return filled(self.valve, self.torque, part * self.l * H, since=self.since)

    def mean(self, at):
        """Mean over the sample of what a pulse changes, by Gauss's points."""
        points, weights = np.polynomial.legendre.leggauss(12)
        inside = sum(w / 2.0 * (at((p + 1.0) / 2.0) - at(0.0)) for p, w in zip(points, weights, strict=True))
        return self.l * inside + (1.0 - self.l) * (at(1.0) - at(0.0))


def exact_share(x):
    """Part of an exponential change in the mean over its pulse."""
    return -1.0 / np.expm1(-x) - 1.0 / x


@pytest.fixture(scope="module")
def pulse():
    return Pulse(11)


def test_pulse_under_a_rising_supply_fills_a_bit_more(pulse):
    change = pulse.at(1.0) - pulse.torque
    level = pulse.room * -np.expm1(pulse.rho * np.log1p(-pulse.u))
    more = (change - level) / level * pulse.room / pulse.rise
    most = rolling_bounds.added_by_rise(pulse.l, pulse.eta)
    assert np.all(more >= 0.0)
    assert np.all(more <= most * (1.0 + 1e-9) + 1e-9)
    assert np.max(most) == pytest.approx(0.5 + H / 0.3 / 12.0)
    assert np.max(more / most) > 0.99
    growth = -np.expm1(-pulse.rate * H) * np.exp(-pulse.rate * pulse.since)  # of the supply over the sample
    assert np.all((change - level) / level * pulse.room / growth <= 0.5115)


def test_share_of_the_change_in_the_mean(pulse):
    change = pulse.at(1.0) - pulse.torque
    level = pulse.room * -np.expm1(pulse.rho * np.log1p(-pulse.u))
    in_mean, from_rise = pulse.mean(pulse.at) / change, 1.0 - level / change
    low, high = rolling_bounds.share_in_mean(pulse.l, pulse.eta, from_rise)
    assert np.all(in_mean >= low - 1e-9)
    assert np.all(in_mean <= high + 1e-9)
    assert in_mean.min() >= 0.4439
    assert in_mean.min() < 0.4470  # a cylinder that begins to fill
    added = pulse.rise / pulse.room * rolling_bounds.added_by_rise(pulse.l, pulse.eta)
    assert np.all(from_rise <= added / (1.0 + added) + 1e-9)


def test_share_of_a_fall_in_the_mean(pulse):
    valve = SimpleNamespace(vent_time=pulse.T_F)
    in_mean = pulse.mean(lambda part: vented(valve, 1.0, part * pulse.l * H)) / (
        vented(valve, 1.0, pulse.l * H) - 1.0
    )
    np.testing.assert_allclose(in_mean, 1.0 - pulse.l * (1.0 - exact_share(pulse.l * pulse.eta)), atol=1e-9)
    low, high = rolling_bounds.share_in_mean(pulse.l, pulse.eta, 0.0)
    assert np.all(in_mean >= low - 1e-9)
    assert np.all(in_mean <= high + 1e-9)


def test_mean_of_the_law_is_near_the_part_of_its_valve(pulse):
    """By the code that runs, for a way x: .6 x (1 - l/2), and a bit more."""
    law = problem_of(1.0).controller
    full = law.valve.brake.max_torque
    command = SimpleNamespace(fill=pulse.l, vent=0.0 * pulse.l)
    pulses = law.valve.after(command, pulse.torque * full, (pulse.torque + pulse.room) * full, full)
    share = (pulses.mean / full - pulse.torque) / (0.6 * pulse.u * pulse.room)
    ends = -np.expm1(0.6 * np.log1p(-pulse.u)) / (0.6 * pulse.u)
    assert np.all(share >= 1.0 - pulse.l / 2.0 - 1e-6)
    assert np.all(share <= (1.0 - pulse.l / 2.0 + pulse.l**2 / 360.0) * ends + 1e-6)
    assert 1.0110 < ends.max() < 1.0112


# --- (e): nothing but filling ---------------------------------------------------------------------------------------
TIMES = np.linspace(0.0, 12.0, 6001)  # s, since the cylinder began to fill


def filling(rate, T_F):
    """Torque, its rate per sample and the room, from an empty cylinder one sample after the supply began."""
    valve = SimpleNamespace(max_torque=1.0, fill_time=T_F, supply_rate=rate)
    torque = filled(valve, 0.0, TIMES, since=H)
    room = -np.expm1(-rate * (H + TIMES)) - torque
    return torque, H / T_F * room, room


def test_rate_and_room_at_a_torque_are_monotone():
    random, levels = np.random.default_rng(3), np.linspace(0.0, 0.95, 60)
    for _ in range(60):
        rate, T_F = random.uniform(0.375, 1.125), random.uniform(0.3, 0.9)
        more_rate, more_time = rate * random.uniform(1.0, 1.3), T_F * random.uniform(1.0, 1.3)

        def at(rate, T_F):
            torque, speed, room = filling(rate, T_F)
            peak = speed.argmax()
            assert np.all(np.diff(speed[: peak + 1]) > 0.0)
            assert np.all(np.diff(speed[peak:]) < 0.0)
            return np.interp(levels, torque, speed), np.interp(levels, torque, room)

        speed, room = at(rate, T_F)
        faster, wider = at(more_rate, T_F)
        assert np.all(faster >= speed - 1e-8)
        assert np.all(wider >= room - 1e-7)
        slower, wider = at(rate, more_time)
        assert np.all(slower <= speed + 1e-8)
        assert np.all(wider >= room - 1e-7)


def test_growth_before_a_level_is_largest_for_the_fastest_corner():
    random, levels = np.random.default_rng(4), np.linspace(0.01, 0.95, 50)

    def grown(rate, T_F, span):
        torque = filling(rate, T_F)[0]
        before = np.interp(np.interp(levels, torque, TIMES) - span, TIMES, torque)  # 0 before it began
        return levels - before

    for _ in range(60):
        span = H * random.integers(1, 40)
        ends = random.uniform(0.375, 1.125), random.uniform(0.3, 0.9)
        assert np.all(grown(*ends, span) <= grown(1.125, 0.3, span) + 1e-7)


# --- (f): an observer that takes no friction below 0 ----------------------------------------------------------------
def observed(inputs, *, cut):
    """Observed friction and error of the wheel speed, and what was cut, over samples (first axis)."""
    p, friction, found = 0.0 * inputs[0], 0.0 * inputs[0], []
    for put_in in inputs:
        r = put_in - p - friction
        plain = friction + (1.0 - THETA) ** 2 * r
        p, friction = -(THETA**2) * r, np.maximum(plain, 0.0) if cut else plain
        found.append((p, friction, friction - plain))
    return np.array(found)


def test_cut_observer_differs_by_bounded_numbers():
    random, count, samples = np.random.default_rng(8), 4000, 60
    sizes = 10.0 ** random.uniform(-2.0, 1.5, count)
    drawn = sizes * random.random((samples, count)) ** random.choice([1.0, 4.0, 16.0], count)
    low = random.random((samples, count)) < random.random(count)
    inputs = np.where(low, -1.0, np.maximum(drawn - 1.0, -1.0))
    inputs[:, 0] = -1.0
    for long_ago in range(1, 40):  # one that leaves nothing of the friction when the next is cut
        inputs[:, long_ago] = -1.0
        inputs[0, long_ago] += 1.0 / ((1.0 - THETA) ** 2 * long_ago * THETA ** (long_ago - 1))
    with_cut, without = observed(inputs, cut=True), observed(inputs, cut=False)
    p, friction, cut = (with_cut - without)[:, 0], (with_cut - without)[:, 1], with_cut[:, 2]
    z = friction - (1.0 - THETA) / THETA * p
    for values, most in ((z, 1.0 / (1.0 + THETA)), (p, THETA**2 / (1.0 - THETA**2)), (friction, 1.0)):
        assert values.min() >= -1e-12
        assert values.max() <= most + 1e-12
        assert values.max() == pytest.approx(most, rel=1e-6)  # by the input that is -1 all the time
    before = np.concatenate([np.zeros((1, count)), z[:-1]])
    seen = np.concatenate([np.zeros((1, count)), with_cut[:-1, 1]])
    allowed = rolling_bounds.most_cut(1.0, THETA, seen, before)
    assert np.all(cut <= np.maximum(allowed, 0.0) + 1e-12)
    assert np.any(cut > 0.95 * (1.0 - THETA))


def test_rolling_wheel_puts_in_a_bit_less_than_what_slows_it_down():
    """A wheel lags behind the first filling: -drag/(1 - slip) is not the least, -drag/(1 - slip + kappa) - d is."""
    problem, points, plant = members("low-adhesion", 9, count=1500)
    points["speed"][:] = 120.0 / 3.6
    law, wheel = Law(problem.controller, SLIP), Wheel(plant)
    unit, least, broken = H / 752.0, [], False
    most_drag = wheel.drag(0.0, points["speed"])
    runs = rolling(problem, law, points)
    for n in range(12):
        pads = plant.max_torque / law.full
        _, vent, mean = law.pulses(
            runs.memory,
            runs.measured,
            runs.torque / pads,
            law.full * -np.expm1(-plant.supply_rate * runs.since),
        )
        assert np.all(vent == 0.0) or n > 2
        turning, torque = runs.wheel, runs.torque / pads * unit
        drag = wheel.drag(0.0, runs.speed)
        runs, _, _ = sampled(law, runs)
        put_in = runs.wheel - turning + mean * unit
        broken = broken or np.any(put_in < -drag / (1.0 - SLIP) - 2e-4)
        least.append((put_in / drag).min())
        if n < 2:
            assert np.all(torque == 0.0)
            change = runs.torque / pads * unit
            own = mean * unit
            apart = wheel.g * change * 0.5057 - own  # no more than the half and a bit is in the mean
            assert np.all(put_in >= -drag / (1.0 - SLIP + wheel.kappa) - np.maximum(apart, 0.0) - 1e-6)
        free = -most_drag / (1.0 - SLIP + wheel.kappa)
        assert np.all(wheel.f(1.0 - wheel.R * runs.wheel / runs.speed, runs.speed) >= free * (1.0 + 1e-3))
    assert broken
    assert np.argmin(least) == 1
