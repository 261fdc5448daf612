"""One sample of the way in, enclosed for a box of states and numbers, against a wheel and a law of their own.

Whatever a symbol stands for, the simulated value is where the form says with this symbol, but for its error.
"""

from dataclasses import fields, replace
from itertools import combinations_with_replacement

import numpy as np
import pytest

import wspd_design as wd
from tests.attack.plant import filled, vented
from tests.certificates.band import sampled_runs
from tests.certificates.band.conftest import problem_of
from tests.certificates.band.sampled_runs import BOX, Law, Runs, measured_from, plant_of, sampled
from wspd_design.certificates.kernel.affine import Affine
from wspd_design.certificates.theorems.slip_band import approach, followed_law, followed_plant, motion
from wspd_design.certificates.theorems.slip_band.followed_plant import NUMBERS, State

POINTS = 400
FIRST_STATE, TIME, FRESH, SIZE = (
    18,
    26,
    27,
    82,
)  # symbols: 8 numbers, 10 combinations of them, 8 states, time, others
KNOWN = [*range(8), *range(FIRST_STATE, TIME)]
# Half widths of mass, inertia, radius, mu0, pads, both times and the supply rate, over the nominal values
SPREAD = (0.01, 0.01, 0.002, 0.02, 0.01, 0.03, 0.03, 0.02)
# Speed, sliding speed, innovation, observed friction, torque, acceleration, change of the speed, supply
STATES = {
    "rolling": (32.0, 0.01, 0.0, 200.0, 300.0, -0.05, -0.001, 0.2),
    "fills all the sample": (32.0, 1.0, 0.001, 9000.0, 4000.0, -0.4, -0.008, 0.42),
    "fills a bit": (32.0, 4.45, 0.0, 21_000.0, 22_000.0, -0.7, -0.0145, 0.5),
    "fills a bit of little": (32.0, 4.45, 0.0, 27_400.0, 28_500.0, -0.7, -0.0145, 0.5),
    "vents all the sample": (25.0, 6.0, -0.004, 9_000.0, 17_500.0, -0.7, -0.0145, 0.6),
    "vents a bit": (25.0, 3.5, 0.0, 16_500.0, 17_500.0, -0.7, -0.0145, 0.6),
    "vents a bit from little": (25.0, 3.5, 0.0, 3_500.0, 4_500.0, -0.7, -0.0145, 0.9),
    "neither": (25.0, 3.5, 0.0, 17_000.0, 17_850.0, -0.7, -0.0145, 0.6),
    "at the supply": (28.0, 2.0, 0.0, 26_000.0, 23_500.0, -0.9, -0.02, 0.4),
}
WIDTHS = np.array([0.02, 0.02, 5e-4, 60.0, 60.0, 0.02, 4e-4, 0.003])  # half, of the states


# Times of filling and venting, true and as the law takes them, and its dead band
VALVES = {
    "alike": ((0.6, 0.6), (0.6, 0.6), 0.0),
    "lopsided": ((0.5, 0.8), (0.7, 0.45), 0.0),
    "resting": ((0.8, 0.5), (0.5, 0.9), 600.0),
}


@pytest.fixture(scope="module")
def problem():
    return problem_with(*VALVES["alike"])


@pytest.fixture(scope="module", params=VALVES)
def valves(request):
    return problem_with(*VALVES[request.param])


def problem_with(true, taken, dead_band):
    """Low adhesion, with other valves than the law takes them for."""
    whole = problem_of(1.0, rail=wd.load_rail("low-adhesion"), dead_band=dead_band, dead_band_share=1e3)

    def with_times(brake, times):
        return replace(brake, **dict(zip(("fill_time", "vent_time"), times, strict=True)))

    law, vehicle = whole.controller, whole.vehicle
    valve = replace(law.valve, brake=with_times(law.valve.brake, taken))
    tracking = replace(law.core.tracking, valve=valve)
    return replace(
        whole,
        vehicle=replace(vehicle, brake=with_times(vehicle.brake, true)),
        controller=replace(law, valve=valve, core=replace(law.core, tracking=tracking)),
    )


