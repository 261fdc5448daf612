"""Objective, limits and the order of points, against numbers worked out by hand."""

import math

import numpy as np
import pytest

from wspd_design.design.criteria import CRITERIA
from wspd_design.design.requirements import Limit, judged_by
from wspd_design.design.search.score import Score, objective, rank, score, score_by_rail, violation


def figures(**changes):
    usual = {
        "efficiency": np.array([0.9, 0.8, np.nan]),
        "excess": np.array([1 / 0.9 - 1, 0.25, 3.0]),
        "stopped": np.array([True, True, False]),
        "distance_m": np.array([100.0, 200.0, 900.0]),
        "longest_lock_s_1": np.array([0.0, 0.2, 0.1]),
        "longest_lock_s_2": np.array([0.3, 0.0, 0.1]),
        "valve_switches_per_s": np.array([3.0, 6.0, 9.0]),
        "vented_air": np.array([1.0, 2.0, 6.0]),
    }
    return usual | changes


def of(objective=0.1, unstopped=0.0, **reached):
    return Score(objective=objective, unstopped=unstopped, reached=reached)


def test_criteria_by_hand():
    found = score(figures())
    assert found.unstopped == pytest.approx(1 / 3)
    assert found.reached == pytest.approx(
        {
            "efficiency_mean": 1.7 / 3,  # a train that does not stop counts as 0
            "efficiency_p05": 0.08,
            "efficiency_worst": 0.0,
            "stopping_distance": 900.0,
            "longest_lock": 0.3,  # the largest of the axles
            "valve_switches": 6.0,
            "vented_air": 3.0,
        }
    )


def test_figures_that_only_some_laws_have():
    found = score(figures(speed_error=np.array([0.01, 0.03, 0.02]), slip_band_1=np.array([0.1, 0.2, 0.05])))
    assert found.reached["speed_error"] == 0.03
    assert found.reached["slip_band"] == 0.2
    assert "distance_error" not in found.reached


def test_slips_that_never_reach_their_reference_have_no_band():
    one, none = np.array([0.1, np.nan, 0.05]), np.full(3, np.nan)
    assert score(figures(slip_band_1=one, slip_band_2=none)).reached["slip_band"] == 0.1
    assert "slip_band" not in score(figures(slip_band_1=none)).reached
    missing = score(figures(speed_error=one)).reached  # that one must be there in every stop
    assert "speed_error" not in missing
    assert judged_by((Limit(criterion="speed_error", value=0.5),), missing)[-1].met is False


def test_objective_by_hand():
    excess = np.array([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1])
    assert objective(excess) == pytest.approx(0.55 + 0.3 * (1.0 + 1.1) / 2)
    assert objective(np.array([0.2])) == pytest.approx(0.2 * 1.3)


def test_violation_counts_in_scales_and_by_the_side_of_the_limit():
    limits = (Limit(criterion="efficiency_mean", value=0.95), Limit(criterion="longest_lock", value=0.0))
    assert violation(of(efficiency_mean=0.96, longest_lock=0.0), limits) == 0.0
    assert violation(of(efficiency_mean=0.93, longest_lock=0.05), limits) == pytest.approx(2.0 + 0.5)
    assert violation(of(longest_lock=0.0), limits) == math.inf  # nothing was reached


def test_limits_rank_before_distance_and_stopping_before_both():
    limits = (Limit(criterion="valve_switches", value=10.0),)
    keeps, misses, stays = (
        rank(each, limits)
        for each in (
            of(0.5, valve_switches=10.0),
            of(0.01, valve_switches=10.1),
            of(0.01, 0.01, valve_switches=1.0),
        )
    )
    assert keeps < misses < stays
    assert rank(of(0.1, valve_switches=1.0), limits, unproved=1.0) > keeps


def test_what_is_not_a_number_ranks_last():
    worst = rank(of(math.nan, valve_switches=1.0), ())
    assert worst == (math.inf,) * 3
    assert rank(of(9.9, 1.0), ()) < worst


@pytest.mark.parametrize("name", CRITERIA)
def test_every_criterion_has_both_sides_of_its_limit(name):
    rule = CRITERIA[name]
    better, worse = (0.6, 0.4) if rule.at_least else (0.4, 0.6)
    assert rule.excess(better, 0.5) == 0.0 == rule.excess(0.5, 0.5)
    assert rule.excess(worse, 0.5) == pytest.approx(0.1 / rule.scale)
    (judged,) = judged_by((Limit(criterion=name, value=0.5),), {name: worse})
    assert judged.met is False
    assert judged_by((Limit(criterion=name, value=0.5),), {name: better})[0].met is True
    assert judged_by((Limit(criterion=name, value=0.5),), {})[0].met is False
    assert judged_by((), {name: worse})[0].met is None


@pytest.mark.parametrize(
    ("criterion", "limit", "kept"),
    [
        ("efficiency_mean", 0.9, 0.905),
        ("valve_switches", 15.0, 14.5),
        ("longest_lock", 0.5, 0.45),
        ("longest_lock", 0.0, 0.0),
    ],
)
def test_a_search_keeps_a_reserve(criterion, limit, kept):
    assert Limit(criterion=criterion, value=limit).with_reserve().value == pytest.approx(kept)


def test_each_rail_has_its_sets():
    """Sets 0 and 2 are those of the first rail, set 1 that of the second; a third one has none."""
    found = score_by_rail(figures(), ("a", "b"))
    assert list(found) == ["a", "b"]
    assert found["a"].reached["valve_switches"] == 6.0 == found["b"].reached["valve_switches"]
    assert (found["a"].reached["efficiency_mean"], found["b"].reached["efficiency_mean"]) == (0.45, 0.8)
    assert (found["a"].unstopped, found["b"].unstopped) == (0.5, 0.0)
    assert list(score_by_rail(figures(), ("a", "b", "c", "d"))) == ["a", "b", "c"]
