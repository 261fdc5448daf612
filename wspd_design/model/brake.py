"""Pressure and torque of the electro-pneumatic brake, eqs. (8)-(14), for the records of a brake.

Two kinds of build-up say what pressure is demanded after the brake was applied, two kinds of valve how the cylinder
follows; the words in the record choose among them, its numbers may be of any kind. Nothing flows back from a cylinder
while it fills: where the supply is below its pressure, the cylinder keeps it. All pressures are above the atmosphere.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import Enum

from wspd_design.model.generated import brake as generated
from wspd_design.model.generated import valve_flow
from wspd_design.model.number import Number, clip, exp, log, maximum, minimum, sin, sqrt, where
from wspd_design.model.valve_flow import ATMOSPHERE, flow_share, orifice_filled, orifice_vented
from wspd_design.parameters.records import Brake

_NEVER = 1e300  # s
_HALF_PI = math.pi / 2.0
_PARTS = 4000  # of the filling through an orifice, whose lateness is a sum
_TRIALS = 12  # of a search for a kink, which a microsecond does not matter to


class Valve(Enum):
    """States of the valve pair (EV, BV), Table 2; the value is (fill, vent) of eq. (9)."""

    FILL = (1.0, 0.0)
    VENT = (0.0, 1.0)
    HOLD = (0.0, 0.0)


def pressure_after(
    brake: Brake,
    valve: Valve,
    time: Number,
    start_time: Number,
    start_pressure: Number,
    reservoir: Number | None = None,
) -> Number:
    """Cylinder pressure while the valve stays in one state since ``start_time``, exactly.

    Parameters
    ----------
    brake : Brake
        Build-up and valves.
    valve : Valve
        State of the valve since ``start_time``.
    time, start_time : number
        Time since the start of braking [s].
    start_pressure : number
        Cylinder pressure at ``start_time`` [Pa].
    reservoir : number, optional
        Pressure of the reservoir, as long as the valve stays in this state [Pa]; that at the start by default.

    Returns
    -------
    number
        Pressure [Pa].
    """
    match valve:
        case Valve.FILL:
            return filled_pressure(brake, time, start_time, start_pressure, reservoir)
        case Valve.VENT:
            return _vented(brake, time - start_time, 0.0, start_pressure)
        case Valve.HOLD:
            return (
                _vented(brake, 0.0, time - start_time, start_pressure) if brake.hold_leak else start_pressure
            )


def pattern_pressure(
    brake: Brake,
    time: Number,
    pattern: tuple[Number, ...],
    before: Number = 0.0,
    *,
    share: Number | None = None,
) -> tuple[Number, Number]:
    """Cylinder pressure under fill, then vent, then hold.

    Parameters
    ----------
    brake : Brake
        Build-up and valves.
    time : number
        On the clock of the pattern [s].
    pattern : tuple of five numbers
        Start of the pattern [s], cylinder pressure there [Pa], end of filling, end of venting [s], and the pressure of
        the reservoir all along [Pa].
    before : number
        Time from the start of braking to the zero of that clock [s].
    share : number, optional
        Of the demanded pressure, that another brake leaves to this one. A cylinder that has more when the pattern
        begins is let down to it while it fills, with the time constant of filling.

    Returns
    -------
    tuple of numbers
        Pressure, and what it would be without what was vented and what leaked [Pa].
    """
    start, start_pressure, fill_end, vent_end, reservoir = pattern
    if brake.valve == "lag" and not brake.reservoir_volume:
        reservoir = None  # it never gets below the demanded pressure

    asked = _asked(brake, share)

    def filled_until(end: Number) -> Number:
        rising = filled_pressure(asked, end + before, start + before, start_pressure, reservoir)
        if share is None:
            return rising
        left = demanded_pressure(asked, start + before)
        return where(start_pressure > left, _approached(brake, end, start, start_pressure, left), rising)

    filled = filled_until(minimum(time, fill_end))
    vented_for = maximum(minimum(time, vent_end) - fill_end, 0.0)
    held_for = maximum(time - vent_end, 0.0)
    if brake.valve == "lag":
        return _vented(brake, vented_for, held_for, filled), filled
    after = _vented(brake, vented_for, held_for, filled_until(fill_end))
    return where(time > fill_end, after, filled), filled


def _asked(brake: Brake, share: Number | None) -> Brake:
    """The brake of which a share of the demanded pressure is asked."""
    return brake if share is None else replace(brake, max_pressure=share * brake.max_pressure)


def kinks(
    brake: Brake, pattern: tuple[Number, ...], before: Number = 0.0, *, share: Number | None = None
) -> tuple[Number, ...]:
    """Times at which the rate of a filling cylinder's pressure jumps, so that no step goes across one.

    Parameters
    ----------
    brake, pattern, before, share
        As of :func:`pattern_pressure`.

    Returns
    -------
    tuple of numbers
        On the clock of the pattern [s], as many as this kind of brake may have; far beyond where there is none.
    """
    if brake.valve == "lag":  # its rate follows pressures that have no jumps
        return ()
    start, start_pressure, fill_end, _, reservoir = pattern
    brake, begin = _asked(brake, share), start + before
    end = begin + minimum(fill_end - start, _HALF_PI * brake.fill_time)  # it is full or at the demand by then
    way = _Way(brake, begin, start_pressure, reservoir)
    apart = minimum(maximum(way.falls_behind, begin), end)
    found = [_crossing(way.above_demand, *ends) for ends in ((begin, apart), (apart, end))]
    if brake.build_up == "electro-pneumatic":
        found += [brake.build_up_delay, demand_time(brake, brake.max_pressure)]
    return tuple(time - before for time in found)


def _crossing(value: Callable[[Number], Number], low: Number, high: Number) -> Number:
    """Where a function gets above zero between two places, by false position; far beyond where it does not."""
    below, above = value(low), value(high)
    there = where(below < 0.0, above > 0.0, 0.0)
    for _ in range(_TRIALS):
        place = (low * above - high * below) / where(above - below > 0.0, above - below, 1.0)
        found = value(place)
        up = found > 0.0
        # The end that stays counts half, so that both ends move (Illinois).
        low, high = where(up, low, place), where(up, place, high)
        below, above = where(up, 0.5 * below, found), where(up, found, 0.5 * above)
    return where(there, where(up, high, low), _NEVER)


def demanded_pressure(brake: Brake, time: Number) -> Number:
    """Pressure that the build-up of the brake demands, a time [s] after the start of braking [Pa]."""
    if brake.build_up == "main-pipe":
        return generated.supply_pressure(time, brake.max_pressure, brake.supply_rate)
    return brake.max_pressure * clip((time - brake.build_up_delay) / brake.build_up_ramp, 0.0, 1.0)


def demand_time(brake: Brake, pressure: Number) -> Number:
    """Time after which the build-up demands a pressure, from 0 up to the full one [s]."""
    share = pressure / brake.max_pressure
    if brake.build_up == "main-pipe":
        below = share < 1.0
        return where(below, -log(where(below, 1.0 - share, 1.0)) / brake.supply_rate, _NEVER)
    return brake.build_up_delay + share * brake.build_up_ramp


def build_up_delay(brake: Brake) -> float:
    """Time by which a sudden full pressure could come later for the same impulse of the filling cylinder [s]."""
    if brake.build_up == "main-pipe":
        demand = 1.0 / brake.supply_rate
    else:
        demand = brake.build_up_delay + brake.build_up_ramp / 2.0
    if brake.valve == "lag":
        return demand + brake.fill_time
    # An orifice has filled after b + (1 - b) pi/2 of its time at most; from then on the demand alone counts.
    last = (
        0.0 if brake.build_up == "main-pipe" else demand_time(brake, brake.max_pressure)
    ) + _HALF_PI * brake.fill_time
    step = last / _PARTS
    lacks = [
        demanded_pressure(brake, k * step) - filled_pressure(brake, k * step, 0.0, 0.0)
        for k in range(_PARTS + 1)
    ]
    return float(demand + step * (math.fsum(lacks) - lacks[-1] / 2.0) / brake.max_pressure)


def filled_pressure(
    brake: Brake, time: Number, start_time: Number, start_pressure: Number, reservoir: Number | None = None
) -> Number:
    """Cylinder pressure while filling since ``start_time``; arguments as of :func:`pressure_after` [Pa]."""
    if brake.valve == "orifice":
        supply = brake.supply_pressure if reservoir is None else reservoir
        return _Way(brake, start_time, start_pressure, supply).pressure(time)
    if brake.build_up == "electro-pneumatic":
        top = brake.max_pressure if reservoir is None else minimum(reservoir, brake.max_pressure)
        return _filled_from_ramp(brake, time, start_time, start_pressure, top)

    def rising(until: Number) -> Number:
        return generated.filled_pressure(
            until, start_time, start_pressure, brake.max_pressure, brake.supply_rate, brake.fill_time
        )

    if reservoir is None:
        return rising(time)
    reached = demand_time(brake, reservoir)
    begin = maximum(start_time, reached)
    late = _approached(brake, time, begin, rising(begin), reservoir)
    return where(time > reached, maximum(late, start_pressure), rising(time))


def _approached(
    brake: Brake, time: Number, start_time: Number, start_pressure: Number, supply: Number
) -> Number:
    elapsed = maximum(time - start_time, 0.0)
    return valve_flow.approached_pressure(elapsed, start_pressure, supply, brake.fill_time)


def _filled_from_ramp(brake: Brake, time: Number, start_time: Number, start: Number, top: Number) -> Number:
    """Through the lag from a demand that rises evenly up to ``top`` and stays there."""
    rate, begin = brake.max_pressure / brake.build_up_ramp, brake.build_up_delay
    end = begin + top / rate

    def on_ramp(until: Number) -> Number:
        from_time = clip(start_time, begin, end)
        return valve_flow.ramp_filled_pressure(
            clip(until, from_time, end), from_time, start, begin, rate, brake.fill_time
        )

    late = _approached(brake, time, maximum(start_time, end), on_ramp(end), top)
    return maximum(where(time > end, late, on_ramp(time)), start)


@dataclass(frozen=True, slots=True)
class _Way:
    """A cylinder that an orifice fills from a reservoir, never above what the build-up demands.

    A cylinder at the demanded pressure follows it as long as the orifice passes what that takes, and falls behind
    from one moment on. The pressure is the least of what the orifice makes of the start, what it makes of that moment,
    and the demand: docs/theory.md#orifice.
    """

    brake: Brake
    start_time: Number
    start: Number
    supply: Number

    @property
    def falls_behind(self) -> Number:
        """Moment from which on the demand rises faster than the orifice passes [s]."""
        return demand_time(self.brake, _falling_behind(self.brake, self.supply))

    def passed(self, time: Number) -> Number:
        """Pressure without the limit of the present demand [Pa]; far beyond where only the demand counts."""
        behind, since = _falling_behind(self.brake, self.supply), self.falls_behind
        on_the_way = where(self.start_time <= since, time > since, 0.0)
        late = where(on_the_way, self._through(time, since, behind), _NEVER)
        return minimum(self._through(time, self.start_time, self.start), late)

    def _through(self, time: Number, since: Number, pressure: Number) -> Number:
        brake, elapsed = self.brake, maximum(time - since, 0.0)
        here, supply = pressure + ATMOSPHERE, self.supply + ATMOSPHERE
        return (
            orifice_filled(elapsed, here, supply, brake.fill_time, brake.critical_pressure_ratio) - ATMOSPHERE
        )

    def above_demand(self, time: Number) -> Number:
        """What the orifice would make of the cylinder above the demand [Pa]; below 0 where the orifice counts."""
        return self.passed(time) - demanded_pressure(self.brake, time)

    def pressure(self, time: Number) -> Number:
        """Pressure of the cylinder [Pa]."""
        return maximum(minimum(self.passed(time), demanded_pressure(self.brake, time)), self.start)


def _falling_behind(brake: Brake, supply: Number) -> Number:
    """Pressure above which the orifice passes less than the demand rises; 0 where it always does [Pa].

    On the ellipse the flow is ``flow`` cos(theta), at the pressure (b + (1 - b) sin(theta)) times the supply; there the
    demand rises with ``least`` - ``bend`` sin(theta).
    """
    ratio, full = brake.critical_pressure_ratio, supply + ATMOSPHERE
    flow = full / brake.fill_time
    if brake.build_up == "main-pipe":
        bend = brake.supply_rate * (1.0 - ratio) * full
        least = brake.supply_rate * (brake.max_pressure + ATMOSPHERE - ratio * full)
    else:
        bend, least = 0.0, brake.max_pressure / brake.build_up_ramp
    square = flow * flow + bend * bend - least * least
    sine = (bend * least + flow * sqrt(maximum(square, 0.0))) / (flow * flow + bend * bend)
    pressure = full * (ratio + (1.0 - ratio) * sine) - ATMOSPHERE
    found = where(square > 0.0, clip(pressure, 0.0, brake.max_pressure), 0.0)
    if (
        brake.build_up == "main-pipe"
    ):  # its demand ends its rise at the full pressure, and so does its need of flow
        return where(supply < brake.max_pressure, found, brake.max_pressure)
    return found


def _vented(brake: Brake, vented_for: Number, held_for: Number, start: Number) -> Number:
    """Cylinder pressure after venting and then holding."""
    if brake.valve == "lag":
        return valve_flow.released_pressure(vented_for, held_for, start, brake.vent_time, brake.hold_leak)
    ratio = brake.critical_pressure_ratio
    vented = orifice_vented(vented_for, start + ATMOSPHERE, brake.vent_time, ratio) - ATMOSPHERE
    return vented * exp(-brake.hold_leak * held_for)


def flow_rates(brake: Brake, pressure: Number) -> tuple[Number, Number]:
    """Rates at which the open valves fill and vent a cylinder under full demand and a full reservoir [Pa/s].

    Parameters
    ----------
    brake : Brake
        Valves.
    pressure : number
        Of the cylinder, below the full one [Pa].
    """
    if brake.valve == "lag":
        return (brake.max_pressure - pressure) / brake.fill_time, pressure / brake.vent_time
    ratio = brake.critical_pressure_ratio
    here, supply = pressure + ATMOSPHERE, brake.supply_pressure + ATMOSPHERE
    filling = supply / brake.fill_time * flow_share(here / supply, ratio)
    return filling, here / brake.vent_time * flow_share(ATMOSPHERE / here, ratio)


def braking_torque(brake: Brake, pressure: Number) -> Number:
    """Torque per wheelset of a cylinder pressure [Pa], eq. (12) with constant pad friction [N m]."""
    return generated.braking_torque(pressure, brake.max_torque, brake.max_pressure)


def torque_disturbance(brake: Brake, time: Number) -> Number:
    """Vibration of the pads at the onset of braking, T_d / T of Section 7 [-]."""
    decay = exp(-brake.disturbance_decay * time)
    return brake.disturbance_gain * decay * sin(2.0 * math.pi * brake.disturbance_frequency * time)