class Sample:
    """Forms of a sample, and what simulated wheels do."""

    def __init__(self, problem, center, widths, spread, seed):
        random = np.random.default_rng(seed)
        z = random.uniform(-1.0, 1.0, (SIZE, POINTS))
        self.z = np.where(random.random(z.shape) < 0.6, np.sign(z), z)
        nominal = np.array([problem.nominal(name) for name in NUMBERS])
        halves = nominal * np.array(spread)
        law, free = problem.controller, iter(range(FRESH, SIZE))

        def fresh(form):
            return form.named(next(free))

        def form(value, half, symbol):
            slopes = np.zeros((1, SIZE))
            slopes[0, symbol] = half
            return Affine(np.array([value]), slopes, np.zeros(1))

        numbers = {
            name: form(v, h, k) for k, (name, v, h) in enumerate(zip(NUMBERS, nominal, halves, strict=True))
        }
        self.plant = followed_plant.plant_of(
            problem.vehicle, problem.rail, law.valve.brake.max_torque, numbers, 8
        )
        self.state = State(
            *(form(v, h, FIRST_STATE + k) for k, (v, h) in enumerate(zip(center, widths, strict=True)))
        )
        self.decided = followed_law.decide(law, self.plant, self.state, fresh)
        self.on_the_way, self.in_the_mean = [], []
        with pytest.MonkeyPatch.context() as patch:
            self.listen(patch)
            self.moved = motion.motion(self.plant, law, self.state, self.decided, TIME, fresh)
        self.points = nominal[:, None] + halves[:, None] * self.z[: len(NUMBERS)]
        self.states = np.array(center)[:, None] + np.array(widths)[:, None] * self.z[FIRST_STATE:TIME]
        self.simulate(problem, Law(law, problem.slip))

    def listen(self, patch):
        """Keep what pulls at the wheel in each part of the sample: at any time in it, and in its mean."""
        enclosed, with_brake = motion._enclosed, motion._with_brake

        def begun(plant, begin, guess, pulled, step):
            self.on_the_way.append(pulled)
            self.in_the_mean.append(None)
            return enclosed(plant, begin, guess, pulled, step)

        def braked(plant, begin, pulled):
            if self.in_the_mean:
                self.in_the_mean[-1] = pulled  # the last one of a part counts for its end
            return with_brake(plant, begin, pulled)

        patch.setattr(motion, "_enclosed", begun)
        patch.setattr(motion, "_with_brake", braked)

    def simulate(self, problem, law):
        named = dict(zip(NUMBERS, self.points, strict=True))
        held = {name: problem.nominal(name) for name in sampled_runs.BESIDE if name != "supply rate"}
        plant = plant_of(
            problem, {name: named[name] for name in BOX} | held | {"supply rate": named["supply rate"]}
        )
        speed, torque, supply = self.states[0], self.states[4], self.states[7]
        radius = plant.wheel_radius
        memory, wheel = measured_from(law, radius, self.states)
        pads = plant.max_torque / law.full
        runs = Runs(
            plant=plant,
            memory=memory,
            since=-np.log1p(-supply) / plant.supply_rate,
            measured=wheel,
            speed=speed,
            wheel=wheel,
            torque=torque * pads,
            number=np.arange(POINTS),
        )
        fill, vent, mean = law.pulses(memory, wheel, torque, law.full * supply)
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(sampled_runs, "SUBSTEP", 1e-4)
            after, _, self.highest = sampled(law, runs)
        self.pulls = lambda t: (
            radius
            / plant.wheelset_inertia
            * vented(
                plant,
                filled(plant, runs.torque, np.minimum(t * law.h, fill), since=runs.since),
                np.clip(t * law.h - fill, 0.0, vent),
            )
        )
        expected = memory.observed + law.h / law.inertia * (memory.friction - mean)
        self.seen = {
            "fill": fill / law.h,
            "vent": vent / law.h,
            "friction": memory.friction,
            "acceleration": memory.acceleration / memory.scale,
            "innovation": -radius * expected,
            "speed": after.speed,
            "sliding": after.speed - radius * after.wheel,
            "torque": after.torque / pads,
            "supply": -np.expm1(-plant.supply_rate * after.since),
        }

    def form(self, name):
        return getattr(self.decided if hasattr(self.decided, name) else self.moved, name)

    def beyond(self, form, value, time=None):
        """By how much a simulated value is farther from its form than the error allows, and the error."""
        known = form.center[0] + form.slopes[0, KNOWN] @ self.z[KNOWN]
        others = [k for k in range(SIZE) if k not in KNOWN and (k != TIME or time is None)]
        if time is not None:
            known = known + form.slopes[0, TIME] * time
        error = form.error[0] + np.abs(form.slopes[0, others]).sum()
        return np.max(np.abs(value - known) - error), error

    def farthest(self, name, scale):
        """The same of a number at the end, over a scale."""
        form = self.form(name)
        beyond, error = self.beyond(form, self.seen[name])
        inside = (self.seen[name] >= form.low[0] - 1e-6 * scale) & (
            self.seen[name] <= form.high[0] + 1e-6 * scale
        )
        assert np.all(inside), name
        return beyond / scale, error / scale


