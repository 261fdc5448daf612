"""A report is made again from its own attachments, also on a busy machine; what was planted in it is found."""

import base64
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
from contextlib import chdir, contextmanager
from functools import partial
from pathlib import Path

import pytest

from wspd_design.certificates import suite
from wspd_design.cli import report_call
from wspd_design.cli.app import run
from wspd_design.controllers.family import FAMILIES
from wspd_design.reporting.attached import attached_files
from wspd_design.studies import dossier as dossier_module

CASE = "--vehicle 'vehicles/my loco.toml' --rail rails/leaves.toml --speed '30 km/h' --patch '20 m polach-wet' --seed 3"
OWN_LAW = "laws/law.py:Mine --rail rails/leaves.toml --speed '20 km/h'"
BLANK = '<svg xmlns="http://www.w3.org/2000/svg" width="10pt" height="10pt" viewBox="0 0 10 10"></svg>'
QUICK = ("gain_positive", "well_posed", "sliding_exists")
LAW = """
from gains import SLIP
from wspd_design import Command
from wspd_design.model.number import where
class Mine:
    name, sample_time = "mine", 0.1
    def start(self, seen):
        return ()
    def step(self, state, seen):
        slides = seen.speed - 0.55 * seen.wheel_speed > SLIP * seen.speed
        return (), Command(fill=where(slides, 0.0, 1.0), vent=where(slides, 1.0, 0.0))
"""


@pytest.fixture(scope="module", autouse=True)
def short_reports():
    """Leave out what takes long and is tested elsewhere: most checks, other laws, drawn sets and faults."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(dossier_module, "verify", partial(suite.verify, only=QUICK))
        patch.setattr(dossier_module, "uncertainty", lambda *_, **__: None)
        patch.setattr(dossier_module, "robustness", lambda *_, **__: None)
        patch.setattr(dossier_module, "next_step", lambda *_, **__: None)
        patch.setattr(report_call, "FAMILIES", {"none": FAMILIES["none"]} | {"smc": FAMILIES["smc"]})
        patch.setattr("wspd_design.reporting.figures.drawing.figure_svg", lambda _figure: BLANK)
        patch.setenv("COLUMNS", "200")
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A report on files that nobody else has, in folders of their own, as HTML and PDF; and one on a law in Python."""
    place = tmp_path_factory.mktemp("replay")
    for name in ("vehicles", "rails", "laws"):
        (place / name).mkdir()
    vehicle = 'base = "er24pc"\ntitle = "Mine"\nmass = "77 t"\nbody_mass = "47 t"\n'
    (place / "vehicles" / "my loco.toml").write_text(vehicle)
    (place / "rails" / "leaves.toml").write_text('base = "low-adhesion"\ntitle = "Leaves"\n')
    (place / "company.toml").write_text('organization = "Brakes & Sons"\nissue = "3"\n')
    (place / "laws" / "law.py").write_text(LAW)
    (place / "laws" / "gains.py").write_text("SLIP = 0.1\n")
    with chdir(place):
        assert run(shlex.split(f"report smc {CASE} --template company.toml --pdf -o report.html")) == 0
        assert run(shlex.split(f"report {OWN_LAW} -o law.html")) == 0
    return place


@pytest.fixture
def wspd(folder, capsys):
    """Run a command in the folder of the reports and return its code and its words, on one line."""

    def call(*words):
        capsys.readouterr()
        with chdir(folder):
            code = run(list(words))
        captured = capsys.readouterr()
        return code, " ".join((captured.out + captured.err).split())

    return call


@contextmanager
def busy(processes):
    """Keep every core busy, for a minute at most."""
    work = "import time\nend = time.monotonic() + 60.0\nwhile time.monotonic() < end: pass"
    running = [subprocess.Popen([sys.executable, "-c", work]) for _ in range(processes)]
    try:
        yield
    finally:
        for each in running:
            each.kill()
            each.wait()


def changed(report, name, content, *, sums=True):
    """Return the page with another attachment, and with the sums that belong to it."""
    files = attached_files(report) | {name: content}
    if sums:
        lines = [line.partition("  ")[2] for line in files["SHA256SUMS"].splitlines()]
        files["SHA256SUMS"] = "".join(
            f"{hashlib.sha256(files[each].encode()).hexdigest()}  {each}\n" for each in lines
        )
    page = report.read_text(encoding="utf-8")
    for each in (name, "SHA256SUMS"):
        data = base64.b64encode(files[each].encode()).decode()
        link = rf'(download="{re.escape(each)}" href="data:[^;]*;base64,)[^"]*'
        page, number = re.subn(link, rf"\g<1>{data}", page)
        assert number == 1
    target = report.with_name("planted.html")
    target.write_text(page, encoding="utf-8")
    return target.name


def test_it_is_the_same_on_a_busy_machine(wspd):
    with busy(2 * (os.cpu_count() or 1)):
        code, said = wspd("report", "--replay", "report.html")
    assert said.startswith("✓ the same: ")
    assert "and every byte of report.html" in said
    assert code == 0


