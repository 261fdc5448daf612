"""From a task to a design: one look at the held-out sets, and a design that says and keeps what was found."""

from dataclasses import replace
from functools import partial

import pytest

from wspd_design.certificates.records import Certificate, Status
from wspd_design.design import finding, judging
from wspd_design.design.file import read_design, write_design
from wspd_design.design.finding import explained, find, space_of
from wspd_design.design.judging import judge
from wspd_design.design.requirements import DrawnSets, Limit
from wspd_design.design.search.run import ranked
from wspd_design.design.selection import design_controller
from wspd_design.design.specification_file import read_task
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.campaign_rows import figures_of


@pytest.fixture(scope="module")
def task(tmp_path_factory):
    path = tmp_path_factory.mktemp("task") / "small.toml"
    path.write_text(
        """schema = "wspd-specification/1"
name = "small"
law = "torque-feedback"
vehicle = "er24pc"
sample_time = "100 ms"
[requirements]
rails = ["polach-dry", "polach-wet"]
held_out = { sets = 20, seed = 9000 }
[requirements.limits]
efficiency_mean = "80 %"
valve_switches = "9 1/s"
[requirements.stop]
initial_speed = "30 km/h"
[requirements.draw]
vehicle.brake.max_torque = { uniform = ["45 kN m", "75 kN m"] }
stop.sensing.speed_noise = { choice = ["0.02 m/s", "0.05 m/s"] }
[search]
evaluations = 16
sets = 18
seed = 1
"""
    )
    return read_task(str(path))


@pytest.fixture(scope="module")
def start(er24pc, task):
    return design_controller(er24pc, load_rail("polach-wet"), task.specification, law=task.law)


@pytest.fixture(scope="module")
def search(task, start, er24pc):
    """Find a design with some requirements changed; what is found goes into a journal."""
    space = space_of(start, er24pc, load_rail("polach-wet"))

    def found(journal, keep=True, effort=task.effort, **changes):
        wanted = replace(task, requirements=replace(task.requirements, **changes), effort=effort)
        return find(wanted, space, keep=keep, journal=journal)

    return found


@pytest.fixture(scope="module")
def usual(search, tmp_path_factory):
    """What is found of the task as it stands, by code in which nothing is planted."""
    return search(tmp_path_factory.mktemp("usual") / "journal")


@pytest.fixture(scope="module")
def free(search, tmp_path_factory):
    """What is found where no limit has to be kept."""
    return search(tmp_path_factory.mktemp("free") / "journal", keep=False)


@pytest.fixture
def finds(search, tmp_path):
    return partial(search, tmp_path / "journal")


def test_the_held_out_sets_are_looked_at_once_and_last(finds, monkeypatch):
    """Two laws on the held-out sets, the start and the chosen one, after everything else; the search saw none."""
    seeds = []

    def counted(cases, controller, ideal, runs):
        seeds.append({scenario.seed for _, scenario in cases})
        return figures_of(cases, controller, ideal, runs)

    monkeypatch.setattr("wspd_design.design.search.evaluation.figures_of", counted)
    drawn = []
    for module in (finding, judging):
        draw_sets = module.draw_sets

        def told(requirements, vehicle, name, wanted, pool, draw_sets=draw_sets):
            drawn.append((wanted.seed, len(seeds)))
            return draw_sets(requirements, vehicle, name, wanted, pool)

        monkeypatch.setattr(module, "draw_sets", told)
    found = finds()
    assert [seed for seed, _ in drawn] == [1, 9000]
    before = drawn[1][1]
    assert before == len(seeds) - 2 * 2  # two laws, two groups
    assert all(max(seen) < 9000 for seen in seeds[:before])
    assert all(min(seen) >= 9000 for seen in seeds[before:])
    assert found.held_out.reached != found.held_out_start.reached


def test_the_design_says_what_was_found(usual, task, start, tmp_path):
    found = usual
    made = explained(found, start, "made")
    assert made.requirements == task.requirements
    assert (made.name, made.law, made.vehicle) == ("made", "torque-feedback", "er24pc")
    values = dict(zip((each.name for each in found.space.variables), found.chosen.values, strict=True))
    assert made.specification.slip == values["slip_reference"]
    assert made.gain("torque_gain") == values["torque_gain"]
    assert made.gain("sliding_gain") == pytest.approx(values["sliding_gain"] * start.gain("sliding_gain"))
    for gain in made.gains:
        assert "best of 16 evaluations on 18 sets of seed 1 (cma)" in gain.why
        assert next(each.why for each in start.gains if each.name == gain.name) in gain.why
    assert found.tried[0].values[1:] == pytest.approx((1.0, start.gain("torque_gain")))
    assert {each.name for each in found.sensitivities} == set(values)
    path = tmp_path / "made.toml"
    write_design(made, path)
    assert read_design(path) == made


def test_the_reason_says_how_many_points_kept_the_limits(finds, free):
    """The first generation is the same with and without limits, so that some point is sure to keep this one."""
    most = max(each.score.reached["vented_air"] for each in free.tried[:8])
    limit = Limit(criterion="vented_air", value=most + 0.5)
    bound = finds(limits=(limit,))
    (kept,) = bound.limits
    assert kept.value == pytest.approx(limit.value - 0.5)  # half a scale in reserve
    assert bound.tried[:8] == free.tried[:8]
    holding = sum(each.score.reached["vented_air"] <= kept.value for each in bound.tried)
    assert bound.reason.startswith(
        f"smallest objective of the {holding} points among 16 that keep all limits: "
    )
    assert free.reason.startswith("smallest objective of 16 points, without limits: ")


