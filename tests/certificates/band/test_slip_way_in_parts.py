"""Numbers within a part of a sample, as forms over its time: what is integrated, and what of a pulse is done."""

import itertools

import numpy as np
import pytest

import wspd_design as wd
from wspd_design.certificates.kernel.affine import Affine
from wspd_design.certificates.theorems.slip_band import followed_law, motion

SYMBOLS, TIME, TIMES = 5, 4, np.linspace(-1.0, 1.0, 21)
COUNT = 4  # parts of a sample


def form_of(middle, slopes=(), error=0.0):
    return Affine(
        np.array([middle]), np.array([[*slopes, *[0.0] * (SYMBOLS - len(slopes))]]), np.array([error])
    )


def holds(form, value, z, time, part=1e-12):
    """Whether the form with these symbols, at this time, is no farther from a value than its error."""
    at = form.center[0] + form.slopes[0, :TIME] @ z[:TIME] + form.slopes[0, TIME] * time
    return abs(value - at) <= form.error[0] + part


@pytest.mark.parametrize("seed", range(8))
def test_value_at_any_time_is_what_the_rate_has_made_of_it(seed):
    """Rates that go with the time, with other symbols and with an error that may switch its sign at any time."""
    random = np.random.default_rng(seed)
    step = random.uniform(0.01, 1.0)
    begin = form_of(random.normal(), random.normal(size=TIME) * 0.1, 0.05 * random.random())
    errors = (
        {"error": 0.5, "time": 3.0} if seed % 2 else {"error": 0.0, "time": 3.0 * random.choice((-1.0, 1.0))}
    )
    rate = form_of(random.normal(), [*random.normal(size=TIME), errors["time"]], errors["error"])
    found = motion._over_time(begin, rate, step, TIME)
    fine = np.linspace(-1.0, 1.0, 401)
    for _ in range(60):
        z, own = random.choice([-1.0, 1.0], SYMBOLS), random.choice([-1.0, 1.0])
        switch = random.choice([-2.0, random.uniform(-1.0, 1.0), 2.0])
        wrong = np.where(fine < switch, 1.0, -1.0) * rate.error[0]
        rates = rate.center[0] + rate.slopes[0, :TIME] @ z[:TIME] + rate.slopes[0, TIME] * fine + wrong
        value = begin.center[0] + begin.slopes[0, :TIME] @ z[:TIME] + own * begin.error[0]
        value += np.concatenate([[0.0], np.cumsum((rates[1:] + rates[:-1]) / 2.0) * step / 400.0])
        assert all(
            holds(found, v, z, t, 5e-3 * rate.error[0] * step) for v, t in zip(value, fine, strict=True)
        )


SHARES = [
    (0.0, 0.01),
    (0.1, 0.1),
    (0.3, 0.32),
    (0.2, 0.6),
    (0.05, 0.9),
    (0.5, 0.5),
    (0.74, 0.76),
    (0.9, 1.0),
    (1.0, 1.0),
    (0.0, 0.4),
]


def done(share, time):
    """Part of a change that goes evenly and ends after a share of the sample."""
    return 1.0 if time >= share else time / share


@pytest.mark.parametrize("ends", SHARES)
def test_part_of_a_change_that_is_done_is_enclosed_at_every_time_and_in_the_mean(ends):
    low, high = ends
    share = form_of(0.5 * (low + high), [0.5 * (high - low)])
    for part in range(COUNT):
        found = motion._gone(share, part, COUNT, TIME)
        mean = motion._gone_in_the_mean(share, part, COUNT)
        for s in np.linspace(low, high, 1 if low == high else 9):
            times = [(part + (t + 1.0) / 2.0) / COUNT for t in TIMES]
            for t, at in zip(TIMES, times, strict=True):
                if at > 0.0:
                    assert holds(found, done(s, at), np.zeros(SYMBOLS), t, 1e-9), (part, s, at)
            fine = (part + (np.arange(4000) + 0.5) / 4000.0) / COUNT
            exact = np.mean([done(s, at) for at in fine])
            assert holds(mean, exact, np.zeros(SYMBOLS), 0.0, 2e-4)


def test_torque_on_the_way_is_between_both_ends_where_it_is_open_which_it_is():
    """A change that rises or falls, of which some part is done; or one that rises, and one that falls."""
    torque, change = form_of(1000.0, [10.0]), form_of(20.0, [0.0, 80.0])
    none = form_of(0.0)
    filled, vented = form_of(0.5, [0.0, 0.0, 0.3]), form_of(0.4, [0.0, 0.0, 0.2])
    across, known = np.array([True]), np.array([False])
    wide = motion._on_the_way(torque, change, none, across, filled, vented)
    rising, falling = form_of(60.0, [0.0, 30.0]), form_of(25.0, [0.0, 20.0])
    one = motion._on_the_way(torque, rising, falling, known, filled, vented)
    for corner in np.array(np.meshgrid(*[[-1.0, 1.0]] * 3)).reshape(3, -1).T:
        z = np.array([*corner, 0.0, 0.0])
        base, whole = 1000.0 + 10.0 * z[0], 20.0 + 80.0 * z[1]
        parts = {1.0: 0.5 + 0.3 * z[2], -1.0: 0.4 + 0.2 * z[2]}
        assert holds(wide, base + whole * parts[np.sign(whole)], z, 0.0, 1e-9)
        there = base + (60.0 + 30.0 * z[1]) * parts[1.0] - (25.0 + 20.0 * z[1]) * parts[-1.0]
        assert holds(one, there, z, 0.0, 1e-9)


