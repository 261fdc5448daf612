"""Data frames of pandas and datasets of xarray, which the extra ``frames`` brings."""

from collections.abc import Sequence
from dataclasses import fields
from enum import Enum
from importlib import import_module
from importlib.util import find_spec
from typing import Any

from wspd_design.certificates.records import Certificate
from wspd_design.exchange.columns import unit_of, with_unit
from wspd_design.exchange.version import program_version
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.table import Table
from wspd_design.simulation.campaign import Campaign
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.trace_table import Traces

INSTALLATION = 'pip install "wspd-design[frames]"'


def frame_of_table(table: Table) -> Any:
    """Return the values of a table, columns named with their unit."""
    pandas = _library("pandas", "to_pandas")
    heads = [column.header for column in table.columns]
    return pandas.DataFrame([list(row) for row in table.rows], columns=heads)


def frame_of_traces(traces: Traces) -> Any:
    """Return traces over time [s]; ``attrs`` has the units and what was simulated."""
    pandas = _library("pandas", "to_pandas")
    frame = pandas.DataFrame({name: traces.table[name] for name in traces.units}).set_index("time_s")
    frame.attrs = {"units": dict(traces.units), **traces.about, "version": program_version()}
    return frame


def dataset_of_traces(traces: Traces) -> Any:
    """Return traces over time and wheelset, each variable with its unit."""
    import numpy as np

    xarray = _library("xarray", "to_xarray")
    grouped: dict[str, dict[int, str]] = {}
    for name in traces.units:
        base, _, number = name.rpartition("_")
        if number.isdigit() and base:
            grouped.setdefault(base, {})[int(number)] = name
        elif name != "time_s":
            grouped[name] = {0: name}
    wheelsets = sorted({number for places in grouped.values() for number in places} - {0})
    variables: dict[str, Any] = {}
    for base, places in grouped.items():
        unit = traces.units[next(iter(places.values()))] or "1"
        if set(places) == {0}:
            variables[base] = (("time",), traces.table[places[0]], {"units": unit})
            continue
        values = np.full((len(traces.table), len(wheelsets)), np.nan)  # no brake: nothing commanded
        for column, wheelset in enumerate(wheelsets):
            if wheelset in places:
                values[:, column] = traces.table[places[wheelset]]
        variables[base] = (("time", "wheelset"), values, {"units": unit})
    return xarray.Dataset(
        variables,
        coords={
            "time": ("time", traces.table["time_s"], {"units": "s"}),
            "wheelset": ("wheelset", wheelsets, {"long_name": "from 1 at the front"}),
        },
        attrs={**traces.about, "version": program_version()},
    )


def frame_of_campaign(campaign: Campaign) -> Any:
    """Return a row for each stop."""
    pandas = _library("pandas", "to_pandas")
    names = campaign.table.dtype.names or ()
    frame = pandas.DataFrame({with_unit(name): campaign.table[name] for name in names}).set_index("run")
    frame.attrs = {
        "units": {with_unit(name): unit_of(name) for name in names},
        "controller": campaign.controller,
        "rail": campaign.rail,
        "plant": campaign.plant,
        "version": program_version(),
    }
    return frame


def frame_of_trials(trials: Sequence[Trial]) -> Any:
    """Return a row for each stop with all its figures [SI units], as the record of the metrics names them."""
    pandas = _library("pandas", "to_pandas")
    rows = [
        {
            "controller": trial.run.controller,
            **{each.name: _plain(getattr(trial.metrics, each.name)) for each in fields(trial.metrics)},
            "sensitive": trial.check.sensitive,
            "spread": trial.check.spread,
            "unresolved": trial.check.unresolved,
            "ending": _plain(trial.run.ending),
        }
        for trial in trials
    ]
    return pandas.DataFrame(rows).set_index("controller")


def frame_of_proofs(certificates: Sequence[Certificate]) -> Any:
    """Return a row for each check."""
    pandas = _library("pandas", "to_pandas")
    rows = [
        {
            "check": each.name,
            "status": each.status.name,
            "title": each.title,
            "claim": each.claim,
            "margin_low": None if each.margin is None else each.margin.low,
            "margin_high": None if each.margin is None else each.margin.high,
            "margin_unit": "" if each.margin is None else each.margin.unit,
            "explanation": each.explanation,
        }
        for each in certificates
    ]
    return pandas.DataFrame(rows).set_index("check")


def _plain(value: Any) -> Any:
    return value.name.lower() if isinstance(value, Enum) else value


def _library(name: str, what: str) -> Any:
    if find_spec(name) is None:
        raise UserError(f"{what} needs {name}, which is not installed: {INSTALLATION}")
    return import_module(name)
