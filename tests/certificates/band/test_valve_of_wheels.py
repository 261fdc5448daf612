"""What the valves do in a sample: bounds of the changes, means and rooms of pulses that the plant makes."""

from types import SimpleNamespace

import numpy as np
import pytest

from tests.attack.plant import filled as filled_plant
from tests.certificates.band import from_rolling
from tests.certificates.band.from_rolling import WET
from wspd_design.certificates.kernel.interval import Interval
from wspd_design.certificates.theorems.from_rolling.valve import Valve, corners

FULL = 60e3 * 0.02 / 752.0
COUNT = 400


def pulses(seed, sign):
    """Random valves with a pulse each, and the torque many times in its sample: exact forms of the plant."""
    random = np.random.default_rng(seed)
    law = from_rolling.law(WET)
    fill, vent = random.uniform(0.3, 0.9, (2, COUNT))
    rate, since = random.uniform(0.375, 1.1, COUNT), random.uniform(0.05, 2.0, COUNT)
    supply = FULL * -np.expm1(-rate * since)
    rise = rate * 0.02 * (FULL - supply)
    # From rest the room is never less than what the supply rises by in a sample.
    torque = np.minimum(supply * random.uniform(0.1, 0.98, COUNT), supply - rise)
    room = supply - torque
    g = random.uniform(0.75, 1.35, COUNT)
    share = np.where(random.random(COUNT) < 0.3, 1.0, random.random(COUNT))
    way = sign * share * (law.fills * room if sign > 0 else law.vents * torque)
    way = np.where(random.random(COUNT) < 0.2, 1.3 * way, way)
    size = np.abs(way) / (room if sign > 0 else torque)
    length = np.minimum(-np.log1p(-size) / law.over_fill, 1.0)
    times = np.linspace(0.0, 1.0, 2001)[:, None]
    pulse = np.minimum(times, length)
    numbers = SimpleNamespace(max_torque=FULL, fill_time=fill, supply_rate=rate)
    if sign > 0:
        course = filled_plant(numbers, torque, 0.02 * pulse, since=since)
    else:
        course = torque * np.exp(-0.02 * pulse / vent)
    own = law.nominal * pulse * law.over_fill
    assumed = room * -np.expm1(-own) if sign > 0 else -torque * -np.expm1(-own)
    later = FULL * -np.expm1(-rate * (since + 0.02))

    def mean(values, weights=1.0):
        middle = 0.5 * (values[1:] + values[:-1])
        weights = np.broadcast_to(weights, middle.shape)
        return (middle * weights).sum(axis=0) / len(middle)

    def one(values):
        return Interval(values, values)

    cells = SimpleNamespace(fills=one(0.36 / fill), vents=one(0.36 / vent))
    spare = Interval(rise * (1 - 0.5 * rate * 0.02), rise)
    made = Valve(law, cells, one(room), spare, one(torque))
    middles = (times[1:] + times[:-1]) / 2
    return SimpleNamespace(
        valve=made,
        law=law,
        g=g,
        way=way,
        change=course[-1] - torque,
        mean=mean(course - torque),
        own=mean(assumed),
        length=length,
        first=2 * mean(course - torque, middles),
        second=2 * mean(course - torque, 1 - middles),
        room=later - course[-1],
        roomy=(rise < 0.1 * room) | np.full(COUNT, sign < 0),
        whole=np.abs(way) >= (law.fills * room if sign > 0 else law.vents * torque) * (1 - 1e-12),
    )


@pytest.fixture(scope="module", params=[1.0, -1.0], ids=["fills", "vents"])
def pulse(request):
    return pulses(3, request.param)


def holds(bound, value, spare=1e-9):
    return (bound.low - spare <= value).all() and (value <= bound.high + spare).all()


@pytest.mark.parametrize("later", [False, True])
def test_changes_and_means_of_pulses_are_within_bounds(pulse, later):
    parts = pulse.valve.parts(Interval(pulse.way, pulse.way), later=later)
    up, down = parts
    assert (up.way.high <= np.maximum(pulse.way, 0.0)).all()
    assert (down.way.low >= np.minimum(pulse.way, 0.0)).all()
    assert holds(pulse.valve.change(parts), pulse.change)
    assert (pulse.mean / pulse.change >= pulse.valve.least_share(parts) - 1e-6).all()
    if not later:
        part = up if pulse.way[0] > 0 else down
        assert (part.length.high >= pulse.length - 1e-9).all()
        assert (part.length.low <= pulse.length + 1e-9).all()
        assert (part.share.high >= pulse.mean / pulse.change - 1e-6).all()
        assert (part.share.low <= pulse.mean / pulse.change + 1e-6).all()
        # They are not far away: nothing is doubled or forgotten.
        some, change = pulse.roomy, pulse.valve.change(parts)
        assert (change.high - change.low < 0.12 * np.abs(pulse.change))[some].all()
        assert (part.share.high - part.share.low < 0.05)[some].all()
        assert np.count_nonzero(some) > 50


