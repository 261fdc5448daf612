"""Places from which no band is kept: found, told, evaluated again, and refused where they deny nothing."""

import json
import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band.conftest import LOCO, problem_of
from tests.certificates.band.courses import polach
from tests.certificates.round_trip import keep, no_word_can_be_changed, refused
from wspd_design.certificates.checks.region import slip_band
from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.file import certificate_text
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.slip_band.search import Attempt
from wspd_design.certificates.setting.plant import plant_with
from wspd_design.certificates.theorems.band import CELLS, DEPARTURE, SLIP_BAND
from wspd_design.certificates.theorems.slip_band import departure
from wspd_design.certificates.theorems.slip_band.statement import NAMES
from wspd_design.certificates.witness import read_witness
from wspd_design.cli import from_witness
from wspd_design.design.case import Case
from wspd_design.design.certification import problem_of_case
from wspd_design.simulation.stop import simulate

PLENTY = 10**9
DRY = wd.load_rail("polach-dry")


@pytest.fixture(scope="module")
def dry():
    """In one window of speed: bounding the friction takes the most time."""
    return problem_of(1.0, rail=DRY, speeds=(10.0 / 3.6, 12.0 / 3.6))


@pytest.fixture(scope="module")
def euro_case():
    """The shipped rules at 100 ms on a rail where the friction falls fast."""
    rail = wd.load_rail("eurosprinter127")
    specification = wd.Specification(sample_time=0.1, reference="constant", speeds=(10.0 / 3.6, 120.0 / 3.6))
    law = wd.design_controller(LOCO, rail, specification, law="observer-smc").build(LOCO, rail)
    tracking = replace(law.core.tracking, dead_band=0.0)
    return Case(
        vehicle=LOCO,
        rail=rail,
        controller=replace(law, core=replace(law.core, tracking=tracking)),
        specification=specification,
        design=None,
        vehicle_name="er24pc",
        rail_name="eurosprinter127",
    )


@pytest.fixture(scope="module")
def euro(euro_case):
    return problem_of_case(euro_case)


@pytest.fixture
def no_ellipsoids(monkeypatch):
    """Leave the long search for ellipsoids out: it finds none here."""

    nothing = Attempt(share=Fraction(1), steps="", window=0, tried=1, cut=False)
    monkeypatch.setattr(slip_band, "largest_share", lambda *_: (None, nothing))


def decided(problem, place):
    (asked,) = (each for each in SLIP_BAND.obligations(problem) if each.key == DEPARTURE)
    return asked.decide(Stated(place=place), Work(PLENTY))


@pytest.mark.usefixtures("no_ellipsoids")
def test_the_brake_is_the_limit_on_a_dry_rail(dry):
    kept = keep(slip_band.CHECK, dry)
    found = kept.certificate
    assert found.status is Status.REFUTED
    assert "the limit in a corner of the box" in found.explanation
    assert "denies the lower side of a band alone" in found.explanation
    place, numbers = found.findings[DEPARTURE].stated.place, found.findings[DEPARTURE].numbers
    load = place["mass"] * 9.80665 / 8.0
    force = polach(DRY, LOCO, place["mu0"], 0.14, place["speed"], load)
    braked = 8.0 * force / place["mass"]  # what slows the wheel down with the train takes no torque
    by_hand = (
        2.0 * place["wheel radius"] * force
        - place["wheelset inertia"] * -braked * 0.86 / place["wheel radius"]
    )
    assert numbers["holding torque"] == pytest.approx(by_hand, rel=0.02)  # without running resistance
    assert numbers["full torque"] == pytest.approx(place["max torque"])
    assert {point.name for point in found.witness} == {"slip", "speed", *NAMES}
    no_word_can_be_changed(kept)
    document = json.loads(json.dumps(kept.content))
    document["findings"][DEPARTURE]["place"]["mu0"] = dry.nominal("mu0")
    assert refused(kept, findings=document["findings"])


