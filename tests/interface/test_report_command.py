"""``wspd report``: what it asks the package for; the report itself is tested elsewhere."""

from types import SimpleNamespace

import pytest

from wspd_design.controllers.family import FAMILIES
from wspd_design.reporting import report as report_module
from wspd_design.reporting.blocks import Status, Verdict
from wspd_design.reporting.sections import summary as summary_module
from wspd_design.reporting.template import BLANK
from wspd_design.studies import dossier as dossier_module

COMPUTED = SimpleNamespace(idle=False, adhesion_use="")


@pytest.fixture
def calls(monkeypatch):
    """Record what the command asks for, and write a stand-in for the report."""
    recorded = {}

    def dossier(made, **options):
        recorded["design"], recorded["options"] = made, options
        return COMPUTED

    def write_report(computed, *paths, template):
        assert computed is COMPUTED
        recorded["template"] = template
        recorded["paths"] = [path.name for path in paths]
        for path in paths:
            path.write_text("new")

    monkeypatch.setattr(dossier_module, "dossier", dossier)
    monkeypatch.setattr(report_module, "write_report", write_report)
    found = Verdict(
        status=Status.REFUTED, sentence=("Not fit: 1 of 2 checks refuted (", "a", "). Something else.")
    )
    monkeypatch.setattr(summary_module, "verdict", lambda computed: found if computed is COMPUTED else None)
    return recorded


def test_report_of_a_design_file(wspd, smc_file, calls):
    outcome = wspd("report", smc_file.name, "--speed", "100 km/h", "--seed", "4", "-o", "a.html", "--pdf")
    assert (outcome.code, outcome.err) == (0, "")
    assert calls["paths"] == ["a.html", "a.pdf"]
    assert "a.html" in outcome.out
    assert "a.pdf" in outcome.out
    assert "✗ Not fit: 1 of 2 checks refuted (a)." in outcome.out
    assert "Something else" not in outcome.out
    assert calls["design"].name == "smc-er24pc-polach-wet"
    options = calls["options"]
    assert (options["vehicle"], options["rail"], options["scenario"].seed) == (
        "er24pc",
        "polach-wet",
        4,
    )
    assert options["scenario"].initial_speed == pytest.approx(100.0 / 3.6)
    assert options["baselines"] == list(FAMILIES)


def test_report_of_a_named_controller_compares_it_with_the_others(wspd, calls):
    assert wspd("report", "smc", "--rail", "polach-dry", "--slip", "0.1", "-o", "a.pdf", "--pdf").code == 0
    assert calls["paths"] == ["a.pdf"]
    assert (calls["design"].name, calls["design"].rail) == ("smc", "polach-dry")
    assert calls["design"].specification.slip == 0.1
    assert calls["options"]["baselines"] == [name for name in FAMILIES if name != "smc"]


def test_a_report_takes_the_template_of_a_company(wspd, smc_file, tmp_path, calls):
    (tmp_path / "company.toml").write_text('document_number = "WSP-0042"\n')
    assert wspd("report", smc_file.name, "--template", "company.toml", "-o", "a.html").code == 0
    assert calls["template"].document_number == "WSP-0042"
    assert wspd("report", smc_file.name, "-o", "b.html").code == 0
    assert calls["template"] == BLANK


def test_a_wrong_template_is_told_before_anything_is_computed(wspd, smc_file, tmp_path, calls):
    (tmp_path / "company.toml").write_text('auther = "A"\n')
    outcome = wspd("report", smc_file.name, "--template", "company.toml", "-o", "a.html")
    assert (outcome.code, calls) == (2, {})
    assert "unknown key auther in company.toml; did you mean author?" in " ".join(outcome.err.split())
    assert not (tmp_path / "a.html").exists()


@pytest.mark.usefixtures("calls")
def test_an_existing_report_is_replaced_only_by_force(wspd, smc_file, tmp_path):
    (tmp_path / "report.html").write_text("old")
    assert wspd("report", smc_file.name).code == 2
    assert (tmp_path / "report.html").read_text() == "old"
    assert wspd("report", smc_file.name, "--force").code == 0
    assert (tmp_path / "report.html").read_text() == "new"


def test_a_report_takes_the_disturbances_of_every_stop(wspd, smc_file, calls):
    options = ("--grade", "-5 permille", "--patch", "50 m polach-dry", "--dead-time", "40 ms")
    assert wspd("report", smc_file.name, *options, "-o", "a.html").code == 0
    scenario = calls["options"]["scenario"]
    assert (scenario.grade, scenario.sensing.dead_time) == (-0.005, 0.04)
    assert [(patch.start, patch.rail.name) for patch in scenario.patches] == [(50.0, "polach-dry")]
