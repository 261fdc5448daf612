"""The wizard, driven by keys through a pipe, as a terminal would send them."""

from contextlib import contextmanager

import pytest
from prompt_toolkit.application import create_app_session
from prompt_toolkit.input import create_pipe_input
from prompt_toolkit.output import DummyOutput

from wspd_design.cli.wizard import session
from wspd_design.design.file import read_design
from wspd_design.design.records import Specification

ENTER, DOWN, UP, BACK, ESCAPE, LEAVE = "\r", "\x1b[B", "\x1b[A", "\x02", "\x1b", "\x03"
ERASE = "\x15"  # Ctrl-U, the whole line
STEPS = 9  # vehicle, rail, law, slip, speeds, sample time, tolerance, requirements, review


@pytest.fixture
def answer(wspd, monkeypatch):
    """Start the wizard and send keys; returns the outcome of the command."""
    monkeypatch.setattr(session, "is_interactive", lambda: True)
    monkeypatch.setenv("TERM", "xterm")

    @contextmanager
    def terminal(keys):
        with create_pipe_input() as pipe, create_app_session(input=pipe, output=DummyOutput()):
            pipe.send_text(keys)
            yield

    def call(keys, *arguments):
        with terminal(keys):
            return wspd(*arguments)

    return call


def test_defaults_give_what_wspd_design_gives(answer, wspd, tmp_path):
    outcome = answer(ENTER * STEPS)
    assert (outcome.code, outcome.err) == (0, "")
    assert read_design(tmp_path / "design.toml").specification == Specification()
    for name, arguments in (("a.toml", ("design",)), ("b.toml", ("new", "--yes"))):
        assert wspd(*arguments, "-o", name).code == 0
        assert (tmp_path / name).read_bytes() == (tmp_path / "design.toml").read_bytes()
    for command in ("wspd verify design.toml", "wspd report design.toml"):
        assert command in outcome.out


def test_answers_reach_the_design(answer, tmp_path):
    keys = ENTER + UP + ENTER + DOWN + ENTER
    keys += (
        f"{ERASE}12 %{ENTER}{ERASE}20 to 100 km/h{ENTER}{ERASE}50 ms{ENTER}{ERASE}0,04{ENTER}{ENTER}{ENTER}"
    )
    outcome = answer(keys, "new", "-o", "mine.toml")
    assert outcome.code == 0
    made = read_design(tmp_path / "mine.toml")
    assert (made.vehicle, made.rail, made.law) == ("er24pc", "polach-dry", "smc")
    specification = made.specification
    assert (specification.slip, specification.sample_time) == (0.12, 0.05)
    assert specification.slip_tolerance == 0.04
    assert specification.speeds == pytest.approx((20.0 / 3.6, 100.0 / 3.6))


def test_the_law_with_torque_feedback(answer, wspd, tmp_path):
    outcome = answer(ENTER * 2 + DOWN * 2 + ENTER * 3 + f"{ERASE}20 ms{ENTER * 4}")
    assert outcome.code == 0
    assert "K = (tau/h - 1) T_nominal/T_max, at least 0" in " ".join(outcome.out.split())
    made = read_design(tmp_path / "design.toml")
    assert (made.law, made.specification.sample_time) == ("torque-feedback", 0.02)
    assert wspd("simulate", "design.toml", "--plant", "quarter").code == 0


def test_a_wrong_number_is_not_accepted(answer, tmp_path):
    keys = f"{ENTER * 3}{ERASE}1.4{ENTER}{ENTER}{ERASE}0.2{ENTER}{ENTER * 5}"
    assert answer(keys).code == 0
    assert read_design(tmp_path / "design.toml").specification.slip == 0.2


@pytest.mark.parametrize("back", [BACK, pytest.param(ESCAPE, id="escape")])
def test_back(back, answer, tmp_path):
    """From the speed range back to the slip, which is changed, and on."""
    keys = f"{ENTER * 4}{back}"
    if back == ESCAPE:
        keys += BACK  # two steps back, so that Esc is followed by another key and not by a sequence
        keys += ENTER
    keys += f"{ERASE}0.2{ENTER}{ENTER * 5}"
    outcome = answer(keys)
    assert outcome.code == 0
    assert "back from Speed range" in outcome.out
    assert read_design(tmp_path / "design.toml").specification.slip == 0.2


