"""What lies beside a design is taken if the checkers accept it again; whatever else lies there is searched anew."""

import json
import os
import subprocess
import sys
from dataclasses import replace

import pytest

from wspd_design.certificates.checks.frame import Check
from wspd_design.certificates.kernel import checker
from wspd_design.certificates.kernel.checker import Work
from wspd_design.certificates.records import Problem, Status
from wspd_design.certificates.replay import replay
from wspd_design.certificates.search import prover
from wspd_design.design import certification
from wspd_design.parameters.loading import load_rail
from wspd_design.testing import assert_certified, assert_refuted

NAMES = ("surface_hurwitz", "gain_positive", "open_loop_pole", "no_go", "tracking")
ASKED = [word for name in NAMES for word in ("--only", name)]


class Searched(Exception):
    """Raised by the planted search."""


@pytest.fixture(scope="session")
def made(tmp_path_factory, smc_text):
    """Certify a design once."""
    folder = tmp_path_factory.mktemp("made")
    (folder / "smc.toml").write_text(smc_text)
    certification.certify(folder / "smc.toml", only=NAMES, folder=folder / "smc.certificates")
    return {each.name: each.read_bytes() for each in (folder / "smc.certificates").iterdir()}


@pytest.fixture
def beside(made, smc_file):
    """Put the certificates beside the design, free to be tampered with."""
    folder = smc_file.parent / "smc.certificates"
    folder.mkdir()
    for name, content in made.items():
        (folder / name).write_bytes(content)
    return folder


@pytest.fixture
def searched(monkeypatch):
    """Plant a search that only notes what it is asked for, and a prover that breaks."""
    asked = []

    def noted(self, _problem, **_options):
        asked.append(self.name)
        raise Searched

    def broken(*_arguments, **_options):
        raise Searched

    monkeypatch.setattr(Check, "run", noted)
    monkeypatch.setattr(prover, "_Search", broken)
    return asked


def tampered(path, **entries):
    path.write_text(json.dumps(json.loads(path.read_text()) | entries))


def test_what_is_kept_is_not_searched(beside, made, smc_file, searched, wspd):
    assert wspd("verify", smc_file, *ASKED).code == 1
    assert wspd("certify", smc_file, *ASKED, "--force").code == 1
    assert_certified(smc_file, "surface_hurwitz", "gain_positive")
    assert_refuted(smc_file, "open_loop_pole", "tracking")
    assert searched == []
    assert {each.name: each.read_bytes() for each in beside.iterdir()} == made


@pytest.mark.usefixtures("beside")
def test_what_is_taken_is_the_certificate_that_a_search_makes(smc_file, monkeypatch):
    anew = certification.certify(smc_file, only=NAMES, stored=smc_file.parent / "nothing")
    monkeypatch.setattr(prover, "_Search", None)
    taken = certification.certify(smc_file, only=NAMES)
    idle = {"seconds": 0.0, "findings": {}}
    assert [replace(each, **idle) for each in taken] == [replace(each, **idle) for each in anew]
    assert [list(each.findings) for each in taken] == [list(each.findings) for each in anew]


FORGED = {
    "gain_positive": {"claim": "All is stable."},
    "surface_hurwitz": {"status": "REFUTED"},
    "open_loop_pole": {"status": "PROVED"},
    "tracking": {"witness": []},
    "no_go": {"findings": {}, "status": "LIMITATION"},
}


@pytest.mark.parametrize("name", FORGED)
def test_what_is_tampered_with_is_searched_anew(beside, smc_file, searched, name):
    tampered(beside / f"{name}.json", **FORGED[name])
    for door in (certification.certify, lambda design, only: assert_certified(design, *only)):
        with pytest.raises(Searched):
            door(smc_file, only=(name,))
    assert searched == [name, name]


@pytest.mark.parametrize("content", [b"", b"{}", b"\xff\xfe", b"[" * 100_000], ids=repr)
def test_what_is_no_certificate_is_searched_anew(beside, smc_file, searched, content):
    (beside / "gain_positive.json").write_bytes(content[:50_000])
    with pytest.raises(Searched):
        assert_certified(smc_file, "gain_positive")
    assert searched == ["gain_positive"]


