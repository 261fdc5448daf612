"""The pytest plugin in a project of a user's own: a process of its own, as nobody of this suite would start it."""

import os
import re
import subprocess
import sys
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from wspd_design.certificates.kernel.file import FOLDER
from wspd_design.design.certification import certify
from wspd_design.design.file import write_design
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.loading import load_rail, load_vehicle

ROOT = Path(__file__).parents[3]
TESTS = """
import pytest
import wspd_design as wd
from wspd_design.testing import assert_certified


@pytest.mark.wspd("../mine.toml", proved=["surface_hurwitz", "gain_positive"], refuted=["open_loop_pole"])
def test_stability(wspd):
    wspd.hold()


@pytest.mark.wspd("../mine.toml", proved=["open_loop_pole"])
def test_it_is_not(wspd):
    wspd.hold()


def test_plain():
    assert_certified("../mine.toml", "surface_hurwitz")


def test_stops(wspd):
    wspd.assert_stops("../mine.toml", within="1 km", runs=2, speed="30 km/h")


def test_misspelled_check(wspd):
    wspd.assert_certified("../mine.toml", "surface_hurwits")


def test_misspelled_rail():
    wd.load_rail("polach-wte")


def test_without_a_marker(wspd):
    wspd.hold()
"""
BROKEN = """
import pytest
import wspd_design as wd

wd.load_vehicle("er24cp")
"""
WRONG = """
import pytest


@pytest.mark.wspd("mine.toml", prooved=["reaching"])
def test_stability(wspd):
    wspd.hold()
"""


def started(folder, *arguments):
    environment = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
    return subprocess.run(
        [
            sys.executable,
            "-m",
            "pytest",
            "-p",
            "wspd_design.testing.plugin",
            "-p",
            "no:cacheprovider",
            *arguments,
        ],
        cwd=folder,
        env=environment | {"PYTHONPATH": str(ROOT), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "COLUMNS": "100"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    folder = tmp_path_factory.mktemp("project")
    made = design_controller(load_vehicle("er24pc"), load_rail("polach-wet"), Specification(), law="smc")
    write_design(made, folder / "mine.toml")
    certify(folder / "mine.toml", only=("surface_hurwitz", "open_loop_pole"), folder=folder / f"mine{FOLDER}")
    (folder / "tests").mkdir()
    (folder / "tests" / "test_mine.py").write_text(TESTS)
    return folder


@pytest.fixture(scope="module")
def outcome(project):
    return started(project, "-v", "--junitxml=junit.xml", "tests/test_mine.py")


@pytest.fixture(scope="module")
def cases(project, outcome):
    assert outcome.returncode == 1
    return {case.get("name"): case for case in ET.parse(project / "junit.xml").iter("testcase")}


def properties(case):
    return {each.get("name"): each.get("value") for each in case.iter("property")}


def test_each_check_is_a_line(outcome):
    for name, verdict in (
        ("test_stability[surface_hurwitz]", "PASSED"),
        ("test_stability[gain_positive]", "PASSED"),
        ("test_stability[open_loop_pole]", "PASSED"),
        ("test_it_is_not[open_loop_pole]", "FAILED"),
        ("test_plain", "PASSED"),
        ("test_stops", "PASSED"),
    ):
        assert f"tests/test_mine.py::{name} {verdict}" in outcome.stdout


def test_margins_are_junit_properties(cases):
    found = properties(cases["test_stability[surface_hurwitz]"])
    assert found["mine.toml/surface_hurwitz/status"] == "PROVED"
    assert float(found["mine.toml/surface_hurwitz/margin low [1/s]"]) == pytest.approx(0.3846, rel=1e-3)
    assert properties(cases["test_plain"]) == found
    assert properties(cases["test_it_is_not[open_loop_pole]"])["mine.toml/open_loop_pole/status"] == "REFUTED"
    assert float(properties(cases["test_stops"])["mine.toml/stops/longest distance [m]"]) > 10.0


def test_a_failure_says_what_was_found_and_where(cases):
    (failure,) = cases["test_it_is_not[open_loop_pole]"].iter("failure")
    assert failure.get("message").startswith("AssertionError: open_loop_pole is REFUTED, asked for PROVED")
    assert "stability.py" not in failure.text


def test_what_was_searched_is_said(outcome, cases):
    """Only what lies beside the design is checked again; the summary names the rest."""
    assert "searched" not in "".join(properties(cases["test_stability[surface_hurwitz]"]))
    summary = outcome.stdout.partition("checks that were searched")[2]
    assert "mine.toml: gain_positive, no certificate of it lies beside the design" in summary
    assert "surface_hurwitz" not in summary.partition("=====")[2].partition("=====")[0]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("test_misspelled_check", 'did you mean "surface_hurwitz"'),
        ("test_misspelled_rail", 'did you mean "polach-wet"'),
        ("test_without_a_marker", "this test has no marker"),
    ],
)
def test_a_mistake_is_a_sentence_with_its_line(name, words, cases):
    (failure,) = cases[name].iter("failure")
    lines = failure.text.splitlines()
    assert len(lines) <= 5
    assert lines[0].startswith("tests/test_mine.py:")
    assert words in lines[-1]


