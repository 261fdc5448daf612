"""The command of a report is written and read without loss, and nothing else is read: it may come from a stranger."""

from dataclasses import fields, replace
from pathlib import Path

import pytest

from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.lazy import COMMANDS
from wspd_design.cli.report_call import ReportCall, check_names, over_attachments, read_call
from wspd_design.cli.sensor_options import SensorOptions
from wspd_design.design.case import CaseOptions, load_case
from wspd_design.design.file import write_design
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.studies.inputs import attached_name
from wspd_design.studies.provenance import InputFile

FULL = ReportCall(
    law="my law.py:Law",
    vehicle="coach 7.toml:laden",
    rail="polach-wet",
    plant="quarter",
    speed="100 km/h",
    slip="12 %",
    sample_time="20 ms",
    seed=12,
    template="template.toml",
    requirements="line 7.toml",
    sensors=SensorOptions(speed_source="wheels", accelerometer=False, pressure_sensors=True),
    disturbances=StopOptions(
        patch=["50 m leaves.toml", "80.5 m polach-dry"],
        grade="-5 permille",
        pulses=80,
        period_timing=True,
        fault=["axle 2: valve-holds from 3 s"],
    ),
)


def test_a_command_is_read_as_it_was_written():
    assert read_call(FULL.text) == FULL
    plain = ReportCall(vehicle="er24pc", rail="polach-wet")
    assert plain.text == "wspd report design.toml --vehicle er24pc --rail polach-wet"
    assert read_call(plain.text) == plain
    assert "template" not in FULL.simulation
    assert "requirements" not in FULL.simulation
    assert FULL.simulation.startswith("wspd simulate 'my law.py:Law' --vehicle")


def test_every_option_is_one_of_the_command():
    known = {
        name: option
        for option in COMMANDS["report"].load("report").params
        for name in (*option.opts, *option.secondary_opts)
    }
    records = {ReportCall: ("law", "sensors", "disturbances"), SensorOptions: (), StopOptions: ()}
    names = {
        each.name for record, left in records.items() for each in fields(record) if each.name not in left
    }
    assert {known[f"--{name.replace('_', '-')}"].name for name in names} == names
    written = {option.name for option in known.values()}
    own = {"name", "controller", "output", "pdf", "force", "replay"}  # of the law and of files
    assert written - names == own


@pytest.mark.parametrize(
    "words",
    [
        "wspd simulate design.toml --vehicle er24pc --rail polach-wet",
        "rm -rf /",
        "wspd report --help",
        "wspd report design.toml --vehicle er24pc",
        "wspd report design.toml --vehicle er24pc --rail polach-wet --output /etc/passwd",
        "wspd report design.toml --vehicle er24pc --rail polach-wet -o x.html --force",
        "wspd report design.toml --vehicle er24pc --rail polach-wet --seed -1",
        "wspd report design.toml --vehicle er24pc --rail polach-wet --seed 99999999999999999999999",
        "wspd report design.toml --vehicle er24pc --rail polach-wet --seed ٣",
        "wspd report design.toml --vehicle er24pc --rail polach-wet --no-period-timing",
        "wspd report design.toml --vehicle er24pc --rail polach-wet --patch",
        "wspd report design.toml --vehicle er24pc --rail polach-wet --plant moon",
        "wspd report 'design.toml",
        "",
    ],
)
def test_nothing_else_is_a_command(words):
    with pytest.raises(UserError):
        read_call(words)


@pytest.mark.parametrize("name", ["/etc/x.toml", "../x.toml", "a/x.toml", "x.toml", "/tmp/x.py:Law"])
@pytest.mark.parametrize("field", ["law", "vehicle", "rail", "requirements"])
def test_only_attached_files_are_opened(name, field):
    call = ReportCall(vehicle="er24pc", rail="polach-wet")
    with pytest.raises(UserError, match="which is not attached"):
        check_names(replace(call, **{field: name}), [InputFile(name="design.toml", text="", meaning="")])


def test_names_lose_their_folders_alone():
    names = (
        "a/b/coach.toml:laden",
        "../law.py:Law",
        "polach-wet",
        "er24pc:laden",
        "afsmc",
        "knorr-bremse:textbook",
    )
    assert tuple(map(attached_name, names)) == (
        "coach.toml:laden",
        "law.py:Law",
        "polach-wet",
        "er24pc:laden",
        "afsmc",
        "knorr-bremse:textbook",
    )


CALL = ReportCall(law="observer-smc", vehicle="er24pc", rail="polach-wet")


def test_a_design_brings_the_requirements_that_it_names(tmp_path, monkeypatch):
    """The call over the attachments names them, and their file is attached; an option counts more."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "designs").mkdir()
    (tmp_path / "line7.toml").write_text('[requirements.limits]\nlongest_lock = "0.4 s"\n')
    made = design_controller(
        load_vehicle("er24pc"), load_rail("polach-wet"), Specification(), law="observer-smc"
    )
    path = Path("designs") / "mine.toml"
    write_design(replace(made, judged_by="../line7.toml"), path)
    case = load_case(str(path), CaseOptions())
    found, files = over_attachments(case, replace(CALL, law=str(path)))
    assert found.requirements == "line7.toml"
    assert "--requirements line7.toml" in found.text
    attached = {each.name: each.text for each in files}
    assert "longest_lock" in attached["line7.toml"]
    assert 'judged_by = "line7.toml"' in attached[found.law]
    other, _ = over_attachments(case, replace(CALL, law=str(path), requirements="en-15595-like"))
    assert other.requirements == "en-15595-like"
    without, _ = over_attachments(load_case("observer-smc", CaseOptions()), CALL)
    assert without.requirements is None
