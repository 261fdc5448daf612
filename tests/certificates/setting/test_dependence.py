"""What a claim about the plant depends on, read from its symbols: nothing more, nothing less."""

from fractions import Fraction

import pytest

from tests.certificates.symbols import used
from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.setting.plant import (
    AXLE_PLANT,
    plant_dynamics,
    plant_forces,
    plant_variables,
)


def claim_of(problem, which, **selection):
    return Claim(
        name=which,
        variables=plant_variables(problem, **selection),
        expression=lambda x: getattr(plant_dynamics(problem, x), which),
        form=(lambda x: getattr(plant_forces(problem, x), which)) if which != "gain" else None,
        relation="<=",
        bound=Fraction(0),
        unit="-",
    )


@pytest.fixture
def problem(make_problem, make_controller):
    return make_problem(make_controller("smc", "polach-wet"), rail="polach-wet")


def test_gain_depends_on_speed_inertia_and_radius_alone(problem):
    assert set(used(claim_of(problem, "gain"))) == {"speed", "wheelset inertia", "wheel radius"}


def test_force_depends_on_all_of_rail_and_contact_and_on_no_inertia(problem):
    found = set(used(claim_of(problem, "creep_force")))
    assert {"mu0", "friction ratio", "slip reduction", "semi axis lateral", "mass", "slip", "speed"} < found
    assert not found & {
        "wheelset inertia",
        "wheel radius",
        "resistance linear",
        "wheel damping",
        "nominal mass",
    }


def test_one_axle_does_not_feel_the_resistance(problem):
    assert "resistance linear" in used(claim_of(problem, "pole"))
    assert "resistance linear" not in used(claim_of(problem, "pole", uses=AXLE_PLANT))
