"""The ultimate bound of the slip error, against runs of the idealized loop."""

from dataclasses import replace

import numpy as np
import pytest

from wspd_design.certificates.checks.ideal_run import sliding_run
from wspd_design.certificates.checks.sliding import boundary_layer
from wspd_design.certificates.records import Hypothesis, Status
from wspd_design.certificates.setting.domain import varied
from wspd_design.certificates.setting.laws import of_theorem


@pytest.fixture(scope="module")
def strong(make_problem, make_controller):
    law = make_controller("smc")
    return make_problem(replace(law, gains=replace(law.gains, switching_gain=40.0)))


@pytest.fixture(scope="module")
def proved(strong):
    return boundary_layer.check(strong)


def test_proved_where_the_reaching_condition_is(proved):
    assert proved.status is Status.PROVED
    assert all(each.status is Status.PROVED for each in proved.hypotheses)
    assert proved.proofs


def test_runs_keep_the_bound(strong, proved):
    at = {point.name: point.value for point in proved.worst_point}
    gains = strong.controller.gains
    for mass, mu0, slip in ((61473.0, 0.66, 0.6), (92209.0, 0.44, 0.02), (76841.0, 0.55, 0.4)):
        vehicle, rail = varied(strong, mass, 752.0, mu0)
        run = sliding_run(vehicle, rail, strong.controller, speeds=strong.speeds, slip=slip)
        error = gains.slip_reference - run.slip
        inside = np.abs(error + gains.surface_rate * run.integral) <= gains.boundary_layer
        entry = int(np.argmax(inside))
        assert inside[entry:].all()
        since = run.time[entry:] - run.time[entry]
        bound = at["bound of abs(e)"] + at["transient at the entry"] * np.exp(-at["c"] * since)
        assert np.all(np.abs(error[entry:]) <= bound)


def test_nothing_is_claimed_without_reaching(make_problem, make_controller):
    law = make_controller("smc")
    weak = replace(law, gains=replace(law.gains, switching_gain=1.0))
    verdict = boundary_layer.check(make_problem(weak))
    assert verdict.status is Status.UNDECIDED
    assert "Violated" in verdict.explanation


@pytest.mark.parametrize(
    ("changes", "text"),
    [({"boundary_layer": 0.07}, "inside the domain"), ({"surface_rate": -0.4}, "stable")],
)
def test_planted_gains_lose_a_hypothesis(strong, changes, text):
    law = strong.controller
    verdict = boundary_layer.check(
        replace(strong, controller=replace(law, gains=replace(law.gains, **changes)))
    )
    assert verdict.status is Status.UNDECIDED
    assert [each.status for each in verdict.hypotheses if text in each.text] == [Status.REFUTED]


@pytest.mark.parametrize("name", ["afsmc", "trenitalia", "torque-feedback"])
def test_other_laws(make_problem, make_controller, name):
    assert boundary_layer.check(make_problem(make_controller(name))).status is Status.NOT_APPLICABLE


@pytest.mark.parametrize(
    ("statuses", "expected"),
    [
        ((Status.PROVED, Status.PROVED), Status.PROVED),
        ((Status.PROVED, Status.EVIDENCE), Status.EVIDENCE),
        ((Status.EVIDENCE, Status.UNDECIDED), Status.UNDECIDED),
        ((Status.PROVED, Status.REFUTED), Status.UNDECIDED),
        ((Status.PROVED, Status.NOT_APPLICABLE), Status.UNDECIDED),
    ],
)
def test_theorem_is_as_strong_as_its_weakest_hypothesis(statuses, expected):
    assert of_theorem(Hypothesis(text="", status=each) for each in statuses) is expected
