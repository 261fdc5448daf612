"""How a deviation grows near the reference: told by the form of a law, by its traced step, or not at all."""

from tests.certificates.own_laws import OwnLaw, held_share, sliding
from wspd_design.certificates.suite import verify
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_rail
from wspd_design.studies.loop_growth import growth_of, speaking

CHECKS = ("margins", "traced_loop")


def judged(vehicle, law, rail):
    problem = stability_problem(vehicle, load_rail(rail), law, Specification(sample_time=law.sample_time))
    found = verify(problem, only=CHECKS, figures=False)
    check = speaking({each.name: each for each in found})
    return check and check.name, growth_of(problem, found)


def proportional(gain):
    return OwnLaw(rule=lambda state, m: (state, held_share(m.speed) + gain * sliding(m)), elements=0)


def test_an_own_law_is_told_by_its_step(er24pc):
    name, growth = judged(er24pc, proportional(-0.3), "polach-dry")
    assert name == "traced_loop"
    assert growth.factor > 1.0
    assert growth.speed > 0.0


def test_a_law_with_a_known_form_is_told_by_it(er24pc, make_controller):
    name, growth = judged(er24pc, make_controller("smc", "polach-wet"), "polach-wet")
    assert (name, growth.speeds) == ("margins", 25)
    assert growth.factor > 1.0


def test_rules_that_switch_have_no_growth(er24pc, make_controller):
    assert judged(er24pc, make_controller("trenitalia"), "polach-wet") == (None, None)