def test_a_limit_that_cannot_be_kept_is_missed_least(finds):
    impossible = (Limit(criterion="efficiency_mean", value=0.999),)
    found = finds(limits=impossible)
    assert "none of 16 points keeps all limits and claims" in found.reason
    (judged,) = (each for each in found.judged if each.limit is not None)
    assert judged.met is False
    best = max(each.score.reached["efficiency_mean"] for each in found.tried)
    assert found.chosen.score.reached["efficiency_mean"] == best


def test_quadratic_functions_that_must_be_found_are_claims(finds, free, monkeypatch):
    """Planted answers: they are found for torque gains below that of the free optimum only."""
    edge = free.chosen.values[-1]
    asked = []

    def closes(law, vehicle, rail, *, speeds, share):
        asked.append((vehicle.name, rail.name, speeds, share))
        return 0.9 if law.gains.torque_gain < edge else None

    monkeypatch.setattr(finding, "closes", closes)
    monkeypatch.setattr(judging, "closes", closes)
    found = finds(limits=(), stable_within=(("polach-dry", 0.5),))
    assert set(asked) == {("er24pc", "polach-dry", (10 / 3.6, 120 / 3.6), 0.5)}
    told = found.judged[-1]
    assert (told.requirement, told.title) == (
        "stable_within",
        "state left per sample, 50% of the box of polach-dry",
    )
    if found.chosen.unproved:
        assert (told.reached, told.met) == (None, False)
        assert "keeps all limits and claims" in found.reason
    else:
        assert found.chosen.values[-1] < edge
        assert (told.limit, told.reached, told.met) == (1.0, 0.9, True)
    asked.clear()
    assert finds(keep=False, stable_within=(("polach-dry", 0.5),)).chosen.unproved == 0.0
    assert len(asked) == 1  # told of the chosen one, not asked of every point


def test_anybody_can_judge_the_design_again(usual, start, tmp_path):
    found = usual
    made = explained(found, start, "made")
    again = judge(made, load_rail("polach-wet"))
    assert again == found.judged
    reached = {each.requirement: each.reached for each in again}
    assert reached == dict(found.held_out.reached)
    assert judge(made, load_rail("polach-wet"), folder=tmp_path) == again


def test_a_design_without_requirements_cannot_be_judged(start):
    with pytest.raises(
        UserError, match="states no requirements; make it from a specification: wspd design SPEC"
    ):
        judge(start, load_rail("polach-wet"))


def test_certificates_that_must_hold_choose_among_the_best(finds, free, monkeypatch):
    """Planted verdicts: only laws with a torque gain below that of the free optimum are proved."""
    wanted = ("open_loop_pole",)
    edge = free.chosen.values[-1]

    def verdict(problem, *, only, figures):
        assert (only, figures) == (("open_loop_pole",), False)
        proved = problem.controller.gains.torque_gain < edge
        status = Status.PROVED if proved else Status.UNDECIDED
        return (
            Certificate(name="open_loop_pole", title="", claim="", status=status, explanation="", method=""),
        )

    monkeypatch.setattr("wspd_design.certificates.suite.verify", verdict)
    found = finds(keep=False, certificates=wanted)
    ranked = sorted(free.tried, key=lambda each: each.score.objective)[: finding.PROOF_TRIALS]
    proved = [each for each in ranked if each.values[-1] < edge]
    if proved:
        assert (found.chosen.values, found.unproved) == (proved[0].values, ())
    else:
        assert (found.chosen.values, found.unproved) == (ranked[0].values, ("open_loop_pole",))
    edge = -1.0
    assert finds(keep=False, certificates=wanted).unproved == ("open_loop_pole",)


def test_a_final_judges_the_best_points_on_further_sets(finds, usual, task):
    """Chosen is the best of start and best points there; held-out sets stay unseen."""
    drawn = DrawnSets(sets=24, seed=500_000)
    found = finds(effort=replace(task.effort, final=drawn))
    assert [each.point for each in found.tried] == [each.point for each in usual.tried]
    aim = finding.Aim(limits=found.limits)
    kept = {each.point for each in found.finalists}
    assert found.tried[0].point in kept
    others = [each.point for each in ranked(found.tried[1:], aim) if each.point != found.tried[0].point]
    assert kept - {found.tried[0].point} == set(others[: finding.FINALISTS])
    assert [aim.rank(each) for each in found.finalists] == sorted(map(aim.rank, found.finalists))
    assert found.chosen.point == found.finalists[0].point
    assert found.chosen in found.tried  # with its score on the sets of the search
    first = next(each for each in found.finalists if each.point == found.chosen.point)
    assert first.score != found.chosen.score
    assert "24 further sets of seed 500000" in found.reason


def test_a_lucky_point_does_not_survive_the_final(finds, usual, task, monkeypatch):
    """Planted luck: the best point of the search is the worst of the final."""
    drawn = DrawnSets(sets=24, seed=500_000)
    lucky = usual.chosen.point
    honest = finding.evaluate

    def unlucky(laws, sets, pool):
        for place, figures in enumerate(honest(laws, sets, pool)):
            worse = sets.drawn == drawn and place == 0  # the best of the search comes first
            yield {**figures, "excess": figures["excess"] + 1.0} if worse else figures

    monkeypatch.setattr(finding, "evaluate", unlucky)
    assert finds(effort=replace(task.effort, final=drawn)).chosen.point != lucky
