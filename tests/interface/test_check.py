"""``wspd check``: accepts what the design implies and refuses everything else, without a traceback."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from wspd_design.cli.app import run

HEAVY = ("scipy", "control", "matplotlib", "ival", "cvxpy", "typst", "jinja2")
STATUSES = {
    "gain_positive": "PROVED",
    "no_go": "VACUOUS",
    "open_loop_pole": "REFUTED",
    "conservation": "EVIDENCE",
}


@pytest.fixture(scope="session")
def certified(tmp_path_factory, smc_text):
    """Certify a design once, with one verdict of each kind."""
    folder = tmp_path_factory.mktemp("certified")
    (folder / "smc.toml").write_text(smc_text)
    assert (
        run(["certify", str(folder / "smc.toml"), *(word for name in STATUSES for word in ("--only", name))])
        == 1
    )
    return folder


@pytest.fixture
def folder(certified, tmp_path):
    """Copy the design and its certificates, free to be tampered with."""
    shutil.copytree(certified, tmp_path / "all")
    return tmp_path / "all" / "smc.certificates"


@pytest.fixture
def proved(folder):
    return folder / "gain_positive.json"


def said(done):
    return " ".join(done.out.split())


def changed(path, **entries):
    path.write_text(json.dumps(json.loads(path.read_text()) | entries))
    return path


def test_an_untouched_certificate_is_accepted_and_its_claim_printed(wspd, proved):
    done = wspd("check", proved)
    assert done.code == 0, done.out + done.err
    assert "✓ accepted gain_positive.json for smc.toml" in said(done)
    assert " ".join(json.loads(proved.read_text())["claim"].split()) in said(done)


def test_each_status_has_its_sign_and_exit_code(wspd, folder):
    signs = {
        "PROVED": "✓ accepted",
        "VACUOUS": "~ accepted",
        "REFUTED": "~ accepted",
        "EVIDENCE": "? unchecked",
    }
    for name, status in STATUSES.items():
        path = folder / f"{name}.json"
        assert json.loads(path.read_text())["status"] == status
        done = wspd("check", path)
        assert done.out.startswith(signs[status]), done.out
        assert done.code == (3 if status == "EVIDENCE" else 0)


def test_a_folder_is_checked_as_a_whole(wspd, folder):
    done = wspd("check", folder)
    assert done.code == 3  # one of them decides nothing
    assert [done.out.count(sign) for sign in ("✓ accepted", "~ accepted", "? unchecked")] == [1, 2, 1]
    (folder / "conservation.json").unlink()
    assert wspd("check", folder).code == 0
    (folder / "broken.json").write_text("{")
    assert wspd("check", folder).code == 1


def test_an_empty_folder_is_one_sentence(wspd, tmp_path):
    (tmp_path / "none").mkdir()
    done = wspd("check", tmp_path / "none")
    assert done.code == 2
    assert "holds no certificate" in done.err


FORGED = {
    "status": "REFUTED",
    "claim": "Every stop of this locomotive on any rail is asymptotically stable.",
    "title": "Asymptotic stability",
    "explanation": "All is well.",
    "method": "exact arithmetic",
    "reference": "nobody",
    "margin": {"low": 99.0, "high": 99.0, "unit": "-"},
    "assumptions": ["none"],
    "hypotheses": [],
    "held": ["nothing"],
    "model_sha256": "0" * 64,
    "worst_point": [],
    "witness": [{"name": "slip", "value": 0.9, "unit": "mph"}],
}


@pytest.mark.parametrize("entry", FORGED)
def test_a_changed_text_is_refused(wspd, proved, entry):
    """Audit B1 and B2: the file is what is handed on, so every word of it counts."""
    done = wspd("check", changed(proved, **{entry: FORGED[entry]}))
    assert done.code == 1
    assert done.err == ""
    assert "✗ refused" in done.out
    assert "✓" not in done.out


@pytest.mark.parametrize("name", ["no_go", "open_loop_pole"])
@pytest.mark.parametrize("status", ["PROVED", "LIMITATION"])
def test_what_is_not_proved_cannot_be_called_so(wspd, folder, name, status):
    assert wspd("check", changed(folder / f"{name}.json", status=status)).code == 1


POINTS = {
    "other unit": lambda at: at | {"unit": "mph"},
    "no unit": lambda at: at | {"unit": None},
    "text": lambda at: at | {"value": "０.３６"},
    "outside": lambda at: at | {"value": 9e9},
    "not finite": lambda at: at | {"value": float("nan")},
    "another name": lambda at: at | {"name": "speed of light"},
}


@pytest.mark.parametrize("fault", POINTS)
def test_a_witness_is_made_again(wspd, folder, fault):
    """Audit B3: unit, name and number of every coordinate are the design's."""
    path = folder / "open_loop_pole.json"
    witness = json.loads(path.read_text())["witness"]
    for k, point in enumerate(witness):
        forged = [*witness[:k], POINTS[fault](point), *witness[k + 1 :]]
        assert wspd("check", changed(path, witness=forged)).code == 1
    for forged in ([], witness[1:], [*witness, witness[0]], witness[::-1]):
        assert wspd("check", changed(path, witness=forged)).code == 1
    assert wspd("check", changed(path, witness=witness)).code == 0


