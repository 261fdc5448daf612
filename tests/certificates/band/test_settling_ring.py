"""Rings around the ellipsoid of a band, and faults that are refused."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest

import wspd_design as wd
from tests.certificates.band.conftest import certificate_of, problem_of
from wspd_design.certificates.kernel.checker import Refused
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.search.slip_band.rings import widened
from wspd_design.certificates.theorems.band import CELLS, contact_held
from wspd_design.certificates.theorems.from_rolling.ring import Ring, added_by, led, scaled
from wspd_design.certificates.theorems.slip_band.proof import read
from wspd_design.certificates.theorems.slip_band.statement import box_of, windows_of

pytestmark = pytest.mark.slow
TIMES, SUPPLY = Fraction(9), Fraction(9, 16)


@pytest.fixture(scope="module")
def asked():
    """Problem, proof and its place: the fastest window of the only cell."""
    problem = problem_of(1.0, rail=wd.load_rail("low-adhesion"))
    windows = windows_of(problem)
    document = json.loads(certificate_text(certificate_of(problem)))
    found = read(document["findings"][CELLS]["proof"], len(windows))
    return contact_held(problem), found, (box_of(problem, found.share), len(windows) - 1), found.cells[0][-1]


def ring_of(band, times=TIMES, **other):
    return Ring(
        **{"ellipsoid": widened(band, times, SUPPLY), "inside": Fraction(1, 2), "spared": Fraction(1, 2)}
        | other
    )


def test_a_wider_ellipsoid_leads_into_the_band(asked):
    *_, band = asked
    shown = led(*around(asked), [ring_of(band)])
    low, high = shown.errors
    assert -0.02 < low < 0.0 < high < 0.02
    # Of alpha V + D with V = 1 at first, so little is left then that all of it is in the band.
    outer = widened(band, TIMES, SUPPLY)
    alpha, added, left = float(outer.alpha), float(added_by(outer)), 1.0
    for _ in range(shown.samples):
        left = alpha * left + added
    assert left * float(TIMES) <= 2.0 + 1e-9


def around(asked):
    """Four times the ellipsoid of the band is what is to be reached: a ring comes near it for ever."""
    *rest, band = asked
    return *rest, scaled(band, Fraction(4))


@pytest.mark.parametrize(
    ("fault", "why"),
    [
        (lambda _: [], "no ring"),
        (lambda band: [ring_of(band, Fraction(10_000))], "beyond"),
        (lambda band: [ring_of(band, ellipsoid=scaled(band, TIMES))], "lead inwards"),
        (lambda band: [ring_of(band, inside=Fraction(1, 100))], "does not lie in"),
        (lambda band: [ring_of(band, spared=Fraction(0))], "lead inwards"),
        (lambda band: [ring_of(band, ellipsoid=widened(band, TIMES, Fraction(1, 100)))], "."),
        (
            lambda band: [
                ring_of(band, ellipsoid=replace(widened(band, TIMES, SUPPLY), alpha=Fraction(1, 2)))
            ],
            "lead",
        ),
    ],
)
def test_faults_are_refused(asked, fault, why):
    *_, band = asked
    with pytest.raises(Refused, match=why):
        led(*around(asked), fault(band))