def test_branches_are_evaluated_again(answer, tmp_path):
    """An own rail file is asked for, and no longer asked for after going back and choosing a shipped rail."""
    (tmp_path / "mine.toml").write_text('base = "polach-wet"\n[mu0]\nvalue = 0.33\nunit = "-"\n')
    to_own = DOWN * 4
    own = answer(f"{ENTER}{to_own}{ENTER}mine.toml{ENTER}{ENTER * 7}", "new", "-o", "own.toml")
    assert own.code == 0
    assert read_design(tmp_path / "own.toml").rail == "mine"
    back = answer(f"{ENTER}{to_own}{ENTER}mine.toml{ENTER}{BACK}{BACK}{UP * 4}{ENTER}{ENTER * 7}")
    assert back.code == 0
    assert read_design(tmp_path / "design.toml").rail == "polach-wet"


def test_missing_own_file_is_not_accepted(answer, tmp_path):
    keys = f"{ENTER}{DOWN * 4}{ENTER}nowhere.toml{ENTER}{LEAVE}"
    assert answer(keys).code == 130
    assert "nowhere" not in (tmp_path / "design.toml.part").read_text()


def test_a_line_of_the_review_is_changed(answer, tmp_path):
    """Down four lines from saving stands the slip; after it comes the review again."""
    outcome = answer(f"{ENTER * 8}{DOWN * 4}{ENTER}{ERASE}0.2{ENTER}{ENTER}")
    assert outcome.code == 0
    assert read_design(tmp_path / "design.toml").specification.slip == 0.2
    assert "Again:    wspd new --yes --set slip=0.2" in outcome.out


def test_leaving_keeps_the_answers_and_resume_goes_on(answer, tmp_path):
    left = answer(f"{ENTER}{UP}{ENTER}{ENTER}{ERASE}0.2{ENTER}{LEAVE}")
    assert left.code == 130
    assert left.err == ""
    assert "wspd new --resume design.toml.part" in left.out
    assert [path.name for path in tmp_path.iterdir()] == ["design.toml.part"]
    resumed = answer(ENTER * 5, "new", "--resume", "design.toml.part")
    assert resumed.code == 0
    assert [path.name for path in tmp_path.iterdir()] == ["design.toml"]
    made = read_design(tmp_path / "design.toml")
    assert (made.rail, made.specification.slip) == ("polach-dry", 0.2)


def test_resume_asks_again_for_an_answer_that_no_longer_holds(answer, tmp_path):
    answer(f"{ENTER * 8}{LEAVE}")
    draft = tmp_path / "design.toml.part"
    draft.write_text(draft.read_text().replace('slip = "0.14"', 'slip = "14"'))
    outcome = answer(f"{ERASE}0.15{ENTER}{ENTER}", "new", "--resume", "design.toml.part")
    assert outcome.code == 0
    assert read_design(tmp_path / "design.toml").specification.slip == 0.15


def test_existing_output_is_refused_before_the_first_question(answer, tmp_path):
    (tmp_path / "design.toml").write_text("mine")
    outcome = answer("", "new")
    assert outcome.code == 2
    assert "--force" in outcome.err
    assert (tmp_path / "design.toml").read_text() == "mine"


def test_a_terminal_that_cannot_move_the_cursor(wspd, monkeypatch, tmp_path):
    """With ``TERM=dumb`` the questions come line by line, without an escape sequence."""
    lines = iter(["", "3", "?", "smc", "1.4", "20 %", "<", "0.16", "", "", "", "", "5", "0.17", "1"])
    monkeypatch.setattr(session, "is_interactive", lambda: True)
    monkeypatch.setattr("builtins.input", lambda _prompt: next(lines))
    monkeypatch.setenv("TERM", "dumb")
    outcome = wspd("new")
    assert (outcome.code, outcome.err) == (0, "")
    assert "\x1b" not in outcome.out
    assert "must lie in (0, 1)" in " ".join(outcome.out.split())
    made = read_design(tmp_path / "design.toml")
    assert (made.rail, made.law, made.specification.slip) == ("polach-dry", "smc", 0.17)
    assert "Control law (3 of 9)" in outcome.out
    assert "Key of the answer: law." in outcome.out
    assert "! The brake asks for an adhesion" in outcome.out