ESCAPE = "\x1b[2J\x1b[32m✓ accepted\x1b[0m\x07\r"


@pytest.mark.parametrize(
    "entry", ["check", "status", "claim", "title", "schema", "unit", "key", "statement", "new"]
)
def test_no_byte_of_a_file_steers_the_terminal(wspd, folder, entry):
    """Audit B4."""
    path = folder / "open_loop_pole.json"
    content = json.loads(path.read_text())
    if entry == "unit":
        content["witness"][0]["unit"] = ESCAPE
    elif entry == "key":
        content["findings"][ESCAPE] = {}
    elif entry == "statement":
        content["findings"] = {
            key: {"proof": {"format": ESCAPE, "statement": {}}} for key in content["findings"]
        }
    else:
        content[ESCAPE if entry == "new" else entry] = ESCAPE
    path.write_text(json.dumps(content))
    done = wspd("check", path)
    assert done.code == 1
    assert "✓" not in done.out
    assert not {"\x1b", "\x07", "\r"} & set(done.out + done.err)


def test_the_name_of_a_file_is_escaped_too(wspd, proved):
    forged = proved.with_name(f"{ESCAPE}.json".replace("/", ""))
    forged.write_text("{")
    done = wspd("check", forged)
    assert done.code == 1
    assert not {"\x1b", "\x07", "\r"} & set(done.out + done.err)


@pytest.mark.parametrize("text", ["", "[]", "null", "{}", '{"schema": "wspd-certificate/3"}', "[" * 100_000])
def test_what_is_not_a_certificate_is_refused(wspd, proved, text):
    proved.write_text(text)
    done = wspd("check", proved)
    assert done.code == 1
    assert done.err == ""


def test_truncated_json_and_bytes_are_refused(wspd, proved):
    whole = proved.read_bytes()
    for part in (whole[: len(whole) // 2], whole[:-3], b"\xff\xfe\x00" * 100):
        proved.write_bytes(part)
        done = wspd("check", proved)
        assert done.code == 1
        assert "not complete JSON" in done.out
        assert done.err == ""


def test_the_claim_comes_from_the_design(wspd, proved):
    design = proved.parent.parent / "smc.toml"
    text = design.read_text()
    other = text.replace("slips = [0.02, 0.6]", "slips = [0.02, 0.7]")
    assert other != text
    design.write_text(other)
    done = wspd("check", proved)
    assert done.code == 1
    assert "is not what the proofs show about this design" in said(done)


def test_a_proof_for_another_rail_is_refused(wspd, proved):
    assert wspd("check", proved, "--rail", "polach-dry").code == 1


def test_one_refused_among_several_decides(wspd, proved):
    other = proved.with_name("broken.json")
    other.write_text("{")
    done = wspd("check", other, proved)
    assert done.code == 1
    assert "✗ refused" in done.out
    assert "✓ accepted" in done.out


def test_a_missing_design_is_one_sentence(wspd, proved):
    design = proved.parent.parent / "smc.toml"
    design.rename(design.with_name("moved.toml"))
    done = wspd("check", proved)
    assert done.code == 2
    assert "smc.toml is not beside it; name it with --design" in done.err
    assert len(done.err.strip().splitlines()) == 1
    assert wspd("check", proved, "--design", design.with_name("moved.toml")).code == 0


def test_a_missing_certificate_is_one_sentence(wspd, proved):
    done = wspd("check", proved.with_name("none.json"))
    assert done.code == 2
    assert "cannot be read" in done.err


def test_the_checker_loads_no_prover(folder):
    """CasADi is there to trace the law alone."""
    files = [str(folder / f"{name}.json") for name in STATUSES if name != "conservation"]
    code = (
        "import sys; from wspd_design.cli.app import run; "
        f"code = run(['check', *{files!r}]); "
        f"print(code, [name for name in {HEAVY!r} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "0 []"


def test_nothing_else_is_written(wspd, proved):
    before = sorted(Path(proved.parent.parent).rglob("*"))
    wspd("check", proved)
    assert sorted(Path(proved.parent.parent).rglob("*")) == before
