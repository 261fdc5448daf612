"""The sampled loop in deviations: its identities, and the same loop simulated in numbers of the plant."""

import math
from functools import cache
from itertools import pairwise, product
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from tests.lazily import Lazily, residuals
from wspd_design.certificates.setting.slip_loop import (
    DISTURBANCES,
    STATES,
    LoopLaw,
    parts_of,
    sample,
    shares_together,
    ways_about,
)
from wspd_design.model.generated import slip_loop as generated

slip_loop = Lazily("slip_loop")


def test_every_identity_holds():
    assert residuals("slip_loop")
    assert {name for name, left in residuals("slip_loop").items() if left != 0} == set()


def test_there_are_identities():
    assert len(residuals("slip_loop")) == 32


def test_bend_says_which_way_the_edges_curve():
    assert slip_loop.bend_residual == 0  # d slope/d span = -exp(...) < 0
    assert slip_loop.run_residual == 0  # d phi/d span has the sign of last - first


H, INERTIA, TRUE_INERTIA, PADS, RADIUS = 0.02, 752.0, 830.0, 0.88, 0.55
SPEED, BRAKING, SLIP, JERK = 8.0, -1.3, 0.14, 0.6
SLIP_RATE = 0.05  # 1/s, of the slip that is held, where it changes
FRICTION, SECANT = 21e3, -3.0  # N m on the reference at the start, 1/s
RATE, OBSERVER, AHEAD, SMOOTHING = 8.0, 30.0, 0.45, 0.1  # 1/s, 1/s, -, s
FULL = 60e3  # N m
SHARE, NOMINAL = 0.6, (0.6, 0.5)  # of the nominal times, s of filling and of venting, that the law assumes
TRUE = (0.45, 0.4)  # s
EFFECT = PADS * INERTIA / TRUE_INERTIA
THETA, KEPT = math.exp(-OBSERVER * H), math.exp(-H / SMOOTHING)
LAW = LoopLaw(sample_time=H, gain=RATE * H, ahead=AHEAD, pole=THETA, kept=KEPT)


def weighted(value):
    """Mean over the sample, of what comes later more as the error grows less."""
    weight = [
        quad(lambda t, f=f: f(t) * math.exp(SECANT * (H - t)), 0.0, H)[0] for f in (value, lambda _: 1.0)
    ]
    return weight[0] / weight[1]


def pulse_for(torque, target):
    """Length of the pulse with the times that the law assumes [s]; filling is 0, venting 1."""
    if target > torque:
        return 0, SHARE * NOMINAL[0] * math.log((FULL - torque) / (FULL - target))
    return 1, SHARE * NOMINAL[1] * math.log(torque / target)


def course(torque, target, times, t):
    """Torque a time after the beginning of the pulse, with these times of filling and venting [N m]."""
    kind, pulse = pulse_for(torque, target)
    left = math.exp(-min(t, pulse) / times[kind])
    return torque * left if kind else FULL - (FULL - torque) * left


def mean_of(torque, target):
    """Mean torque over the sample as the law works it out, with the nominal times [N m]."""
    _, pulse = pulse_for(torque, target)
    ends = [0.0, pulse, H]
    return (
        sum(
            quad(lambda t: course(torque, target, NOMINAL, t), *each, epsabs=1e-9)[0]
            for each in pairwise(ends)
        )
        / H
    )


