"""What the verdict makes of findings: ellipsoids count for the friction that they were made for, and for no more."""

from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import product
from math import inf

import pytest

from tests.certificates.band.conftest import SLOW, problem_of
from tests.certificates.band.test_declared_law import problem_with
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Finding, Stated
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.records import Status
from wspd_design.certificates.setting.creep_slope import STEEPNESS, steepness_of
from wspd_design.certificates.theorems import band
from wspd_design.certificates.theorems.band import (
    CELLS,
    DEPARTURE,
    DISTURBED,
    LATE,
    NOISY,
    RESERVED,
    SLIP_BAND,
    claims,
    contact_held,
    covered,
    held_names,
    key,
    proved_friction,
)
from wspd_design.certificates.theorems.slip_band.attempt import Attempt, effort_of
from wspd_design.certificates.theorems.slip_band.friction import NAMES, PARTS, parts_of
from wspd_design.certificates.theorems.slip_band.statement import windows_of
from wspd_design.controllers.references import FallingSlip

WINDOWS = 2
BANDS = {0: (0.002, 0.009), 1: (0.004, 0.003)}  # below and above, of each window


@pytest.fixture(scope="module")
def problem():
    return problem_of(0.5, speeds=SLOW)


def ends_of(name, part, k):
    """Proved bounds, each of them another one."""
    low = 1.0 + NAMES.index(name) + 20.0 * part + 100.0 * k
    return low, low + 0.5


def keys():
    return [(name, part, k) for name in NAMES for part in range(PARTS) for k in range(WINDOWS)]


@pytest.fixture(scope="module")
def friction(problem):
    """Findings on the friction as if all of it had been proved."""
    assert len(windows_of(problem)) == WINDOWS
    found = {}
    for each in keys():
        low, high = ends_of(*each)
        found[key(*each, ">=")] = Finding(status=Status.PROVED, asked="a", shown="a", low=low, high=low + 0.1)
        found[key(*each, "<=")] = Finding(
            status=Status.PROVED, asked="a", shown="a", low=high - 0.1, high=high
        )
    assert found.keys() == claims(problem).keys()
    return found


@cache
def steepness_parts():
    return parts_of(steepness_of(contact_held(problem_of(0.5, speeds=SLOW))))


def numbers_of(**changed):
    """What the checker tells of ellipsoids that were made for just these bounds."""
    numbers = {"share": 1.0, "cells": 1.0, "delay": 0.0, "noise": 0.0, "reserve": 1.0}
    for k, (below, above) in BANDS.items():
        numbers |= {f"supply {k}": 0.5 + 0.1 * k, f"band {k} below": below, f"band {k} above": above}
    for name, part, k in keys():
        low, high = ends_of(name, part, k)
        numbers |= {f"{name} {part} {k} low": low, f"{name} {part} {k} high": high}
    for (part, (low, high)), k in product(enumerate(steepness_parts()), range(WINDOWS)):
        numbers |= {f"{STEEPNESS} {part} {k} low": low, f"{STEEPNESS} {part} {k} high": high}
    return numbers | changed


def shown(numbers):
    return Finding(status=Status.PROVED, asked="ellipsoids", shown="ellipsoids", numbers=numbers)


@pytest.fixture(scope="module")
def findings(problem, friction):
    """Nothing is known but the friction."""
    left = [each for each in SLIP_BAND.obligations(problem) if each.key not in friction]
    return friction | {each.key: each.decide(Stated(), Work()) for each in left}


def test_ellipsoids_for_the_proved_friction_count(problem, findings):
    told = SLIP_BAND.tell(problem, findings | {CELLS: shown(numbers_of())})
    assert told.status is Status.PROVED
    assert told.margin.low == pytest.approx(1.0 - (0.14 + 0.009))
    assert told.worst_point[0].value == pytest.approx(0.14 + 0.009)
    assert "must have 60 % at" in told.explanation
    assert "and 60 % where it must have most" in told.explanation


@pytest.mark.parametrize("end", ["low", "high"])
def test_ellipsoids_for_less_friction_than_is_proved_do_not_count(problem, findings, end):
    """For each bound alone, in each part and window: a bit more is in order, a bit less is not."""
    for name, part, k in keys():
        number = f"{name} {part} {k} {end}"
        outward = {"low": -1e-9, "high": 1e-9}[end]
        at = dict(zip(("low", "high"), ends_of(name, part, k), strict=True))[end]
        wider, narrower = (shown(numbers_of(**{number: at + sign * outward})) for sign in (1.0, -1.0))
        assert covered(problem, findings | {CELLS: wider}, CELLS) is wider
        assert covered(problem, findings | {CELLS: narrower}, CELLS).status is Status.UNDECIDED
    narrower = shown(numbers_of(**{number: at - outward}))
    for place in (CELLS, *DISTURBED):
        told = SLIP_BAND.tell(problem, findings | {place: narrower})
        assert told.status is Status.UNDECIDED
        assert "% of each range" not in told.explanation


