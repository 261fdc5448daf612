"""Gains of the laws of a vehicle that ask for a braking torque, by stated rules.

What limits such a law: a sample and the lag of the valve for the rate of approach, the noise of wheel speeds for the
observer, the torque that venting lets out for the braking curve. The slip that it holds decides most: a reference that
falls as 1/sqrt(v) runs beside the peaks of the rails that are known here.
"""

from wspd_design.analysis.stopping import demanded_adhesion
from wspd_design.controllers.protected import OBSERVER_RATE
from wspd_design.design.records import Gain, Specification
from wspd_design.model.slip import static_wheel_load
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import KMH
from wspd_design.simulation.peak import peak_adhesion

LAG_PART = 6.0  # part of the lag of the valve that the approach takes longer than a sample
UNKNOWN_RAIL = (
    0.16  # -, slip at 1 m/s between the peaks of the rails known here, on the side of the small slips
)
LARGEST_SLIP = 0.35  # -
AHEAD = 0.5  # -, a command acts in the middle of its sample
TIME_SHARE = (
    0.6  # of the nominal valve times: the fastest valve that full inversion does not drive beyond its target
)
DEAD_BAND_SHARE = 0.01  # of the full torque
DEAD_BAND_SLIP = 0.01  # -
CUT_OUT = 5.0 / KMH  # m/s
PEAK_POINTS = 12  # of the table of the peak


def tracking_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose the gains that all laws with a wanted torque have.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle, nominal values; the bounds of its valves count.
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
    gains = [
        Gain(
            name="falling_slip",
            value=UNKNOWN_RAIL,
            unit="-",
            why=f"c of c/sqrt(v) with v in m/s: the peaks of the known rails lie at c = 0.1 to 0.32; {UNKNOWN_RAIL:g} "
            "loses least over all of them, since beyond a peak friction falls and below it nothing is lost but slip",
        ),
        Gain(
            name="largest_slip",
            value=LARGEST_SLIP,
            unit="-",
            why="limit of c/sqrt(v), which has none at standstill",
        ),
        *(_peak(vehicle, rail, specification) if specification.reference == "peak" else ()),
        Gain(
            name="observer_rate",
            value=OBSERVER_RATE,
            unit="1/s",
            why=f"w_o = {OBSERVER_RATE:g} 1/s: friction is followed within {1e3 / OBSERVER_RATE:.0f} ms, faster than "
            "the approach; a faster observer passes on the noise of the wheel speed",
        ),
        Gain(
            name="valve_time_share",
            value=TIME_SHARE,
            unit="-",
            why=f"the inversion takes {TIME_SHARE:g} of the nominal valve times: a valve that is faster than the "
            "nominal one by so much does not go beyond the wanted torque",
        ),
        Gain(
            name="least_pulse",
            value=brake.shortest_pulse,
            unit="s",
            why="the shortest pulse that opens the valve"
            if brake.shortest_pulse
            else "the vehicle states no shortest pulse",
        ),
        Gain(
            name="cut_out_speed",
            value=CUT_OUT,
            unit="m/s",
            why=f"below {CUT_OUT * KMH:g} km/h the valves hold: slip poles are faster than any sample there",
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
            name="dead_band_slip",
            value=DEAD_BAND_SLIP,
            unit="-",
            why="a dead band of J k e is an error of the slip that grows as 1/v: at low speed it is narrowed to this "
            "slip",
        ),
    ]
    return tuple(gains)


def torque_slew(vehicle: Vehicle, rail: Rail, specification: Specification) -> Gain:
    """Choose the slew of the braking curve: what venting lets out at the torque that the rail holds."""
    import numpy as np

    brake = vehicle.brake
    slowest = brake.bounds.around("vent_time", brake.vent_time)[1]
    speeds = np.geomspace(*specification.speeds, PEAK_POINTS)
    adhesion = min(float(peak_adhesion(vehicle, rail, speeds)[1].min()), demanded_adhesion(vehicle))
    torque = 2.0 * float(static_wheel_load(vehicle)) * adhesion * vehicle.wheel_radius
    return Gain(
        name="torque_slew",
        value=torque / slowest,
        unit="N m/s",
        why=f"T/tau: {rail.name} carries {torque / 1e3:.3g} kN m per wheelset at its worst, and the slowest valve, "
        f"tau = {slowest:g} s, vents it at this rate; on the braking curve the pull falls no faster",
    )


def observer_smc_gains(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, ...]:
    """Choose the gains of the sliding mode through the observed friction; parameters as :func:`tracking_gains`."""
    return (
        *tracking_gains(vehicle, rail, specification),
        torque_slew(vehicle, rail, specification),
    )


def _peak(vehicle: Vehicle, rail: Rail, specification: Specification) -> tuple[Gain, Gain]:
    """Table of the slip at the peak of the design rail."""
    import numpy as np

    speeds = np.geomspace(CUT_OUT, specification.speeds[1], PEAK_POINTS)
    slips, _ = peak_adhesion(vehicle, rail, speeds)
    why = f"the adhesion of {rail.name} peaks there, under the static load"
    return (
        Gain(name="peak_speeds", value=tuple(map(float, speeds)), unit="m/s", why=why),
        Gain(name="peak_slips", value=tuple(map(float, slips)), unit="-", why=why),
    )
