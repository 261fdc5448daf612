"""Ctrl-C during the checks: what is finished is shown, kept, and not searched again."""

import pytest

from wspd_design.certificates.checks.frame import Check

ASKED = ("surface_hurwitz", "gain_positive", "open_loop_pole")
ONLY = [word for name in ASKED for word in ("--only", name)]


@pytest.fixture
def interrupt(monkeypatch):
    """Make the search of one check take Ctrl-C, and count the searches of the others."""
    searched = []
    run = Check.run

    def start(at):
        searched.clear()

        def stopped(self, problem, **options):
            if self.name == at:
                raise KeyboardInterrupt
            searched.append(self.name)
            return run(self, problem, **options)

        monkeypatch.setattr(Check, "run", stopped)
        return searched

    return start


def test_verify_shows_and_keeps_what_is_finished(wspd, smc_file, interrupt):
    folder = smc_file.with_suffix(".certificates")
    interrupt("open_loop_pole")
    left = wspd("verify", smc_file, *ONLY)
    assert left.code == 130
    assert "✓ PROVED  surface_hurwitz" in left.out
    assert "open_loop_pole" not in left.out
    assert "interrupted after 2 of 3 checks" in left.err
    assert "goes on from there" in left.err
    assert sorted(path.stem for path in folder.iterdir()) == ["gain_positive", "surface_hurwitz"]
    searched = interrupt("")
    assert wspd("verify", smc_file, *ONLY).code == 1
    assert searched == ["open_loop_pole"]


def test_an_interrupt_before_the_first_check_is_told(wspd, smc_file, interrupt):
    interrupt("surface_hurwitz")
    left = wspd("verify", smc_file, *ONLY)
    assert (left.code, left.out) == (130, "")
    assert left.err == "wspd: interrupted after 0 of 3 checks.\n"
    assert not smc_file.with_suffix(".certificates").exists()


def test_another_case_than_that_of_the_design_is_not_kept_beside_it(wspd, smc_file, interrupt):
    interrupt("open_loop_pole")
    for other in (("--rail", "polach-dry"), ("--seed", "1")):
        left = wspd("verify", smc_file, *ONLY, *other)
        assert left.code == 130
        assert "kept" not in left.err
    assert not smc_file.with_suffix(".certificates").exists()


def test_files_that_are_there_stay(wspd, smc_file, interrupt):
    folder = smc_file.with_suffix(".certificates")
    folder.mkdir()
    (folder / "surface_hurwitz.json").write_text("mine")
    interrupt("open_loop_pole")
    assert wspd("verify", smc_file, *ONLY).code == 130
    assert (folder / "surface_hurwitz.json").read_text() == "mine"
    assert (folder / "gain_positive.json").exists()


def test_certify_writes_each_file_as_it_is_found(wspd, smc_file, interrupt):
    interrupt("gain_positive")
    left = wspd("certify", smc_file, *ONLY)
    assert left.code == 130
    assert "interrupted after 1 of 3 checks" in left.err
    assert "--force goes on" in left.err
    searched = interrupt("")
    assert wspd("certify", smc_file, *ONLY, "--force").code == 1
    assert searched == ["gain_positive", "open_loop_pole"]


def test_json_is_whole_or_not_there(wspd, smc_file, interrupt):
    interrupt("open_loop_pole")
    left = wspd("verify", smc_file, *ONLY, "--json")
    assert (left.code, left.out) == (130, "")
