"""What the checker accepts and what it must refuse: false sets, other claims, garbage, wrong searches."""

import json
import math
from copy import deepcopy
from dataclasses import replace

import flint
import numpy as np
import pytest

from tests.certificates.invariance.loops import check, drawn, feedback_problem
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.search.invariant_sets import document, one_sample, search
from wspd_design.certificates.search.invariant_sets.search import search as search_sets
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.theorems.invariant_sets.ball_plant import BallPlant
from wspd_design.certificates.theorems.invariant_sets.ball_slopes import law_slopes
from wspd_design.certificates.theorems.invariant_sets.checker import decide
from wspd_design.controllers.protocol import Command
from wspd_design.controllers.torque_feedback import TorqueFeedback
from wspd_design.model.number import atan, clip, exp
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.bounds import EXACT


def changed(written, change, problem=None):
    """The sets after a change of their content, for the claim of a problem."""
    content = deepcopy(written)
    if problem is not None:
        content["claim_sha256"] = model_hash(problem)
    change(content)
    return content


def refused(problem, written):
    verdict = check(problem, written)
    assert not verdict.accepted
    assert all(math.isnan(bound) for bound in verdict.slips)
    return verdict.reason


def test_true_sets_are_accepted(problem, written, found):
    verdict = check(problem, written)
    assert verdict.accepted, verdict.reason
    low, high = verdict.slips
    fastest = written["windows"][0]
    size, cells = 1.0 / fastest["per_unit"], [int(each) for each in fastest["columns"]]
    assert low <= min(cells) * size < 0.14 < (max(cells) + 1) * size <= high < 0.5
    assert len(json.dumps(written)) < 20_000
    assert len(found) == len(written["windows"]) == 3


def test_other_claims_are_refused(problem, written):
    for other in (
        replace(
            problem, bounds=problem.bounds | {"mu0": (0.9 * problem.span("mu0")[0], problem.span("mu0")[1])}
        ),
        replace(
            problem,
            bounds=problem.bounds | {"mass": (problem.span("mass")[0], 1.2 * problem.span("mass")[1])},
        ),
        replace(
            problem,
            bounds=problem.bounds
            | {
                "wheelset inertia": (
                    0.3 * problem.span("wheelset inertia")[0],
                    problem.span("wheelset inertia")[1],
                )
            },
        ),
        replace(problem, sample_time=0.2),
        feedback_problem(sliding_gain=0.2),
        feedback_problem(rail="polach-dry"),
    ):
        assert "another model" in refused(other, written)
        # Also with the fingerprint forged: the sets themselves do not hold.
        assert "may leave" in refused(other, changed(written, lambda _: None, other))


def test_a_larger_range_of_speed_is_refused(problem, written):
    for speeds in ((22.0, 26.0), (23.0, 26.5)):
        other = replace(problem, speeds=speeds)
        assert "cover" in refused(other, changed(written, lambda _: None, other))

    def stretch(content):
        content["windows"][-1]["low"] = 12.0

    other = replace(problem, speeds=(12.0, 26.0))
    assert "may leave" in refused(other, changed(written, stretch, other))


def test_gaps_and_jumps_are_refused(problem, written):
    def drop(content):
        del content["windows"][1]

    def slit(content):
        content["windows"][1]["high"] -= 1e-9

    def crowd(content):
        middle = content["windows"][1]
        thin = {**middle, "low": middle["high"] - 0.05}
        content["windows"].insert(1, thin)
        middle["high"] = thin["low"]

    assert "gap" in refused(problem, changed(written, drop))
    assert "gap" in refused(problem, changed(written, slit))
    assert "jump" in refused(problem, changed(written, crowd))


def columns(content, window=0):
    return content["windows"][window]["columns"]


def test_a_cell_more_is_refused(problem, written):
    def add(content):
        columns(content)["100"] = [*columns(content)["100"], 300, 301]  # large slip under large torque

    def hide(content, level):
        columns(content)["40"] = [*columns(content)["40"], level, level + 1]

    assert "may leave" in refused(problem, changed(written, add))
    beside = columns(written)["40"][-1] + 6
    assert "may leave" in refused(problem, changed(written, lambda content: hide(content, beside)))
    # Far above, the cell stands for torques that no brake has: no state is there, none can leave.
    assert check(problem, changed(written, lambda content: hide(content, 800))).accepted


