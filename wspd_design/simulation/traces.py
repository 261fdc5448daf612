"""Traces of a stop as a table: what was recorded, what the law saw, commanded and remembers, in full or on a grid."""

import math
import re
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from wspd_design.controllers.protocol import TRAIN_SPEED
from wspd_design.parameters.errors import UserError
from wspd_design.simulation.runs import Run, Sample
from wspd_design.simulation.trace_table import Traces

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wspd_design.simulation.runs import Trace

MOST_ROWS = 10_000_000
_SLACK = 1e-9  # s, by which a time on a grid may lie before its sample


def traces(run: Run) -> "NDArray[Any]":
    """Return what moves in a stop as a table, one row a record, columns named with their unit."""
    return _table({name: values for name, _, values in _moving(run)})


def traces_of(run: Run, *, every: float | None = None) -> Traces:
    """Return all traces of a stop.

    Parameters
    ----------
    run : Run
        The stop.
    every : float, optional
        Interval of a uniform grid of times from 0 to the end [s]; the recorded times by default.
    """
    import numpy as np

    time = run.time if every is None else _grid(float(run.time[-1]), every)
    columns, units = {"time_s": time}, {"time_s": "s"}
    for name, unit, values in _moving(run):
        if name != "time_s":
            columns[name] = values if every is None else np.interp(time, run.time, values)
            units[name] = unit
    for axle, samples in enumerate(run.axle_samples):
        if samples:
            pressure = run.cylinder_pressure[:, axle]
            columns[f"pressure_Pa_{axle + 1}"] = np.interp(time, run.time, pressure)
            units[f"pressure_Pa_{axle + 1}"] = "Pa"
            place = _last_sample(samples, time)
            for name, unit, read in _sampled(run, axle):
                columns[name] = np.array([read(sample) for sample in samples], dtype=np.float64)[place]
                units[name] = unit
    return Traces(table=_table(columns), units=units, about=about(run))


def about(run: Run) -> dict[str, str]:
    """Say what was simulated, for the head of a file."""
    return {
        "controller": run.controller,
        "vehicle": run.vehicle,
        "rail": run.rail,
        "plant": run.plant,
        "initial_speed_m_s": repr(run.initial_speed),
        "sample_time_s": repr(run.sample_time),
        "dead_time_s": repr(run.dead_time),
        "shortest_pulse_s": repr(run.shortest_pulse),
        "seed": str(run.seed),
        "ending": run.ending.name.lower(),
        "engine": run.engine,
    }


def on_a_grid(table: "NDArray[Any]", interval: float) -> "NDArray[Any]":
    """Return traces at multiples of an interval [s] and at the end, interpolated between their rows."""
    import numpy as np

    time = table["time_s"]
    grid = np.arange(0.0, time[-1], interval)
    found = np.zeros(len(grid) + 1, dtype=table.dtype)
    for name in table.dtype.names or ():
        found[name] = np.interp([*grid, time[-1]], time, table[name])
    return found


def trace_name(number: int, controller: str) -> str:
    """Return the name of the file with the traces of a stop of several; number 0 is that of the design."""
    plain = re.sub(r"[^a-z0-9]+", "-", controller.lower()).strip("-")
    return f"stop-{number + 1}{plain and '-'}{plain}.csv"


def check_interval(every: float) -> None:
    """Refuse an interval that is none."""
    if not 0.0 < every < math.inf:
        raise UserError(f"interval of the traces = {every:g} s must be finite and above 0; 0.01 is 10 ms")


def _grid(end: float, every: float) -> "Trace":
    import numpy as np

    check_interval(every)
    if end / every > MOST_ROWS:
        raise UserError(
            f"interval of the traces = {every:g} s makes {end / every:.2g} rows of a stop of {end:.4g} s; "
            "choose a longer one"
        )
    return every * np.arange(math.floor(end / every + _SLACK) + 1, dtype=np.float64)


def _moving(run: Run) -> "Iterator[tuple[str, str, Trace]]":
    """Name, unit and values of what moves between samples as well."""
    yield from (("time_s", "s", run.time), ("speed_m_s", "m/s", run.speed), ("distance_m", "m", run.distance))
    for name, unit, trace in (
        ("wheel_speed_rad_s", "rad/s", run.wheel_speed),
        ("slip", "", run.slip),
        ("torque_Nm", "N m", run.torque),
        ("wheel_load_N", "N", run.wheel_load),
        ("dynamic_torque_Nm", "N m", run.dynamic_torque),
        ("pad_temperature_K", "K", run.pad_temperature),
    ):
        if trace is not None:
            yield from ((f"{name}_{k + 1}", unit, column) for k, column in enumerate(trace.T))
    for name, trace in run.further.items():
        unit = run.further_units[name]
        yield from (
            (f"{name}_{unit.replace(' ', '')}_{k + 1}", unit, column) for k, column in enumerate(trace.T)
        )
    if run.track_brake_force is not None:
        yield "track_brake_force_N", "N", run.track_brake_force


def _sampled(run: Run, axle: int) -> Iterator[tuple[str, str, Callable[[Sample], float]]]:
    """Name, unit and value of what a law saw of a wheelset, decided about it and remembers."""
    number = axle + 1
    if axle == run.first_braked:
        yield "told_speed_m_s", "m/s", lambda sample: float(sample.seen.speed)
    yield f"told_wheel_speed_rad_s_{number}", "rad/s", lambda sample: float(sample.seen.wheel_speed)
    yield f"told_torque_Nm_{number}", "N m", lambda sample: float(sample.seen.torque)
    yield f"fill_{number}", "", lambda sample: sample.fill
    yield f"vent_{number}", "", lambda sample: sample.vent
    if run.shared_state and axle != run.first_braked:
        return
    states = len(run.axle_samples[axle][0].state)
    names = run.memory if len(run.memory) == states else tuple(f"state_{k + 1}" for k in range(states))
    for place, name in enumerate(names):
        unit = "m/s" if name == TRAIN_SPEED else ""
        plain = re.sub(r"\W+", "_", name) + ("_m_s" if unit else "")
        key = f"law_{plain}" if run.shared_state else f"law_{plain}_{number}"
        yield key, unit, lambda sample, place=place: float(sample.state[place])  # type: ignore[misc]


def _last_sample(samples: tuple[Sample, ...], time: "Trace") -> "NDArray[np.intp]":
    import numpy as np

    times = np.array([sample.time for sample in samples])
    return np.maximum(np.searchsorted(times, time + _SLACK, side="right") - 1, 0)


def _table(columns: "dict[str, Trace]") -> "NDArray[Any]":
    import numpy as np

    table = np.zeros(len(columns["time_s"]), dtype=[(name, "f8") for name in columns])
    for name, column in columns.items():
        table[name] = column
    return table
