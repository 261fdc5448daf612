"""The adaptive fuzzy law (29)-(42): fuzzy system, one step by hand, limits, and its two repairs."""

import math

import pytest

from wspd_design.controllers.adaptive_fuzzy import (
    AdaptiveFuzzy,
    adaptation,
    firing_strengths,
    sliding_variable,
    torque_demand,
)
from wspd_design.controllers.protocol import Measurement

RADIUS, PERIOD, T_MAX = 0.55, 0.1, 60e3


def measured(slip, speed=20.0):
    return Measurement(speed=speed, wheel_speed=(1.0 - slip) * speed / RADIUS, torque=0.0)


@pytest.fixture
def law(printed_gains):
    """Make the sampled law with changed gains."""

    def make(**changes):
        return AdaptiveFuzzy(
            name="law",
            sample_time=PERIOD,
            wheel_radius=RADIUS,
            max_torque=T_MAX,
            gains=printed_gains(**changes),
        )

    return make


def plain_strengths(gains, s):
    """Eqs. (29), (31) as printed."""
    mu = [math.exp(-(((s - c) / w) ** 2)) for c, w in zip(gains.centres, gains.widths, strict=True)]
    return [m / sum(mu) for m in mu]


@pytest.mark.parametrize("s", [-252.0, -126.0, -31.0, 0.0, 10.0, 63.0, 126.0, 300.0])
def test_strengths_are_those_of_29_and_31(printed_gains, s):
    gains = printed_gains()
    assert firing_strengths(gains, s) == pytest.approx(plain_strengths(gains, s), rel=1e-12)


@pytest.mark.parametrize("s", [-1e5, -4e3, 0.0, 63.0, 2e3, 1e5])
def test_strengths_sum_to_one_and_stay_finite_far_away(printed_gains, s):
    strengths = firing_strengths(printed_gains(), s)
    assert all(0.0 <= w <= 1.0 for w in strengths)
    assert sum(strengths) == pytest.approx(1.0, rel=1e-14)


def test_plain_formula_would_fail_far_away(printed_gains):
    with pytest.raises(ZeroDivisionError):
        plain_strengths(printed_gains(), 1e5)


def test_far_away_only_the_nearest_rule_fires(printed_gains):
    assert firing_strengths(printed_gains(), 1e5) == (0.0, 0.0, 0.0, 0.0, 1.0)


def test_neighbors_cross_at_one_half(printed_gains):
    gains = printed_gains()
    memberships = [
        math.exp(-(((63.0 - c) / w) ** 2)) for c, w in zip(gains.centres, gains.widths, strict=True)
    ]
    assert memberships[2] == pytest.approx(0.5)
    assert memberships[3] == pytest.approx(0.5)


def test_sliding_variable_is_22(printed_gains):
    # s = K_P e + K_I int e with the printed 1800 and 550.
    assert sliding_variable(printed_gains(), 0.14, 0.0) == pytest.approx(252.0)
    assert sliding_variable(printed_gains(), 0.0, 0.1) == pytest.approx(55.0)


def test_torque_demand_is_36_with_37(printed_gains):
    # At s = 126 the centre of rule 4: by hand from (30), plus psi sat(s) = 0.7 kN m.
    gains, weights = printed_gains(), (3.0, -2.0, 1.0, 5.0, 4.0)
    mu = [math.exp(-(((126.0 - c) / 75.6707117535) ** 2)) for c in (-252, -126, 0, 126, 252)]
    fuzzy = sum(b * m for b, m in zip(weights, mu, strict=True)) / sum(mu)
    assert torque_demand(gains, 126.0, weights, 0.7) == pytest.approx(1e3 * (fuzzy + 0.7), rel=1e-12)
    inside = torque_demand(gains, 0.25, weights, 0.7) - torque_demand(gains, 0.25, weights, 0.0)
    assert inside == pytest.approx(1e3 * 0.7 * 0.25)


def test_adaptation_is_41_and_42(printed_gains):
    gains = printed_gains()
    for s in (-126.0, 0.5, 80.0):
        rates = adaptation(gains, s, 20.0)
        assert rates.weights == pytest.approx([10.0 * s * w for w in plain_strengths(gains, s)], rel=1e-12)
        assert rates.bound == pytest.approx(0.85 * abs(s))