def test_the_file_of_another_check_is_searched_anew(beside, smc_file, searched):
    (beside / "gain_positive.json").write_bytes((beside / "surface_hurwitz.json").read_bytes())
    with pytest.raises(Searched):
        assert_certified(smc_file, "gain_positive")
    assert searched == ["gain_positive"]


def test_the_files_of_another_design_are_searched_anew(beside, smc_file, searched):
    text = smc_file.read_text()
    start = text.index("value = ", text.index("[gains.switching_gain]"))
    smc_file.write_text(text[:start] + "value = 19.0" + text[text.index("\n", start) :])
    for name in ("gain_positive", "open_loop_pole"):
        with pytest.raises(Searched):
            assert_certified(smc_file, name)
    assert searched == ["gain_positive", "open_loop_pole"]
    assert (beside / "gain_positive.json").exists()


@pytest.mark.usefixtures("beside")
def test_on_another_rail_it_is_searched_anew(smc_file, searched):
    same_name = replace(load_rail("polach-wet"), mu0=0.31)  # a rail is what it contains, not its name
    for rail in ("polach-dry", same_name):
        with pytest.raises(Searched):
            certification.certify(smc_file, only=("gain_positive",), rail=rail)
    assert len(searched) == 2


@pytest.mark.usefixtures("beside")
def test_a_problem_made_by_hand_has_nothing_beside_it(smc_file, searched):
    problem = certification.problem_of(smc_file)
    assert isinstance(problem, Problem)
    with pytest.raises(Searched):
        certification.certify(problem, only=("gain_positive",))
    assert searched == ["gain_positive"]


def test_evidence_is_simulated_again(smc_file, searched, beside):
    """What nothing decides is not taken from a file."""
    (beside / "conservation.json").write_bytes((beside / "tracking.json").read_bytes())
    with pytest.raises(Searched):
        assert_certified(smc_file, "conservation", at_least=Status.EVIDENCE)
    assert searched == ["conservation"]


def test_what_is_open_is_searched_again(smc_file, beside, request):
    certification.certify(smc_file, only=("well_posed",), effort=1e-9, folder=beside)
    assert json.loads((beside / "well_posed.json").read_text())["status"] == Status.UNDECIDED.name
    searched = request.getfixturevalue("searched")
    with pytest.raises(Searched):
        certification.certify(smc_file, only=("well_posed",))
    assert searched == ["well_posed"]


CERTIFY = "import sys; from wspd_design.cli import main; sys.argv[0] = 'wspd'; main()"
SPIN = "while True: pass"


def test_the_same_inputs_give_the_same_bytes_on_a_busy_machine(made, smc_text, tmp_path):
    """Certified in another process, beside one that uses up the processor."""
    design, folder = tmp_path / "smc.toml", tmp_path / "again"
    design.write_text(smc_text)
    busy = subprocess.Popen([sys.executable, "-c", SPIN])
    try:
        command = [sys.executable, "-c", CERTIFY, "certify", str(design), *ASKED, "-o", str(folder)]
        done = subprocess.run(
            command, capture_output=True, check=False, env=os.environ | {"PYTHONHASHSEED": "7"}
        )
    finally:
        busy.kill()
        busy.wait()
    assert done.returncode == 1, done.stderr
    assert {each.name: each.read_bytes() for each in folder.iterdir()} == made


def test_a_genuine_file_of_twenty_megabytes_is_decided_by_counted_work(made, smc_file):
    """Blanks do not change what a file says; the work of the checker is counted, and does not grow with them."""
    problem = certification.problem_of(smc_file)
    text = made["gain_positive.json"].decode()
    long = text + " " * (checker.MOST_BYTES - len(text))
    assert replay(problem, long).accepted
    refused = replay(problem, long + " ")
    assert (refused.accepted, refused.reason) == (False, "the file is too long")


def test_a_proof_ends_after_the_work_that_it_may_cost(made):
    """Operations are counted, to the last one, and no clock is looked at."""
    findings = json.loads(made["no_go.json"])["findings"].values()
    proof = next(each["proof"] for each in findings if "tree" in each.get("proof", {}))
    work = Work()
    leaves = checker.decide(proof, work).leaves
    spent = checker.MOST_WORK - work.left
    assert 0 < leaves < spent < checker.MOST_WORK / 50
    assert checker.decide(proof, Work(spent)).leaves == leaves
    with pytest.raises(checker.Refused, match="more work than the checker may do"):
        checker.decide(proof, Work(spent - 1))