@pytest.mark.parametrize("seed", range(4))
def test_a_cell_less_is_refused(problem, written, seed):
    """Some other cell maps onto what was taken out; the reference row stays."""
    rng = np.random.default_rng(seed)
    row = rng.choice([30, 32, 34, 38, 40])

    def remove(content):
        first, last = columns(content)[str(row)][:2]
        hole = (first + last) // 2 + int(rng.integers(-8, 9))
        columns(content)[str(row)] = [first, hole, hole + 1, last]

    assert "may leave" in refused(problem, changed(written, remove))


def test_sets_without_the_reference_are_refused(problem, written):
    def empty(content):
        content["windows"][0]["columns"] = {}

    assert "no state at the reference" in refused(problem, changed(written, empty))


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("format",), "wspd-invariant-sets/0"),
        (("windows",), []),
        (("windows",), None),
        (("windows",), [1] * 3),
        (("windows", 0, "steps"), 0),
        (("windows", 0, "steps"), 10**9),
        (("windows", 0, "steps"), True),
        (("windows", 0, "per_unit"), 100),
        (("windows", 0, "per_unit"), 2**40),
        (("windows", 0, "tilt"), float("nan")),
        (("windows", 0, "high"), float("inf")),
        (("windows", 0, "columns"), [3]),
        (("windows", 0, "columns"), {"x": [1, 2]}),
        (("windows", 0, "columns"), {"17": [1, 2, 3]}),
        (("windows", 0, "columns"), {"17": [60, 50]}),
        (("windows", 0, "columns"), {"17": [1.5, 70.5]}),
        (("windows", 0, "columns"), {"17": [0, 10**12]}),
        (("windows", 0, "columns"), {"17": [10**400, 10**400 + 1]}),
    ],
)
def test_garbage_is_refused(problem, written, path, value):
    def plant(content):
        for key in path[:-1]:
            content = content[key]
        content[path[-1]] = value

    assert refused(problem, changed(written, plant))


@pytest.mark.parametrize("garbage", ["", "{", [], 3, None, {}, {"format": 1}])
def test_no_sets_are_refused(problem, garbage):
    assert refused(problem, garbage)


def test_more_work_than_the_checker_may_do_is_refused(problem, written):
    with pytest.raises(Refused, match="more work"):
        decide(problem, written, Work(50_000))


def test_a_law_with_memory_is_refused(problem, written, make_controller):
    other = replace(problem, controller=make_controller("smc", "polach-wet", sample_time=0.02))
    assert "memory" in refused(other, changed(written, lambda _: None, other))


def test_wrong_searches_are_refused(problem, monkeypatch):
    """Mutated searches find sets that are too large, and the checker sees each of them."""

    def found_by(other):
        sets = search.search(other, most_work=math.inf)
        assert None not in sets
        return document.write(problem, sets)

    assert check(problem, found_by(problem)).accepted
    nominal = feedback_problem(spread=0.0)
    hopeful = replace(nominal, bounds=nominal.bounds | {"mu0": problem.span("mu0")})
    assert refused(
        feedback_problem(spread=0.03),
        changed(found_by(hopeful), lambda _: None, feedback_problem(spread=0.03)),
    )
    brake = problem.vehicle.brake
    quick = replace(brake, fill_time=0.2 * brake.fill_time, vent_time=0.2 * brake.vent_time)
    assert refused(
        problem, found_by(replace(problem, vehicle=replace(problem.vehicle, brake=quick)))
    )  # no lag
    right = search.images

    def shrunk(*arguments, **options):
        image = right(*arguments, **options)
        quarter = np.where(np.isfinite(image.slip_high), (image.slip_high - image.slip_low) / 4.0, 0.0)
        return replace(image, slip_low=image.slip_low + quarter, slip_high=image.slip_high - quarter)

    with monkeypatch.context() as patch:
        patch.setattr(search, "images", shrunk)
        assert refused(problem, found_by(problem))
    with monkeypatch.context() as patch:
        patch.setattr(
            search, "images", lambda p, w, s, z, steps: right(p, replace(w, low=w.high), s, z, steps=steps)
        )
        assert refused(problem, found_by(problem))  # top speed only
    rate = one_sample.slip_rate
    with monkeypatch.context() as patch:
        patch.setattr(one_sample, "slip_rate", lambda p, s, v, t: 0.2 * rate(p, s, v, t))
        assert refused(problem, found_by(problem))  # slow slip


