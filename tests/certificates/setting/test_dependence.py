"""What a claim depends on is read from its symbols: nothing more, nothing less, and the sentences follow."""

from dataclasses import replace
from fractions import Fraction

import pytest

from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.search.prover import extreme
from wspd_design.certificates.setting import dependence, domain
from wspd_design.certificates.setting.plant import (
    AXLE_PLANT,
    OTHERS,
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
    assert set(dependence.used(claim_of(problem, "gain"))) == {"speed", "wheelset inertia", "wheel radius"}


def test_force_depends_on_all_of_rail_and_contact_and_on_no_inertia(problem):
    found = set(dependence.used(claim_of(problem, "creep_force")))
    assert {"mu0", "friction ratio", "slip reduction", "semi axis lateral", "mass", "slip", "speed"} < found
    assert not found & {
        "wheelset inertia",
        "wheel radius",
        "resistance linear",
        "wheel damping",
        "nominal mass",
    }


def test_one_axle_does_not_feel_the_resistance(problem):
    assert "resistance linear" in dependence.used(claim_of(problem, "pole"))
    assert "resistance linear" not in dependence.used(claim_of(problem, "pole", uses=AXLE_PLANT))


def test_trimmed_claim_has_the_same_values_in_fewer_variables(problem):
    whole = claim_of(problem, "creep_force", hold=OTHERS, ranges={"speed": 5.0})
    less = dependence.trimmed(whole)
    assert {v.name for v in less.variables} == set(dependence.used(whole))
    assert len(less.variables) < len(whole.variables)
    assert "wheelset inertia" not in {v.name for v in less.free}
    one, other = (extreme(each, tolerance=1.0) for each in (whole, less))
    assert one.low <= other.high
    assert other.low <= one.high
    assert dependence.trimmed(less).statement() == less.statement()


def test_sentences_say_what_varies_what_is_held_and_which_axle(problem):
    claims = [
        claim_of(problem, "gain", hold=OTHERS),
        claim_of(problem, "deceleration", hold=("wheel radius",)),
    ]
    words = dependence.told(problem, claims)
    assert "held: wheel radius 0.55 m" in words
    assert words.endswith("axle at static load")
    assert "friction ratio 0.32 to 0.48" in words
    line = dependence.left_out(problem, claims)
    assert line.startswith("not varied: wheel radius, max torque, ")
    assert "vent time" in line
    assert "train deceleration" in line
    assert "mass" not in line
    every = dependence.told(problem, [claim_of(problem, "pole", uses=AXLE_PLANT)])
    assert "static load" not in every
    assert "axle load share 0.75" in every


def test_nothing_is_left_out_when_all_vary(problem):
    names = domain.uncertain(problem)
    everything = claim_of(problem, "pole", uses=(*AXLE_PLANT, *(n for n in names if n not in AXLE_PLANT)))

    def summed(x):
        return sum(x[name] for name in names)

    assert (
        dependence.left_out(problem, [replace(everything, expression=summed, form=None)])
        == "not varied: nothing"
    )
