"""Reports on laws that are no designs: from a file, of the industry, of a vehicle, and made in Python."""

import json
from dataclasses import dataclass, replace
from functools import partial

import pytest

import wspd_design as wd
from wspd_design.certificates import suite
from wspd_design.controllers.protocol import Command
from wspd_design.model.number import maximum, sqrt, where
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.reporting.blocks import Document
from wspd_design.reporting.report import report_document, report_time
from wspd_design.reporting.sections.summary import verdict
from wspd_design.reporting.text import plain
from wspd_design.simulation.records import Scenario
from wspd_design.studies import dossier as dossier_module
from wspd_design.studies.uncertainty import uncertainty

RAIL = load_rail("low-adhesion")
STOP = Scenario.stop(from_kmh=40.0, rail=RAIL)
QUICK = ("gain_positive", "sliding_exists")


@dataclass(frozen=True)
class Band:
    """Vent above a slip, fill below it; ``sign`` = -1 plants the fault that it does the opposite."""

    radius: float
    sign: float = 1.0
    slip: float = 0.1
    sample_time: float = 0.05
    name: str = "band <of mine>"

    def start(self, _measurement):
        return ()

    def step(self, state, measurement):
        now = 1.0 - self.radius * measurement.wheel_speed / maximum(measurement.speed, 0.5)
        slides = self.sign * (now - self.slip) > 0.0
        return state, Command(fill=where(slides, 0.0, 1.0), vent=where(slides, 1.0, 0.0))


@pytest.fixture(scope="module", autouse=True)
def few_checks():
    """Run the checks that take no time, and few drawn sets: what is said about a law is tested, not its proofs."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dossier_module, "verify", partial(suite.verify, only=QUICK))
        patch.setattr(dossier_module, "uncertainty", partial(uncertainty, sets=16))
        yield


@pytest.fixture(scope="module")
def vehicle():
    """Return a vehicle that no file states."""
    shipped = load_vehicle("er24pc")
    return replace(shipped, name="prototype 7", wheel_radius=0.52)


@pytest.fixture(scope="module", autouse=True)
def one_alternative():
    """Try one other law in place of those that are rejected: each costs a stop and a check."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("wspd_design.studies.next_step.RULES", {"super-twisting": None})
        yield


@pytest.fixture(scope="module")
def in_memory(vehicle):
    return wd.dossier(Band(radius=vehicle.wheel_radius), vehicle=vehicle, rail=RAIL, scenario=STOP)


def _texts(document: Document) -> str:
    return plain(str(document))


def test_a_law_and_a_vehicle_of_python_get_a_report(in_memory, tmp_path):
    assert in_memory.design is None
    assert in_memory.specification.slip == 0.1
    assert in_memory.specification.sample_time == 0.05
    assert in_memory.law.origin == "made in Python"
    assert in_memory.vehicle.entries["mass"].source == "given in Python"
    wd.write_report(in_memory, tmp_path / "own.html")
    html = (tmp_path / "own.html").read_text(encoding="utf-8")
    assert "band &lt;of mine&gt;" in html
    assert "made in Python" in html
    assert "design.toml" not in html


def test_its_vehicle_travels_with_the_report_to_the_last_bit(in_memory, vehicle, tmp_path):
    document = report_document(in_memory, report_time())
    files = {each.name: each.content for each in document.attachments}
    (tmp_path / "prototype 7.toml").write_text(files["prototype 7.toml"], encoding="utf-8")
    assert load_vehicle(tmp_path / "prototype 7.toml") == vehicle
    record = json.loads(files["report.json"])
    assert record["design"] is None
    assert record["law"]["fingerprint"] == in_memory.law.fingerprint
    assert record["specification"]["slip_reference"] == 0.1


def test_the_opposite_law_is_another_one_and_is_not_fit(in_memory, vehicle, monkeypatch):
    for study in ("uncertainty", "robustness"):  # of a train that hardly brakes, they take long
        monkeypatch.setattr(dossier_module, study, lambda *_, **__: None)
    wrong = wd.dossier(
        Band(radius=vehicle.wheel_radius, sign=-1.0), vehicle=vehicle, rail=RAIL, scenario=STOP
    )
    assert wrong.law.fingerprint != in_memory.law.fingerprint
    assert wrong.provenance.input_hash != in_memory.provenance.input_hash
    assert plain(verdict(wrong).sentence).startswith("Rejected")


def test_a_law_that_commands_no_number_is_refused(vehicle):
    class NoNumber(Band):
        def step(self, state, measurement):
            return state, Command(fill=0.1 * sqrt(measurement.speed - 8.0), vent=0.0)

    with pytest.raises(wd.UserError, match="commanded fill = nan"):
        wd.dossier(NoNumber(radius=vehicle.wheel_radius), vehicle=vehicle, rail=RAIL, scenario=STOP)


def test_a_design_keeps_its_specification():
    made = wd.design_controller(load_vehicle("er24pc"), RAIL, wd.Specification())
    with pytest.raises(wd.UserError, match="has its own specification; leave specification out"):
        wd.dossier(made, vehicle="er24pc", rail=RAIL, scenario=STOP, specification=wd.Specification(slip=0.1))


def test_an_impossible_vehicle_is_refused(vehicle):
    with pytest.raises(wd.UserError, match="body_mass"):
        wd.dossier(Band(radius=0.52), vehicle=replace(vehicle, mass=80e3), rail=RAIL, scenario=STOP)