def test_the_pdf_is_the_same(wspd):
    code, said = wspd("report", "--replay", "report.pdf")
    assert (code, said[:10]) == (0, "✓ the same")


def test_everything_that_it_was_made_from_travels_with_it(folder):
    files = attached_files(folder / "report.html")
    assert files == attached_files(folder / "report.pdf")
    command = "wspd report design.toml --vehicle 'my loco.toml' --rail leaves.toml --speed '30 km/h' --seed 3"
    assert files["command.txt"] == f"{command} --template template.toml --patch '20 m polach-wet'\n"
    assert files["my loco.toml"] == (folder / "vehicles" / "my loco.toml").read_text()
    assert files["leaves.toml"] == (folder / "rails" / "leaves.toml").read_text()
    assert 'vehicle_file = "my loco.toml"' in files["design.toml"]
    assert {
        "shipped-er24pc.toml",
        "shipped-low-adhesion.toml",
        "stop-1-smc.csv",
        "stop-2-none.csv",
    } <= files.keys()
    assert str(folder) not in "".join(files.values())


def test_sha256sum_tells_the_hashes_again(folder, tmp_path):
    for name, text in attached_files(folder / "report.html").items():
        (tmp_path / name).write_bytes(text.encode())
    subprocess.run(["sha256sum", "--check", "--quiet", "SHA256SUMS"], cwd=tmp_path, check=True)
    record = json.loads((tmp_path / "report.json").read_text())["provenance"]
    names = [each["name"] for each in record["inputs"]]
    told = subprocess.run(["sha256sum", *names], cwd=tmp_path, capture_output=True, check=True).stdout
    assert hashlib.sha256(told).hexdigest() == record["input_hash"]
    (tmp_path / "design.toml").write_text("planted")
    assert (
        subprocess.run(
            ["sha256sum", "--check", "--status", "SHA256SUMS"], cwd=tmp_path, check=False
        ).returncode
        == 1
    )


def test_the_attachments_can_be_run_by_hand(folder, tmp_path, monkeypatch):
    for name, text in attached_files(folder / "report.html").items():
        (tmp_path / name).write_bytes(text.encode())
    record = json.loads((tmp_path / "report.json").read_text())
    command = report_call.read_call((tmp_path / "command.txt").read_text()).text
    monkeypatch.setenv("SOURCE_DATE_EPOCH", _seconds(record["provenance"]["made_at"]))
    with chdir(tmp_path):
        assert run([*shlex.split(command)[1:], "-o", "again.html"]) == 0
    assert (tmp_path / "again.html").read_bytes() == (folder / "report.html").read_bytes()


def _seconds(made_at):
    from datetime import datetime

    return str(int(datetime.fromisoformat(made_at).timestamp()))


def test_a_planted_number_is_found(wspd, folder):
    record = json.loads(attached_files(folder / "report.html")["report.json"])
    distance = record["stops"][0]["distance_m"]
    record["stops"][0]["distance_m"] = distance - 1e-9
    planted = changed(
        folder / "report.html", "report.json", json.dumps(record, indent=1, ensure_ascii=False) + "\n"
    )
    code, said = wspd("report", "--replay", planted)
    assert code == 1
    assert said.startswith(
        f"✗ different: number stops: smc: distance m: {distance - 1e-9!r}, here {distance!r}."
    )


def test_what_is_not_in_the_sums_is_found_without_computing(wspd, folder):
    planted = changed(folder / "report.html", "stop-1-smc.csv", "time_s\n", sums=False)
    for words in (("report", "--replay", planted), ("check", planted)):
        code, said = wspd(*words)
        assert code == 1
        assert "stop-1-smc.csv" in said


def test_every_certificate_is_decided_again_by_one_command(wspd, folder):
    code, said = wspd("check", "report.html")
    assert code == 0
    for name in ("gain_positive", "well_posed", "sliding_exists"):
        assert re.search(rf"[✓~] accepted {name}.json for report.html", said)
    planted = changed(
        folder / "report.html",
        "gain_positive.json",
        attached_files(folder / "report.html")["gain_positive.json"].replace("positive", "negative"),
    )
    code, said = wspd("check", planted)
    assert code == 1
    assert "✗ refused gain_positive.json" in said


def test_a_certificate_with_another_verdict_than_the_report_is_refused(wspd, folder):
    record = attached_files(folder / "report.html")["report.json"]
    (status,) = {each["status"] for each in json.loads(record)["checks"] if each["name"] == "gain_positive"}
    assert status == "PROVED"
    lying = json.loads(record)
    for each in lying["checks"]:
        each["status"] = "REFUTED" if each["name"] == "gain_positive" else each["status"]
    planted = changed(folder / "report.html", "report.json", json.dumps(lying))
    code, said = wspd("check", planted)
    assert code == 1
    assert "report.json says REFUTED of gain_positive, the file PROVED" in said


