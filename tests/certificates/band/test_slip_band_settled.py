"""Where a loop settles, and the way of the torque at the center: what a proof says of them is checked."""

import json
import math
from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from flint import ctx
from scipy.integrate import quad
from scipy.optimize import linprog

from tests.certificates.band.conftest import refused, told_of
from wspd_design.certificates.kernel.arb import point
from wspd_design.certificates.kernel.checker import Refused, number
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    STATES,
    Way,
    parts_of,
    shares_together,
    ways_about,
)
from wspd_design.certificates.theorems.band import CELLS, contact_held
from wspd_design.certificates.theorems.slip_band import center, checker
from wspd_design.certificates.theorems.slip_band.center import Lengths, about, way_at
from wspd_design.certificates.theorems.slip_band.loop import Conditions, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Choice, read
from wspd_design.certificates.theorems.slip_band.statement import NAMES, box_of, law_of, windows_of
from wspd_design.parameters.bounds import Bounds

pytestmark = pytest.mark.slow
SETTLES, SHORTEST, LONGEST, BACK = 3, 4, 5, 6
PULSE = Fraction(1, 2)


def forged(proof, window, place, change):
    """A proof of which one number of an ellipsoid is another."""
    found = json.loads(json.dumps(proof))
    each = found["ellipsoids"][window]
    each[place] = repr(change(float(number(each[place]))))
    return found


@pytest.mark.parametrize("window", [0, 5, 9])
@pytest.mark.parametrize("by", [-0.01, 0.01])
def test_ellipsoid_about_another_error_than_its_own_is_refused(half, proof, window, by):
    assert "may lead out of an ellipsoid" in refused(half, forged(proof, window, SETTLES, lambda e: e + by))


@pytest.mark.parametrize("window", [0, 9])
@pytest.mark.parametrize("settled", [0.137, -0.066])
def test_error_from_where_the_fading_is_not_bounded_is_refused(half, proof, window, settled):
    """27 per mille below and 13 above the reference at 10 km/h, and wheels of .55 m at most."""
    slowest = half.speeds[0] / half.span("wheel radius")[1]
    assert not -0.013 * slowest <= settled <= 0.027 * slowest
    reason = refused(half, forged(proof, window, SETTLES, lambda _: settled))
    assert "where the friction is not bounded" in reason


@pytest.mark.parametrize("window", [0, 5, 9])
def test_pulses_at_the_center_that_the_torques_do_not_keep_are_refused(half, proof, window):
    shortest, longest = (float(number(proof["ellipsoids"][window][k])) for k in (SHORTEST, LONGEST))
    assert "too long" in refused(half, forged(proof, window, LONGEST, lambda _: 1.02 * shortest))
    assert "too short" in refused(half, forged(proof, window, SHORTEST, lambda _: 0.98 * longest))


@pytest.mark.parametrize(
    ("place", "length"),
    [
        *((SHORTEST, 0.4), (SHORTEST, -0.001), (LONGEST, 0.001), (LONGEST, 0.9)),
        *((BACK, 0.0), (BACK, -0.001), (BACK, 0.9)),
    ],
)
def test_pulses_at_the_center_in_no_order_are_refused(half, proof, place, length):
    """Longer than the longest one, shorter than the shortest, below 0, and longer than any pulse; so is one back."""
    reason = refused(half, forged(proof, 0, place, lambda _: length))
    assert reason == "the pulses of the way at the center, and those back, must be from 0 to the longest one"


@pytest.mark.parametrize("window", [0, 5, 9])
def test_pulses_back_that_the_states_do_not_keep_are_refused(half, proof, window):
    """The states go some way to the other side of 0: no pulse there may be longer than the one that is told."""
    law = law_of(half.controller)
    with ctx.workprec(128):
        loop, each = loop_in(half, proof, window)
        way = way_at(loop, [point(x) for x in each.center])
        side = "venting" if way > 0 else "filling"
        told, least = each.back, Fraction(0)
        while told - least > Fraction(1, 1000):
            middle = (told + least) / 2
            try:
                checker.errors(law, loop, replace(each, back=middle))
                told = middle
            except Refused:
                least = middle
    reason = refused(half, forged(proof, window, BACK, lambda _: float(least)))
    assert reason.startswith(f"the state may go beyond what {side}")
    assert reason.endswith("in its longest pulse")
    # Not for any length: some are shorter than what the search tells, and are kept to.
    assert least > 0
    assert told_of(half, forged(proof, window, BACK, lambda _: float(told)))


