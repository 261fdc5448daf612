"""Drawn sets: the same for everybody, and the held-out ones different from those of the search."""

from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.design.requirements import DrawnSets
from wspd_design.design.search.evaluation import evaluate
from wspd_design.design.search.sets import STOPS_SIDE_BY_SIDE, disjoint, draw_sets
from wspd_design.design.selection import shipped_design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.stop import simulate_on


class Backwards:
    """An executor that does the last task first, and each only when its result is asked for."""

    def __init__(self):
        self._waiting = []

    def submit(self, work, *given):
        future = _Late(self)
        self._waiting.append((future, work, given))
        return future

    def map(self, work, *given):
        return [future.result() for future in [self.submit(work, *each) for each in zip(*given, strict=True)]]

    def run(self):
        while self._waiting:
            future, work, given = self._waiting.pop()
            future.set_result(work(*given))


class _Late(Future):
    def __init__(self, executor):
        super().__init__()
        self._executor = executor

    def result(self, timeout=None):
        self._executor.run()
        return super().result(timeout)


@pytest.fixture(scope="module")
def law(er24pc, task):
    rail = load_rail("polach-wet")
    return shipped_design("knorr-bremse", er24pc, rail, task.specification).build(er24pc, rail)


def drawn(task, er24pc, pool, sets=20, seed=1):
    return draw_sets(task.requirements, er24pc, "er24pc", DrawnSets(sets=sets, seed=seed), pool)


def test_figures_depend_on_neither_threads_nor_order(task, er24pc, law):
    found = []
    for pool in (ThreadPoolExecutor(1), ThreadPoolExecutor(5), Backwards()):
        sets = drawn(task, er24pc, pool)
        found.append([{k: v.tobytes() for k, v in each.items()} for each in evaluate([law, law], sets, pool)])
    assert found[0] == found[1] == found[2]
    assert found[0][0] == found[0][1]
    assert len(found[0][0]["excess"]) == 20 * 8


def test_a_set_is_the_stop_that_it_says(task, er24pc, law):
    """Each figure belongs to its set: the rails take turns, and single stops come to the same distance."""
    with ThreadPoolExecutor(1) as pool:
        sets = drawn(task, er24pc, pool)
        (figures,) = evaluate([law], sets, pool)
    cases = {k: case for group in sets.groups for k, case in zip(group.numbers, group.cases, strict=True)}
    assert sorted(cases)[:20] == list(range(20))
    assert len(cases) % STOPS_SIDE_BY_SIDE == 0
    for k in range(20):
        plant, scenario = cases[k]
        assert scenario.rail.name == ("polach-dry", "polach-wet")[k % 2]
        alone = simulate_on(plant, law, scenario).totals.distance
        assert figures["distance_m"][k] == pytest.approx(alone, rel=1e-6)
        ideal = ideal_stop(plant.vehicle, scenario).distance
        assert figures["excess"][k] == pytest.approx(alone / ideal - 1.0, abs=1e-5)
    assert len({plant.vehicle.brake.max_torque for plant, _ in cases.values()}) == len(cases)


def test_more_sets_begin_with_the_same_ones(task, er24pc):
    with ThreadPoolExecutor(1) as pool:
        few, many = drawn(task, er24pc, pool, sets=3), drawn(task, er24pc, pool, sets=40)
    at = [
        {k: case for group in sets.groups for k, case in zip(group.numbers, group.cases, strict=True)}
        for sets in (few, many)
    ]
    for k in range(3):
        assert at[0][k][0].vehicle == at[1][k][0].vehicle
        assert at[0][k][1] == at[1][k][1]


def test_other_seeds_share_nothing(task, er24pc):
    with ThreadPoolExecutor(1) as pool:
        one, other = (drawn(task, er24pc, pool, seed=seed) for seed in (1, 9000))
    vehicles, noises = (
        [{read(case) for group in sets.groups for case in group.cases} for sets in (one, other)]
        for read in (lambda case: case[0].vehicle.brake.max_torque, lambda case: case[1].seed)
    )
    assert not vehicles[0] & vehicles[1]
    assert not noises[0] & noises[1]


@pytest.mark.parametrize(
    ("one", "other", "apart"), [(0, 0, False), (0, 115, False), (0, 116, True), (500, 400, False)]
)
def test_seeds_that_are_too_close_share_noise(one, other, apart):
    assert disjoint(DrawnSets(sets=100, seed=one), DrawnSets(sets=50, seed=other)) == apart


def test_a_train_that_cannot_stop_is_refused(task, er24pc):
    downhill = (*task.requirements.stop, ("stop.grade", -0.1))
    wanted = replace(task.requirements, stop=downhill, rails=("low-adhesion",))
    with ThreadPoolExecutor(1) as pool, pytest.raises(UserError, match="has no ideal stop to compare with"):
        draw_sets(wanted, er24pc, "er24pc", DrawnSets(sets=4, seed=0), pool)


def test_a_number_that_does_not_exist_is_named(task, er24pc):
    draw = replace(task.requirements.draws[0], name="vehicle.brake.max_torqe")
    with (
        ThreadPoolExecutor(1) as pool,
        pytest.raises(UserError, match=r'did you mean "vehicle\.brake\.max_torque"'),
    ):
        draw_sets(
            replace(task.requirements, draws=(draw,)), er24pc, "er24pc", DrawnSets(sets=4, seed=0), pool
        )


def test_what_a_law_measures_does_not_move_its_ideal_stop(task, er24pc):
    with ThreadPoolExecutor(1) as pool:
        calm = replace(task.requirements, draws=task.requirements.draws[:1])
        one, other = (
            draw_sets(each, er24pc, "er24pc", DrawnSets(sets=8, seed=3), pool)
            for each in (calm, task.requirements)
        )
    for a, b in zip(one.groups, other.groups, strict=True):
        assert np.array_equal(a.ideal, b.ideal)
