"""A scenario in words."""

from collections.abc import Sequence

from wspd_design.simulation.law_memory import reference_range
from wspd_design.simulation.records import Fault, Scenario
from wspd_design.simulation.runs import Run

_FEW = 3  # changes of rail that are told one by one

_FAULTS = {
    "sensor-lost": "speed sensor of axle {axle} lost",
    "valve-holds": "valve of axle {axle} stuck holding",
    "valve-vents": "valve of axle {axle} stuck venting",
    "valve-fills": "valve of axle {axle} stuck filling",
}


def rails_of(stop: Scenario) -> str:
    """Say on which rails a stop runs, many changes in short."""
    if len(stop.patches) <= _FEW or stop.axle_rails:
        return every_rail_of(stop)
    names = list(dict.fromkeys((stop.rail.name, *(patch.rail.name for patch in stop.patches))))
    listed = " and ".join(filter(None, (", ".join(names[:-1]), names[-1])))
    return f"{1 + len(stop.patches)} stretches of {listed}"


def every_rail_of(stop: Scenario) -> str:
    """Say on which rails a stop runs, change by change."""
    names = "/".join(rail.name for rail in stop.axle_rails) if stop.axle_rails else stop.rail.name
    return ", ".join((names, *(f"{patch.rail.name} from {patch.start:g} m" for patch in stop.patches)))


def disturbances_of(stop: Scenario) -> str:
    """Say what disturbs a stop besides its rails; empty for nothing."""
    sensing = stop.sensing
    loads = stop.load_irregularity
    said = (
        (stop.grade, f"grade {1e3 * stop.grade:g} permille"),
        (stop.pad_vibration, "pad vibration"),
        (loads, f"wheel loads that vary by {100.0 * loads.spread:.2g} % rms" if loads else ""),
        (stop.irregularities != "none", f"track irregularities of ERRI B 176, {stop.irregularities} level"),
        (sensing.speed_noise, f"speed noise {sensing.speed_noise:g} m/s rms"),
        (
            sensing.pulses_per_turn,
            f"{sensing.pulses_per_turn} pulses per turn, {'timed' if sensing.period_timing else 'counted'}",
        ),
        (sensing.reference_error, f"reference error {100.0 * sensing.reference_error:g} %"),
        (sensing.reference_drift, f"reference drift {sensing.reference_drift:g} m/s2"),
        (sensing.reference_noise, f"reference noise {sensing.reference_noise:g} m/s rms"),
        (sensing.torque_error, f"torque error {100.0 * sensing.torque_error:g} %"),
        (sensing.accelerometer_bias, f"accelerometer bias {sensing.accelerometer_bias:g} m/s2"),
        (sensing.accelerometer_noise, f"accelerometer noise {sensing.accelerometer_noise:g} m/s2 rms"),
        (any(sensing.radius_errors), f"wheel radii wrong by {_percents(sensing.radius_errors)} %"),
        (sensing.dead_time, f"dead time {1e3 * (sensing.dead_time or 0.0):g} ms"),
        (sensing.shortest_pulse, f"shortest pulse {1e3 * (sensing.shortest_pulse or 0.0):g} ms"),
        *((True, fault_words(each)) for each in stop.faults),
    )
    return ", ".join(words for present, words in said if present)


def fault_words(fault: Fault) -> str:
    """Say what fails where, and from when on unless from the start."""
    since = f" from {fault.since:g} s on" if fault.since else ""
    return _FAULTS[fault.kind].format(axle=fault.axle) + since


def held_slip(run: Run, slip: float) -> str:
    """Say which slip a law holds: one for the whole stop, or a course of its own."""
    own = reference_range(run)
    if own is None or own[0] == own[1]:
        return f"{slip if own is None else own[0]:g}"
    low, high = (f"{each:.3g}" for each in own)
    return f"the law's own, {low} to {high}"


def _percents(shares: Sequence[float]) -> str:
    return ", ".join(f"{100.0 * share:g}" for share in shares)