def test_ellipsoids_lie_in_each_other_only_with_errors_counted_from_the_same(half, proof, monkeypatch):
    """With nothing else asked for: an ellipsoid about another error is not where it seems to be."""
    monkeypatch.setattr(checker, "errors", lambda *_: (point(-0.01), point(0.01)))
    assert told_of(half, proof)["cells"] == 1.0
    for by in (-1e-6, 0.03):
        assert "next slower" in refused(half, forged(proof, 6, SETTLES, lambda e, by=by: e + by))


def test_band_reaches_as_far_as_the_states_do(half, proved, proof):
    """About E and the center; with the largest wheel at the lowest speed of the window."""
    windows = windows_of(half)
    for k, each in enumerate(read(proof, len(windows)).cells[0]):
        middle, reach = float(each.settled + each.center[0]), math.sqrt(each.matrix[0][0])
        slip = half.span("wheel radius")[1] / windows[k][0]
        numbers = proved.findings[CELLS].numbers
        assert slip * (middle + reach) <= numbers[f"band {k} below"] <= 1.35 * slip * (middle + reach)
        assert slip * (reach - middle) <= numbers[f"band {k} above"]


def loop_in(problem, proof, window):
    """The loop of an ellipsoid of the proof, and the ellipsoid."""
    found = read(proof, len(windows_of(problem)))
    each = found.cells[0][window]
    return loop_of(
        contact_held(problem),
        law_of(problem.controller),
        box_of(problem, Fraction(1)),
        windows_of(problem)[window],
        found.friction[window],
        each.choice,
        Conditions(each.supply, Fraction(0), Fraction(0)),
    ), each


# --- the way at a center, with valves that fill and vent at different rates -------------------------------------
WAYS = (0.003, -0.003)  # rad/s
LENGTHS = Lengths(
    Fraction(1, 20), Fraction(1, 4), Fraction(1, 2)
)  # of the pulse at the center over the sample time


@pytest.fixture(scope="module", params=[("fill", (0.3, 0.4), (0.8, 1.0)), ("vent", (0.8, 1.0), (0.3, 0.4))])
def valves(request, half, proved):
    """Problem with one of the valves the faster one, and the loop of a middle window."""
    _, fill, vent = request.param
    narrow = {name: (half.nominal(name),) * 2 for name in NAMES}
    problem = replace(half, bounds=Bounds.of(narrow | {"fill time": fill, "vent time": vent}))
    found = proved.findings[CELLS].stated.proof
    window = 6
    with ctx.workprec(128):
        each = read(found, len(windows_of(half)))
        cell = tuple(
            tuple(Fraction(end) for end in ends)
            for ends in (narrow | {"fill time": fill, "vent time": vent}).values()
        )
        loop = loop_of(
            problem,
            law_of(problem.controller),
            cell,
            windows_of(problem)[window],
            each.friction[window],
            Choice(PULSE, 0, Fraction(0)),
            Conditions(Fraction(63, 64), Fraction(0), Fraction(0)),
        )
    return problem, loop, fill, vent


def centered(problem, loop, way):
    """A center with this way, and the loop about it."""
    law = law_of(problem.controller)
    with ctx.workprec(128):
        zero = [point(0)] * STATES
        one = [point(0), point(0), point(1), point(0), point(0)]
        friction = (point(Fraction(way)) - way_at(loop, zero)) / (way_at(loop, one) - way_at(loop, zero))
        center = [point(0), point(0), friction, point(0), point(0)]
        return law, about(law, loop, center, LENGTHS)


@pytest.mark.parametrize("way", WAYS)
def test_way_at_the_center_has_the_part_of_its_own_side(valves, way):
    """Against true valves: a pulse of the length that the law asks for, with each of the true times."""
    problem, loop, fill, vent = valves
    law, found = centered(problem, loop, way)
    assumed = [float(each) for each in (law.fill_time, law.vent_time)]
    h = float(law.sample_time)

    def gone(kind, length):
        """Parts of a way that both true times go in a pulse of this length over the sample time."""
        asked = -math.expm1(-length * h / assumed[kind])
        return [-math.expm1(-length * h / time) / asked for time in (fill, vent)[kind]]

    pairs = pairs_of(Way(*(each.mid() for each in each_way)) for each_way in found.ranges.ways)
    side, other = (0, 1) if way > 0.0 else (1, 0)
    here, there = (
        [part for length in (1e-3, 0.2, 0.5) for part in gone(kind, length)] for kind in (side, other)
    )
    centers = [center for _, center in pairs]
    assert min(centers) <= min(here) <= max(here) <= max(centers)
    # Ways to this side and to the other, of which the center's goes a part as any on its side.
    for part, u in [*product(here, (0.3 * way, 2.0 * way)), *product(there, (-0.5 * way, -3.0 * way))]:
        ends = [rest * (u - way) + center * way for rest, center in pairs]
        assert min(ends) <= part * u <= max(ends)
    # The slower side's parts are no bounds for the faster one.
    assert not min(centers) <= min(there) <= max(there) <= max(centers)