def test_dead_zone_adapts_with_the_part_outside_the_layer(printed_gains):
    gains = printed_gains(dead_zone=True, boundary_layer=20.0)
    inside = adaptation(gains, -19.9, 20.0)
    assert inside.bound == 0.0
    assert set(inside.weights) == {0.0}
    outside = adaptation(gains, -50.0, 20.0)
    assert outside.bound == pytest.approx(0.85 * 30.0)
    assert sum(outside.weights) == pytest.approx(10.0 * -30.0)


def test_scheduled_rates_fall_with_the_speed(printed_gains):
    """In sigma = integral of dt/v they are those of the law at 1 m/s."""
    plain, scheduled = (adaptation(printed_gains(scheduled_rates=on), 80.0, 25.0) for on in (False, True))
    assert scheduled.weights == pytest.approx([rate / 25.0 for rate in plain.weights], rel=1e-12)
    assert scheduled.bound == pytest.approx(plain.bound / 25.0, rel=1e-12)


def test_first_sample_by_hand(law):
    # e = 0.14 - 0.10 = 0.04, s = 72; one Euler step of 100 ms with alpha_1 = 10, alpha_2 = 0.85.
    controller = law()
    state, command = controller.step(controller.start(measured(0.0)), measured(0.10))
    strengths = plain_strengths(controller.gains, 72.0)
    initial = (-1.0, -0.5, 0.0, 0.5, 1.0)
    assert state[0] == pytest.approx(0.004)
    adapted = [b + 0.1 * 10.0 * 72.0 * w for b, w in zip(initial, strengths, strict=True)]
    assert state[1:6] == pytest.approx(adapted, rel=1e-9)
    assert state[6] == pytest.approx(1.0 + 0.1 * 0.85 * 72.0)
    torque = sum(b * w for b, w in zip(initial, strengths, strict=True)) + 1.0  # kN m
    assert command.fill == pytest.approx(torque / 60.0, rel=1e-9)
    assert command.vent == pytest.approx(1.0 - command.fill)


@pytest.mark.parametrize(("bound", "slip", "duty"), [(500.0, 0.0, 1.0), (500.0, 0.9, 0.0)])
def test_command_is_limited_to_the_brake(law, bound, slip, duty):
    controller = law()
    state = (0.0, *controller.gains.initial_weights, bound)
    assert tuple(controller.step(state, measured(slip))[1]) == (duty, 1.0 - duty)


@pytest.mark.parametrize(
    ("weight", "slip", "held"),
    [
        (200.0, 0.05, True),  # wants more than T_max and s > 0 asks for still more
        (200.0, 0.30, False),  # wants more than T_max, but s < 0 takes it back
        (-200.0, 0.30, True),
        (-200.0, 0.05, False),
        (30.0, 0.05, False),  # within the limits
    ],
)
def test_adaptation_is_held_only_while_the_command_pushes_into_a_limit(law, weight, slip, held):
    state = (0.0, *[weight] * 5, 1.0)
    free, holding = law(), law(hold_when_saturated=True)
    with_hold, command = holding.step(state, measured(slip))
    without, same_command = free.step(state, measured(slip))
    assert command == same_command
    assert without[1:] != state[1:]
    assert with_hold[1:] == (state[1:] if held else without[1:])
    assert with_hold[0] == without[0] == pytest.approx(PERIOD * (0.14 - slip))


def test_printed_law_lets_its_weights_grow_and_the_repair_does_not(stop):
    # Findings section 3: the adapted weights of the printed law grow to hundreds of kN m, many times T_max.
    printed, repaired = (
        max(abs(b) for b in stop(name, "polach-dry").samples[-1].state[1:])
        for name in ("afsmc", "afsmc-repaired")
    )
    assert printed > 10.0 * 60.0
    assert repaired < 0.5 * printed


def test_printed_law_is_a_relay(stop):
    # Findings section 3: the duty is 0 or 1 in 99 % of the samples.
    samples = stop("afsmc", "polach-dry").samples
    assert sum(sample.fill in (0.0, 1.0) for sample in samples) / len(samples) > 0.95
