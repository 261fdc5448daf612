"""One search: points, order, journal, planted faults."""

import json
import math
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.design.ranges import SearchRange
from wspd_design.design.requirements import DrawnSets, Limit
from wspd_design.design.search import evaluation, run
from wspd_design.design.search.journal import Journal
from wspd_design.design.search.run import Aim, Space, front, ranked, search
from wspd_design.design.search.sets import Sets
from wspd_design.design.search.variables import variables_of
from wspd_design.design.selection import search_ranges, shipped_design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail

SETS = Sets(drawn=DrawnSets(sets=6, seed=0), groups=())


def best(tried, aim):
    return ranked(tried, aim)[0]


@pytest.fixture
def bowl(monkeypatch, er24pc, task):
    """A search whose stops are a formula: best at slide limits .5 and pulses 2; switches rise with the pulses."""
    calls = Counter()

    def figures(laws, _sets, _pool):
        for law in laws:
            calls["laws"] += 1
            slide, _, pulses = law
            excess = math.log(slide / 0.5) ** 2 + math.log(pulses / 2.0) ** 2
            yield usual(excess, switches=5.0 * pulses)

    def usual(excess, switches):
        return {
            "efficiency": np.full(6, 1.0 / (1.0 + excess)),
            "excess": np.full(6, excess),
            "stopped": np.full(6, True),
            "distance_m": np.full(6, 100.0),
            "longest_lock_s": np.zeros(6),
            "valve_switches_per_s": np.full(6, switches),
            "vented_air": np.full(6, 1.0),
        }

    monkeypatch.setattr(run, "evaluate", figures)
    base = shipped_design("knorr-bremse", er24pc, load_rail("polach-wet"), task.specification)
    variables = variables_of(base, search_ranges("knorr-bremse"))
    space = Space(law="bowl", variables=variables, build=tuple)

    def searching(path, limits=(), method="cma", evaluations=120, seed=3, progress=abs, **options):
        return search(
            space,
            Aim(limits=limits, **options),
            SETS,
            method=method,
            evaluations=evaluations,
            seed=seed,
            journal=Journal(path, "key"),
            pool=ThreadPoolExecutor(1),
            progress=progress,
        )

    searching.calls = calls
    return searching


@pytest.mark.parametrize(("method", "within"), [("cma", 0.003), ("random", 0.3)])
def test_the_minimum_is_found(bowl, tmp_path, method, within):
    tried = bowl(tmp_path / "journal", method=method)
    assert len(tried) == 120
    assert tried[0].values == pytest.approx((1.0, 1.0, 1.0))
    assert best(tried, Aim(limits=())).score.objective < within
    assert tried[0].score.objective > 0.9


def test_a_search_that_learns_beats_the_control(bowl, tmp_path):
    medians = [
        np.median(
            [
                best(
                    bowl(tmp_path / f"{method}{seed}", method=method, seed=seed), Aim(limits=())
                ).score.objective
                for seed in range(5)
            ]
        )
        for method in ("cma", "random")
    ]
    assert medians[0] < 0.1 * medians[1]


def test_a_limit_is_kept_at_the_cost_of_distance(bowl, tmp_path):
    """At most 7 switches means pulses of 1.4, away from the free minimum at 2."""
    limits = (Limit(criterion="valve_switches", value=7.0),)
    tried = bowl(tmp_path / "journal", limits=limits)
    chosen = best(tried, Aim(limits=limits))
    assert Aim(limits=limits).holds(chosen)
    assert chosen.values[2] == pytest.approx(1.4, abs=0.05)
    assert chosen.score.objective == pytest.approx(1.3 * math.log(1.4 / 2.0) ** 2, abs=0.05)
    free = best(tried, Aim(limits=()))  # the planted fault: a choice that forgets the limit
    assert free.score.reached["valve_switches"] > 7.0


def test_a_claim_that_must_hold_is_kept(bowl, tmp_path):
    aim = {"claims": (lambda law: max(0.0, law[0] - 0.4),)}
    chosen = best(bowl(tmp_path / "journal", **aim), Aim(limits=(), **aim))
    assert chosen.unproved == 0.0
    assert 0.35 < chosen.values[0] <= 0.4  # without the claim it is 0.5


def test_claims_are_asked_of_points_alone_that_keep_all_limits(bowl, tmp_path):
    """A proof takes longer than all stops of a point."""
    limits = (Limit(criterion="valve_switches", value=7.0),)
    asked = []

    def claim(law):
        asked.append(law)
        return 0.0

    tried = bowl(tmp_path / "journal", limits=limits, claims=(claim,))
    keeping = [each for each in tried if each.score.reached["valve_switches"] <= 7.0]
    assert 0 < len(asked) == len(keeping) < len(tried)


