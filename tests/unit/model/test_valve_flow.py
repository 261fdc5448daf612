"""Orifices against the published answers of ISO 6358, and every valve and build-up against an integrated equation."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from wspd_design.model.brake import (
    Valve,
    demand_time,
    demanded_pressure,
    pressure_after,
)
from wspd_design.model.valve_flow import ATMOSPHERE, orifice_filled, orifice_vented

BAR = 1e5
NOZZLE = 0.528
VENTED = {3.0: 0.18177, 1.9: 0.50210, 1.0: 0.87162, 0.4: 1.23363}
"""Times over tau from 3.8 bar above the atmosphere down to a pressure [bar], case O7."""
FILLED = {1.0: 0.20776, 1.9: 0.39509, 3.0: 0.65014, 3.61: 0.86449}
"""Times over tau from empty up to a pressure, with a supply of 3.8 bar, case O8."""


def flow(ratio, critical):
    """Flow over the choked one, as ISO 6358 writes it."""
    beyond = (min(max(ratio, 0.0), 1.0) - critical) / (1.0 - critical)
    return 1.0 if beyond <= 0.0 else np.sqrt(max(0.0, 1.0 - beyond**2))


@pytest.mark.parametrize(("pressure", "time"), VENTED.items())
def test_known_times_of_venting(pressure, time):
    def above(elapsed):
        return orifice_vented(elapsed, 3.8 * BAR + ATMOSPHERE, 1.0, NOZZLE) - ATMOSPHERE - pressure * BAR

    assert brentq(above, 0.0, 3.0) == pytest.approx(time, abs=1e-5)


@pytest.mark.parametrize(("pressure", "time"), FILLED.items())
def test_known_times_of_filling(pressure, time):
    def above(elapsed):
        found = orifice_filled(elapsed, ATMOSPHERE, 3.8 * BAR + ATMOSPHERE, 1.0, NOZZLE)
        return found - ATMOSPHERE - pressure * BAR

    assert brentq(above, 0.0, 1.0) == pytest.approx(time, abs=1e-5)


@pytest.mark.parametrize("critical", [0.2, 0.4, 0.5 - 1e-9, 0.5, 0.5 + 1e-9, 0.5 + 4e-9, 0.528, 0.7])
def test_an_orifice_of_any_critical_ratio(critical):
    times = np.linspace(0.0, 1.5, 31)
    for start in (1.2 * BAR, 2.0 * BAR, 4.8 * BAR, 9.0 * BAR):
        run = solve_ivp(
            lambda _, p: -p / 0.3 * flow(ATMOSPHERE / p[0], critical),
            (0.0, 1.5),
            [start],
            t_eval=times,
            rtol=1e-11,
            atol=1e-6,
            max_step=0.01,
        )
        found = orifice_vented(times, start, 0.3, critical)
        np.testing.assert_allclose(found, run.y[0], rtol=2e-8)
        run = solve_ivp(
            lambda _, p: 9e5 / 0.3 * flow(p[0] / 9e5, critical),
            (0.0, 1.5),
            [start],
            t_eval=times,
            rtol=1e-11,
            atol=1e-6,
            max_step=0.01,
        )
        np.testing.assert_allclose(orifice_filled(times, start, 9e5, 0.3, critical), run.y[0], rtol=2e-8)


def test_an_orifice_empties_and_fills_in_finite_time_and_stays_there():
    assert orifice_vented(1e9, 8 * BAR, 0.3, NOZZLE) == pytest.approx(ATMOSPHERE, rel=1e-15)
    assert orifice_filled(1e9, 2 * BAR, 8 * BAR, 0.3, NOZZLE) == 8 * BAR
    assert orifice_filled(1.0, 8 * BAR, 5 * BAR, 0.3, NOZZLE) == 8 * BAR  # nothing flows back


@pytest.fixture
def brakes(er24pc):
    """Brakes of every build-up and valve; a slow orifice falls behind the demand."""
    base = replace(er24pc.brake, max_pressure=3.8 * BAR, hold_leak=0.05, vent_time=0.25)
    ramp = {"build_up": "electro-pneumatic", "build_up_delay": 0.4, "build_up_ramp": 1.5}
    orifice = {"valve": "orifice", "reservoir_pressure": 6.0 * BAR}
    kinds = {
        "main pipe, lag": {},
        "ramp, lag": ramp,
        "main pipe, orifice": {**orifice, "fill_time": 1.2},
        "ramp, quick orifice": {**orifice, **ramp, "fill_time": 0.3},
        "ramp, orifice that falls behind": {**orifice, **ramp, "fill_time": 2.4},
        "ramp, orifice that is slower from the start": {**orifice, **ramp, "fill_time": 4.0},
        "main pipe, orifice with its supply at the brake pressure": {"valve": "orifice", "fill_time": 0.9},
        "ramp, orifice with its supply at the brake pressure": {"valve": "orifice", **ramp, "fill_time": 1.1},
    }
    return {name: replace(base, **changes) for name, changes in kinds.items()}


def flow_rate(brake, reservoir, pressure):
    """Rate at which the valve alone would fill an orifice's cylinder [Pa/s]."""
    supply = reservoir + ATMOSPHERE
    return supply / brake.fill_time * flow((pressure + ATMOSPHERE) / supply, brake.critical_pressure_ratio)


