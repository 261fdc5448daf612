"""How far a stop spreads over the bounds: the drawn sets, their worst, single effects and other conditions."""

import math
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.design.catalog import controller
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
from wspd_design.simulation.batch import STOPS_SIDE_BY_SIDE
from wspd_design.simulation.campaign import simulate_many
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.draws import within_bounds
from wspd_design.simulation.records import Scenario
from wspd_design.studies.key_figures import KEY_FIGURES, key_figures, outcome_of
from wspd_design.studies.uncertainty import uncertainty

LOCO, WET = load_vehicle("er24pc"), load_rail("polach-wet")
FILES = load_entries("vehicle", "er24pc"), load_entries("rail", "polach-wet")
STOP = Scenario.stop(from_kmh=30.0, rail=WET, seed=5)
SETS = 2 * STOPS_SIDE_BY_SIDE
LAW = controller("smc", LOCO, WET, Specification())


@pytest.fixture(scope="module")
def nominal():
    return trial(LOCO, LAW, STOP, slip_reference=0.14)


def spread_out(nominal, *, files=FILES, stop=STOP, law=LAW, laden=None):
    return uncertainty(
        LOCO,
        law,
        stop,
        nominal,
        slip_reference=0.14,
        parameters=files,
        laden=laden,
        plant="planar",
        command="wspd simulate mine.toml",
        sets=SETS,
    )


@pytest.fixture(scope="module")
def found(nominal):
    return spread_out(nominal)


@pytest.fixture(scope="module")
def table():
    draws = within_bounds(*FILES)
    return simulate_many(LOCO, LAW, STOP, count=SETS, draws=draws, check_every=0).table


def test_the_sets_are_the_runs_of_a_campaign(found, table):
    spread = found.spread_of("distance")
    assert spread.values == pytest.approx(table["distance_m"].tolist(), rel=1e-3)
    assert found.numbers[7] == tuple(table[7][name] for name in found.drawn)
    assert set(found.drawn) == {draw.name for draw in within_bounds(*FILES)}
    assert found.held == ()
    assert (found.sets, found.seed, found.unstopped, found.checked) == (SETS, 5, 0, 1)


def test_low_percentiles_and_high_are_figures_of_sets(found):
    for spread in found.spreads:
        ordered = sorted(value for value in spread.values if not math.isnan(value))
        count = len(ordered)
        assert (spread.low, spread.high) == (ordered[0], ordered[-1])
        assert spread.p05 == ordered[math.ceil(0.05 * count) - 1]
        assert spread.p95 == ordered[math.ceil(0.95 * count) - 1]
        assert spread.low <= spread.p05 <= spread.p95 <= spread.high


def test_the_worst_set_is_the_worst_and_has_its_numbers(found, table):
    for spread in found.spreads:
        worst = spread.low if KEY_FIGURES[spread.name].least_is_worst else spread.high
        assert spread.worst.value == worst == spread.values[spread.worst.number]
        assert dict(spread.worst.parameters)["rail.mu0"] == table["rail.mu0"][spread.worst.number]
        assert spread.worst.command == f"wspd simulate mine.toml --only-run {spread.worst.number}"


def test_every_key_figure_means_the_same_in_a_campaign_and_alone(nominal):
    """A column and a figure of one stop that are not the same would be told as one number."""
    table = simulate_many(LOCO, LAW, STOP, count=1, check_every=0).table
    columns = key_figures({name: table[name] for name in table.dtype.names})
    alone = dict(outcome_of(nominal))
    assert set(alone) == set(columns)
    for name, values in columns.items():
        assert values[0] == pytest.approx(alone[name], rel=1e-3, abs=1e-3), name


def test_a_train_that_does_not_stop_has_no_distance_and_no_efficiency():
    table = simulate_many(LOCO, LAW, STOP, count=2, check_every=0).table
    columns = {name: table[name].copy() for name in table.dtype.names}
    columns["stopped"] = np.array([True, False])
    figures = key_figures(columns)
    assert np.isinf(figures["distance"]).tolist() == [False, True]
    assert np.isinf(figures["time"]).tolist() == [False, True]
    assert figures["efficiency"][1] == 0.0