@pytest.mark.parametrize("end", ["low", "high"])
def test_ellipsoids_for_more_steepness_than_bounds_were_proved_for_do_not_count(problem, findings, end):
    """In each part and window: a range that is a bit narrower is in order, a wider one is not."""
    for part, k in product(range(PARTS), range(WINDOWS)):
        at = steepness_parts()[part][end == "high"]
        inward = {"low": 1e-9, "high": -1e-9}[end] * at
        number = f"{STEEPNESS} {part} {k} {end}"
        narrower, wider = (shown(numbers_of(**{number: at + sign * inward})) for sign in (1.0, -1.0))
        assert covered(problem, findings | {CELLS: narrower}, CELLS) is narrower
        assert covered(problem, findings | {CELLS: wider}, CELLS).status is Status.UNDECIDED


def test_ellipsoids_count_only_where_all_of_the_friction_is_proved(problem, findings):
    for open_one in (key("fading 3", 1, 1, "<="), key("level", 0, 0, ">=")):
        other = {open_one: replace(findings[open_one], low=-inf, high=inf)}
        assert proved_friction(problem, findings | other) is None
        told = SLIP_BAND.tell(problem, findings | other | {CELLS: shown(numbers_of())})
        assert told.status is Status.UNDECIDED


def test_what_is_not_proved_is_not_covered(problem, findings):
    numbers = shown(numbers_of())
    for status in (Status.UNDECIDED, Status.EVIDENCE):
        assert covered(problem, findings | {CELLS: replace(numbers, status=status)}, CELLS).status is status


def test_part_of_the_box_is_not_the_box(problem, findings):
    told = SLIP_BAND.tell(problem, findings | {CELLS: shown(numbers_of(share=0.999))})
    assert told.status is Status.UNDECIDED
    assert told.margin is None
    assert told.explanation.startswith("Shown on 99.9 % of each range")


def test_what_else_is_borne_is_told_with_its_widest_band(problem, findings):
    proved = findings | {CELLS: shown(numbers_of())}
    for name, numbers, words in (
        (RESERVED, {"reserve": 0.8}, "takes at most 80 % of the full pressure"),
        (LATE, {"delay": 0.003}, "begin up to 3 ms late"),
        (NOISY, {"noise": 0.004}, "within 0.004 m/s"),
    ):
        told = SLIP_BAND.tell(problem, proved | {name: shown(numbers_of(**numbers))}).explanation
        assert words in told
        assert "+0.009 and -0.004 at all speeds" in told


def test_search_that_ended_within_what_is_proved_is_refused(problem, findings):
    def ended(share):
        tried = Attempt(share=Fraction(share), steps="", window=0, tried=3, cut=False)
        effort = effort_of(problem, tried, proved=Fraction(1, 2))
        found = replace(shown(numbers_of(share=0.5)), stated=Stated(effort=effort))
        return SLIP_BAND.tell(problem, findings | {CELLS: found})

    assert "found no ellipsoid" in ended("3/4").explanation
    for share in ("1/2", "1/4"):
        with pytest.raises(Refused, match="that the proof covers"):
            ended(share)


def test_place_that_denies_a_band_refutes_it_whatever_else_is_shown(problem, findings):
    place = {name: problem.nominal(name) for name in band.NAMES} | {"speed": 4.0}
    numbers = {"lock time": 1.0, "lock speed": 3.0}
    away = Finding(status=Status.REFUTED, asked="a", numbers=numbers, stated=Stated(place=place))
    told = SLIP_BAND.tell(problem, findings | {CELLS: shown(numbers_of()), DEPARTURE: away})
    assert told.status is Status.REFUTED
    assert told.margin is None
    assert {each.name for each in told.witness} == {"slip", "speed", *band.NAMES}


