"""A brake engineer with a vehicle of their own: every command that is printed runs as printed, from any folder."""

import json
import re
import shlex
from functools import partial
from pathlib import Path

import pytest

import wspd_design
from wspd_design.certificates import suite
from wspd_design.cli import report_call
from wspd_design.controllers.family import FAMILIES
from wspd_design.reporting.attached import attached_files
from wspd_design.studies import dossier

VEHICLES = Path(__file__).parent / "vehicles"
BLANK = '<svg xmlns="http://www.w3.org/2000/svg" width="10pt" height="10pt" viewBox="0 0 10 10"></svg>'
CHECKS = ("surface_hurwitz", "gain_positive", "well_posed", "reaching", "no_go", "slip_band", "stop_bound")
LADEN = '\n[laden.mass]\nvalue = 54\nunit = "t"\n'


@pytest.fixture(autouse=True)
def folder(tmp_path):
    """Make a folder with a space in its name that holds the vehicles."""
    made = tmp_path / "my trains"
    made.mkdir()
    for each in VEHICLES.glob("*.toml"):
        (made / each.name).write_text(each.read_text())
    (made / "coach.toml").write_text((VEHICLES / "coach.toml").read_text() + LADEN)
    return made


def printed(outcome):
    """Return the commands that an outcome prints, each as its words."""
    lines = (line.partition("wspd ") for line in outcome.out.splitlines())
    return [shlex.split(rest) for before, command, rest in lines if command and before.endswith((" ", ""))]


def designed(wspd, vehicle, *, target="my designs/d 1.toml"):
    Path(target).parent.mkdir(exist_ok=True)
    outcome = wspd(
        *(
            "design",
            "--law",
            "smc",
            "--vehicle",
            f"my trains/{vehicle}",
            "--rail",
            "low-adhesion",
            "-o",
            target,
        )
    )
    assert outcome.code == 0, outcome.err
    commands = {words[0]: words for words in printed(outcome)}
    assert commands["verify"] == ["verify", target]
    assert commands["simulate"] == ["simulate", target]
    assert commands["report"] == ["report", target, "-o", str(Path(target).with_suffix(".html"))]
    return commands


@pytest.mark.parametrize("vehicle", ["coach.toml", "metro.toml", "coach.toml:laden"])
def test_what_design_prints_runs(wspd, vehicle):
    commands = designed(wspd, vehicle)
    stop = wspd(*commands["simulate"])
    assert stop.code == 0, stop.err
    name = vehicle.replace(".toml", "")
    assert f"{name} (planar), from 120 km/h" in " ".join(stop.out.split())
    assert wspd(*commands["verify"], "--only", "gain_positive").code == 0


def test_the_folder_of_the_design_does_not_matter(wspd, folder, monkeypatch):
    designed(wspd, "coach.toml")
    monkeypatch.chdir("my designs")
    stop = wspd("simulate", "d 1.toml", "--speed", "60 km/h")
    assert (stop.code, stop.err) == (0, "")
    (folder / "coach.toml").unlink()
    gone = wspd("simulate", "d 1.toml")
    assert gone.code == 2
    assert "coach.toml, which is not there; give its file with --vehicle" in gone.err


def test_the_numbers_of_a_laden_vehicle_are_shown(wspd):
    for name in ("my trains/coach.toml:laden", "freight-wagon:laden"):
        outcome = wspd("sources", name)
        assert (outcome.code, outcome.err) == (0, "")
        assert "laden" in outcome.out.splitlines()[0]
    assert "has no laden state" in wspd("sources", "er24pc:laden").err