@pytest.mark.parametrize("sign", [1.0, -1.0], ids=["fills", "vents"])
def test_change_in_a_sample_after_another_is_within_bounds(sign):
    """The second pulse finds the room that the first one left, in which the supply rises by more of it."""
    random, law, one = np.random.default_rng(17), from_rolling.law(WET), np.ones(COUNT)
    fill, vent = random.uniform(0.3, 0.9, (2, COUNT))
    rate, since = random.uniform(0.375, 1.1, COUNT), random.uniform(0.05, 2.0, COUNT)
    numbers = SimpleNamespace(max_torque=FULL, fill_time=fill, supply_rate=rate)
    supply, later = (FULL * -np.expm1(-rate * time) for time in (since, since + 0.02))
    rise = rate * 0.02 * (FULL - supply)
    torque = np.minimum(supply * random.uniform(0.1, 0.98, COUNT), supply - rise)
    cells = SimpleNamespace(
        fills=Interval(0.36 / fill, 0.36 / fill), vents=Interval(0.36 / vent, 0.36 / vent)
    )
    spare = Interval(rise * (1.0 - 0.5 * rate * 0.02), rise)
    valve = Valve(law, cells, Interval(supply - torque, supply - torque), spare, Interval(torque, torque))
    share = np.where(random.random((2, COUNT)) < 0.5, 1.0, random.random((2, COUNT)))

    def pulse(size):
        return 0.02 * np.minimum(-np.log1p(-size) / law.over_fill, one)

    filled = filled_plant(numbers, torque, pulse(share[0] * law.fills), since=since)
    if sign > 0:
        way = share[1] * law.fills * (later - filled)
        after = filled_plant(numbers, filled, pulse(share[1] * law.fills), since=since + 0.02)
    else:
        way = -share[1] * law.vents * filled
        after = filled * np.exp(-pulse(share[1] * law.vents) / vent)
    found = valve.change(valve.parts(Interval(way, way), later=True))
    assert (found.low <= after - filled + 1e-9).all()
    assert (found.high >= after - filled - 1e-9).all()


def test_what_observer_learns_of_pulses_is_within_bounds(pulse):
    parts = pulse.valve.parts(Interval(pulse.way, pulse.way))
    z, unlike = pulse.valve.learned(Interval(pulse.g, pulse.g), parts)
    exact = pulse.g * pulse.mean - pulse.own
    assert holds(unlike, exact, 1e-7)
    assert holds(z, (pulse.g - 1) * pulse.change - (1 - pulse.law.theta) * exact, 1e-7)
    assert (unlike.high - unlike.low < 0.25 * np.abs(pulse.change))[pulse.roomy].all()


def test_weights_that_rise_and_fall_count_no_more_than_is_said(pulse):
    parts = pulse.valve.parts(Interval(pulse.way, pulse.way))
    first = pulse.valve.in_first(parts)
    assert (first >= pulse.first - 1e-9).all()
    second = pulse.valve.in_second(Interval(pulse.change, pulse.change))
    assert (second >= pulse.second - 1e-9).all()
    upwards = np.maximum(pulse.change, 0.0)
    some = pulse.roomy
    assert (first - np.maximum(pulse.first, 0.0) <= 0.12 * upwards + 1e-300)[some].all()
    assert (second <= np.maximum(pulse.second, 0.0) + 0.3 * upwards + 1e-300)[some].all()


def test_room_of_the_next_sample_is_within_bounds(pulse):
    parts, way = pulse.valve.parts(Interval(pulse.way, pulse.way)), Interval(pulse.way, pulse.way)
    found = pulse.valve.next_room(parts, way)
    assert holds(found, pulse.room)
    assert (found.high - found.low < 0.02).all()


def test_corners_hold_what_lies_between():
    random = np.random.default_rng(9)

    def affine(a, b, c):
        return a * b - 2.0 * a * b * c + b - 3.0 * c

    low = random.normal(size=(3, 50))
    high = low + random.random((3, 50))
    found = corners(affine, *(Interval(*ends) for ends in zip(low, high, strict=True)))
    ends = []
    for _ in range(200):
        share = random.random((3, 50))
        share = np.where(random.random((3, 1)) < 0.8, np.round(share), share)
        value = affine(*(low + share * (high - low)))
        assert holds(found, value, 0.0)
        ends.append(value)
    np.testing.assert_allclose(found.low, np.min(ends, axis=0), atol=1e-9)
    np.testing.assert_allclose(found.high, np.max(ends, axis=0), atol=1e-9)
