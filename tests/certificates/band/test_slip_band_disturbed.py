"""A band with valves that begin late, noise of the measured speeds, and a supply that still rises."""

from dataclasses import replace
from fractions import Fraction

import pytest

from tests.certificates.band.band_attack import attack_boundary, sets_of
from tests.certificates.band.conftest import certificate_of, problem_of
from tests.certificates.band.sampled_runs import Disturbance
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.slip_band import disturbed
from wspd_design.certificates.theorems.band import CELLS, LATE, NOISY

pytestmark = pytest.mark.slow
STARTS, FEW = 2000, 200
DEAD_TIME = 0.002  # s


@pytest.fixture(scope="module")
def late():
    """Fast part of a stop through valves with a dead time, on a part of the box."""
    problem = problem_of(0.2, speeds=(25.0, 120.0 / 3.6))
    brake = replace(problem.vehicle.brake, dead_time=DEAD_TIME)
    return replace(problem, vehicle=replace(problem.vehicle, brake=brake))


@pytest.fixture(scope="module")
def certificate(late):
    """With few steps, one of each that is too much."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(disturbed, "DELAYS", (Fraction(1, 2), Fraction(7, 8), Fraction(63, 64)))
        patch.setattr(disturbed, "NOISES", (Fraction(1, 1000), Fraction(1, 10)))
        return certificate_of(late, effort=1.0)


@pytest.fixture(scope="module")
def sets(late, certificate):
    """What was proved with exact speeds, with late pulses and with noise."""
    found = {name: certificate.findings[name] for name in (CELLS, LATE, NOISY)}
    return {name: sets_of(late, each.stated.proof, each.numbers) for name, each in found.items()}


@pytest.fixture(scope="module")
def borne(certificate):
    """The disturbances that were proved with them."""
    numbers = {name: certificate.findings[name].numbers for name in (CELLS, LATE, NOISY)}
    return {name: Disturbance(late=each["delay"], noise=each["noise"]) for name, each in numbers.items()}


def test_what_the_band_bears_is_proved_and_told(certificate, borne):
    assert certificate.status is Status.PROVED
    assert borne[CELLS] == Disturbance(late=DEAD_TIME)
    assert borne[LATE] == Disturbance(late=pytest.approx(0.0175))
    assert borne[NOISY] == Disturbance(late=DEAD_TIME, noise=0.001)
    assert f"begin up to {1e3 * borne[LATE].late:g} ms late" in certificate.explanation
    assert f"measured within {borne[NOISY].noise:g} m/s" in certificate.explanation
    assert "pulses begin at most 2 ms after their sample" in " ".join(certificate.assumptions)


@pytest.mark.parametrize("name", [CELLS, LATE, NOISY])
def test_no_disturbance_that_is_borne_leads_out(late, sets, borne, name):
    seen = attack_boundary(late, sets[name], starts=STARTS, disturbance=borne[name])
    assert seen.entered.all()
    assert not seen.left.any()


@pytest.mark.parametrize(
    "larger", [Disturbance(late=0.06), Disturbance(late=DEAD_TIME, noise=0.02)], ids=["late", "noise"]
)
def test_larger_disturbances_lead_out(late, sets, larger):
    """The attack can tell bounds that are too small."""
    assert attack_boundary(late, sets[CELLS], starts=FEW, disturbance=larger).left.any()


def test_less_supply_leads_out(late, sets, borne):
    exact = sets[CELLS]
    starved = replace(exact, supplies=0.3 * exact.supplies)  # less than holding takes in some of the plants
    assert attack_boundary(late, starved, starts=FEW, disturbance=borne[CELLS]).left.any()