def test_mistakes_of_a_whole_file_are_short_as_well(project):
    (project / "test_broken.py").write_text(BROKEN)
    (project / "test_wrong.py").write_text(WRONG)
    shown = started(project, "test_broken.py", "test_wrong.py")
    assert shown.returncode == 2
    assert 'did you mean "er24pc"' in shown.stdout
    assert "the marker is wspd(design, proved=[]" in shown.stdout
    assert "prooved is none of its words" in shown.stdout
    assert "loading.py" not in shown.stdout
    assert "plugin.py" not in shown.stdout
    assert len(shown.stdout.splitlines()) < 30


def test_a_stale_certificate_is_searched_again_and_named(project, tmp_path):
    """A file that does not belong to the design never counts, and the summary says why."""
    text = (project / "mine.toml").read_text()
    folder = tmp_path / f"mine{FOLDER}"
    folder.mkdir()
    (tmp_path / "mine.toml").write_text(
        text.replace("[gains.surface_rate]\nvalue = ", "[gains.surface_rate]\nvalue = 1")
    )
    (folder / "surface_hurwitz.json").write_bytes(
        (project / f"mine{FOLDER}" / "surface_hurwitz.json").read_bytes()
    )
    (tmp_path / "test_it.py").write_text(
        'def test_it(wspd):\n    wspd.assert_certified("mine.toml", "surface_hurwitz")\n'
    )
    shown = started(tmp_path, "-q")
    assert shown.returncode == 0, shown.stdout
    assert "mine.toml: surface_hurwitz, its certificate: " in shown.stdout


def test_the_page_shows_what_runs(project):
    """The Python blocks of docs/testing.md are green, line by line as the page shows, and its CI files are YAML."""
    blocks = re.findall(
        r"^```(\w+)\n(.*?)^```$", (ROOT / "docs/testing.md").read_text(), re.MULTILINE | re.DOTALL
    )
    (project / "tests" / "test_page.py").write_text(
        "\n\n".join(text for kind, text in blocks if kind == "python")
    )
    shown = started(project, "-v", "tests/test_page.py")
    assert shown.returncode == 0, shown.stdout
    promised = [text for kind, text in blocks if kind == "text" and text.startswith("$ pytest")]
    lines = re.findall(r"::(\S+) PASSED", promised[0])
    assert len(lines) == 5
    for line in lines:
        assert f"tests/test_page.py::{line} PASSED" in shown.stdout
    yaml = pytest.importorskip("yaml")
    github, gitlab = (yaml.safe_load(text) for kind, text in blocks if kind == "yaml")
    steps = [step.get("run") for step in github["jobs"]["test"]["steps"]]
    assert [each for each in steps if each] == gitlab["wsp"]["script"]


def test_the_plugin_is_registered_and_light():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    assert project["entry-points"]["pytest11"] == {"wspd": "wspd_design.testing.plugin"}
    code = (
        "import sys, pytest, wspd_design.testing.plugin\n"
        "heavy = {'numpy', 'casadi', 'scipy', 'sympy', 'typer', 'rich'}\n"
        "print(sorted(heavy & {m.split('.')[0] for m in sys.modules}))\n"
        "print(sorted(m for m in sys.modules if m.startswith('wspd_design')))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=True,
    )
    heavy, own = done.stdout.splitlines()
    assert heavy == "[]"
    assert (
        own
        == "['wspd_design', 'wspd_design.testing', 'wspd_design.testing.plugin', 'wspd_design.testing.running']"
    )