# --- what is asked ------------------------------------------------------------------------------------------------
def test_only_the_ellipsoids_with_a_reserve_may_leave_windows_out(problem, monkeypatch):
    """And all of them are about what the claim varies: no contact, but supply rate and running resistance."""
    asked = []

    def checker(about, law, *, reserved=False):
        asked.append((about, law, reserved))
        return len(asked)

    monkeypatch.setattr(band, "checker", checker)
    found = {each.key: each.check for each in SLIP_BAND.obligations(problem) if hasattr(each, "check")}
    assert {name: asked[found[name] - 1][2] for name in (CELLS, *DISTURBED)} == {
        CELLS: False,
        RESERVED: True,
        LATE: False,
        NOISY: False,
    }
    varied = {
        *band.NAMES,
        "supply rate",
        *(f"resistance {each}" for each in ("constant", "linear", "quadratic")),
    }
    for about, law, _ in asked:
        assert law is problem.controller
        assert dict(about.bounds.items()) == {n: e for n, e in problem.bounds.items() if n in varied}
        assert {name for name, _ in about.bounds.items()} == varied


def test_numbers_that_are_held_are_told(problem):
    """All that has bounds counts as one or the other."""
    named = {name for name, _ in problem.bounds.items()}
    varied = {name for name, _ in contact_held(problem).bounds.items()}
    assert {*held_names(problem)} == named - varied
    assert {"adhesion reduction", "semi axis rolling", "friction ratio"} <= {*held_names(problem)}


def test_speeds_at_which_a_sample_may_end_at_standstill_are_outside(problem):
    slow = replace(problem, speeds=(0.05, 4.0), controller=replace(problem.controller, cut_out_speed=0.01))
    with pytest.raises(OutsideModel, match="standstill"):
        SLIP_BAND.obligations(slow)


def test_numbers_without_meaning_are_outside(problem):
    for name in ("supply rate", "resistance linear", "wheel radius"):
        bounds = problem.bounds | {name: (-0.1, 0.5)}
        with pytest.raises(OutsideModel, match=name):
            SLIP_BAND.obligations(replace(problem, bounds=bounds))


def test_laws_of_another_vehicle_or_range_are_not_spoken_about(problem):
    law, vehicle = problem.controller, problem.vehicle

    def reason(**changed):
        return SLIP_BAND.speaks_about(replace(problem, **changed))

    def with_brake(**changed):
        return reason(vehicle=replace(vehicle, brake=replace(vehicle.brake, **changed)))

    assert reason() == ""
    assert "another vehicle" in with_brake(max_pressure=1.01 * vehicle.brake.max_pressure)
    assert "another vehicle" in reason(
        controller=replace(law, valve=replace(law.valve, brake=replace(law.valve.brake, max_pressure=1.0)))
    )
    assert "another vehicle" in reason(vehicle=replace(vehicle, wheelsets=6))
    assert with_brake(dead_time=0.0199) == ""
    assert "a sample or more" in with_brake(dead_time=law.sample_time)
    assert "holds its valves" in reason(controller=replace(law, cut_out_speed=1.001 * problem.speeds[0]))
    # The largest slip is that at the lowest speed of the slowest window, with the largest wheels.
    slowest = windows_of(problem)[0][0] ** 0.5
    assert (
        reason(controller=replace(law, reference=FallingSlip(slip=0.2, largest=1.001 * 0.2 / slowest))) == ""
    )
    ended = reason(controller=replace(law, reference=FallingSlip(slip=0.2, largest=0.999 * 0.2 / slowest)))
    assert "ends its fall" in ended


def test_declared_laws_of_another_vehicle_or_with_errors_that_cannot_be_are_not_spoken_about(tmp_path):
    declared = problem_with(tmp_path)
    vehicle = declared.vehicle

    def with_brake(**changed):
        other = replace(vehicle, brake=replace(vehicle.brake, **changed))
        return SLIP_BAND.speaks_about(replace(declared, vehicle=other))

    assert "another vehicle" in with_brake(max_pressure=1.01 * vehicle.brake.max_pressure)
    assert "another vehicle" in SLIP_BAND.speaks_about(
        replace(declared, vehicle=replace(vehicle, wheelsets=6))
    )
    assert "one valve with a lag" in with_brake(valve="flow")
    assert "one full torque" in with_brake(axle_shares=(1.0, 1.0, 1.0, 0.9))
    for told in ("slip_error=-0.01", "slip_drift=-0.01", "slip_error=0.14"):
        problem = problem_with(tmp_path, ("time_share=self.share", f"time_share=self.share, {told}"))
        assert "that cannot be" in SLIP_BAND.speaks_about(problem)