SCALES = {
    "fill": 1.0,
    "vent": 1.0,
    "friction": 1e3,
    "acceleration": 0.1,
    "innovation": 0.3,
    "speed": 1.0,
    "sliding": 1.0,
    "torque": 1e3,
    "supply": 0.1,
}


@pytest.mark.parametrize("wide", [1e-3, 0.2, 1.0])
@pytest.mark.parametrize("kind", STATES)
def test_simulated_samples_are_where_the_forms_say(valves, kind, wide):
    """From nearly a point to states of which it is open whether the valve fills or vents, and for how long."""
    found = Sample(valves, STATES[kind], wide * WIDTHS, [min(wide, 1.0) * each for each in SPREAD], 3)
    narrow = wide < 0.01 and not valves.controller.core.tracking.dead_band
    for name, scale in SCALES.items():
        beyond, error = found.farthest(name, scale)
        assert beyond <= 1e-6, (name, beyond)
        if narrow:
            assert error < 0.01, name
        assert (
            name not in ("speed", "sliding") or found.form(name).slopes[0, TIME] == 0.0
        )  # of a time that is over
    assert np.all(found.highest <= found.moved.top[0] + 1e-9)
    if wide < 0.01:
        assert found.highest.max() > found.moved.top[0] - 1e-3


@pytest.mark.parametrize("wide", [1e-3, 0.2, 1.0])
@pytest.mark.parametrize("kind", STATES)
def test_brake_pulls_at_every_instant_as_the_forms_say(valves, kind, wide):
    """In each part of the sample, at its times and in its mean."""
    found = Sample(valves, STATES[kind], wide * WIDTHS, [min(wide, 1.0) * each for each in SPREAD], 4)
    count = len(found.on_the_way)
    assert count == len(found.in_the_mean) == round(valves.sample_time / motion.STEP)
    for part, (on_the_way, in_the_mean) in enumerate(zip(found.on_the_way, found.in_the_mean, strict=True)):
        for time in np.linspace(-1.0, 1.0, 9):
            beyond, _ = found.beyond(on_the_way, found.pulls((part + (time + 1.0) / 2.0) / count), time)
            assert beyond <= 1e-9
        middles = (part + (np.arange(400) + 0.5) / 400.0) / count
        beyond, _ = found.beyond(in_the_mean, np.mean([found.pulls(t) for t in middles], axis=0))
        assert beyond <= 1e-6


