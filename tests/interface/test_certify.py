"""``wspd certify``: the verdicts of ``wspd verify``, and a file for every check that speaks about the design."""

import json

import pytest

from wspd_design.certificates.kernel.file import SCHEMA
from wspd_design.certificates.records import Status
from wspd_design.design.certification import certify

ONLY = ("--only", "open_loop_pole")
QUICK = ("surface_hurwitz", "gain_positive", "open_loop_pole", "no_go", "tracking", "conservation")


def asked(*names):
    return [word for name in names for word in ("--only", name)]


def said(done):
    return " ".join(done.out.split())


@pytest.fixture
def folder(smc_file):
    return smc_file.parent / "smc.certificates"


def test_a_proof_is_kept_beside_the_design(wspd, smc_file, folder):
    certified = wspd("certify", smc_file, *asked("gain_positive"))
    assert certified.code == 0, certified.err
    (kept,) = folder.iterdir()
    assert kept.name == "gain_positive.json"
    content = json.loads(kept.read_text())
    assert (content["schema"], content["status"]) == (SCHEMA, Status.PROVED.name)
    assert len([each for each in content["findings"].values() if "proof" in each]) == 3
    (row,) = (line for line in certified.out.splitlines() if line.startswith("✓ PROVED"))
    assert row.split()[:3] == ["✓", "PROVED", "gain_positive"]
    size, unit, seconds = row.split()[-3:]
    assert unit == "kB"
    assert float(size) == pytest.approx(kept.stat().st_size / 1e3, abs=0.06)
    assert float(seconds) >= 0.0


def test_files_are_not_replaced_unless_one_asks_for_it(wspd, smc_file, folder):
    assert wspd("certify", smc_file, *ONLY).code == 1
    first = (folder / "open_loop_pole.json").read_bytes()
    refused = wspd("certify", smc_file, *ONLY)
    assert refused.code == 2
    assert "is not empty" in refused.err
    assert wspd("certify", smc_file, *ONLY, "--force").code == 1
    assert (folder / "open_loop_pole.json").read_bytes() == first


def test_a_search_whose_work_is_used_up_leaves_the_claim_undecided(wspd, smc_file, folder):
    (found,) = certify(smc_file, only=("well_posed",), effort=1e-9, folder=folder)
    assert found.status is Status.UNDECIDED
    assert found.cut
    assert json.loads((folder / "well_posed.json").read_text())["status"] == Status.UNDECIDED.name
    checked = wspd("check", folder)
    assert checked.code == 3
    assert "? unchecked" in checked.out


@pytest.mark.parametrize("written", ["0", "-1", "5 s", "soon", "nan"])
def test_the_effort_must_be_a_positive_number(wspd, smc_file, folder, written):
    done = wspd("certify", smc_file, *ONLY, f"--effort={written}")
    assert done.code == 2
    assert "effort" in done.err
    assert not folder.exists()


def test_what_does_not_speak_about_the_design_leaves_nothing_behind(wspd, smc_file, folder):
    done = wspd("certify", smc_file, *asked("afsmc_energy"))
    assert done.code == 3
    assert "NOT APPLICABLE" in done.out
    assert not folder.exists()


def test_files_of_all_verdicts_are_checked(wspd, smc_file, folder):
    done = wspd("certify", smc_file, *asked(*QUICK))
    assert done.code == 1
    assert sorted(each.stem for each in folder.iterdir()) == sorted(QUICK)
    checked = wspd("check", folder)
    assert checked.code == 3  # the simulations of conservation decide nothing
    statuses = {each.stem: json.loads(each.read_text())["status"] for each in folder.iterdir()}
    assert checked.out.count("✓ accepted") == list(statuses.values()).count("PROVED")
    assert checked.out.count("? unchecked") == list(statuses.values()).count("EVIDENCE")


def test_a_stop_that_refutes_is_simulated_again(wspd, smc_file, folder):
    assert wspd("certify", smc_file, *asked("tracking")).code == 1
    content = json.loads((folder / "tracking.json").read_text())
    assert content["status"] == Status.REFUTED.name
    assert content["witness"]
    checked = wspd("check", folder / "tracking.json")
    assert checked.code == 0
    assert "~ accepted tracking.json for smc.toml" in said(checked)
    (folder / "tracking.json").write_text(json.dumps(content | {"findings": {}}))
    assert wspd("check", folder / "tracking.json").code == 1


def test_a_refuted_check_says_so_and_keeps_its_witness(wspd, smc_file, tmp_path):
    folder = tmp_path / "elsewhere"
    done = wspd("certify", smc_file, *ONLY, "-o", folder)
    assert done.code == 1
    assert "✗ REFUTED" in done.out
    path = folder / "open_loop_pole.json"
    content = json.loads(path.read_text())
    assert content["witness"]
    checked = wspd("check", path, "--design", smc_file)
    assert checked.code == 0
    assert "✓" not in checked.out
    assert "~ accepted open_loop_pole.json for smc.toml" in said(checked)
    # Who writes PROVED over it is refused.
    path.write_text(json.dumps(content | {"status": "PROVED"}))
    checked = wspd("check", path, "--design", smc_file)
    assert checked.code == 1
    assert "its status is not what the proofs show" in said(checked)


def test_a_named_controller_is_certified_and_checked_by_its_name(wspd, tmp_path):
    done = wspd("certify", "afsmc", "--rail", "polach-dry", *asked("gain_positive"))
    assert done.code == 0, done.err
    assert "--design afsmc --rail polach-dry" in said(done)
    kept = tmp_path / "afsmc.certificates" / "gain_positive.json"
    assert wspd("check", kept, "--design", "afsmc", "--rail", "polach-dry").code == 0
    assert wspd("check", kept, "--design", "afsmc").code == 1  # made for another rail


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("afsmcc",), "afsmc"),
        (("missing.toml",), "missing.toml"),
        (("smc.toml", "--only", "raeching"), 'did you mean "reaching"'),
        (("smc.toml", "-o", "no/such/folder"), "does not exist"),
        (("smc.toml", "-o", "smc.toml"), "is a file"),
    ],
)
def test_wrong_use_is_one_sentence(wspd, smc_file, arguments, sentence):
    done = wspd("certify", *arguments)
    assert done.code == 2
    assert sentence in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert [each.name for each in smc_file.parent.iterdir()] == ["smc.toml"]
