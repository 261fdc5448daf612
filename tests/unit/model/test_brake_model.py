"""Cylinder pressure in closed form against the differential equation (8), (9)."""

import math
from dataclasses import replace

import pytest
from scipy.integrate import solve_ivp

from wspd_design.model.brake import Valve, braking_torque, pressure_after, torque_disturbance

BAR = 1e5


def integrated(brake, valve, start, end, pressure):
    """Solve (8), (9) with Table 2, written out from the paper."""
    u_ev, u_bv = {Valve.FILL: (0, 0), Valve.VENT: (1, 1), Valve.HOLD: (0, 1)}[valve]

    def rate(t, p):
        supply = brake.max_pressure * (1.0 - math.exp(-0.75 * t))
        return u_ev * (-p / brake.vent_time) + (1 - u_bv) * (supply - p) / brake.fill_time

    return solve_ivp(rate, (start, end), [pressure], method="DOP853", rtol=1e-12, atol=1e-4).y[0, -1]


@pytest.mark.parametrize("valve", list(Valve))
@pytest.mark.parametrize(
    ("start", "span", "pressure"),
    [(0.0, 0.1, 0.0), (0.0, 5.0, 0.0), (1.3, 0.067, 2.2 * BAR), (9.9, 0.4, 6.0 * BAR)],
)
def test_closed_form_solves_the_differential_equation(er24pc, valve, start, span, pressure):
    for brake in (er24pc.brake, replace(er24pc.brake, fill_time=0.31, vent_time=0.84)):
        expected = integrated(brake, valve, start, start + span, pressure)
        assert pressure_after(brake, valve, start + span, start, pressure) == pytest.approx(
            expected, rel=1e-9
        )


def test_one_long_filling_is_two_short_ones(er24pc):
    brake = er24pc.brake
    half = pressure_after(brake, Valve.FILL, 0.75, 0.5, 1.0 * BAR)
    assert pressure_after(brake, Valve.FILL, 1.0, 0.75, half) == pytest.approx(
        pressure_after(brake, Valve.FILL, 1.0, 0.5, 1.0 * BAR), rel=1e-14
    )


def test_printed_law_10_would_be_seen(er24pc):
    # Eq. (10) takes the supply pressure of (8) as constant: wrong by more than a tenth in the first second.
    brake = er24pc.brake
    printed = brake.max_pressure * (1.0 - math.exp(-0.75)) * (1.0 - math.exp(-1.0 / brake.fill_time))
    assert printed != pytest.approx(integrated(brake, Valve.FILL, 0.0, 1.0, 0.0), rel=0.1)


def test_valve_states_are_those_of_table_2():
    # (u_EV, u_BV) of Table 2: reduction (1, 1), maintenance (0, 1), increase (0, 0); (9) fills with 1 - u_BV.
    assert Valve.VENT.value == (0.0, 1.0)
    assert Valve.HOLD.value == (0.0, 0.0)
    assert Valve.FILL.value == (1.0, 0.0)


def test_torque_is_proportional_to_pressure(er24pc):
    assert braking_torque(er24pc.brake, 6.0 * BAR) == pytest.approx(60e3)
    assert braking_torque(er24pc.brake, 1.5 * BAR) == pytest.approx(15e3)


@pytest.mark.parametrize("time", [0.0, 0.03, 0.25, 1.1])
def test_pad_vibration_is_that_of_section_7(er24pc, time):
    # T_d = 0.05 T exp(-4 t) sin(10 pi t).
    printed = 0.05 * math.exp(-4.0 * time) * math.sin(10.0 * math.pi * time)
    assert torque_disturbance(er24pc.brake, time) == pytest.approx(printed, abs=1e-15)