def test_wheels_lock_from_the_reference(euro, euro_case, monkeypatch):
    """Whatever is known of the friction: that takes long to bound, and is left open."""
    monkeypatch.setattr(slip_band, "bounded_friction", lambda *_: ({}, None))
    every = list(departure.corners(euro))
    speed = math.sqrt(euro.speeds[0] * euro.speeds[1])
    # The nominal numbers and the first two corners that lock suffice here; the whole search takes some seconds.
    locking = [each for each in every if departure.lock(euro, {**each, "speed": speed})][:2]
    assert locking
    monkeypatch.setattr(slip_band, "corners", lambda _problem: iter([every[0], *locking]))
    found = keep(slip_band.CHECK, euro).certificate
    assert found.status is Status.REFUTED
    assert "has locked wheels" in found.explanation
    assert found.findings[DEPARTURE].stated.place == {**locking[0], "speed": speed}
    assert found.findings[DEPARTURE].numbers["lock speed"] >= euro.speeds[0]
    assert first_lock(euro_case, found) == pytest.approx(
        found.findings[DEPARTURE].numbers["lock time"], rel=1e-6
    )
    # A controller that has to find the state out first is another stop; so is one about other numbers.
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(from_witness, "_begins_settled", lambda *_: False)
        assert first_lock(euro_case, found) != pytest.approx(
            found.findings[DEPARTURE].numbers["lock time"], rel=1e-3
        )
    other = replace(euro_case, vehicle=replace(LOCO, wheelset_inertia=700.0))
    assert not from_witness.witness_start(
        other, wd.Scenario(rail=other.rail, initial_speed=20.0), witness_of(found)
    ).settled


def witness_of(certificate):
    return read_witness(certificate_text(certificate), "w.json")


def first_lock(case, certificate):
    """When a wheel first locks in the stop that ``wspd simulate --from-witness`` shows [s]."""
    made = from_witness.witness_start(
        case, wd.Scenario(rail=case.rail, initial_speed=20.0), witness_of(certificate)
    )
    run = simulate(made.vehicle, made.controller, made.scenario, plant="quarter")
    return run.time[np.flatnonzero(run.wheel_speed[:, 0] <= 0.0)[0]]


def test_a_place_that_denies_nothing_is_refused(dry, euro):
    nominal = next(departure.corners(euro))
    with pytest.raises(Refused, match="denies nothing"):
        decided(euro, {**nominal, "speed": 20.0})
    beyond = {**next(departure.corners(dry)), "speed": dry.speeds[0], "mu0": 2.0 * dry.nominal("mu0")}
    with pytest.raises(Refused, match="leaves the domain"):
        decided(dry, beyond)


def test_nothing_is_sought_where_the_whole_box_is_shown(dry, monkeypatch):
    class Whole:
        share = 1

    monkeypatch.setattr(slip_band, "largest_share", lambda *_: (Whole(), None))
    monkeypatch.setattr(slip_band, "write", lambda _: {})
    monkeypatch.setattr(slip_band, "_disturbed", lambda *_: {})
    stated = slip_band.search(dry)
    assert stated[DEPARTURE] == Stated()
    assert stated[CELLS].proof == {}


def test_the_start_is_settled():
    """On low adhesion the slip stays where it began; a law that has to find the state out lets it move first."""
    rail = wd.load_rail("low-adhesion")
    problem = problem_of(1.0, rail=rail)
    worn = next(
        each for each in departure.corners(problem) if each["wheel radius"] == problem.span("wheel radius")[0]
    )
    place = {**worn, "speed": 25.0}
    runs = []
    original = departure.Settled

    def unsettled(*, law, **_numbers):
        return law

    for kind in (original, unsettled):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(departure, "Settled", kind)
            patch.setattr(departure, "simulate", lambda *a, **k: runs.append(simulate(*a, **k)) or runs[-1])
            assert departure.lock(problem, place) == {}
    vehicle, _ = plant_with(problem, {name: place[name] for name in NAMES})
    assert vehicle.wheel_radius == place["wheel radius"]
    strays = [float(np.max(np.abs(run.slip[run.time < 1.0, 0] - 0.14))) for run in runs]
    assert strays[0] < 1e-3
    assert strays[1] > 0.03
