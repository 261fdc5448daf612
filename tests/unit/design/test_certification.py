"""certify and check in Python: what they take, what they write, and that a file is believed only after checking."""

import json

import pytest

import wspd_design as wd
from wspd_design.certificates.kernel.file import FOLDER, certificate_text
from wspd_design.design.certification import folder_beside, problem_of, stored_beside
from wspd_design.parameters.errors import UserError

QUICK = ("surface_hurwitz", "gain_positive")


@pytest.fixture(scope="module")
def design():
    vehicle, rail = wd.load_vehicle("er24pc"), wd.load_rail("polach-wet")
    return wd.design_controller(vehicle, rail, wd.Specification(), law="smc")


@pytest.fixture
def path(design, tmp_path):
    path = tmp_path / "mine.toml"
    wd.write_design(design, path)
    return path


def test_every_way_to_name_a_design_gives_the_same_certificates(design, path, tmp_path):
    found = wd.certify(design, only=QUICK)
    assert [each.status for each in found] == [wd.Status.PROVED] * 2
    texts = [certificate_text(each) for each in found]
    for given in (path, str(path), problem_of(design)):
        assert [certificate_text(each) for each in wd.certify(given, only=QUICK)] == texts
    assert list(tmp_path.iterdir()) == [path]  # nothing is written unless a folder is named


def test_a_name_of_a_controller_or_an_own_one(tmp_path):
    (found,) = wd.certify("smc", rail="polach-dry", only=("surface_hurwitz",))
    assert found.status is wd.Status.PROVED
    law = tmp_path / "law.py"
    law.write_text("import wspd_design as wd\nlaw = wd.controller('none', wd.load_vehicle('er24pc'), "
                   "wd.load_rail('polach-wet'), wd.Specification())\n")  # fmt: skip
    (own,) = wd.certify(f"{law}:law", only=("surface_hurwitz",))
    assert own.status is wd.Status.NOT_APPLICABLE
    assert folder_beside(f"{law}:law") == tmp_path / f"law{FOLDER}"


def test_files_are_written_checked_and_taken_again(path, monkeypatch):
    folder = folder_beside(path)
    assert stored_beside(path) is None
    made = wd.certify(path, only=(*QUICK, "lyapunov_printed"), folder=folder)
    assert made[-1].status is wd.Status.NOT_APPLICABLE
    assert sorted(each.name for each in folder.iterdir()) == sorted(f"{name}.json" for name in QUICK)
    for name in QUICK:
        found = wd.check(folder / f"{name}.json", path)
        assert found.accepted
        assert wd.check((folder / f"{name}.json").read_text(), path) == found
    # What lies there and is accepted is not searched again; what is changed is.
    from wspd_design.certificates.checks.frame import Check

    monkeypatch.setattr(Check, "run", lambda *_, **__: pytest.fail("searched"))
    assert [certificate_text(each) for each in wd.certify(path, only=QUICK)] == [
        certificate_text(each) for each in made[:2]
    ]
    file = folder / "gain_positive.json"
    file.write_text(json.dumps(json.loads(file.read_text()) | {"claim": "Every stop is stable."}))
    with pytest.raises(pytest.fail.Exception, match="searched"):
        wd.certify(path, only=QUICK)


def test_a_file_of_another_design_is_refused(path, tmp_path):
    (made,) = wd.certify(path, only=("gain_positive",), folder=tmp_path / "kept")
    found = wd.check(tmp_path / "kept" / "gain_positive.json", "smc", rail="polach-dry")
    assert not found.accepted
    assert found.certificate is None
    assert made.status is wd.Status.PROVED


def test_bad_input_is_said_in_a_sentence(design, path, tmp_path):
    with pytest.raises(UserError, match="cannot be read"):
        wd.check(tmp_path / "missing.json", path)
    with pytest.raises(UserError, match="did you mean"):
        wd.certify(path, only=("reachin",))
    with pytest.raises(UserError, match="must be above 0"):
        wd.certify(path, only=QUICK, effort=0.0)
    with pytest.raises(UserError, match="its own vehicle and rail"):
        wd.certify(problem_of(design), rail="polach-dry")
    (tmp_path / "file").write_text("")
    with pytest.raises(UserError, match="cannot be written"):
        wd.certify(path, only=QUICK, folder=tmp_path / "file")