def counted(side, other, way, most, times=1.0):
    """Pairs of parts where ways of at most this length to the other side count for their part of the distance."""
    far = most / (most + times * way)
    here, there = (tuple(float(end.mid()) for end in each.parts) for each in (side, other))
    share = (0.0, 0.6)
    return pairs_of(ways_about(here, there, far, ([share], [share]), share))


def pairs_of(ways):
    """Different pairs of parts of the rest and of the way at the center."""
    return sorted({tuple(round(float(end), 12) for end in (each.part, each.part_center)) for each in ways})


@pytest.mark.parametrize("way", WAYS)
def test_ways_to_the_other_side_count_for_their_part_of_the_distance(valves, way):
    """Pulses of true valves up to the longest one back, at any torque: half of the distance would be too little."""
    problem, loop, fill, vent = valves
    law, found = centered(problem, loop, way)
    h, full = float(law.sample_time), float(law.sample_time * law.full_torque / law.inertia)
    kind = 1 if way > 0.0 else 0
    assumed, times = float((law.fill_time, law.vent_time)[kind]), (fill, vent)[kind]
    sides = loop.pulses[::-1] if kind == 0 else loop.pulses
    most = -math.expm1(-float(LENGTHS.back) * h / assumed)
    most *= sum(float(each.height[1].mid()) for each in loop.pulses)
    pairs = pairs_of(Way(*(each.mid() for each in each_way)) for each_way in found.ranges.ways)
    np.testing.assert_allclose(pairs, counted(*sides, abs(way), most), rtol=1e-9)
    center_parts = [float(end.mid()) for end in sides[0].parts]

    def enclosed(pairs):
        """Whether each way is a mean of those of the pairs, with any part of the way at the center."""
        return all(
            min(ends) <= gone <= max(ends)
            for u, gone in simulated
            for ends in ([rest * (u - way) + center * way for rest, center in pairs],)
        )

    simulated = []
    for length, height, time in product(
        (0.01, 0.1, float(LENGTHS.back)), (0.1 * full, 0.6 * full, full), times
    ):
        wanted, gone = (-math.expm1(-length * h / each) * height for each in (assumed, time))
        simulated.append((-math.copysign(wanted, way), -math.copysign(gone, way)))
    assert sorted({center for _, center in pairs}) == pytest.approx(sorted(set(center_parts)))
    assert enclosed(pairs)
    # Near 0 the parts are nearly those of the side of the center.
    assert not enclosed(counted(*sides, abs(way), most, times=2.0))
    assert not enclosed(counted(*sides, abs(way), 0.0))


@pytest.mark.parametrize("way", WAYS)
def test_limits_keep_the_pulse_at_the_center_between_its_lengths(valves, way):
    problem, loop, *_ = valves
    law, found = centered(problem, loop, way)
    limits = found.limits[len(loop.limits) :]
    assert [each.what.rsplit(" ", 1)[1] for each in limits] == ["long", "short"]
    side = loop.pulses[0 if way > 0.0 else 1]
    time = float((law.fill_time if way > 0.0 else law.vent_time) / law.sample_time)
    lengths = {True: [], False: []}
    for torque, height in product(np.linspace(-1.0, 1.0, 801), side.height):
        left = float(height.mid()) + (-torque if way > 0.0 else torque)  # room that is left, or torque
        if left <= abs(way):
            continue
        inside = all(float(each.row[3].mid()) * torque < float(each.bound.mid()) for each in limits)
        lengths[inside].append(-time * math.log1p(-abs(way) / left))
    shortest, longest, _ = map(float, LENGTHS)
    assert shortest <= min(lengths[True]) <= max(lengths[True]) <= longest
    assert max(lengths[False]) > longest
    assert min(lengths[False]) < shortest