def test_rate_on_balls_is_that_of_the_kernels():
    problem = feedback_problem(spread=0.1)
    plant = BallPlant(problem)
    rng = np.random.default_rng(5)
    for _ in range(300):
        vehicle, rail = drawn(problem, rng)
        slip, speed, torque = rng.uniform(0.02, 0.6), rng.uniform(2.0, 34.0), rng.uniform(0.0, 6e4)
        at = slip_dynamics(vehicle, rail, slip, speed)
        assert plant.rate(flint.arb(slip), flint.arb(speed), flint.arb(torque)).contains(
            flint.arb(at.drift + at.gain * torque)
        )
        wide = plant.rate(flint.arb(slip, 0.02), flint.arb(speed, 0.1), flint.arb(torque, 50.0))
        assert wide.contains(flint.arb(at.drift + at.gain * torque))
        thin = BallPlant(
            replace(
                problem,
                bounds=EXACT,
            )
        ).rate(flint.arb(slip), flint.arb(speed), flint.arb(torque))
        assert float(thin.rad()) < vehicle.wheel_damping / vehicle.wheel_inertia


def test_rate_on_balls_sees_inward_rounding():
    """The exact value, at 300 bits, of thin arguments lies inside; half the ball would not hold it."""
    problem = replace(
        feedback_problem(spread=0.0), vehicle=replace(feedback_problem().vehicle, wheel_damping=0.0)
    )
    arguments = [flint.arb(x) for x in (0.137, 11.3, 21234.5)]
    thin = BallPlant(problem).rate(*arguments)
    with flint.ctx.workprec(300):
        exact = BallPlant(problem).rate(*arguments)
    assert thin.contains(exact)
    assert 0.0 < float(thin.rad()) < 1e-10


def test_slopes_of_balls_enclose_differences():
    def function(x, y):
        return (clip(exp(-x) * y / (1.0 + x**2) - atan(y - x), -0.5, 0.6), abs(2.0 - x) - y, 3.0)

    rng = np.random.default_rng(6)
    for _ in range(100):
        center, width = rng.uniform(0.3, 2.0, 2), rng.uniform(0.0, 0.1, 2)
        found = law_slopes(function, tuple(flint.arb(c, w) for c, w in zip(center, width, strict=True)))
        points = center + width * rng.uniform(-1.0, 1.0, (2, 2))
        first, second = (function(*map(float, point)) for point in points)
        for a, b, (value, slopes) in zip(first, second, found, strict=True):
            assert (value + flint.arb(0, 1e-13)).contains(flint.arb(a))
            moved = sum((s * (p - q) for s, p, q in zip(slopes, *points, strict=True)), flint.arb(0, 1e-13))
            assert moved.contains(flint.arb(a - b))


def test_a_train_that_is_pushed_is_refused():
    """Where the speed can rise, a state comes into a faster window, about whose set nothing is said."""
    plain = feedback_problem(spread=0.0)
    vehicle = replace(plain.vehicle, resistance_constant=-170e3)
    pushed = replace(plain, vehicle=vehicle, controller=replace(plain.controller, vehicle=vehicle))
    found = search_sets(pushed, most_work=math.inf)
    assert None not in found
    assert not check(pushed, document.write(pushed, found)).accepted


@pytest.mark.parametrize("law", [lambda x: (1.0 if x == 0 else 0.0,), lambda x: (1.0 if x else 0.0,)])
def test_a_law_that_asks_for_a_single_value_cannot_be_enclosed(law):
    with pytest.raises(TypeError):
        law_slopes(law, (flint.arb(0, 1),))


class FillsAtOneSpeed(TorqueFeedback):
    """A fault at a single speed, which slopes on balls do not see."""

    __slots__ = ()

    def step(self, state, measurement):
        if measurement.speed == 25.0:
            return state, Command(fill=1.0, vent=0.0)
        return TorqueFeedback.step(self, state, measurement)


def test_a_fault_at_a_single_speed_is_refused(problem, found):
    law = problem.controller
    names = ("name", "sample_time", "vehicle", "rail", "gains")
    faulty = replace(problem, controller=FillsAtOneSpeed(**{name: getattr(law, name) for name in names}))
    assert not check(faulty, document.write(faulty, found)).accepted
