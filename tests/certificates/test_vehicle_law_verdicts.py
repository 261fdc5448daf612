"""Checks say in one sentence that they do not speak about a law of a vehicle; those about plant and rail still run."""

import pytest

from tests.unit.controllers.vehicle_cases import LAWS, protection
from wspd_design.certificates.records import Status
from wspd_design.certificates.suite import NAMES, verify
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.protected import protected
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_rail

ABOUT_PLANT_AND_RAIL = ("derivation", "gain_positive", "hard_limits")
OTHERS = ("well_posed", "holding_torque", "conservation", "stop_bound")  # that take longer, or simulate
OF_EVERY_LAW = ("feedback", "traced_loop", "overshoot", "slip_limit")  # with tests of their own
ABOUT_A_LAW = tuple(name for name in NAMES if name not in (*ABOUT_PLANT_AND_RAIL, *OTHERS, *OF_EVERY_LAW))


def checked(vehicle, law, only):
    specification = Specification(sample_time=law.sample_time)
    problem = stability_problem(vehicle, load_rail("polach-wet"), law, specification)
    return verify(problem, only=only, figures=False)


def laws(vehicle, make_controller):
    wrapped = protected(make_controller("smc", sample_time=0.02), vehicle, Sensors())
    return [*(protection(vehicle, law) for law in LAWS), wrapped]


def test_checks_about_a_law_of_one_wheelset_do_not_apply(er24pc, make_controller):
    for law in laws(er24pc, make_controller):
        for found in checked(er24pc, law, [name for name in ABOUT_A_LAW if name != "slip_band"]):
            assert found.status is Status.NOT_APPLICABLE, (law.name, found.name)
            assert law.name in found.explanation
            assert found.explanation.endswith(".")


@pytest.mark.parametrize("law", LAWS)
def test_checks_about_plant_and_rail_run(er24pc, law):
    found = checked(er24pc, protection(er24pc, law), ABOUT_PLANT_AND_RAIL)
    assert {each.status for each in found} == {Status.PROVED}