def test_not_a_number_is_never_chosen(bowl, tmp_path, monkeypatch):
    healthy = run.evaluate

    def planted(laws, sets, pool):
        for k, figures in enumerate(healthy(laws, sets, pool)):
            yield figures | {"excess": np.full(6, np.nan)} if k % 2 else figures

    monkeypatch.setattr(run, "evaluate", planted)
    tried = bowl(tmp_path / "journal")
    assert sum(math.isnan(each.score.objective) for each in tried) > 30
    assert best(tried, Aim(limits=())).score.objective < 0.02
    assert not any(math.isnan(each.score.objective) for each in front(tried))


@pytest.mark.parametrize("left", [0, 1, 7, 8, 50])
@pytest.mark.parametrize("torn", [b"", b'{"point": [0.1, 0.', b'{"point": 3}\n', b"\xff\x00\n"])
def test_an_interrupted_search_ends_as_a_whole_one(bowl, tmp_path, left, torn):
    path = tmp_path / "journal"
    whole = bowl(path)
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines[: 1 + left]) + torn)
    bowl.calls.clear()
    assert bowl(path) == whole
    assert bowl.calls["laws"] == 120 - left
    assert path.read_bytes() == b"".join(lines)


def test_a_journal_of_another_search_is_not_believed(bowl, tmp_path):
    path = tmp_path / "journal"
    bowl(path)
    bowl.calls.clear()
    assert not Journal(path, "key").replaced
    assert Journal(path, "another").replaced
    bowl(path)
    assert bowl.calls["laws"] == 120


def test_a_forged_score_would_be_seen(bowl, tmp_path):
    """The journal is believed: what is in it decides, so that its key has to hold all that scores depend on."""
    path = tmp_path / "journal"
    bowl(path, evaluations=20)
    lines = path.read_text().splitlines()
    entry = json.loads(lines[5]) | {"objective": -1.0}
    path.write_text("\n".join([*lines[:5], json.dumps(entry), *lines[6:]]) + "\n")
    assert best(bowl(path, evaluations=20), Aim(limits=())).score.objective == -1.0


def test_more_evaluations_go_on_from_fewer(bowl, tmp_path):
    path = tmp_path / "journal"
    few = bowl(path, evaluations=50)
    bowl.calls.clear()
    many = bowl(path, evaluations=80)
    assert many[:50] == few
    assert bowl.calls["laws"] == 30


def test_progress_counts_every_point(bowl, tmp_path):
    for left in (0, 4):  # a new search, and one that goes on
        told = []
        path = tmp_path / "journal"
        bowl(path, evaluations=10, progress=told.append)
        assert told == list(range(1, 11))
        path.write_text("".join(path.read_text().splitlines(keepends=True)[: 1 + left]))


def test_the_front_has_no_beaten_point(bowl, tmp_path):
    tried = bowl(tmp_path / "journal")
    found = front(tried)
    assert found[0] == best(tried, Aim(limits=()))
    costs = [(each.score.objective, each.score.reached["valve_switches"]) for each in found]
    assert costs == sorted(costs)
    assert [b for _, b in costs] == sorted((b for _, b in costs), reverse=True)
    for each in tried:
        cost = each.score.objective, each.score.reached["valve_switches"]
        assert each in found or any(a <= cost[0] and b <= cost[1] for a, b in costs)


def test_cma_needs_two_variables(er24pc, task, tmp_path):
    base = shipped_design("knorr-bremse", er24pc, load_rail("polach-wet"), task.specification)
    one = {"pulses": SearchRange(low=0.5, high=2.0, why="", relative=True)}
    space = Space(law="knorr-bremse", variables=variables_of(base, one), build=tuple)
    with pytest.raises(
        UserError, match='needs two or more variables, and knorr-bremse has 1; write method = "random"'
    ):
        search(
            space, Aim(limits=()), SETS, method="cma", evaluations=3, seed=0,
            journal=Journal(tmp_path / "j", "k"), pool=ThreadPoolExecutor(1),
        )  # fmt: skip


def test_nothing_waits_behind_a_failure():
    """A law that commands nonsense ends the search at once, with its sentence."""
    cancelled = []

    class Pool:
        def submit(self, *_):
            class Late:
                def result(self):
                    raise UserError("nonsense")

                def cancel(self):
                    cancelled.append(1)

            return Late()

    group = replace(SETS, groups=(type("G", (), {"numbers": (0,)})(),) * 3)
    with pytest.raises(UserError, match="nonsense"):
        list(evaluation.evaluate([None, None], group, Pool()))
    assert len(cancelled) == 6
