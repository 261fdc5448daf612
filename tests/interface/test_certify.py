"""``wspd certify``: the verdicts of ``wspd verify``, and a file for every proof and every witness."""

import json

import pytest

from wspd_design.certificates.records import Status

ONLY = ("--only", "reaching")


@pytest.fixture
def certified(wspd, smc_file):
    return wspd("certify", smc_file, *ONLY)


def test_a_proof_is_kept_beside_the_design(certified, smc_file):
    assert certified.code == 0, certified.err
    (kept,) = (smc_file.parent / "smc.certificates").iterdir()
    assert kept.name == "reaching.json"
    content = json.loads(kept.read_text())
    assert content["schema"] == "wspd-certificate/1"
    assert content["status"] == Status.PROVED.name
    assert len(content["proofs"]) == 2
    (row,) = (line for line in certified.out.splitlines() if line.startswith("✓ PROVED"))
    assert row.split()[:3] == ["✓", "PROVED", "reaching"]
    size, unit, seconds = row.split()[-3:]
    assert unit == "kB"
    assert float(size) == pytest.approx(kept.stat().st_size / 1e3, abs=0.06)
    assert float(seconds) > 0.0


@pytest.mark.usefixtures("certified")
def test_the_same_design_gives_the_same_file(wspd, smc_file):
    kept = smc_file.parent / "smc.certificates" / "reaching.json"
    first = kept.read_bytes()
    refused = wspd("certify", smc_file, *ONLY)
    assert refused.code == 2
    assert "is not empty" in refused.err
    assert wspd("certify", smc_file, *ONLY, "--force").code == 0
    assert kept.read_bytes() == first


def test_search_that_runs_out_of_time_leaves_the_claim_undecided(wspd, smc_file):
    done = wspd("certify", smc_file, *ONLY, "--search-time", "1 ms")
    assert done.code == 3
    said = " ".join(done.out.split())
    assert "of the box is undecided after" in said
    assert "more time may decide it" in said
    assert wspd("certify", smc_file, *ONLY, "--search-time", "1 min", "--force").code == 0


@pytest.mark.parametrize("written", ["0 s", "-1 s", "5 km/h", "soon"])
def test_search_time_must_be_a_time(wspd, smc_file, written):
    done = wspd("certify", smc_file, *ONLY, f"--search-time={written}")
    assert done.code == 2
    assert "search time" in done.err


def test_a_check_without_proof_or_witness_leaves_nothing_behind(wspd, smc_file):
    done = wspd("certify", smc_file, "--only", "conservation")
    assert done.code == 0
    assert "No check has a proof or a witness to keep" in done.out
    assert not (smc_file.parent / "smc.certificates").exists()


def test_a_check_that_needs_no_search_is_kept_and_checked(wspd, smc_file):
    names = ("derivation", "surface_hurwitz", "gain_positive")
    done = wspd("certify", smc_file, *(word for name in names for word in ("--only", name)))
    assert done.code == 0
    files = sorted((smc_file.parent / "smc.certificates").iterdir())
    assert [each.stem for each in files] == sorted(names)
    checked = wspd("check", *files)
    assert checked.code == 0
    assert checked.out.count("✓ accepted") == len(names)


def test_a_refuted_check_without_proofs_keeps_its_witness(wspd, smc_file):
    done = wspd("certify", smc_file, "--only", "tracking")
    assert done.code == 1
    assert "1 checks with a proof or a witness" in " ".join(done.out.split())
    kept = smc_file.parent / "smc.certificates" / "tracking.json"
    content = json.loads(kept.read_text())
    assert content["status"] == Status.REFUTED.name
    assert content["proofs"] == []
    assert content["witness"]
    checked = wspd("check", kept)
    assert checked.code == 3
    assert "? unchecked" in checked.out
    assert "no proof to check" in " ".join(checked.out.split())
    assert "✓" not in checked.out


def test_a_refuted_check_says_so_and_keeps_what_is_proved(wspd, smc_text, tmp_path):
    weak = tmp_path / "weak.toml"
    gain = smc_text.index("[gains.switching_gain]")
    value = smc_text.index("value = ", gain)
    weak.write_text(smc_text[:value] + "value = 1.0\n" + smc_text[smc_text.index("\n", value) + 1 :])
    folder = tmp_path / "elsewhere"
    done = wspd("certify", weak, *ONLY, "-o", folder)
    assert done.code == 1
    assert "✗ REFUTED" in done.out
    content = json.loads((folder / "reaching.json").read_text())
    assert content["status"] == Status.REFUTED.name
    assert content["witness"]
    checked = wspd("check", folder / "reaching.json", "--design", weak)
    assert checked.code == 0
    said = " ".join(checked.out.split())
    assert "✓" not in said
    assert "~ accepted reaching.json for weak.toml (REFUTED" in said
    assert "The witness denies (abs(r) + eta)/rho <= 1 m/s2: it is " in said
    assert "So reaching is refuted." in said
    # Who writes PROVED over it is refused: the proof that counts is missing.
    (folder / "reaching.json").write_text(json.dumps(content | {"status": "PROVED"}))
    checked = wspd("check", folder / "reaching.json", "--design", weak)
    assert checked.code == 1
    assert "no proof of (abs(r) + eta)/rho <= 1" in checked.out


def test_a_named_controller_is_certified_and_checked_by_its_name(wspd, tmp_path):
    done = wspd("certify", "afsmc", "--rail", "polach-dry", "--only", "well_posed")
    assert done.code == 0, done.err
    assert "--design afsmc --rail polach-dry" in " ".join(done.out.split())
    kept = tmp_path / "afsmc.certificates" / "well_posed.json"
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
