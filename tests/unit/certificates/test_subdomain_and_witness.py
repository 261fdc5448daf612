"""A subdomain and a witness that a file states lie inside the domain: by an ulp, and up to the rounding of a unit."""

import math
from fractions import Fraction

import pytest
from wspd_design.certificates.kernel.counterexample import denials
from wspd_design.certificates.kernel.enclosures import Refused
from wspd_design.certificates.kernel.subdomain import stated_part

from wspd_design.certificates.kernel.claim import Claim, variable
from wspd_design.certificates.kernel.obligation import inequality
from wspd_design.certificates.records import Point

WITHIN = (2.5, 30.0)


@pytest.mark.parametrize("ends", [WITHIN, (2.5, 2.5), (3.0, 30.0), (2.5, 4.0)])
def test_a_part_of_the_domain_is_read(ends):
    content = {"part": {"speed": [repr(end) for end in ends]}}
    assert stated_part(content, "speed", WITHIN) == ends


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
    content = {"part": {"speed": [repr(end) for end in ends]}}
    with pytest.raises(Refused, match="no part of the domain"):
        stated_part(content, "speed", WITHIN)


def witnessed(speed, unit="m/s"):
    """What a witness at a speed denies of speed <= 20 on 2.5 to 30 m/s."""
    claim = Claim(
        name="speed itself",
        variables=(variable("speed", WITHIN, "m/s"),),
        expression=lambda x: x["speed"],
        relation="<=",
        bound=Fraction(20),
        unit="m/s",
    )
    return denials((inequality(claim),), (Point(name="speed", value=speed, unit=unit),), WITHIN)


def test_a_witness_inside_the_domain_denies():
    assert len(witnessed(25.0)) == len(witnessed(30.0)) == 1


@pytest.mark.parametrize("excess", [2e-9, 1e-6, 1e-4, 5e-3, 0.5])
def test_a_witness_outside_the_domain_is_refused(excess):
    with pytest.raises(Refused, match="leaves the domain"):
        witnessed(30.0 * (1.0 + excess))


def test_the_rounding_of_a_unit_is_no_excess():
    """120 km/h and what 33.3... m/s gives in km/h differ by an ulp."""
    for ulps in range(-3, 4):
        speed = 108.0
        for _ in range(abs(ulps)):
            speed = math.nextafter(speed, math.copysign(math.inf, ulps))
        assert len(witnessed(speed, "km/h")) == 1