def simulated(*, slip_rate=0.0, delay=0.0, misread=(0.0, 0.0), settled=0.0, torque=22.9e3, times=TRUE):
    """One sample in numbers of the plant, and what the theorem says about it.

    The pulse begins late, over the sample time, with errors of the wheel speed at both samples [rad/s]; errors are
    counted from one that is settled [rad/s].
    """

    def speed(t):
        return SPEED + BRAKING * t + JERK * t * t / 2.0

    def slip(t):
        return SLIP + slip_rate * t

    def reference(t):
        """Wheel speed of a slip that changes, and its rate at a fixed slip."""
        return (1.0 - slip(t)) * speed(t) / RADIUS, (1.0 - slip(t)) * (BRAKING + JERK * t) / RADIUS

    def friction(t, w):
        return FRICTION + 900.0 * t + SECANT * TRUE_INERTIA * (w - reference(t)[0])

    def held(t):
        """Torque that holds the speed that errors are counted from, over the inertia of the law."""
        return (friction(t, reference(t)[0] + settled) / TRUE_INERTIA - reference(t)[1]) / EFFECT

    e, p, observed_friction = 0.03 - settled, -0.004, FRICTION * 1.02
    (w0, rate0), (w1_reference, rate1) = reference(0.0), reference(H)
    filtered, misjudged = (
        BRAKING + 0.04,
        -0.03,
    )  # m/s2 that the filter shows, rad/s2 by which the law is wrong beside
    known_rate = (1.0 - slip(0.0)) / RADIUS * filtered - misjudged
    seen_error = e + settled + misread[0]
    ahead = seen_error + AHEAD * H * ((observed_friction - torque) / INERTIA - known_rate)
    target = observed_friction - INERTIA * (known_rate - RATE * ahead)
    kind, pulse = pulse_for(torque, target)
    assert pulse + delay * H < H

    def seen_torque(t):
        return course(torque, target, times, max(t - delay * H, 0.0))

    def motion(t, state):
        return [(friction(t, state[0]) - PADS * seen_torque(t)) / TRUE_INERTIA]

    run = solve_ivp(motion, (0.0, H), [w0 + settled + e], rtol=1e-12, atol=1e-12, max_step=1e-4)
    w1 = float(run.y[0, -1])
    mean = mean_of(torque, target)
    expected = w0 + settled + e + p + H / INERTIA * (observed_friction - mean)
    r = w1 + misread[1] - expected
    learned = observed_friction + (1 - THETA) ** 2 * INERTIA / H * r
    filtered_next = filtered + (1.0 - KEPT) * ((speed(H) - speed(0.0)) / H - filtered)
    after = (
        w1 - w1_reference - settled,
        expected + (1 - THETA**2) * r - w1,
        H * (learned / INERTIA - held(H) - rate1),
        H * (seen_torque(H) / INERTIA - held(H)),
        H * (rate1 - (1.0 - slip(H)) / RADIUS * filtered_next),
    )

    lag = H * (1.0 - slip(0.0)) / RADIUS * (BRAKING - filtered)
    state = (
        e,
        p,
        H * (observed_friction / INERTIA - held(0.0) - rate0),
        H * (torque / INERTIA - held(0.0)),
        lag,
    )

    def sliding(t):
        return slip_rate * speed(t) / RADIUS

    moved = quad(sliding, 0.0, H)[0]
    # The train slows down ever less; the rims take another part in that at the end of the sample.
    lagged = H * H * (1.0 - slip(0.0)) / RADIUS * JERK * (1.0 - (1.0 - KEPT) / 2.0)
    turned = (1.0 - slip(H)) / (1.0 - slip(0.0))
    disturbed = (
        H * misjudged,
        RATE * H * (misread[0] + settled),
        H * (held(H) - held(0.0)),
        H * weighted(lambda t: held(t) - held(0.0)),
        H * (rate1 - rate0),
        w1_reference - w0 - H * rate0 + moved,
        moved,
        quad(lambda t: (math.exp(SECANT * (H - t)) - 1.0) * sliding(t), 0.0, H)[0],
        misread[1],
        turned * lagged + (turned - 1.0) * KEPT * lag,
    )
    assert len(disturbed) == len(DISTURBANCES)
    way = generated.wanted_torque(e, state[2], state[3], RATE * H, AHEAD, lag + disturbed[0]) - state[3]
    phi, psi, _ = generated.switched_slide(SECANT, SECANT, 1.0, H)
    return SimpleNamespace(
        z=np.array([*state, *disturbed]),
        after=np.array(after),
        wanted=way + disturbed[1],
        step=H / INERTIA * (target - torque),
        gone=H / INERTIA * (seen_torque(H) - torque),
        in_mean=H / INERTIA * (mean - torque),
        slide=(phi, psi),
        late=weighted(lambda t: 1.0 - (seen_torque(t) - torque) / (seen_torque(H) - torque)),
        kind=kind,
        pulse=pulse / H,
        torque=torque,
    )


CASES = [
    {},
    {"settled": 0.02},
    {"slip_rate": SLIP_RATE, "delay": 0.3, "misread": (0.01, -0.02), "settled": -0.01},
    {"slip_rate": -SLIP_RATE, "delay": 0.5, "misread": (-0.01, 0.02), "settled": 0.05},
    {"torque": 23.6e3, "settled": 0.02},
    {"torque": 23.6e3, "delay": 0.3, "slip_rate": SLIP_RATE, "misread": (0.01, -0.02), "settled": 0.05},
]


