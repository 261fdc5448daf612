"""What a stop is judged by, worked out from its integrals."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wspd_design.model.number import Number
from wspd_design.model.valve_flow import ATMOSPHERE
from wspd_design.parameters.gear import static_shares
from wspd_design.parameters.later import later
from wspd_design.parameters.loading import constants
from wspd_design.parameters.records import Brake, Vehicle
from wspd_design.plants.names import plant_of
from wspd_design.plants.protocol import is_coupled
from wspd_design.simulation.held_slip import build_up, held_slip_of, perfect_hold
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.law_memory import rms_about_references
from wspd_design.simulation.peak import peak_adhesion
from wspd_design.simulation.records import Scenario, Start
from wspd_design.simulation.released import released_below
from wspd_design.simulation.runs import Ending, Run

if TYPE_CHECKING:
    from wspd_design.parameters.table import Table


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Metrics:
    """Figures of one stop. Slip figures count above 10 km/h, means are those of the wheelsets with a brake.

    What a law does not tell, the speed that it goes by and the slip that it holds, is NaN.

    Attributes
    ----------
    distance : float [m]
    stopping_time : float [s]
    torque_integral : float [N m s]
        Sum over wheelsets of the transmitted torque.
    build_up : float [s]
        Until the torque first reaches 90 % of what it then holds.
    build_up_distance : float [m]
        Until then.
    lag : float [s]
        2 d / v0 - t: with the plateau the two numbers of Table 10 in another form, no time of the brake.
    plateau : float [m/s2]
        V0 / (2 (t - d / v0)).
    slip_mean : float [-]
    slip_max : float [-]
    slip_rms : float [-]
        About the reference, or the slips that the law holds, with the build-up before it is reached.
    slip_reached : float [s]
        Until the first wheelset has 90 % of its reference; NaN if none has.
    held_slip_rms : float [-]
        Each wheelset from then on.
    slip_overshoot : float [-]
        Likewise, largest excess over the reference.
    slip_undershoot : float [-]
        Likewise, largest shortfall.
    perfect_slip_rms : float [-]
        Held_slip_rms of a brake that fills and then holds the reference; NaN if not known.
    lock_time : float [s]
    judged_lock : float [s]
        Longest lock of a wheelset without a break, above 10 km/h.
    slip_band : float [-]
        Largest distance of the slip from the law's own reference at samples, once it was reached.
    speed_error : float [-]
        Largest relative error above 20 km/h of the train speed that the law goes by.
    distance_error : float [-]
        Largest error of that speed's integral over 5 m + 5 %.
    saturated_share : float [-]
        Samples that fill or vent for the whole sample time.
    valve_switches : int
        Changes of the valve state.
    vented_air : float [-]
        Full brake cylinders let out, mean of the wheelsets.
    air_used : float [normal litres]
        That all cylinders took from the reservoir; NaN where their volume is not known.
    lowest_reservoir : float [Pa]
        Above the atmosphere, in a stop without refilling; NaN without a reservoir.
    watchdog_fills : int or None
        Times that a watchdog filled, all wheelsets; None without watchdogs.
    adhesion_utilization : float [-]
        Creep force over the force at the adhesion peak, mean over time.
    ideal_stop : float [m]
        Distance of the brake that holds the best slip; NaN where there is none.
    ideal_ending : Ending or None
        Of the ideal stop; None where it is not known.
    efficiency : float [-]
        Ideal stop over distance.
    released_below : float [m/s]
        Speed from which on the brake was let go until the end; NaN where it was not.
    momentum_residual : float [-]
        Relative to the initial momentum.
    energy_residual : float [-]
        Relative to the initial energy.
    """

    distance: float
    stopping_time: float
    torque_integral: float
    build_up: float
    build_up_distance: float
    lag: float
    plateau: float
    slip_mean: float
    slip_max: float
    slip_rms: float
    slip_reached: float
    held_slip_rms: float
    slip_overshoot: float
    slip_undershoot: float
    perfect_slip_rms: float
    lock_time: float
    judged_lock: float
    slip_band: float
    speed_error: float
    distance_error: float
    saturated_share: float
    valve_switches: int
    vented_air: float
    air_used: float
    lowest_reservoir: float
    watchdog_fills: int | None
    adhesion_utilization: float
    ideal_stop: float
    ideal_ending: Ending | None
    efficiency: float
    released_below: float
    momentum_residual: float
    energy_residual: float

    def __repr__(self) -> str:
        """Say the main figures in one line."""
        return f"<Metrics: {self.brief}>"

    @property
    def brief(self) -> str:
        """The main figures in words."""
        return (
            f"{self.distance:.1f} m in {self.stopping_time:.2f} s, efficiency {100.0 * self.efficiency:.0f} %, "
            f"slip rms {self.slip_rms:.3f}, wheels locked {self.lock_time:.2f} s"
        )

    def _repr_html_(self) -> str:
        return str(later("notebook.stops", "metrics_card")(self))

    def table(self) -> "Table":
        """Return all figures with their units."""
        table: Table = later("notebook.stops", "metrics_table")(self)
        return table


def metrics(run: Run, vehicle: Vehicle, scenario: Scenario, *, slip_reference: float) -> Metrics:
    """Judge a stop.

    Parameters
    ----------
    run : Run
        The stop.
    vehicle : Vehicle
        The vehicle it was simulated with.
    scenario : Scenario
        The stop it was.
    slip_reference : float
        Reference of ``slip_rms`` [-], unless the law tells the slips that it holds: then the rms is about those, at its
        samples.

    Returns
    -------
    Metrics
        A run that did not come to a standstill gives NaN for lag and plateau; so does one that did not start
        rolling with empty cylinders, or that came to another rail, whose ideal stop is not known either;
        nor is that of a coupled plant.
    """
    totals, time = run.totals, float(run.time[-1])
    stopped = run.ending is Ending.STOPPED
    judged = totals.judged_time
    mean = totals.slip / judged if judged else math.nan
    square = (
        totals.slip_squared / judged - 2.0 * slip_reference * mean + slip_reference**2 if judged else math.nan
    )
    own = rms_about_references(run)
    moved = totals.distance > 0.0  # a start below the stop speed is at rest at once
    known = scenario.start == Start() and not scenario.patches
    followed = known and not is_coupled(plant_of(run.plant, vehicle))  # by an ideal brake
    ideal = ideal_stop(vehicle, scenario, plant=run.plant) if followed else None
    ideal_distance = math.nan if ideal is None else ideal.distance
    parted = stopped and known and moved
    held = held_slip_of(run, slip_reference)
    perfect = (
        perfect_hold(vehicle, scenario, slip=slip_reference, plant=run.plant)
        if known and own is None
        else None
    )
    built_up, built_up_distance = build_up(run) if known else (math.nan, math.nan)
    commands = [(sample.fill, sample.vent) for samples in run.axle_samples for sample in samples]
    return Metrics(
        distance=totals.distance,
        stopping_time=time,
        torque_integral=totals.torque,
        build_up=built_up,
        build_up_distance=built_up_distance,
        lag=2.0 * totals.distance / run.initial_speed - time if parted else math.nan,
        plateau=run.initial_speed / (2.0 * (time - totals.distance / run.initial_speed))
        if parted
        else math.nan,
        slip_mean=mean,
        slip_max=run.slip_max,
        slip_rms=math.sqrt(max(square, 0.0)) if own is None else own,
        slip_reached=held.reached,
        held_slip_rms=held.rms,
        slip_overshoot=held.overshoot,
        slip_undershoot=held.undershoot,
        perfect_slip_rms=math.nan if perfect is None else perfect.rms,
        lock_time=totals.lock_time,
        judged_lock=totals.judged_lock,
        slip_band=totals.slip_band,
        speed_error=totals.speed_error,
        distance_error=totals.distance_error,
        saturated_share=sum(max(command) == 1.0 for command in commands) / len(commands)
        if commands
        else math.nan,
        valve_switches=round(totals.valve_switches),
        vented_air=totals.vented_pressure / vehicle.brake.max_pressure / valved_axles(vehicle),
        air_used=air_used(vehicle.brake, totals.filled_pressure),
        lowest_reservoir=lowest_reservoir(vehicle.brake, totals.filled_pressure),
        watchdog_fills=totals.watchdog_fills if vehicle.brake.longest_release else None,
        adhesion_utilization=adhesion_utilization(run, vehicle, scenario),
        ideal_stop=ideal_distance,
        ideal_ending=None if ideal is None else ideal.ending,
        efficiency=ideal_distance / totals.distance if stopped and moved else math.nan,
        released_below=released_below(run, vehicle, scenario),
        momentum_residual=momentum_residual(run, vehicle),
        energy_residual=energy_residual(run, vehicle),
    )


def air_used(brake: Brake, filled: Number) -> Number:
    """Air that cylinders take from the reservoir for pressures that add up to ``filled`` [Pa], in normal litres.

    A normal litre is one at the pressure of the standard atmosphere and the temperature of the cylinder.
    """
    return 1e3 * brake.cylinder_volume * filled / ATMOSPHERE if brake.cylinder_volume else math.nan


def lowest_reservoir(brake: Brake, filled: Number) -> Number:
    """Pressure of a reservoir that nothing refills after pressures that add up to ``filled`` were let in [Pa]."""
    if not brake.reservoir_volume:
        return math.nan
    return brake.supply_pressure - brake.cylinder_volume / brake.reservoir_volume * filled


def valved_axles(vehicle: Vehicle) -> int:
    """Return the number of wheelsets with a friction brake and its valves."""
    return sum(share > 0.0 for share in vehicle.brake_shares)


def adhesion_utilization(run: Run, vehicle: Vehicle, scenario: Scenario) -> float:
    """Impulse of the creep forces over that of the adhesion peak at each speed, under the static load [-].

    The adhesion of wheelsets without a brake cannot be used and does not count.

    NaN for a change of rail along the track, and for a train that is at rest at once.
    """
    import numpy as np

    if scenario.patches or len(run.time) == 1:
        return math.nan
    loads, rails = static_shares(vehicle), scenario.axle_rails or (scenario.rail,) * vehicle.wheelsets
    axles = [
        pair for pair, brakes in zip(zip(rails, loads, strict=True), vehicle.braked, strict=True) if brakes
    ]
    alike = axles[:1] if len(set(axles)) == 1 else axles
    peak = np.mean(
        [load * peak_adhesion(vehicle, rail, run.speed, load_share=load)[1] for rail, load in alike], axis=0
    )
    weight = vehicle.mass * constants().gravity * (len(axles) / vehicle.wheelsets)
    available = weight * float(np.trapezoid(peak, run.time))
    used = vehicle.mass * (run.initial_speed - float(run.speed[-1])) - run.totals.resistance_impulse
    return used / available


def momentum_residual(run: Run, vehicle: Vehicle) -> float:
    """What is missing in the balance behind Table 10, relative to the initial momentum.

    sum of the torque integrals = R m (v0 - v) + n I (omega0 - omega) - R int f_d dt - n int B omega dt for n
    wheels.
    """
    radius, inertia = vehicle.wheel_radius, vehicle.wheelset_inertia
    turning = float(run.wheel_speed[0, 0])  # all wheelsets start alike
    initial = radius * vehicle.mass * run.initial_speed + inertia * turning * len(run.final_wheel_speeds)
    final = radius * vehicle.mass * float(run.speed[-1]) + inertia * sum(run.final_wheel_speeds)
    taken = run.totals.torque + radius * run.totals.resistance_impulse + run.totals.damping_impulse
    return (initial - final - taken) / initial


def energy_residual(run: Run, vehicle: Vehicle) -> float:
    """What is missing in the balance of kinetic energy and work, relative to the initial energy."""
    turning = [float(run.wheel_speed[0, 0])] * len(run.final_wheel_speeds)
    initial = _kinetic_energy(vehicle, run.initial_speed, turning)
    final = _kinetic_energy(vehicle, float(run.speed[-1]), run.final_wheel_speeds)
    totals = run.totals
    work = totals.brake_work + totals.sliding_work + totals.resistance_work + totals.damping_work
    return (initial - final - work) / initial


def _kinetic_energy(vehicle: Vehicle, speed: float, wheel_speeds: Sequence[float]) -> float:
    turning = sum(0.5 * vehicle.wheelset_inertia * wheel_speed**2 for wheel_speed in wheel_speeds)
    return 0.5 * vehicle.mass * speed**2 + turning