@pytest.mark.parametrize(
    ("torque", "friction", "wide"),
    [
        *((17_500.0, 15_820.0, 1e-3), (22_000.0, 21_850.0, 1e-3), (17_500.0, 16_232.0, 400.0)),
        *((17_500.0, 14_000.0, 800.0), (22_000.0, 25_000.0, 800.0)),
    ],
)
def test_torque_bends_within_a_pulse_of_nearly_all_of_the_sample_or_all_of_it(torque, friction, wide):
    """With valves that go just what is asked for: nothing else covers for that."""
    center, widths = (25.0, 3.5, 0.0, friction, torque, -0.7, -0.0145, 0.6), 1e-6 * WIDTHS
    widths[4] = wide
    found = Sample(problem_with((0.36, 0.36), (0.6, 0.6), 0.0), center, widths, [0.0] * len(NUMBERS), 4)
    assert bool(found.decided.even[0]) is (wide < 800.0)
    assert 0.9 < (found.seen["fill"] + found.seen["vent"]).max() <= 1.0
    for part, on_the_way in enumerate(found.on_the_way):
        for time in np.linspace(-1.0, 1.0, 9):
            at = (part + (time + 1.0) / 2.0) / len(found.on_the_way)
            assert found.beyond(on_the_way, found.pulls(at), time)[0] <= 1e-9


def test_slip_that_is_largest_in_the_middle_of_a_part_is_not_exceeded(problem):
    """While venting, at torques that a wheel follows at first and does not any more later in the sample."""
    nominal = dict(zip(NUMBERS, (np.array([problem.nominal(name)]) for name in NUMBERS), strict=True))
    held = {name: problem.nominal(name) for name in sampled_runs.BESIDE}
    plant = plant_of(problem, {name: nominal[name] for name in BOX} | held)
    slowing, turning = sampled_runs.motion(plant, 25.0, (25.0 - 3.5) / plant.wheel_radius, 0.0)
    # The slip does not change with this torque.
    still = float((turning * plant.wheel_radius - (1.0 - 3.5 / 25.0) * slowing)[0])
    still *= float((plant.wheelset_inertia / plant.wheel_radius)[0])
    peaks = []
    for more in np.linspace(0.004, 0.02, 10):
        center = (25.0, 3.5, 0.0, 3_000.0, (1.0 + more) * still, -0.7, -0.0145, 0.9)
        found = Sample(problem, center, 1e-6 * WIDTHS, [0.0] * len(NUMBERS), 3)
        top, ends = (
            found.moved.top[0],
            max(3.5 / 25.0, float((found.seen["sliding"] / found.seen["speed"]).max())),
        )
        assert found.highest.max() <= top < found.highest.max() + 2e-4
        peaks.append(found.highest.max() - ends)
    assert np.count_nonzero(np.array(peaks) > 1e-6) > 5


