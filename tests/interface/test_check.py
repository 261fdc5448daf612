"""``wspd check``: accepts what the design implies and refuses everything else, without a traceback."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from wspd_design.cli.app import run

HEAVY = ("casadi", "scipy", "control", "matplotlib", "ival", "cvxpy", "typst", "jinja2")
SEARCHED = ("reaching", "no_go", "sliding_exists", "stop_bound")


@pytest.fixture(scope="session")
def proved(tmp_path_factory, smc_text):
    """Certify a design once; its switching gain suffices, its surface is too fast for a vented brake."""
    folder = tmp_path_factory.mktemp("proved")
    (folder / "smc.toml").write_text(smc_text)
    only = [word for name in SEARCHED for word in ("--only", name)]
    assert run(["certify", str(folder / "smc.toml"), *only]) == 1
    return folder


@pytest.fixture
def certificates(proved, tmp_path):
    """Copy the design and all its certificates."""
    shutil.copytree(proved, tmp_path / "all")
    return [tmp_path / "all" / "smc.certificates" / f"{name}.json" for name in SEARCHED]


@pytest.fixture
def certificate(proved, tmp_path):
    """Copy the design and its certificate, free to be tampered with."""
    folder = tmp_path / "smc.certificates"
    folder.mkdir()
    (tmp_path / "smc.toml").write_bytes((proved / "smc.toml").read_bytes())
    copy = folder / "reaching.json"
    copy.write_bytes((proved / "smc.certificates" / "reaching.json").read_bytes())
    return copy


def test_an_untouched_certificate_is_accepted(wspd, certificate):
    done = wspd("check", certificate)
    assert done.code == 0, done.out + done.err
    assert "✓ accepted" in done.out
    assert "proofs are all that reaching needs" in " ".join(done.out.split())


def cut_tree(content):
    content["proofs"][0]["tree"] = content["proofs"][0]["tree"][:-1]


def one_leaf(content):
    content["proofs"][0]["tree"] = "."


def tighter_bound(content):
    content["proofs"][0]["bound"] = "1.0"


def no_bound(content):
    del content["proofs"][0]["bound"]


def other_relation(content):
    content["proofs"][0]["relation"] = ">="


def lost_proof(content):
    del content["proofs"][0]


def no_proofs(content):
    content["proofs"] = []


def other_check(content):
    content["check"] = "open_loop_pole"


def unknown_check(content):
    content["check"] = "reach"


def no_status(content):
    content["status"] = ["PROVED"]


def proof_is_a_number(content):
    content["proofs"][1] = 7


@pytest.mark.parametrize(
    "tamper",
    [
        cut_tree, one_leaf, tighter_bound, no_bound, other_relation, lost_proof, no_proofs, other_check,
        unknown_check, no_status, proof_is_a_number,
    ],
)  # fmt: skip
def test_a_tampered_certificate_is_refused(wspd, certificate, tamper):
    content = json.loads(certificate.read_text())
    tamper(content)
    certificate.write_text(json.dumps(content))
    done = wspd("check", certificate)
    assert done.code == 1, done.out
    assert "✗ refused" in done.out
    assert done.err == ""


@pytest.mark.parametrize("text", ["", "[]", "null", "{}", '{"schema": "wspd-certificate/1"}', "[" * 100_000])
def test_what_is_no_certificate_is_refused(wspd, certificate, text):
    certificate.write_text(text)
    done = wspd("check", certificate)
    assert done.code == 1
    assert done.err == ""


def test_truncated_json_and_bytes_are_refused(wspd, certificate):
    whole = certificate.read_bytes()
    for part in (whole[: len(whole) // 2], whole[:-3], b"\xff\xfe\x00" * 100):
        certificate.write_bytes(part)
        done = wspd("check", certificate)
        assert done.code == 1
        assert "no complete JSON" in done.out
        assert done.err == ""


def test_the_claim_comes_from_the_design(wspd, certificate):
    design = certificate.parent.parent / "smc.toml"
    text = design.read_text()
    changed = text.replace("slips = [0.02, 0.6]", "slips = [0.02, 0.7]")
    assert changed != text
    design.write_text(changed)
    done = wspd("check", certificate)
    assert done.code == 1
    assert "belongs to another claim" in " ".join(done.out.split())


def test_a_proof_for_another_rail_is_refused(wspd, certificate):
    assert wspd("check", certificate, "--rail", "polach-dry").code == 1


def test_one_refused_among_several_decides(wspd, certificate):
    other = certificate.with_name("broken.json")
    other.write_text("{")
    done = wspd("check", other, certificate)
    assert done.code == 1
    assert "✗ refused" in done.out
    assert "✓ accepted" in done.out


def test_a_missing_design_is_one_sentence(wspd, certificate):
    design = certificate.parent.parent / "smc.toml"
    design.rename(design.with_name("moved.toml"))
    done = wspd("check", certificate)
    assert done.code == 2
    assert "smc.toml is not beside it; name it with --design" in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert wspd("check", certificate, "--design", design.with_name("moved.toml")).code == 0


def test_a_missing_certificate_is_one_sentence(wspd, certificate):
    done = wspd("check", certificate.with_name("none.json"))
    assert done.code == 2
    assert "cannot be read" in done.err


def test_the_checker_loads_no_prover(certificates):
    """Nor what could search again which part of a domain was proved."""
    files = [str(each) for each in certificates]
    code = (
        "import sys; from wspd_design.cli.app import run; "
        f"code = run(['check', *{files!r}]); "
        f"print(code, [name for name in {HEAVY!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "0 []"


def test_only_what_is_proved_looks_proved(wspd, certificates):
    heads = {}
    for path in certificates:
        done = wspd("check", path)
        assert done.code == 0
        heads[path.stem] = done.out.split()[0]
    statuses = {path.stem: json.loads(path.read_text())["status"] for path in certificates}
    assert statuses == {
        "reaching": "PROVED",
        "no_go": "VACUOUS",
        "sliding_exists": "REFUTED",
        "stop_bound": "PROVED",
    }
    assert {name: head == "✓" for name, head in heads.items()} == {
        name: status == "PROVED" for name, status in statuses.items()
    }


def test_what_was_shown_is_said_with_its_numbers(wspd, certificates):
    done = wspd("check", *certificates)
    said = " ".join(done.out.split())
    assert "no stop from 120 km/h is shorter than 272.2" in said
    assert "show that no_go is vacuous" in said
    assert "The witness denies u* - eta/g >= 0 N m: it is -" in said


def moved_witness(content):
    content["witness"][1]["value"] = 20.0


def witness_outside(content):
    content["witness"][1]["value"] = 500.0


def no_list_of_points(content):
    content["witness"] = "slip 0.6"


@pytest.mark.parametrize("tamper", [moved_witness, witness_outside, no_list_of_points])
def test_a_witness_that_denies_nothing_is_refused(wspd, certificates, tamper):
    path = certificates[SEARCHED.index("sliding_exists")]
    content = json.loads(path.read_text())
    tamper(content)
    path.write_text(json.dumps(content))
    done = wspd("check", path)
    assert done.code == 1
    assert "✗ refused" in done.out


def test_nothing_else_is_written(wspd, certificate):
    before = sorted(Path(certificate.parent.parent).rglob("*"))
    wspd("check", certificate)
    assert sorted(Path(certificate.parent.parent).rglob("*")) == before