@pytest.mark.parametrize("power", [0.4, 1.0, 1.7])
@pytest.mark.parametrize("more", [0.0, 30.0])
@pytest.mark.parametrize("wide", [0.03, 0.3])
def test_way_that_is_asked_goes_as_far_as_both_valves_go(power, more, wide):
    """In little room, up or down, with a supply that may have more or less than the room says."""
    random = np.random.default_rng(2)
    lengths = (18.0, 18.0)
    longest = -np.expm1(-1.0 / 18.0)
    for ends in ((-60.0, 40.0), (5.0, 50.0), (-70.0, -10.0), (50.0, 50.0), (5.0, 5.0), (-70.0, -70.0)):
        asked = form_of(0.5 * sum(ends), [0.5 * (ends[1] - ends[0])])
        rooms = form_of(1000.0, [0.0, 100.0]), form_of(1500.0, [0.0, 0.0, 100.0])
        powers = form_of(power, [0.0, 0.0, 0.0, wide]), form_of(1.2 * power, [0.0, 0.0, 0.0, -wide])
        found = followed_law.went(asked, rooms, powers, lengths, more)
        for _ in range(300):
            z = random.choice([-1.0, 1.0, random.uniform(-1.0, 1.0)], SYMBOLS)
            way = asked.center[0] + asked.slopes[0, 0] * z[0]
            kind = 0 if way > 0.0 else 1
            room = rooms[kind].center[0] + rooms[kind].slopes[0] @ z
            there = room + (random.choice([-more, more]) if kind == 0 else 0.0)
            own = power + wide * z[3] if kind == 0 else 1.2 * power - wide * z[3]
            y = min(abs(way) / room, longest)
            if abs(way) / room <= longest:
                assert holds(found, np.sign(way) * there * (1.0 - (1.0 - y) ** own), z, 0.0, 1e-9)


CURVES = {
    "adhesion": (lambda x: x.line(*motion._adhesion_part(RAIL, x)), lambda y: adhesion_part(y), (-1.0, 12.0)),
    "slip": (
        lambda x: x.line(*motion._slip_part(RAIL, x)),
        lambda y: 2.0 / np.pi * np.arctan(RAIL.slip_reduction * y),
        (-5.0, 60.0),
    ),
    "pull": (lambda x: followed_law._pull(x, 8.0, 20.0), lambda y: pull(y, 8.0, 20.0), (-2.0, 6.0)),
    "share": (
        lambda x: followed_law._share(x, form_of(1.0), 18.0, 1e-3, left_out=0.0, pulse=0.0),
        lambda y: np.minimum(-18.0 * np.log1p(-np.clip(y, 0.0, 0.9)), 1.0),
        (0.0, 0.09),
    ),
}
RAIL = wd.load_rail("polach-wet")


def adhesion_part(gradient):
    z = RAIL.adhesion_reduction * gradient
    return 2.0 / np.pi * z / (1.0 + z * z)


def pull(error, rate, slew):
    """k e, and beyond the beginning of the braking curve the root that touches it."""
    far = np.sqrt(np.maximum(2.0 * slew * (error - 0.5 * slew / rate**2), 0.0))
    return np.where(error * rate**2 > slew, far, rate * error)


@pytest.mark.parametrize("name", CURVES)
def test_curves_are_enclosed_over_wide_and_narrow_ranges(name):
    """Between its ends a curve is farther from its secant than at them."""
    enclosed, curve, (low, high) = CURVES[name]
    random = np.random.default_rng(7)
    widest = 0.0
    for wide in (1.0, 0.4, 0.05):
        for _ in range(12):
            half = 0.5 * wide * (high - low)
            middle = random.uniform(low + half, high - half)
            found = enclosed(form_of(middle, [half]))
            widest = max(widest, float(found.error[0]))
            for z in np.linspace(-1.0, 1.0, 201):
                assert holds(
                    found, float(curve(np.float64(middle + half * z))), np.full(SYMBOLS, z), 0.0, 1e-9
                )
    assert widest < 2.0 * np.ptp(curve(np.linspace(low, high, 101)))


@pytest.mark.parametrize("friction", [0.7, -0.7])
def test_force_is_as_far_from_its_line_as_the_shape_is_anywhere(friction):
    """With the shape at either end of its distance, and what adheres and the friction at the ends of their ranges."""
    slope, offset, distance = (np.array([each]) for each in (0.3, 0.2, 0.05))
    adhering, sliding = form_of(1.1, [0.2]), form_of(friction, [0.0, 0.3])
    found = motion._along((slope, offset, distance), adhering, sliding)
    for one, other, side in itertools.product((-1.0, 1.0), repeat=3):
        used, force = friction + 0.3 * other, 0.3 * (1.1 + 0.2 * one)
        value = force + (0.2 + 0.05 * side) * used
        assert holds(found, value, np.array([one, other, 0.0, 0.0, 0.0]), 0.0)
    assert found.error[0] <= 0.05 * 1.0 + 1e-9  # the largest friction is that far from 0