def demand_rate(brake, time):
    if brake.build_up == "main-pipe":
        return brake.supply_rate * (brake.max_pressure - demanded_pressure(brake, time))
    rising = brake.build_up_delay <= time < brake.build_up_delay + brake.build_up_ramp
    return brake.max_pressure / brake.build_up_ramp if rising else 0.0


def solved(rate, span, pressure, *, until=None):
    options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-4, "max_step": 2e-3}
    return solve_ivp(lambda t, p: rate(t, p[0]), span, [pressure], events=until, **options)


def filled_by_orifice(brake, reservoir, begin, end, pressure):
    """Follow the demand as long as the flow allows, and the flow below it; no kink of the demand lies between."""
    time = begin
    while time < end:
        demand = demanded_pressure(brake, time)
        spare = flow_rate(brake, reservoir, demand) - demand_rate(brake, time)
        if pressure >= demand - 1e-3 and spare >= 0.0:  # it follows
            grid = np.linspace(time, end, 400)
            lacks = [
                k
                for k, t in enumerate(grid[:-1])
                if flow_rate(brake, reservoir, demanded_pressure(brake, t)) < demand_rate(brake, t)
            ]
            if not lacks:
                return max(float(demanded_pressure(brake, end)), pressure)
            time = brentq(
                lambda t: flow_rate(brake, reservoir, demanded_pressure(brake, t)) - demand_rate(brake, t),
                grid[lacks[0] - 1],
                grid[lacks[0]],
                xtol=1e-14,
            )
            time, pressure = time + 1e-9, float(demanded_pressure(brake, time))
            pressure += 1e-9 * flow_rate(brake, reservoir, pressure)
        meets = lambda t, p: p[0] - demanded_pressure(brake, t)  # noqa: E731
        meets.terminal, meets.direction = True, 1.0
        run = solved(lambda _, p: flow_rate(brake, reservoir, p), (time, end), pressure, until=meets)
        time, pressure = float(run.t[-1]), float(run.y[0, -1])
    return pressure


def filled_by_lag(brake, reservoir, begin, end, pressure):
    def rate(time, now):
        return max(min(demanded_pressure(brake, time), reservoir) - now, 0.0) / brake.fill_time

    return solved(rate, (begin, end), pressure).y[0, -1]


def integrated(brake, reservoir, begin, end, valve, pressure):
    """Pressure at the end by an integration that knows nothing of the closed forms."""
    if valve is Valve.HOLD:
        return solved(lambda _, p: -brake.hold_leak * p, (begin, end), pressure).y[0, -1]
    if valve is Valve.VENT and brake.valve == "lag":
        return solved(lambda _, p: -p / brake.vent_time, (begin, end), pressure).y[0, -1]
    if valve is Valve.VENT:
        b, tau = brake.critical_pressure_ratio, brake.vent_time
        run = solved(lambda _, p: -p / tau * flow(ATMOSPHERE / p, b), (begin, end), pressure + ATMOSPHERE)
        return run.y[0, -1] - ATMOSPHERE
    kinks = [brake.build_up_delay, brake.build_up_delay + brake.build_up_ramp]
    kinks.append(float(demand_time(brake, min(reservoir, brake.max_pressure))))
    times = sorted({begin, end, *(kink for kink in kinks if begin < kink < end)})
    for start, stop in pairwise(times):
        if brake.valve == "orifice":
            pressure = filled_by_orifice(brake, reservoir, start, stop, pressure)
        else:
            pressure = filled_by_lag(brake, reservoir, start, stop, pressure)
    return pressure


KINDS = (
    "main pipe, lag",
    "ramp, lag",
    "main pipe, orifice",
    "ramp, quick orifice",
    "ramp, orifice that falls behind",
    "ramp, orifice that is slower from the start",
    "main pipe, orifice with its supply at the brake pressure",
    "ramp, orifice with its supply at the brake pressure",
)


@pytest.mark.parametrize("low", [False, True], ids=["full reservoir", "low reservoir"])
@pytest.mark.parametrize("name", KINDS)
def test_random_patterns_against_an_integration(brakes, name, low):
    brake, random = brakes[name], np.random.default_rng(5)
    states = (Valve.FILL, Valve.VENT, Valve.HOLD)
    for _ in range(3):
        pressure, time = 0.0, 0.0
        for _ in range(8):
            valve = states[random.choice(3, p=(0.6, 0.2, 0.2))]
            reservoir = random.uniform(0.5, 3.5) * BAR if low else brake.supply_pressure
            end = time + random.uniform(0.02, 0.6)
            expected = integrated(brake, reservoir, time, end, valve, pressure)
            found = float(pressure_after(brake, valve, end, time, pressure, reservoir))
            assert found == pytest.approx(expected, abs=2e-9 * brake.max_pressure + 1e-3), (valve, time, end)
            # No command gives more than filling all along: what the bound of the shortest stop rests on.
            most = float(pressure_after(brake, Valve.FILL, end, 0.0, 0.0))
            assert found <= most * (1.0 + 1e-12)
            pressure, time = found, end