def test_code_that_came_with_a_report_runs_only_if_it_is_named(wspd, tmp_path, monkeypatch):
    for words in (("report", "--replay", "law.html"), ("check", "law.html")):
        code, said = wspd(*words)
        assert code == 2
        assert "whose Python code is attached; to let it run, save it, read it, and name it" in said
    monkeypatch.delitem(sys.modules, "gains")  # as in a new process
    assert wspd("report", "laws/law.py:Mine", "--replay", "law.html")[0] == 0
    assert wspd("check", "law.html", "--design", "laws/law.py:Mine")[0] == 0
    (tmp_path / "law.py").write_text(LAW)
    (tmp_path / "gains.py").write_text("SLIP = 0.2\n")
    code, said = wspd("report", f"{tmp_path}/law.py:Mine", "--replay", "law.html")
    assert code == 2
    assert "gains.py is not the file" in said


@pytest.mark.parametrize(
    "more",
    [("--rail", "polach-wet"), ("--seed", "4"), ("--pdf",), ("--grade", "1 %"), ("--diff", "report.html")],
)
def test_a_replay_takes_no_other_options(wspd, more):
    code, said = wspd("report", "--replay", "report.html", *more)
    assert code == 2
    assert "--replay takes everything from report.html" in said


def test_changes_are_told_here_and_in_the_report(wspd, folder):
    code, said = wspd(*shlex.split(f"report smc {CASE} --slip '12 %' --diff report.html -o new.html"))
    assert code == 0
    assert re.search(r"Against the report of \S+: .*\d+ numbers", said)
    assert "specification: slip reference: 0.14, now 0.12" in said
    page = (folder / "new.html").read_text(encoding="utf-8")
    assert 'id="changed-numbers"' in page
    assert (
        attached_files(folder / "new.html")["previous.json"]
        == attached_files(folder / "report.html")["report.json"]
    )
    assert wspd("report", "--replay", "new.html")[0] == 0


def test_nothing_changes_against_itself(wspd, folder):
    (folder / "record.json").write_text(attached_files(folder / "law.html")["report.json"], encoding="utf-8")
    code, said = wspd(*shlex.split(f"report {OWN_LAW} -o same.html --diff record.json"))
    assert code == 0
    assert said.endswith(": nothing differs.")


def _hostile(folder):
    """Yield pages that no report is, each with what is said about it."""
    report = folder / "report.html"
    record = json.loads(attached_files(report)["report.json"])
    yield "<html></html>", "nothing is attached"
    page = report.read_text(encoding="utf-8")
    yield (
        page.replace('download="my loco.toml"', 'download="../../my loco.toml"'),
        "is not the name of an attachment",
    )
    command = "wspd report design.toml --vehicle er24pc --rail polach-wet"
    for words, why in (
        ("rm -rf /", "must begin with"),
        (f"{command} --output /etc/passwd --force", "has '--output', which replay does not take"),
        (f"{command} --patch '20 m /etc/x.toml'", "/etc/x.toml"),
        ("wspd report /tmp/evil.py:Law --vehicle er24pc --rail polach-wet", "whose Python code is attached"),
        (
            "wspd report design.toml --vehicle ../x.toml --rail polach-wet",
            "'../x.toml', which is not attached",
        ),
    ):
        yield (folder / changed(report, "command.txt", words)).read_text(encoding="utf-8"), why
    for made_at in ("yesterday", "2026-01-01", None, 3):
        record["provenance"]["made_at"] = made_at
        planted = changed(report, "report.json", json.dumps(record))
        yield (folder / planted).read_text(encoding="utf-8"), "does not state made_at"
    for name, content, why in (
        ("report.json", "[" * 100_000, "is not JSON that can be read"),
        ("design.toml", "schema = 3", "is not a design of this version"),
        ("my loco.toml", "mass = 'heavy'", "my loco.toml"),
        ("template.toml", "logo = '/etc/passwd'", "is neither PNG nor SVG"),
    ):
        yield (folder / changed(report, name, content)).read_text(encoding="utf-8"), why


def test_a_hostile_report_is_refused_in_one_sentence(wspd, folder):
    for page, why in list(_hostile(folder)):
        (folder / "hostile.html").write_text(page, encoding="utf-8")
        code, said = wspd("report", "--replay", "hostile.html")
        assert (code, why in said, "Traceback" in said) == (2, True, False), said
    assert sorted(each.name for each in folder.parent.glob("*.toml")) == []


@pytest.mark.parametrize("content", ["", "{}", "[" * 100_000, '{"schema": 3}', '{"schema": "wspd-stop/2"}'])
def test_what_is_no_older_report_is_refused(wspd, folder, content):
    (folder / "old.json").write_text(content)
    code, said = wspd("report", "smc", "--diff", "old.json", "-o", "never.html")
    assert code == 2
    assert "old.json is not" in said
    assert not Path(folder / "never.html").exists()