@pytest.mark.parametrize("way", WAYS)
def test_mean_torque_of_the_law_is_between_what_is_seen_of_both_ways(valves, way):
    """Means of pulses with the nominal times, for heights at which the way at the center takes any length allowed."""
    problem, loop, *_ = valves
    law, found = centered(problem, loop, way)
    h, share = float(law.sample_time), float(law.time_share)
    times = [float(each) for each in (law.fill_time, law.vent_time)]

    def in_mean(u, heights):
        """What the law counts of a way in the mean, for the heights of filling and venting."""
        kind = 0 if u > 0.0 else 1
        length = -times[kind] / h * math.log1p(-abs(u) / heights[kind])
        assert length <= float(PULSE) + 1e-9
        nominal = times[kind] / share

        def gone(t):
            return heights[kind] * -math.expm1(-min(t, length) * h / nominal)

        return math.copysign(quad(gone, 0.0, 1.0, points=[length], epsabs=1e-13)[0], u)

    side = 0 if way > 0.0 else 1
    seen = [float(each.seen.mid()) for each in found.ranges.ways]
    known = float(found.ranges.shares_center[1].mid())
    place = DISTURBANCES.index("mean reference drift")
    below, above = (
        float((after - before).mid())
        for after, before in zip(found.disturbances[place], loop.disturbances[place], strict=True)
    )
    further, center = [], []
    for length in (float(LENGTHS[0]), 0.12, float(LENGTHS[1])):
        heights = [0.0, 0.0]
        heights[side] = abs(way) / -math.expm1(-length * h / times[side])
        heights[1 - side] = 0.1
        at_center = in_mean(way, heights)
        center.append(at_center - known * way)
        ends = [
            -math.expm1(-float(PULSE) * h / each) * height
            for each, height in zip(times, heights, strict=True)
        ]
        further += [
            (in_mean(u, heights) - at_center) / (u - way)
            for u in np.linspace(-ends[1], ends[0], 40)
            if abs(u - way) > 1e-6
        ]
    assert below <= min(center) <= max(center) <= above
    assert above - below < 0.5 * abs(way)
    assert min(seen) <= min(further) <= max(further) <= max(seen)
    # With half of the longest pulse alone the mean would be taken to see more than it does.
    assert min(further) < share * (1.0 - float(PULSE) / 2.0)


@pytest.mark.parametrize("way", WAYS)
def test_way_further_than_the_center_is_another_part_than_all_of_it_from_none_on(valves, way, monkeypatch):
    """What the law counts of it, over what it would count if its valves had the times that it assumes."""
    problem, loop, *_ = valves
    told = []
    monkeypatch.setattr(
        center, "shares_together", lambda *asked: told.append(asked) or shares_together(*asked)
    )
    law, _ = centered(problem, loop, way)
    (_, _, counted), _ = told
    time = float((law.fill_time if way > 0.0 else law.vent_time) / law.sample_time)
    share = float(law.time_share)

    def counts(rate, ends):
        return quad(lambda length: (1.0 - length) * rate * math.exp(-rate * length / time), *ends)[0]

    further = [
        counts(share, ends) / counts(1.0, ends)
        for ends in product(map(float, LENGTHS[:2]), (0.3, float(PULSE)))
    ]
    low, high = (float(end.mid()) for end in counted)
    assert low <= min(further) <= max(further) <= high
    assert max(further) > parts_of((share, share), float(PULSE) / time)[1]


def test_way_without_a_sign_has_no_numbers_of_its_own(valves):
    problem, loop, *_ = valves
    law = law_of(problem.controller)
    with ctx.workprec(128):
        wide = [point(0), point(0), point(-1).union(point(1)), point(0), point(0)]
        assert about(law, loop, wide, LENGTHS) is loop


# --- what counts in the mean of a sample, of the true torque and of the one that the law works out ---------------
GROWTHS = (-0.3, 0.4)  # of errors over a sample


def in_means(law, u, heights, true_times, growth, delay):
    """What of a way is gone at the end of a sample, in its weighted mean, and in the mean of the law."""
    kind = 0 if u > 0.0 else 1
    h, assumed = float(law.sample_time), float((law.fill_time, law.vent_time)[kind])
    length = -assumed / h * math.log1p(-abs(u) / heights[kind])

    def gone(t, time):
        return math.copysign(heights[kind] * -math.expm1(-min(max(t, 0.0), length) * h / time), u)

    def weighed(t):
        return gone(t - delay, true_times[kind]) * math.exp(growth * (1.0 - t))

    breaks = sorted({min(each, 1.0) for each in (delay, delay + length, length)})
    weighted = quad(weighed, 0.0, 1.0, points=breaks, epsabs=1e-14)[0] * growth / math.expm1(growth)
    nominal = assumed / float(law.time_share)
    mean = quad(lambda t: gone(t, nominal), 0.0, 1.0, points=breaks, epsabs=1e-14)[0]
    return gone(delay + length, true_times[kind]), weighted, mean