def test_every_check_takes_a_vehicle_or_says_why_not(wspd):
    """Motors on two axles ended all checks: one of them asked for the plant of axles that are alike."""
    outcome = wspd("verify", "smc", "--vehicle", "my trains/emu.toml", "--rail", "low-adhesion", "--json")
    assert (outcome.code, outcome.err) == (0, "")
    checks = {each["name"]: each for each in json.loads(outcome.out)["checks"]}
    assert checks["conservation"]["status"] == "EVIDENCE"
    assert {point["name"].split(", ")[1] for point in checks["conservation"]["worst_point"]} == {"planar"}
    silent = [each for each in checks.values() if each["status"] == "NOT_APPLICABLE"]
    assert len(silent) > 10
    for each in silent:
        said = each["explanation"]
        assert said.count(". ") == 0
        assert said.endswith(".")
        assert "emu" in said or "smc" in said
    assert checks["stop_bound"]["explanation"].endswith("emu has pads.speeds.")


def test_what_certify_prints_runs(wspd):
    designed(wspd, "coach.toml")
    outcome = wspd("certify", "my designs/d 1.toml", "--only", "gain_positive", "--only", "surface_hurwitz")
    assert outcome.code == 0, outcome.err
    (check,) = printed(outcome)
    assert check == ["check", "my designs/d 1.certificates"]
    again = wspd(*check)
    assert again.code == 0, again.err
    assert "gain_positive: ✓ PROVED" in again.out


def assert_check_runs(wspd, report, folder):
    """Check all that a report attaches without the user's own files, and one file of it by hand, beside the design."""
    for each in folder.iterdir():
        if each.resolve() != report.resolve():
            each.unlink()
    again = wspd("check", report)
    assert again.code in (0, 3), again.err  # 3: accepted, and one decides nothing
    assert "✓ accepted" in again.out
    assert "refused" not in again.out
    attached = attached_files(report)
    assert {"design.toml", "coach.toml"} <= attached.keys()
    for name, content in attached.items():
        Path(name).write_text(content, encoding="utf-8", newline="")
    by_hand = wspd("check", "gain_positive.json", "--design", "design.toml")
    assert by_hand.code == 0, by_hand.err
    assert "PROVED" in by_hand.out


# Names of the plants and of their classes, which say nothing of a vehicle.
PLANTS_NAMED = re.compile(
    r'"locomotive(-linear)?"|``locomotive``|plants\.locomotive|locomotive and locomotive-linear|\b(Linear)?Locomotive\b'
)


def test_sentences_about_every_vehicle_do_not_speak_of_a_locomotive():
    """Reports of a coach told of "the four-axle locomotive" and "the quarter locomotive"."""
    package = Path(wspd_design.__file__).parent
    rooms = ("certificates", "simulation", "exchange", "analysis", "plants", "reporting/sections")
    sources = [path for room in rooms for path in (package / room).rglob("*.py")]
    assert len(sources) > 100
    for path in sources:
        text = PLANTS_NAMED.sub("", path.read_text(encoding="utf-8"))
        assert "locomotive" not in text.lower(), path


@pytest.mark.slow
def test_the_report_that_design_prints_runs(wspd, folder, monkeypatch):
    """With axles whose brakes differ; without what takes long: most checks, drawn sets, faults, laws, figures."""
    monkeypatch.setattr(dossier, "verify", partial(suite.verify, only=CHECKS))
    monkeypatch.setattr(
        report_call, "FAMILIES", {name: FAMILIES[name] for name in ("smc", "none", "trenitalia")}
    )
    monkeypatch.setattr("wspd_design.reporting.figures.drawing.figure_svg", lambda _figure: BLANK)
    for part in ("uncertainty", "robustness", "next_step"):
        monkeypatch.setattr(dossier, part, lambda *_, **__: None)
    with (folder / "coach.toml").open("a") as file:
        file.write('[brake.axle_shares]\nvalue = [1, 1, 1, 0.9]\nunit = "-"\n')
    commands = designed(wspd, "coach.toml")
    outcome = wspd(*commands["report"])
    assert outcome.code == 0, outcome.err
    page = Path("my designs/d 1.html").read_text(encoding="utf-8")
    assert_check_runs(wspd, Path("my designs/d 1.html"), folder)
    for word in ("trenitalia (textbook)", "The brake on full adhesion", "coach (planar)"):
        assert word in page
    for word in ("four-axle", "planar locomotive", "quarter locomotive"):
        assert word not in page