def test_input_that_ends_is_like_leaving(wspd, monkeypatch, tmp_path):
    def ended(_prompt):
        raise EOFError

    monkeypatch.setattr(session, "is_interactive", lambda: True)
    monkeypatch.setattr("builtins.input", ended)
    monkeypatch.setenv("TERM", "dumb")
    assert wspd("new").code == 130
    assert (tmp_path / "design.toml.part").exists()


def test_answers_of_a_file_and_of_set_need_no_terminal(wspd, tmp_path):
    shown = wspd("new", "--print-answers", "--set", "rail=polach-dry", "--set", "law=smc")
    assert shown.code == 0
    (tmp_path / "answers.toml").write_text(shown.out)
    made = wspd("new", "--answers", "answers.toml", "--set", "slip=12 %", "-o", "mine.toml")
    assert (made.code, made.err) == (0, "")
    design = read_design(tmp_path / "mine.toml")
    assert (design.rail, design.law, design.specification.slip) == ("polach-dry", "smc", 0.12)
    assert (tmp_path / "answers.toml").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--set", "ral=polach-dry"), "unknown answer ral; did you mean rail"),
        (("--set", "slip=1.4"), "slip = 1.4 must lie in (0, 1)"),
        (("--set", "rail=own file", "--set", "rail_file=none.toml", "--yes"), "none.toml does not exist"),
        (("--answers", "nowhere.toml"), "nowhere.toml"),
        (("--set", "slip=12 %"), "needs a terminal to ask for vehicle, rail, law, speeds"),
        (("--set", "requirements=own file", "--set", "requirements_file=x", "--yes"), "path of a .toml file"),
    ],
)
def test_wrong_answers_are_refused_without_a_terminal(arguments, words, wspd, tmp_path):
    outcome = wspd("new", *arguments)
    assert outcome.code == 2
    assert words in outcome.err
    assert list(tmp_path.iterdir()) == []


def test_the_design_names_its_requirements(wspd, tmp_path):
    made = wspd("new", "--yes", "--set", "requirements=en-15595-like")
    assert "Judged by en-15595-like." in made.out
    assert read_design(tmp_path / "design.toml").judged_by == "en-15595-like"
    (tmp_path / "line7.toml").write_text('[requirements.limits]\nlongest_lock = "0.4 s"\n')
    (tmp_path / "designs").mkdir()
    own = ("--set", "requirements=own file", "--set", "requirements_file=line7.toml")
    assert wspd("new", "--yes", *own, "-o", "designs/own.toml").code == 0
    assert read_design(tmp_path / "designs" / "own.toml").judged_by == "../line7.toml"
    assert wspd("new", "--yes", "-o", "plain.toml").code == 0
    assert "judged_by" not in (tmp_path / "plain.toml").read_text()


def test_vehicles_and_rails_take_files_of_answers(wspd, tmp_path):
    for kind, given in (("vehicle", ("--mass", "48 t")), ("rail", ("--peak", "0.05"))):
        shown = wspd("new", kind, "--print-answers", *given)
        assert given[1] in shown.out
        (tmp_path / "answers.toml").write_text(shown.out)
        assert wspd("new", kind, f"{kind}.toml", "--answers", "answers.toml").code == 0
        again = wspd("new", kind, "other.toml", *given, "--yes", "--force")
        assert again.code == 0
        first, second = ((tmp_path / name).read_text() for name in (f"{kind}.toml", "other.toml"))
        numbers = [
            [line for line in text.splitlines() if line.startswith(("value", "["))]
            for text in (first, second)
        ]
        assert numbers[0] == numbers[1]
