"""A part and a place that a file states lie inside the domain, to the last bit."""

import math
from dataclasses import replace
from fractions import Fraction

import pytest

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.claim import Claim, variable
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.kernel.obligation import Inequality, OnPart, Special, proof_of
from wspd_design.certificates.records import Status

WITHIN = (2.5, 30.0)


def claim(ends, bound=40):
    """Speed <= bound on a range of it."""
    return Claim(
        name="speed itself",
        variables=(variable("speed", ends, "m/s"),),
        expression=lambda x: x["speed"],
        relation="<=",
        bound=Fraction(bound),
        unit="m/s",
    )


ON_PART = OnPart(key="slow", claim=claim, quantity="speed", within=WITHIN)
AT = Inequality(key="slow", claim=claim(WITHIN, bound=20))


def on_part(ends, **changes):
    proof = proof_of(claim(ends), ".")
    proof["statement"] |= changes
    return ON_PART.decide(Stated(proof=proof), Work())


@pytest.mark.parametrize(
    "ends", [WITHIN, (3.0, 30.0), (2.5, 4.0), (math.nextafter(2.5, 3.0), math.nextafter(30.0, 20.0))]
)
def test_a_part_of_the_domain_is_read_from_the_proof(ends):
    found = on_part(ends)
    assert found.status is Status.PROVED
    assert found.part == ends


@pytest.mark.parametrize(
    "ends",
    [
        (math.nextafter(2.5, 0.0), 30.0),
        (2.5, math.nextafter(30.0, 40.0)),
        (0.0, 1.0),
        (31.0, 32.0),
        (-1e9, 1e9),
    ],
)
def test_a_part_that_leaves_the_domain_is_refused(ends):
    with pytest.raises(Refused, match="not part of the domain"):
        on_part(ends)


@pytest.mark.parametrize("ends", [(2.5, 2.5), (10.0, 10.0), (30.0, 30.0)])
def test_a_single_value_is_not_a_part(ends):
    """What holds at one speed says nothing about a stop."""
    with pytest.raises(Refused, match="not part of the domain"):
        on_part(ends)


def test_a_part_between_two_doubles_is_refused():
    """The range of the claim is made of doubles, so that a proof on another range is another statement."""
    with pytest.raises(Refused, match="another statement"):
        on_part(WITHIN, variables=[["speed", "3000000000000000000001/1000000000000000000000", "30.0", "m/s"]])


@pytest.mark.parametrize(
    "variables",
    [
        [],
        None,
        7,
        [["speed", "2.5", "30.0"]],
        [["mass", "2.5", "30.0", "kg"]],
        [["speed", "30.0", "2.5", "m/s"]],
    ],
    ids=repr,
)
def test_a_proof_that_states_no_part_is_refused(variables):
    with pytest.raises(Refused, match="range of speed"):
        on_part(WITHIN, variables=variables)


def test_without_a_proof_nothing_is_known():
    found = ON_PART.decide(Stated(), Work())
    assert found.status is Status.UNDECIDED
    assert found.part == WITHIN


@pytest.mark.parametrize("speed", [math.nextafter(20.0, 30.0), 25.0, 30.0])
def test_a_place_inside_the_domain_denies(speed):
    found = AT.decide(Stated(place={"speed": speed}), Work())
    assert found.status is Status.REFUTED
    assert found.low <= speed


@pytest.mark.parametrize("speed", [2.5, 20.0])
def test_a_place_where_the_claim_holds_denies_nothing(speed):
    assert AT.decide(Stated(place={"speed": speed}), Work()).status is Status.UNDECIDED


OUTSIDE = [
    *(30.0 * (1.0 + excess) for excess in (2e-9, 1e-6, 1e-4, 5e-3, 0.5)),
    math.nextafter(30.0, 40.0),
    math.nextafter(2.5, 0.0),
    -25.0,
    1e300,
]


@pytest.mark.parametrize("speed", OUTSIDE)
def test_a_place_outside_the_domain_is_refused_by_whatever_amount(speed):
    with pytest.raises(Refused, match="outside the box"):
        AT.decide(Stated(place={"speed": speed}), Work())
    special = Special(
        key="fast", text="slow", evaluate=lambda place, _: dict(place), within={"speed": WITHIN}
    )
    with pytest.raises(Refused, match="leaves the domain"):
        special.decide(Stated(place={"speed": speed}), Work())
    assert special.decide(Stated(place={"speed": 30.0}), Work()).status is Status.REFUTED


@pytest.mark.parametrize("speed", [math.nan, math.inf, -math.inf])
def test_a_place_that_is_not_finite_is_refused(speed):
    special = Special(
        key="fast", text="slow", evaluate=lambda place, _: dict(place), within={"speed": WITHIN}
    )
    for obligation in (AT, special):
        with pytest.raises(Refused, match=r"not finite|leaves the domain"):
            obligation.decide(Stated(place={"speed": speed}), Work())


@pytest.mark.parametrize("place", [{"slip": 25.0}, {"speed": 25.0, "slip": 0.1}])
def test_a_place_names_the_free_quantities_and_nothing_else(place):
    special = Special(
        key="fast", text="slow", evaluate=lambda place, _: dict(place), within={"speed": WITHIN}
    )
    for obligation in (AT, special):
        with pytest.raises(Refused, match="must name speed and nothing else"):
            obligation.decide(Stated(place=place), Work())


def test_proof_and_place_of_a_special_statement_exclude_each_other():
    special = Special(
        key="fast",
        text="slow",
        check=lambda *_: {},
        evaluate=lambda place, _: dict(place),
        within={"speed": WITHIN},
    )
    assert special.decide(Stated(proof={}), Work()).status is Status.PROVED
    with pytest.raises(Refused, match="no proof can show fast"):
        special.decide(Stated(proof={}, place={"speed": 25.0}), Work())
    for dumb in (replace(special, check=None), replace(special, evaluate=None)):
        stated = Stated(proof={}) if dumb.check is None else Stated(place={"speed": 25.0})
        with pytest.raises(Refused, match=r"no (proof can show|place can deny) fast"):
            dumb.decide(stated, Work())
