"""The simulated yardstick and the proved one keep their own names; where there is none, words say so."""

import math
from dataclasses import replace

import pytest

from tests.unit.reporting.sample_dossier import certificate, sample_dossier, trial
from wspd_design.certificates.records import Point, Status
from wspd_design.certificates.theorems.shortest_stop.stop_bound import DISTANCE, STOP_BOUND
from wspd_design.parameters.loading import load_rail
from wspd_design.reporting.numbering import parts
from wspd_design.reporting.sections.comparison import comparison
from wspd_design.reporting.sections.limits import limits
from wspd_design.reporting.sections.stop import stop
from wspd_design.reporting.sections.summary import summary
from wspd_design.reporting.text import plain
from wspd_design.reporting.yardsticks import proved_bound
from wspd_design.simulation.ideal import NO_IDEAL_STOP
from wspd_design.simulation.records import Patch, Sensing
from wspd_design.simulation.runs import Ending

pytestmark = pytest.mark.usefixtures("blank_figures")


def proof(status=Status.PROVED):
    return replace(
        certificate(STOP_BOUND.name, status),
        claim="No controller stops from 120 km/h within less than 170.19 m.",
        worst_point=(
            Point(name="bound on the time", value=9.5, unit="s"),
            Point(name=DISTANCE, value=170.199, unit="m"),
        ),
    )


def words(dossier):
    said = [*summary(dossier), *stop(dossier), *comparison(dossier)]
    return " ".join(part for block in said for part in parts(block) if isinstance(part, str))


def test_both_stand_under_their_own_names():
    dossier = sample_dossier()
    told = words(replace(dossier, certificates=(*dossier.certificates, proof())))
    assert "ideal stop, simulated: 174.2 m" in told
    assert "proved bound" in told
    assert "170.19 m" in told  # rounded down, so that it stays proved
    assert "170.20 m" not in told
    assert "No controller stops from 120 km/h within less than 170.19 m." in told
    assert "The ideal stop takes 174.2 m: a simulation" in told


@pytest.mark.parametrize("status", [status for status in Status if status is not Status.PROVED])
def test_only_a_proof_makes_a_bound(status):
    assert proved_bound([proof(status)]) is None
    dossier = sample_dossier()
    told = words(replace(dossier, certificates=(proof(status),)))
    assert "no bound is proved" in told
    assert "170.19" not in told.replace(proof().claim, "")


@pytest.mark.parametrize(
    ("ending", "said"),
    [
        (Ending.TIME_LIMIT, f"There is no ideal stop: {NO_IDEAL_STOP[Ending.TIME_LIMIT]}."),
        (None, "The ideal stop is not known"),
    ],
)
def test_without_an_ideal_stop_words_stand_in_its_place(ending, said):
    own = trial("mine", ideal_stop=math.nan, ideal_ending=ending, efficiency=math.nan)
    told = words(sample_dossier(trials=(own, own)))
    assert said in told
    assert "nan" not in told
    assert plain(said)


def test_limits_name_the_disturbances_of_the_stops():
    def said(**changes):
        dossier = sample_dossier()
        made = replace(dossier, scenario=replace(dossier.scenario, **changes))
        return [plain(item) for item in limits(made)[1].items]

    calm = said()
    assert "the track is straight, level and in one condition from end to end" in "".join(calm)
    assert any("measured without error" in item and "known" in item for item in calm)
    assert not any("disturbed" in item for item in calm)
    disturbed = said(grade=0.005, sensing=Sensing(speed_noise=0.05, dead_time=0.04))
    assert "the track is straight and in one condition from end to end" in "".join(disturbed)
    assert not any("measured without error" in item or "dead times" in item for item in disturbed)
    (told,) = (item for item in disturbed if "disturbed" in item)
    assert "grade 5 permille, speed noise 0.05 m/s rms, dead time 40 ms" in told
    assert "the checks know nothing of it" in told
    patched = said(patches=(Patch(start=50.0, rail=load_rail("very-low")),))
    assert not any("in one condition" in item for item in patched)
    (told,) = (item for item in patched if "checks speak about one rail" in item)
    assert "very-low from 50 m" in told
    assert not any("checks speak about one rail" in item for item in calm)
