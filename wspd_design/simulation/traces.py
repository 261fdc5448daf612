"""Traces of a stop as a table, in full or on a grid of times."""

import re
from typing import TYPE_CHECKING, Any

from wspd_design.simulation.records import Run

if TYPE_CHECKING:
    from numpy.typing import NDArray


def traces(run: Run) -> "NDArray[Any]":
    """Return the traces of a stop as a table, one row a record, columns named with their unit."""
    import numpy as np

    columns = [("time_s", run.time), ("speed_m_s", run.speed), ("distance_m", run.distance)]
    for name, trace in (
        ("wheel_speed_rad_s", run.wheel_speed),
        ("slip", run.slip),
        ("torque_Nm", run.torque),
        ("wheel_load_N", run.wheel_load),
        ("dynamic_torque_Nm", run.dynamic_torque),
        ("pad_temperature_K", run.pad_temperature),
    ):
        if trace is not None:
            columns += [(f"{name}_{k + 1}", column) for k, column in enumerate(trace.T)]
    if run.track_brake_force is not None:
        columns.append(("track_brake_force_N", run.track_brake_force))
    table = np.zeros(len(run.time), dtype=[(name, "f8") for name, _ in columns])
    for name, column in columns:
        table[name] = column
    return table


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
