"""The sliding mode through the observed friction, against formulas written down apart from the package."""

import math
from dataclasses import dataclass, replace

import pytest

from tests.unit.controllers.vehicle_cases import protection, seen
from wspd_design.controllers.observer_smc import approach
from wspd_design.design.records import Specification
from wspd_design.design.selection import named_design
from wspd_design.parameters.loading import load_rail


@dataclass
class Written:
    """One wheelset: reference c/sqrt(v), observer, surface and inversion, as they stand in the notes on the law."""

    h: float
    R: float
    J: float
    T_max: float
    T_F: float
    T_V: float
    c: float
    k: float
    w_o: float
    ahead: float
    share: float
    w: float
    tau: float = 0.0
    mean: float = 0.0

    def step(self, v, v_rate, omega, T, T_in):
        """Observe and return (fill, vent)."""
        th = math.exp(-self.w_o * self.h)
        expected = self.w + self.h / self.J * (self.tau - self.mean)
        r = omega - expected
        self.w = expected + (1 - th**2) * r
        self.tau = max(0.0, self.tau + (1 - th) ** 2 * self.J / self.h * r)
        lam = min(self.c / math.sqrt(v), 0.35)
        w_r = (1 - lam) * v / self.R
        w_rate = v_rate / self.R * (1 - lam / 2 if lam < 0.35 else 1 - lam)
        e = omega - w_r
        e += self.ahead * self.h * ((self.tau - T) / self.J - w_rate)
        wanted = min(max(self.tau - self.J * (w_rate - self.k * e), 0.0), T_in)
        a = b = 0.0
        if wanted > T:
            a = self.T_F / self.h * math.log((T_in - T) / max(T_in - wanted, 1e-3 * self.T_max))
        elif wanted < T:
            b = self.T_V / self.h * math.log(T / max(wanted, 1e-3 * self.T_max))
        a, b = min(self.share * a, 1.0), min(self.share * b, 1.0)
        T_a = T_in - (T_in - T) * math.exp(-a * self.h / self.T_F)
        after = T_a * math.exp(-b * self.h / self.T_V)
        area = a * self.h * T_in - (T_in - T) * self.T_F * (1 - math.exp(-a * self.h / self.T_F))
        area += T_a * self.T_V * (1 - math.exp(-b * self.h / self.T_V)) + (1 - a - b) * self.h * after
        self.mean = area / self.h
        return a, b


def rail_torque(slip):
    """2 R f of one wheelset, with a peak at 5 % [N m]."""
    return 21e3 * 2.0 * (slip / 0.05) / (1.0 + (slip / 0.05) ** 2)


@pytest.mark.parametrize(("period", "share"), [(0.02, 1.0), (0.02, 0.6), (0.1, 0.6)])
def test_the_traced_law_is_the_written_one(er24pc, period, share):
    """A stop of one wheelset at 1.8 m/s2, with a brake that fills and vents by its nominal times."""
    rail = load_rail("polach-wet")
    made = named_design("observer-smc", er24pc, rail, Specification(sample_time=period))
    changed = {"valve_time_share": share, "dead_band": 0.0, "torque_slew": 1e12}
    gains = tuple(replace(gain, value=changed.get(gain.name, gain.value)) for gain in made.gains)
    law = replace(made, gains=gains).build(er24pc, rail)
    brake, R, J = er24pc.brake, er24pc.wheel_radius, er24pc.wheelset_inertia
    v, omega, T = 30.0, 30.0 / R, 0.0
    written = Written(
        h=period,
        R=R,
        J=J,
        T_max=brake.max_torque,
        T_F=brake.fill_time,
        T_V=brake.vent_time,
        c=made.gain("falling_slip"),
        k=made.gain("approach_rate"),
        w_o=made.gain("observer_rate"),
        ahead=made.gain("ahead"),
        share=share,
        w=omega,
    )
    state, slips = None, []
    filtered, before = 0.0, v
    while v > 6.0:
        slip = 1.0 - R * omega / v
        now = seen(er24pc, v, (slip,) * 4, (T / brake.max_torque * brake.max_pressure,) * 4)
        state = law.start(now) if state is None else state
        state, commands = law.step(state, now)
        share_of_new = 1.0 - math.exp(-period / law.source.acceleration_time)
        filtered += share_of_new * ((v - before) / period - filtered)
        before = v
        expected = written.step(v, filtered, omega, T, brake.max_torque)
        for command in commands:
            assert (command.fill, command.vent) == pytest.approx(expected, abs=1e-7)
        slips.append(slip)
        a, b = expected
        for part in range(200):
            at = (part + 0.5) / 200
            T += (
                period
                / 200
                * (
                    (brake.max_torque - T) / brake.fill_time
                    if at < a
                    else -T / brake.vent_time
                    if at < a + b
                    else 0.0
                )
            )
            omega += period / 200 * (rail_torque(1.0 - R * omega / v) - T) / J
            omega, v = max(omega, 0.0), v - period / 200 * 1.8
    reference = [0.16 / math.sqrt(30.0 - 1.8 * period * k) for k in range(len(slips))]
    settled = round(2.0 / period)
    worst = max(abs(a / b - 1.0) for a, b in zip(slips[settled:], reference[settled:], strict=True))
    assert worst < 0.25  # the wheel follows its reference, at low speed beyond the peak


def landing(pull, *, error=8.0, slew=16.0, step=1e-3):
    """Lowest error of a wheel whose pull falls no faster than the slew allows."""
    e, y, lowest = error, 0.0, error
    for _ in range(6000):
        wanted = pull(e)
        y = max(wanted, y - slew * step)  # venting is limited, filling is not
        e -= step * y
        lowest = min(lowest, e)
    return lowest


def test_a_braking_curve_does_not_run_beyond_the_reference():
    k, s = 8.0, 16.0
    assert landing(lambda e: approach(e, k, s)) > -0.03
    assert landing(lambda e: k * e) < -1.0  # the straight pull does


def test_approach_is_smooth_and_never_above_the_line():
    k, s = 8.0, 16.0
    meeting = s / k**2
    assert approach(meeting * 1.0001, k, s) == pytest.approx(k * meeting, rel=1e-3)
    assert all(approach(e, k, s) <= k * e + 1e-12 for e in (0.0, 0.1, 0.25, 0.3, 1.0, 10.0))
    assert approach(-2.0, k, s) == -16.0
    assert approach(3.0, k, 1e12) == pytest.approx(24.0)


def test_less_torque_is_asked_for_at_more_slip(er24pc):
    """The sign: a wheel that slides too far vents, one that slides too little fills."""
    law = protection(er24pc)
    brake = er24pc.brake
    pressures = (0.4 * brake.max_pressure,) * 4
    rolling = seen(er24pc, 20.0, (0.036,) * 4, pressures)
    state = law.start(rolling)
    for slips, fills in (((0.005,) * 4, True), ((0.2,) * 4, False)):
        _, commands = law.step(state, seen(er24pc, 20.0, slips, pressures))
        assert all((command.fill > 0.0, command.vent > 0.0) == (fills, not fills) for command in commands)