def left_out(problem, loop, way, delay, *, faulty=lambda ways: ways):
    """How far what simulated ways do is from every mixture of the corners of the loop, and of what disturbs."""
    with ctx.workprec(128):
        h = Fraction(law_of(problem.controller).sample_time)
        low, high = (point(Fraction(each) / h) for each in GROWTHS)
        ranges = replace(loop.ranges, secants=(low, high))
        law, found = centered(problem, replace(loop, ranges=ranges, delay=point(Fraction(delay))), way)
    corners = np.array(faulty([[float(each.mid()) for each in one] for one in found.ranges.ways]))
    known = [float(each.mid()) for each in found.ranges.shares_center]
    # A change of a mean is a disturbance of the error over the effect, and the growth of what it adds to it.
    to_mean = GROWTHS[1] / math.expm1(GROWTHS[1]) / float(found.ranges.effects[1].mid())
    disturbed = [
        [
            float((after - before).mid()) * factor
            for after, before in zip(found.disturbances[k], loop.disturbances[k], strict=True)
        ]
        for k, factor in (
            (DISTURBANCES.index("uneven slip drift"), to_mean),
            (DISTURBANCES.index("mean reference drift"), 1.0),
        )
    ]
    side, farthest = 0 if way > 0.0 else 1, 0.0
    assumed, h = [float(each) for each in (law.fill_time, law.vent_time)], float(law.sample_time)
    fill, vent = (problem.span(name) for name in ("fill time", "vent time"))
    for times, growth, length in product(product(fill, vent), GROWTHS, map(float, LENGTHS[:2])):
        heights = [0.1, 0.1]
        heights[side] = abs(way) / -math.expm1(-length * h / assumed[side])
        longest = [float(PULSE), float(PULSE)]
        longest[1 - side] = float(LENGTHS.back)
        ends = [
            -math.expm1(-each * h / time) * height
            for each, time, height in zip(longest, assumed, heights, strict=True)
        ]
        for u in np.linspace(-0.999 * ends[1], 0.999 * ends[0], 7):
            done = np.array(in_means(law, u, heights, times, growth, delay))
            part, center, late, seen = corners.T
            whole = part * (u - way) + center * way
            weighed = part * (1.0 - late) * (u - way) + center * (1.0 - known[0]) * way
            mean = seen * (u - way) + known[1] * way
            farthest = max(farthest, apart(np.array([whole, weighed, mean]).T, done, disturbed) / abs(way))
    return farthest


def apart(corners, point, disturbed):
    """Least distance of a point from the mixtures of corners, the last two coordinates moved between two ends."""
    count = len(corners)
    # Unknowns: weights of the corners, what is added to the last two coordinates, and the distance.
    costs = np.zeros(count + 3)
    costs[-1] = 1.0
    moved = np.zeros((3, 2))
    moved[1:, :] = np.eye(2)
    rows = np.concatenate([corners.T, moved], axis=1)
    within = np.concatenate([np.concatenate([sign * rows, -np.ones((3, 1))], axis=1) for sign in (1.0, -1.0)])
    found = linprog(
        costs,
        A_ub=within,
        b_ub=np.concatenate([point, -point]),
        A_eq=[[*np.ones(count), 0.0, 0.0, 0.0]],
        b_eq=[1.0],
        bounds=[(0.0, None)] * count + [tuple(each) for each in disturbed] + [(0.0, None)],
    )
    assert found.status == 0
    return float(found.fun)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("delay", [0.0, 0.2])
def test_simulated_ways_are_mixtures_of_the_corners(valves, way, delay):
    """What is gone, and both means, against integrals over the sample: ways to both sides, errors that grow or fade."""
    problem, loop, *_ = valves
    assert left_out(problem, loop, way, delay) < 1e-6


@pytest.mark.parametrize("way", WAYS[:1])
def test_shares_that_are_too_close_leave_ways_out(valves, way):
    """Mutants: pulses of half the length, no ways to the other side, and shares of the same side for those."""
    problem, loop, *_ = valves

    def shorter(ways):
        return [[a, b, 0.5 * late, 0.5 * (seen + 0.6)] for a, b, late, seen in ways]

    def one_side(ways):
        return [each for each in ways if each[0] == each[1]]

    for faulty in (shorter, one_side):
        assert left_out(problem, loop, way, 0.0, faulty=faulty) > 1e-3