@pytest.mark.parametrize("case", CASES)
def test_loop_in_deviations_is_the_loop_in_numbers_of_the_plant(case):
    run, delay = simulated(**case), case.get("delay", 0.0)
    assert run.kind == ("torque" in case)
    assert run.wanted == pytest.approx(run.step, rel=1e-12)
    rho, seen = run.gone / run.wanted, run.in_mean / run.wanted
    numbers = (*run.slide, EFFECT, rho, run.late, seen)
    np.testing.assert_allclose(of_sample(numbers) @ run.z, run.after, rtol=1e-7, atol=1e-10)
    speedup = SHARE * NOMINAL[run.kind] / TRUE[run.kind]
    low, high = parts_of((speedup, speedup), H / (SHARE * NOMINAL[run.kind]))
    assert low <= rho <= high
    latest = generated.lateness(SECANT * H, run.pulse, delay)
    assert 0.0 <= run.late <= latest <= generated.lateness(SECANT * H, 1.0, delay)
    assert (run.late > generated.lateness(SECANT * H, run.pulse, 0.0)) is (delay > 0.0)
    # Of the mean that the law works out with nominal times
    low, high = parts_of((SHARE, SHARE), run.pulse * H / (SHARE * NOMINAL[run.kind]))
    assert low * (1.0 - run.pulse / 2.0) <= seen <= high
    steady = 1.0 - generated.lateness(SECANT * H, 1.0, 0.0)  # of a steady drift in its weighted mean
    assert weighted(lambda t: t / H) == pytest.approx(steady, rel=1e-9)


def of_sample(numbers):
    """[A B] for some numbers of a sample, with the pull k e."""
    return np.array(sample(LAW, (*numbers, 1.0), list(np.eye(STATES + len(DISTURBANCES)))))


@pytest.mark.parametrize("place", [0, 2, 3, 4, STATES + 1])
def test_what_is_counted_from_another_speed_is_not_the_same(place):
    """Errors, torques, lag and what the settled error asks for: without one the next state is another."""
    run = simulated(settled=0.05)
    numbers = (*run.slide, EFFECT, run.gone / run.wanted, run.late, run.in_mean / run.wanted)
    moved = run.z.copy()
    moved[place] += {0: 0.05, 4: -run.z[4]}.get(place, RATE * H * 0.05)
    assert np.abs(of_sample(numbers) @ moved - run.after).max() > 1e-5


# --- ways about one at a center -----------------------------------------------------------------------------------
PULSE, AT_CENTER = 0.6, 0.2  # longest pulse over the sample time, and of the way at the center
TORQUES = (22.2e3, 22.8e3, 23.0e3, 23.1e3, 23.2e3, 23.7e3)  # N m, from which the way is up, none, and down
# True times of filling and venting [s]: the valve that fills is the slower, or the faster one.
VALVES = ((0.5, 0.2), (0.25, 0.9))


def center_of(run, kind):
    """State and disturbances of a center from which the way fills (0) or vents (1); neither those of the run nor 0."""
    z = 0.5 * run.z
    wanted = np.array(
        [each[3] for each in np.eye(STATES + len(DISTURBANCES))]
    )  # the row of Y, of which Y* is to be what it takes
    height = (run.torque - FULL if kind == 0 else run.torque) * -H / INERTIA
    way = height * -math.expm1(-AT_CENTER * H / (SHARE * NOMINAL[kind]))
    row = way_row()
    return z + wanted * (way - row @ z) / (row @ wanted), way


def way_row():
    """What gives the wanted way, from state and disturbances."""
    found = of_sample((1.0, 0.0, 0.0, 1.0, 0.0, 0.0))[3]  # Y+ of a valve that goes the whole way
    return found - np.eye(len(found))[3] + np.eye(len(found))[STATES + DISTURBANCES.index("torque drift")]


@cache
def ways():
    """Runs with all torques, valves and kinds of center, with the parts of the way that each kind of pulse can go."""
    found = []
    for times, kind, torque in product(VALVES, (0, 1), TORQUES):
        run = simulated(torque=torque, times=times, settled=0.02, delay=0.2)
        parts = [
            parts_of((assumed / time,) * 2, PULSE * H / assumed)
            for assumed, time in zip((SHARE * each for each in NOMINAL), times, strict=True)
        ]
        z, way = center_of(run, kind)
        found.append((run, z, way, (parts[kind], parts[1 - kind])))
    return found


def pairs_about(side, other):
    """Pairs of parts of the rest and of the way at the center, as far to the other side as ways may go."""
    share = (0.0, 0.6)
    found = ways_about(side, other, 1.0, ([share], [share]), share)
    return sorted({(each.part, each.part_center) for each in found})


def mixed(pairs, run, way):
    """A mean of pairs of parts, rest and center, with which the simulated way is gone; none if there is none."""
    gone = [rest * (run.wanted - way) + center * way for rest, center in pairs]
    least, most = np.argmin(gone), np.argmax(gone)
    if not gone[least] - 1e-12 <= run.gone <= gone[most] + 1e-12:
        return None
    share = (run.gone - gone[least]) / (gone[most] - gone[least])
    return tuple((1.0 - share) * a + share * b for a, b in zip(pairs[least], pairs[most], strict=True))


