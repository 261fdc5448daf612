"""Gains of the laws of a vehicle that ask for a braking torque, by stated rules.

What limits such a law: a sample and the lag of the valve for the rate of approach, the torque that venting lets out for
the braking curve.
"""

from typing import NamedTuple

from wspd_design.analysis.stopping import demanded_adhesion
from wspd_design.design.protection_gains import PEAK_POINTS, protection_gains
from wspd_design.design.records import Gain, Specification
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import KMH
from wspd_design.simulation.peak import peak_adhesion

LAG_PART = 6.0  # part of the lag of the valve that the approach takes longer than a sample
AHEAD = 0.5  # -, a command acts in the middle of its sample
TIME_SHARE, TIME_SHARE_RATE, LARGEST_TIME_SHARE = 0.55, 2.5, 0.8  # of the nominal valve times: -, 1/s, -
DEAD_BAND_SHARE = 0.03  # of the full torque
DEAD_BAND_SLIP_SHARE = 0.2  # of the desired slip
INTEGRAL_SHARE = 0.5
SURFACE_SHARE = 0.6
CURVE_SHARE = 0.25
"""Of the torque rate that the slowest valve can vent, for a braking curve beyond the peak. The friction falls while the
wheel slides on, the observer lags and the torque has errors: with all of the rate wheels run beyond their reference."""
BEYOND_PEAK = 2.0  # least slip of the reference over that of the peak for this share


def tracking_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose the gains that all laws with a wanted torque have.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle, nominal values.
    rail : Rail
        Design rail, for the table of the peak.
    specification : Specification
        Ranges, sample time and reference.

    Returns
    -------
    tuple of Gain
        Gains of the protection and of the tracking.
    """
    brake, period = vehicle.brake, specification.sample_time
    lag = max(brake.fill_time, brake.vent_time)
    rate = 1.0 / (period + lag / LAG_PART)
    share = round(min(TIME_SHARE + TIME_SHARE_RATE * period, LARGEST_TIME_SHARE), 3)
    return (
        *protection_gains(vehicle, rail, specification),
        Gain(
            name="valve_time_share",
            value=share,
            unit="-",
            why=f"the inversion takes {share:.2g} of the nominal valve times: a valve that is so much faster than "
            "the nominal one does not go beyond the wanted torque; more of it where a long sample makes each part of "
            "the way count",
        ),
        Gain(
            name="approach_rate",
            value=rate,
            unit="1/s",
            why=f"k = 1/(h + tau/{LAG_PART:g}): the error falls by a factor e within a sample, h = {period:g} s, and a "
            f"sixth of the lag of the valve, tau = {lag:g} s",
        ),
        Gain(
            name="ahead",
            value=AHEAD,
            unit="-",
            why="half a sample: pulses begin at its start, and the torque changes until they end",
        ),
        Gain(
            name="dead_band",
            value=DEAD_BAND_SHARE * brake.max_torque,
            unit="N m",
            why=f"{DEAD_BAND_SHARE:.0%} of the full torque: the valves rest while noise alone moves the wanted torque",
        ),
        Gain(
            name="dead_band_share",
            value=DEAD_BAND_SLIP_SHARE,
            unit="-",
            why="a dead band of J k e leaves an error e of the wheel speed: at low speed, where the wheel slides by "
            f"little, it is narrowed to {DEAD_BAND_SLIP_SHARE:.0%} of the desired slip",
        ),
    )


class VentedRate(NamedTuple):
    """Torque rate that the slowest valve can vent at the least torque that the rail carries."""

    torque: float  # N m
    slowest: float  # s
    why: str

    @property
    def rate(self) -> float:
        """T/tau [N m/s]."""
        return self.torque / self.slowest


def vented_rate(vehicle: Vehicle, rail: Rail, specification: Specification) -> VentedRate:
    """Return the torque rate that venting lets out for sure; parameters as :func:`tracking_gains`."""
    import numpy as np

    brake = vehicle.brake
    slowest = brake.bounds.around("vent_time", brake.vent_time)[1]
    speeds = np.geomspace(*specification.speeds, PEAK_POINTS)
    adhesion = min(float(peak_adhesion(vehicle, rail, speeds)[1].min()), demanded_adhesion(vehicle))
    torque = 2.0 * float(static_wheel_load(vehicle)) * adhesion * vehicle.wheel_radius
    why = (
        f"at T/tau the slowest valve, tau = {slowest:g} s, vents the {torque / 1e3:.3g} kN m that {rail.name} carries "
        "per wheelset at its worst"
    )
    return VentedRate(torque, slowest, why)


def torque_slew(vehicle: Vehicle, rail: Rail, specification: Specification) -> Gain:
    """Choose the slew of the braking curve, a share of what venting lets out; parameters as :func:`tracking_gains`."""
    import numpy as np

    vented, fastest = vented_rate(vehicle, rail, specification), specification.speeds[1]
    peak = float(peak_adhesion(vehicle, rail, np.array([fastest]))[0][0])
    if specification.reference == "constant" and specification.slip >= BEYOND_PEAK * peak:
        share, name = CURVE_SHARE, f"{CURVE_SHARE:g} T/tau"
        reason = (
            "the rest is for the lag of the observer, errors of the torque and the friction, which falls while the "
            f"wheel slides on beyond its peak at slip {peak:.2g}"
        )
    else:
        share, name = 1.0, "T/tau"
        reason = (
            f"only a constant reference beyond {BEYOND_PEAK:g} times the slip of the peak, {peak:.2g} at "
            f"{fastest * KMH:.3g} km/h, takes less of it: up to the peak a slower curve builds up the brake later"
        )
    return Gain(
        name="torque_slew",
        value=share * vented.rate,
        unit="N m/s",
        why=f"{name}, and on the braking curve the pull falls no faster: {vented.why}; {reason}",
    )


def observer_smc_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose the gains of the sliding mode through the observed friction; parameters as :func:`tracking_gains`."""
    return (
        *tracking_gains(vehicle, rail, specification),
        torque_slew(vehicle, rail, specification),
    )