def test_rates_that_are_enclosed_hold_as_long_as_is_said(problem):
    """Of wheels that begin to slide or to roll again; where the enclosure is not one, nothing is told."""
    random, count, law = np.random.default_rng(9), 60, Law(problem.controller, problem.slip)

    def form(values, half=0.0):
        slopes = np.zeros((count, SIZE))
        slopes[:, FIRST_STATE] = half
        return Affine(np.array(values), slopes, np.zeros(count))

    sliding, torque = random.uniform(0.3, 4.0, count), random.uniform(0.0, 4e4, count)
    nominal = {name: np.full(count, problem.nominal(name)) for name in NUMBERS}
    plant = followed_plant.plant_of(
        problem.vehicle, problem.rail, law.full, {name: form(each) for name, each in nominal.items()}, 8
    )
    held = {name: problem.nominal(name) for name in sampled_runs.BESIDE}
    wheels = plant_of(problem, {name: nominal[name] for name in BOX} | held)
    begin, pulled = (form(np.full(count, 25.0)), form(sliding)), form(torque) * plant.effect
    told, none = {}, (form(np.zeros(count)),) * 2
    for step, trials in ((0.005, 6), (0.02, 6), (0.06, 6), (1.0, 6), (0.06, 1)):
        with np.errstate(all="ignore"), pytest.MonkeyPatch.context() as patch:
            patch.setattr(motion, "TRIALS", trials)
            # From no rates at all one trial does not get there.
            guess = motion._with_brake(plant, begin, pulled) if trials > 1 else none
            found = motion._enclosed(plant, begin, guess, pulled, step)
        speed, wheel = np.full(count, 25.0), (25.0 - sliding) / wheels.wheel_radius
        finite = np.isfinite(found[1].error) & np.isfinite(found[0].error)
        told[step, trials] = np.count_nonzero(finite)
        for _ in range(200):
            slowing, turning = sampled_runs.motion(wheels, speed, wheel, torque)
            gliding = slowing - wheels.wheel_radius * turning
            for rate, form_of in ((slowing, found[0]), (gliding, found[1])):
                inside = (form_of.low - 1e-4 <= rate) & (rate <= form_of.high + 1e-4)
                assert np.all(inside | ~finite)
            speed, wheel = speed + step / 200.0 * slowing, np.maximum(wheel + step / 200.0 * turning, 0.0)
    assert told[0.005, 6] == count
    assert told[0.02, 6] > count / 2
    assert told[0.06, 1] < count / 2


def test_slip_within_a_part_is_not_beyond_the_top_though_its_ends_are_far_below(problem, monkeypatch):
    """Rates of the sliding speed that fall from 40 to -40 m/s2 in each part: halfway it is higher than at both ends."""

    def with_brake(_plant, begin, _pulled):
        speed, _ = begin
        none = speed * 0.0
        slopes = none.slopes.copy()
        slopes[:, TIME] = -40.0
        return none, Affine(none.center, slopes, none.error)

    monkeypatch.setattr(motion, "_with_brake", with_brake)
    found = Sample(problem, STATES["neither"], 1e-6 * WIDTHS, [0.0] * len(NUMBERS), 3)
    step = motion.STEP
    assert found.form("sliding").high[0] == pytest.approx(3.5, abs=1e-4)
    # 40 m/s2 for half of a part, falling evenly
    assert found.moved.top[0] >= (3.5 + 40.0 * step / 4.0) / 25.0 - 1e-9