def test_ways_about_a_center_are_those_of_the_valve():
    """X+ = [A B] (Z - Z_c) + [A B]_c Z_c, on both sides of 0, for a valve that fills faster or slower than it vents."""
    kinds = set()
    for run, z, way, parts in ways():
        kinds.add((run.wanted > 0.0, way > 0.0))
        assert way_row() @ run.z == pytest.approx(run.wanted, rel=1e-9)
        assert way_row() @ z == pytest.approx(way, rel=1e-9)
        found = mixed(pairs_about(*parts), run, way)
        assert found is not None
        at_center = H / INERTIA * (mean_of(run.torque, run.torque + way * INERTIA / H) - run.torque)
        seen, seen_center = (run.in_mean - at_center) / (run.wanted - way), at_center / way
        rest, center = (
            of_sample((*run.slide, EFFECT, rho, run.late, share))
            for rho, share in zip(found, (seen, seen_center), strict=True)
        )
        np.testing.assert_allclose(rest @ (run.z - z) + center @ z, run.after, rtol=1e-7, atol=1e-10)
    assert len(kinds) == 4


@pytest.mark.parametrize("missing", [0, 1, -2, -1])  # those between are mixtures of them
def test_without_one_pair_of_parts_a_way_is_left_out(missing):
    left_out = []
    for run, _, way, parts in ways():
        pairs = pairs_about(*parts)
        rest = [each for each in pairs if each != pairs[missing]]
        left_out.append(mixed(rest, run, way) is None)
    assert any(left_out)


def test_parts_of_the_other_side_do_not_hold_for_the_center():
    assert any(mixed(pairs_about(*parts[::-1]), run, way) is None for run, _, way, parts in ways())


def further(torque, kind, before, after):
    """What of a way that is wanted further is gone, and is in the mean of the law, by nominal times.

    For two lengths over the sample time.
    """
    assumed = SHARE * NOMINAL[kind]
    wanted, gone = (
        [
            FULL - (FULL - torque) * math.exp(-each * H / time)
            if kind == 0
            else torque * math.exp(-each * H / time)
            for each in (before, after)
        ]
        for time in (assumed, NOMINAL[kind])
    )
    means = [mean_of(torque, each) for each in wanted]
    return tuple((ends[1] - ends[0]) / (wanted[1] - wanted[0]) for ends in (gone, means))


def rate_at(length):
    """Change of the way by the nominal time over that of the wanted one, at the end of a pulse of the faster valve."""
    assumed = SHARE * min(NOMINAL)
    given = {"h": H, "P": length, "T_a": assumed, "T_n": assumed / SHARE}
    return float(slip_loop.rate.subs({each: given[each.name] for each in slip_loop.rate.free_symbols}))


def seen_beside(shortest_left):
    """Shares in the mean of the law of ways about a center, where at least so much of the sample is left."""
    ends = shares_together((shortest_left, 1.0), (1.0, 1.0), (rate_at(0.0), rate_at(PULSE)))
    found = [each.seen for each in ways_about((1.0, 1.0), (1.0, 1.0), 0.0, (ends, ends), ends[0])]
    return min(found), max(found)


def test_what_a_longer_pulse_adds_to_the_mean_of_the_law():
    """It counts from the end of the pulse at the center on: half of the longest pulse alone would be too much."""
    gone, seen = zip(
        *(
            further(torque, kind, before, after)
            for torque, kind, before, after in product(
                (10e3, 24e3, 50e3), (0, 1), (0.05, 0.1, AT_CENTER), (1e-3, 0.15, 0.3, PULSE)
            )
        ),
        strict=True,
    )
    low, high = seen_beside(1.0 - (PULSE + AT_CENTER) / 2.0)
    assert low <= min(seen) <= max(seen) <= high
    assert min(seen) < seen_beside(1.0 - PULSE / 2.0)[0]
    # Nor is what is gone further a part of the way from none on.
    assert rate_at(0.0) <= min(gone) <= max(gone) <= rate_at(PULSE)
    assert max(gone) > parts_of((SHARE, SHARE), PULSE * H / (SHARE * min(NOMINAL)))[1]


def test_lag_of_the_filter_follows_a_jerk_of_any_course():
    """Its change over a sample is that of a steady jerk between the least and the most; weights at both ends differ."""
    random, h, share = np.random.default_rng(4), 0.02, 1.0 - KEPT
    for _ in range(50):
        jerks = random.uniform(-1.0, 3.0, 40)
        dt = h / len(jerks)
        rate = np.concatenate([[-1.2], -1.2 + np.cumsum(jerks) * dt])
        gained = float(np.sum((rate[1:] + rate[:-1]) / 2.0) * dt)
        filtered = -1.0
        after = filtered + share * (gained / h - filtered)
        drift = (rate[-1] - after) - KEPT * (rate[0] - filtered)
        low, high = (float(end) * h * (1.0 - share / 2.0) for end in (jerks.min(), jerks.max()))
        assert low <= drift <= high