def test_an_effect_is_the_stop_with_that_number_alone(found):
    effect = next(each for each in found.effects if each.name == "rail.mu0")
    assert (effect.low, effect.high) == FILES[1].bounds["mu0"]
    other = replace(STOP, rail=replace(WET, mu0=effect.low))
    alone = trial(LOCO, LAW, other, slip_reference=0.14).metrics
    assert effect.ends("distance")[0] == pytest.approx(alone.distance, rel=1e-3)
    assert effect.ends("efficiency")[0] == pytest.approx(alone.efficiency, rel=1e-3)
    reaches = [
        each.reach("distance", found.spread_of("distance").nominal) for each in found.strongest("distance")
    ]
    assert reaches == sorted(reaches, reverse=True)
    assert len(reaches) == len(found.drawn)


def test_the_law_does_not_know_what_is_drawn(found):
    """A worn wheel makes the law see slip that is not there; a law that knew it would stop as before."""
    worn = next(each for each in found.effects if each.name == "vehicle.wheel_radius")
    knowing = controller("smc", replace(LOCO, wheel_radius=worn.low), WET, Specification())
    vehicle = replace(LOCO, wheel_radius=worn.low)
    told = trial(vehicle, knowing, STOP, slip_reference=0.14).metrics.slip_rms
    not_told = trial(vehicle, LAW, STOP, slip_reference=0.14).metrics.slip_rms
    assert worn.ends("slip_rms")[0] == pytest.approx(not_told, rel=1e-3)
    assert abs(told - not_told) > 5e-3


def test_all_numbers_together_go_beyond_each_alone(found):
    short, long = (dict(each.outcome)["distance"] for each in found.variants if each.subject == "all numbers")
    ends = [end for each in found.effects for end in each.ends("distance")]
    assert short < min(ends)
    assert long > max(ends)


def test_other_conditions_are_the_stops_that_they_name(found):
    by_words = {each.words: dict(each.outcome) for each in found.variants}
    subjects = {each.subject for each in found.variants}
    assert subjects == {"rail", "speed", "wheels", "sensors", "dead time", "all numbers"}
    slow = replace(STOP, initial_speed=STOP.initial_speed / 3.0)
    assert by_words["from 10 km/h"]["distance"] == pytest.approx(
        trial(LOCO, LAW, slow, slip_reference=0.14).metrics.distance, rel=1e-3
    )
    late = replace(STOP, sensing=replace(STOP.sensing, dead_time=0.1))
    assert by_words["dead time 100 ms"]["slip_max"] == pytest.approx(
        trial(LOCO, LAW, late, slip_reference=0.14).metrics.slip_max, rel=1e-3
    )
    assert by_words["low-adhesion"]["distance"] > by_words["front wheelset on low-adhesion"]["distance"]


def test_rails_of_single_axles_are_held(nominal):
    stop = replace(STOP, axle_rails=(WET,) * 4)
    found = spread_out(nominal, stop=stop)
    assert {name.partition(".")[0] for name in found.drawn} == {"vehicle"}
    assert set(found.held) == {f"rail.{name}" for name in FILES[1].bounds}


def test_exact_numbers_have_no_uncertainty(nominal):
    exact = tuple(
        replace(each, entries={name: replace(entry, bounds=None) for name, entry in each.entries.items()})
        for each in FILES
    )
    assert spread_out(nominal, files=exact) is None


def test_a_load_is_a_condition_of_its_own(nominal):
    found = spread_out(nominal, laden=replace(LOCO, mass=90e3, body_mass=60e3))
    (load,) = (each for each in found.variants if each.subject == "load")
    assert load.words == "laden, 90 t"
    assert dict(load.outcome)["distance"] > found.spread_of("distance").nominal


def test_interrupted_sets_are_no_answer(nominal, monkeypatch):
    def interrupted(*arguments, **options):
        return replace(simulate_many(*arguments, **options), complete=False)

    monkeypatch.setattr("wspd_design.studies.uncertainty.simulate_many", interrupted)
    with pytest.raises(KeyboardInterrupt):
        spread_out(nominal)
