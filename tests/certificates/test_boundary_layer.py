"""The ultimate bound on the slip error, against runs of the idealized loop."""

from dataclasses import replace

import numpy as np
import pytest

from tests.certificates.round_trip import keep, no_proof_can_be_missed, no_word_can_be_changed, not_for
from wspd_design.certificates.checks.ideal_run import sliding_run
from wspd_design.certificates.checks.sliding import boundary_layer, reaching
from wspd_design.certificates.memory import remembering
from wspd_design.certificates.records import Status
from wspd_design.certificates.search import together
from wspd_design.certificates.setting.plant import plant_with


@pytest.fixture(scope="module")
def strong(make_problem, make_controller, narrow, er24pc):
    law = make_controller("smc", "polach-wet")
    law = replace(law, gains=replace(law.gains, switching_gain=20.0))
    bounds = narrow(er24pc, law.rail, mass=(70e3, 80e3), mu0=(0.28, 0.32))
    return make_problem(law, rail="polach-wet", bounds=bounds, speeds=(5.0, 30.0), slips=(0.05, 0.4))


@pytest.fixture(scope="module")
def proved(strong):
    return keep(boundary_layer.CHECK, strong)


def test_proved_where_the_reaching_condition_is(proved):
    assert proved.certificate.status is Status.PROVED
    assert all(each.status is Status.PROVED for each in proved.certificate.hypotheses)
    assert proved.certificate.claim.startswith("Once the layer is entered, and while the slip stays between")
    no_word_can_be_changed(proved)
    no_proof_can_be_missed(proved)


def test_the_bound_is_that_of_the_design(proved):
    """Audit B2: a file of another layer says another number, and is refused."""
    law = proved.problem.controller
    wider = replace(law, gains=replace(law.gains, boundary_layer=0.03))
    assert not_for(proved, replace(proved.problem, controller=wider))
    assert "0.05" in proved.certificate.claim


def test_what_reaching_has_found_is_not_searched_again(strong, monkeypatch):
    counted = []
    honest = together.extreme
    monkeypatch.setattr(together, "extreme", lambda *a, **k: counted.append(1) or honest(*a, **k))
    with remembering():
        reaching.CHECK.run(strong)
        first = len(counted)
        boundary_layer.CHECK.run(strong)
    assert len(counted) == first > 0
    boundary_layer.CHECK.run(strong)  # without the memory it is
    assert len(counted) == 2 * first


def test_runs_keep_the_bound(strong, proved):
    at = {point.name: point.value for point in proved.certificate.worst_point}
    gains = strong.controller.gains
    for mass, mu0, slip in ((70e3, 0.32, 0.4), (80e3, 0.28, 0.05), (76841.0, 0.3, 0.3)):
        vehicle, rail = plant_with(strong, {"mass": mass, "mu0": mu0})
        run = sliding_run(vehicle, rail, strong.controller, speeds=strong.speeds, slip=slip)
        error = gains.slip_reference - run.slip
        inside = np.abs(error + gains.surface_rate * run.integral) <= gains.boundary_layer
        entry = int(np.argmax(inside))
        assert inside[entry:].all()
        since = run.time[entry:] - run.time[entry]
        bound = at["bound on abs(e)"] + at["transient at the entry"] * np.exp(-at["c"] * since)
        assert np.all(np.abs(error[entry:]) <= bound)


def test_nothing_is_claimed_without_reaching(strong):
    law = strong.controller
    weak = replace(strong, controller=replace(law, gains=replace(law.gains, switching_gain=1.0)))
    verdict = boundary_layer.CHECK.run(weak)
    assert verdict.status is Status.UNDECIDED
    assert "Violated" in verdict.explanation


@pytest.mark.parametrize(
    ("changes", "text"),
    [({"boundary_layer": 0.07}, "inside the range"), ({"surface_rate": -0.4}, "stable")],
)
def test_planted_gains_lose_a_hypothesis(strong, changes, text):
    law = strong.controller
    planted = replace(strong, controller=replace(law, gains=replace(law.gains, **changes)))
    verdict = boundary_layer.CHECK.run(planted)
    assert verdict.status is Status.UNDECIDED
    assert [each.status for each in verdict.hypotheses if text in each.text] == [Status.REFUTED]


@pytest.mark.parametrize("name", ["afsmc", "trenitalia", "torque-feedback"])
def test_other_laws(make_problem, make_controller, name):
    assert boundary_layer.CHECK.run(make_problem(make_controller(name))).status is Status.NOT_APPLICABLE