def test_errors_of_the_numbers_of_a_plant_do_not_cancel(problem):
    """Sum and difference of any two are where the numbers of the vehicle say, but for the errors of both."""
    nominal, halves = np.array([problem.nominal(name) for name in NUMBERS]), 0.2
    slopes = np.zeros((len(NUMBERS), 1, SIZE))
    for k, value in enumerate(nominal):
        slopes[k, 0, k] = halves * value
    numbers = {
        name: Affine(np.array([v]), slopes[k], np.zeros(1))
        for k, (name, v) in enumerate(zip(NUMBERS, nominal, strict=True))
    }
    plant = followed_plant.plant_of(problem.vehicle, problem.rail, 6e4, numbers, 8)
    # Errors of reciprocals are largest at the ends and near the middle.
    z = np.array(np.meshgrid(*[[-1.0, -0.1, 1.0]] * len(NUMBERS))).reshape(len(NUMBERS), -1)
    mass, inertia, radius, mu0, torque, fill, vent, supply = nominal[:, None] * (1.0 + halves * z)
    contact = problem.vehicle.contact
    load = mass * sampled_runs.static_load(plant_of(problem, named(problem, nominal))) / nominal[0]
    ellipse = np.pi * contact.semi_axis_rolling * contact.semi_axis_lateral
    ellipse = ellipse * (load / contact.reference_load) ** (2.0 / 3.0)
    seen = {
        "radius": radius,
        "curvature": 1.0 / radius,
        "mass": 1.0 / mass,
        "inertia": 1.0 / inertia,
        "effect": radius / inertia * torque / 6e4,
        "fill_rate": 1.0 / fill,
        "vent_rate": 1.0 / vent,
        "gripping": mu0 * load * 8.0 / mass,
        "turning": 2.0 * radius**2 / inertia * mu0 * load,
        "gradient": contact.shear_modulus * ellipse * contact.kalker_c11 / (4.0 * load * mu0),
        "train_stiffness": contact.shear_modulus * ellipse * contact.kalker_c11 * 2.0 / mass,
        "rim_stiffness": contact.shear_modulus * ellipse * contact.kalker_c11 / 2.0 * radius**2 / inertia,
        "supply_rate": supply,
    }
    assert {*seen, "vehicle", "rail"} == {each.name for each in fields(plant)}
    for (one, values), (other, rest) in combinations_with_replacement(seen.items(), 2):
        for sign in (-1.0, 1.0):
            scale = sign * float(getattr(plant, one).center[0] / getattr(plant, other).center[0])
            form = getattr(plant, one) + getattr(plant, other) * scale
            known = form.center[0] + form.slopes[0, : len(NUMBERS)] @ z
            error = form.error[0] + np.abs(form.slopes[0, len(NUMBERS) :]).sum()
            beyond = np.abs(values + scale * rest - known) - error
            assert np.all(beyond <= 1e-9 * np.abs(values)), (one, other)


@pytest.mark.parametrize("which", [0, 1])
@pytest.mark.parametrize("rate", [-1.5, 1.5])
@pytest.mark.parametrize("step", [0.005, 0.02, 0.1, 0.4, 1.0])
def test_rates_that_grow_ever_faster_are_enclosed_or_lost(monkeypatch, which, rate, step):
    """One of both grows with its own speed, to either side: by more than any trial takes it for, where time is long."""
    begin = tuple(Affine(np.array([value]), np.zeros((1, SIZE)), np.zeros(1)) for value in (2.0, 2.0))
    growth = 8.0  # 1/s

    def with_brake(_plant, speeds, _pulled):
        at = [*speeds]
        rates = [each * 0.0 for each in at]
        rates[which] = (at[which] - 2.0) * growth + rate
        return tuple(rates)

    monkeypatch.setattr(motion, "_with_brake", with_brake)
    pulled = begin[0] * 0.0
    found = motion._enclosed(None, begin, with_brake(None, begin, pulled), pulled, step)
    most = rate * np.exp(growth * step)
    if np.isfinite(found[which].error[0]):
        assert found[which].low[0] <= min(rate, most)
        assert found[which].high[0] >= max(rate, most)
    assert np.isfinite(found[which].error[0]) == (step < 0.03)


def named(problem, numbers):
    """Numbers of the plant of the attacker by their names."""
    held = {name: problem.nominal(name) for name in sampled_runs.BESIDE}
    return {name: number for name, number in zip(NUMBERS, numbers, strict=True) if name in BOX} | held


def test_symbols_of_the_numbers_of_a_plant_are_kept_from_sample_to_sample(problem):
    """A symbol that were put together with others would stand for two things in the next sample."""
    numbers = {}
    for k, name in enumerate(NUMBERS):
        slopes = np.zeros((1, SIZE))
        slopes[0, k] = 0.1 * problem.nominal(name)
        numbers[name] = Affine(np.array([problem.nominal(name)]), slopes, np.zeros(1))
    plant = followed_plant.plant_of(problem.vehicle, problem.rail, 6e4, numbers, len(NUMBERS))
    forms = [getattr(plant, each.name) for each in fields(plant)]
    used = np.max([np.flatnonzero(form.slopes[0]).max() for form in forms if isinstance(form, Affine)])
    assert used == approach.PARAMETERS - 1
