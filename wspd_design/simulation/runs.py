"""What comes out of a simulated stop."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, NamedTuple

from wspd_design.controllers.protocol import Measurement
from wspd_design.parameters.later import later
from wspd_design.parameters.units import KMH

if TYPE_CHECKING:
    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from wspd_design.simulation.trace_table import Traces

    Trace = NDArray[np.float64]


class Ending(Enum):
    """How a run ended; the value says what it means to the reader."""

    STOPPED = "the train came to a standstill"
    TIME_LIMIT = (
        "the train was still moving at the time limit; more brake torque, another controller "
        "or a lower initial speed is needed"
    )
    RUNAWAY = (
        "no brake can stop this train: the grade pulls harder than rail and resistance can hold; only its first "
        "seconds were simulated"
    )


class Sample(NamedTuple):
    """What a law saw of one wheelset and did with it at one sampling instant."""

    time: float  # s
    fill: float  # share of the sample time
    vent: float
    state: tuple[float, ...]  # after it; of a law of the vehicle that of all wheelsets
    seen: Measurement


@dataclass(frozen=True, slots=True, kw_only=True)
class Totals:
    """Integrals over a run; torques and their work are sums over all wheelsets.

    Attributes
    ----------
    distance : float [m]
    torque : float [N m s]
        Transmitted braking torque.
    resistance_impulse : float [N s]
    damping_impulse : float [N m s]
        Sum over wheels.
    brake_work : float [J]
    sliding_work : float [J]
    resistance_work : float [J]
    damping_work : float [J]
    lock_time : float [s]
        Longest of the wheelsets.
    judged_time : float [s]
        Above the judging speed.
    slip : float [s]
        Integral of the slip over the judged time, mean of the wheelsets with a brake.
    slip_squared : float [s]
    vented_pressure : float [Pa]
        Sum over all vents of all wheelsets with a brake of the pressure let out.
    valve_switches : float
        Changes of the valve state that the commands ask for, mean of the wheelsets with a brake.
    filled_pressure : float [Pa]
        Sum over all fillings of all wheelsets with a brake of the pressure let in.
    watchdog_fills : int
        Times that the watchdog of a wheelset with a brake filled.
    judged_lock : float [s]
        Longest lock of a wheelset without a break, above the judging speed.
    slip_band : float [-]
        As of Metrics; NaN as well.
    speed_error : float
    distance_error : float
    """

    distance: float
    torque: float
    resistance_impulse: float
    damping_impulse: float
    brake_work: float
    sliding_work: float
    resistance_work: float
    damping_work: float
    lock_time: float
    judged_time: float
    slip: float
    slip_squared: float
    vented_pressure: float
    valve_switches: float
    filled_pressure: float
    watchdog_fills: int
    judged_lock: float
    slip_band: float
    speed_error: float
    distance_error: float


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Run:
    """A simulated stop. Traces are arrays over time; those of a wheelset have a second axis, front axle first.

    The quarter plant has one wheelset that stands for all.

    Attributes
    ----------
    controller : str
    vehicle : str
    rail : str
    plant : str
    sample_time : float [s]
    dead_time : float [s]
        That the valves had.
    shortest_pulse : float [s]
        Likewise.
    initial_speed : float [m/s]
    seed : int
        Of what was random.
    wheel_radius : float [m]
    ending : Ending
    time : ndarray [s]
    speed : ndarray [m/s]
    distance : ndarray [m]
    wheel_speed : ndarray [rad/s]
        Per wheelset.
    slip : ndarray [-]
        Per wheelset.
    torque : ndarray [N m]
        Per wheelset, transmitted; 0 without a brake.
    wheel_load : ndarray [N]
        Per wheelset: load of one of its wheels.
    cylinder_pressure : ndarray [Pa]
        Above the atmosphere, per wheelset; 0 without a friction brake.
    axle_samples : tuple[tuple[Sample, ...], ...]
        Per wheelset; none of one without a brake.
    totals : Totals
    final_wheel_speeds : tuple[float, ...] [rad/s]
        Of all wheelsets.
    slip_max : float [-]
        Above the judging speed.
    engine : str
        What computed it.
    shared_state : bool
        Whether the state in the samples of a wheelset is that of all of them.
    memory : tuple[str, ...]
        Names of the states in the samples, as far as the law tells them.
    dynamic_torque : ndarray or None [N m]
        Per wheelset, of an electrodynamic brake, within ``torque``.
    pad_temperature : ndarray or None [K]
        Above that before the stop, per wheelset, where friction depends on it.
    track_brake_force : ndarray or None [N]
        Of the magnets of the vehicle.
    further : Mapping[str, ndarray] [those of ``further_units``]
        Per wheelset, what a coupled plant adds.
    further_units : Mapping[str, str]
        Unit of each trace of ``further``.
    """

    controller: str
    vehicle: str
    rail: str
    plant: str
    sample_time: float
    dead_time: float
    shortest_pulse: float
    initial_speed: float
    seed: int
    wheel_radius: float
    ending: Ending
    time: "Trace"
    speed: "Trace"
    distance: "Trace"
    wheel_speed: "Trace"
    slip: "Trace"
    torque: "Trace"
    wheel_load: "Trace"
    cylinder_pressure: "Trace"
    axle_samples: tuple[tuple[Sample, ...], ...]
    totals: Totals
    final_wheel_speeds: tuple[float, ...]
    slip_max: float
    engine: str
    shared_state: bool = False
    memory: tuple[str, ...] = ()
    dynamic_torque: "Trace | None" = None
    pad_temperature: "Trace | None" = None
    track_brake_force: "Trace | None" = None
    further: "Mapping[str, Trace]" = field(default_factory=dict)
    further_units: Mapping[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        """Say in one line what became of the stop."""
        return (
            f"<Run {self.controller} on {self.rail}, {self.train}, from {KMH * self.initial_speed:g} km/h: "
            f"{self.totals.distance:.1f} m in {float(self.time[-1]):.2f} s, {self.ending.name.lower()}; "
            f"traces of {len(self.time)} rows>"
        )

    def _repr_html_(self) -> str:
        return str(later("notebook.stops", "run_card")(self))

    def plot(self, what: str = "slip", *, ax: "Axes | None" = None) -> "Axes":
        """Plot a trace of every wheelset over time.

        Parameters
        ----------
        what : {"slip", "speed", "torque", "pressure", "load", "valve", "estimate"}
            Which trace; an estimate is the train speed that a law works out, beside the true one.
        ax : Axes, optional
            Where to draw; new axes by default.

        Returns
        -------
        Axes
            With units at both axes; nothing is shown or saved.

        Raises
        ------
        UserError
            If there is no such trace.
        """
        axes: Axes = later("plotting.stops", "plot_run")(self, what, ax=ax)
        return axes

    def resampled(self, *, every: float) -> "Traces":
        """Return all traces on a uniform grid of times: also commands, pressures and what the law remembers.

        Parameters
        ----------
        every : float
            Interval [s].

        Returns
        -------
        Traces
            Columns with units; what a law commands and remembers is held from one sample to the next.

        Raises
        ------
        UserError
            If the interval is not above zero, or so short that there would be more than ten million rows.
        """
        traces: Traces = later("simulation.traces", "traces_of")(self, every=every)
        return traces

    def traces(self) -> "Traces":
        """Return all traces at the times at which they were recorded; otherwise as :meth:`resampled`."""
        traces: Traces = later("simulation.traces", "traces_of")(self)
        return traces

    @property
    def train(self) -> str:
        """Vehicle and plant, as sentences name them."""
        return f"{self.vehicle} ({self.plant})"

    @property
    def samples(self) -> tuple[Sample, ...]:
        """Samples of the first wheelset with a brake."""
        return self.axle_samples[self.first_braked]

    @property
    def first_braked(self) -> int:
        """Place of the first wheelset with a brake, from 0 at the front; 0 if the train was at rest at once."""
        return next((axle for axle, samples in enumerate(self.axle_samples) if samples), 0)