def super_twisting_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose the gains of super-twisting; parameters as :func:`tracking_gains`."""
    common = tracking_gains(vehicle, rail, specification)
    rate = _rate(common)
    return (
        *common,
        Gain(
            name="integral_rate",
            value=INTEGRAL_SHARE * rate,
            unit="1/s",
            why=f"{INTEGRAL_SHARE:g} k: within the layer the poles are those of q^2 + k q + (k/2)^2, equal",
        ),
        _layer(vehicle, rail, specification, rate),
    )


def integral_smc_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose the gains of the integral sliding mode; parameters as :func:`tracking_gains`."""
    common = tracking_gains(vehicle, rail, specification)
    whole = _rate(common)
    rate = SURFACE_SHARE * whole
    layer = _layer(vehicle, rail, specification, whole)
    assert isinstance(layer.value, float)
    return (
        *(each for each in common if each.name != "approach_rate"),
        Gain(
            name="approach_rate",
            value=rate,
            unit="1/s",
            why=f"{SURFACE_SHARE:g} of the rate that sample and valve allow, {whole:.3g} 1/s; switching adds the rest",
        ),
        Gain(
            name="switching_gain",
            value=(whole - rate) * layer.value,
            unit="m/s^2",
            why="W = k_W Phi: within the layer the switching pulls at the rest of the rate, k_W = "
            f"{whole - rate:.3g} 1/s",
        ),
        layer,
    )


def _rate(gains: tuple[Gain, ...]) -> float:
    value = next(gain.value for gain in gains if gain.name == "approach_rate")
    assert isinstance(value, float)
    return value


def _layer(vehicle: Vehicle, rail: Rail, specification: Specification, rate: float) -> Gain:
    """Width of the layer: the error from which on the valve is too slow for k e, s/k^2 with all that it can vent."""
    vented = vented_rate(vehicle, rail, specification)
    return Gain(
        name="layer",
        value=vented.rate / vehicle.wheelset_inertia / rate**2 * vehicle.wheel_radius,
        unit="m/s",
        why=f"Phi = R s/k^2: beyond it the valve cannot let the pull fall as fast as k e would; s = "
        f"{vented.rate / 1e3:.3g} kN m/s over the inertia: {vented.why}",
    )
