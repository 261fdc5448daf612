"""Statements about many drawn stops: ``assert_stops("mine.toml", within="900 m", locked_below="0.5 s")``."""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from wspd_design.design.case import Case, CaseOptions, case_of, load_case
from wspd_design.design.records import Design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import load_entries
from wspd_design.parameters.units import Dimension, parse_quantity
from wspd_design.simulation.campaign import Campaign, simulate_many, whole
from wspd_design.simulation.draws import within_bounds_of_stop
from wspd_design.simulation.records import Scenario
from wspd_design.testing.running import located, record

if TYPE_CHECKING:
    from numpy.typing import NDArray

_TOLD = 3  # runs that a failure names, the worst first


def assert_stops(
    design: Design | str | Path,
    *,
    within: str | None = None,
    locked_below: str | None = None,
    runs: int = 100,
    seed: int = 0,
    speed: str | None = None,
    vehicle: str | Path | None = None,
    rail: str | Path | None = None,
) -> Campaign:
    """Assert that drawn stops keep limits: the stops of ``wspd simulate DESIGN --runs RUNS --seed SEED``.

    Every number of vehicle and rail that has bounds is drawn anew for each stop. What is not drawn is not covered.

    Parameters
    ----------
    design : Design, str or Path
        A design, its file, a controller's name or ``FILE.py:NAME``.
    within : str, optional
        Longest stopping distance that is allowed, such as ``"900 m"``.
    locked_below : str, optional
        Time that no wheel may be locked for above 10 km/h without a break, such as ``"0.5 s"``.
    runs : int
        Number of stops.
    seed : int
        Of all that is drawn, and of the noise.
    speed : str, optional
        Initial speed, such as ``"160 km/h"``; the top of the design's range by default.
    vehicle, rail : str or Path, optional
        Shipped names or files, whose bounds are drawn within; those of the design by default.

    Returns
    -------
    Campaign
        One row for each stop.

    Raises
    ------
    AssertionError
        If a stop misses a limit, or its train does not come to a standstill; the message names the worst ones.
    UserError
        If no limit is given, or a limit, a name or a file is wrong.
    """
    __tracebackhide__ = True  # pytest shows the line of the user's test
    try:
        limits, case, campaign = _simulated(design, within, locked_below, runs, seed, speed, vehicle, rail)
    except UserError as error:
        raise UserError(str(error)) from None  # the sentence, without the way to where it was found
    locks = longest_locks(campaign)
    name = design.name if isinstance(design, Design) else Path(design).name
    record(f"{name}/stops/longest distance [m]", f"{campaign.table['distance_m'].max():.6g}")
    record(f"{name}/stops/longest lock [s]", f"{locks.max():.6g}")
    record(f"{name}/stops/runs", runs)
    missed = _missed(campaign, locks, limits)
    if missed:
        limit_words = " or ".join(
            word
            for word, given in (
                (f"{within} of distance", within),
                (f"{locked_below} of a locked wheel", locked_below),
            )
            if given is not None
        )
        lines = [
            f"{len(missed)} of {runs} drawn stops of {name} on {case.rail.name} miss {limit_words}",
            *(_told(campaign, locks, run) for run in missed[:_TOLD]),
            f"see the first one: {_command(design, vehicle, rail, speed, seed, missed[0])}",
        ]
        raise AssertionError("\n  ".join(lines))
    return campaign


class _Limits(NamedTuple):
    distance: float  # m
    lock: float  # s


def _simulated(
    design: Design | str | Path,
    within: str | None,
    locked_below: str | None,
    runs: int,
    seed: int,
    speed: str | None,
    vehicle: str | Path | None,
    rail: str | Path | None,
) -> tuple[_Limits, Case, Campaign]:
    """Read what is asked for, and simulate."""
    if within is None and locked_below is None:
        raise UserError('no limit is given; write for example within="900 m" or locked_below="0.5 s"')
    limits = _Limits(_limit(within, "length", "within"), _limit(locked_below, "time", "locked_below"))
    case = _case(design, vehicle, rail)
    start = case.specification.speeds[1] if speed is None else parse_quantity(speed, "speed", what="speed")
    scenario = Scenario(rail=case.rail, initial_speed=start, seed=seed)
    files = load_entries("vehicle", case.vehicle_name), load_entries("rail", case.rail_name)
    draws = within_bounds_of_stop(scenario, files)
    campaign = simulate_many(case.vehicle, case.controller, scenario, count=runs, draws=draws)
    return limits, case, whole(campaign)


def _missed(campaign: Campaign, locks: "NDArray[Any]", limits: _Limits) -> list[int]:
    """Return the runs that miss a limit or do not end, the worst first."""
    import numpy as np

    table = campaign.table
    bad = np.flatnonzero(
        ~table["stopped"] | ~(table["distance_m"] <= limits.distance) | ~(locks < limits.lock)
    )
    excess = np.maximum(table["distance_m"] / limits.distance, locks / limits.lock)
    order = np.lexsort((-excess[bad], table["stopped"][bad]))
    return [int(run) for run in bad[order]]


def longest_locks(campaign: Campaign) -> "NDArray[Any]":
    """Longest lock of any wheelset above 10 km/h in each stop [s]."""
    import numpy as np

    names = [name for name in campaign.table.dtype.names or () if name.startswith("longest_lock_s_")]
    return np.asarray(np.max([campaign.table[name] for name in names], axis=0))


def _case(design: Design | str | Path, vehicle: str | Path | None, rail: str | Path | None) -> Case:
    options = CaseOptions(vehicle=located(vehicle), rail=located(rail))  # type: ignore[arg-type]
    if isinstance(design, Design):
        return case_of(design, options, where=design.name)
    return load_case(str(located(design)), options)


def _limit(text: str | None, dimension: Dimension, name: str) -> float:
    """Read a limit; infinite where none is given."""
    if text is None:
        return float("inf")
    if not isinstance(text, str):
        example = "900 m" if dimension == "length" else "0.5 s"
        raise UserError(f'{name} = {text!r} must be text with a unit, such as {name}="{example}"')
    value = parse_quantity(text, dimension, what=name)
    if not value > 0.0:
        raise UserError(f'{name} = "{text}" must be above 0')
    return value


def _told(campaign: Campaign, locks: "NDArray[Any]", run: int) -> str:
    row = campaign.table[run]
    ending = "" if row["stopped"] else ", no standstill"
    return f"run {run}: {row['distance_m']:.1f} m, longest lock {locks[run]:.2f} s{ending}"


def _command(
    design: Design | str | Path,
    vehicle: str | Path | None,
    rail: str | Path | None,
    speed: str | None,
    seed: int,
    run: int,
) -> str:
    """Return the command that simulates one of the stops alone."""
    words = ["wspd", "simulate", design.name if isinstance(design, Design) else str(located(design))]
    for option, given in (("--vehicle", vehicle), ("--rail", rail), ("--speed", speed)):
        words += [] if given is None else [option, str(located(given))]
    return shlex.join([*words, "--seed", str(seed), "--only-run", str(run)])
