"""No forged certificate file is accepted that says something else; and the judge sees checkers that accept some."""

import json

import pytest

from tests.attack.forge import (
    Ambiguous,
    Decision,
    Judge,
    Mutant,
    decide,
    load_problem,
    main,
    mutants,
    read_files,
    says,
)
from tests.attack.mutators import KINDS
from tests.attack.proof_mutators import PROOF_KINDS

CHECKS = (
    "gain_positive",
    "no_go",
    "sampling",
    "open_loop_pole",
    "surface_hurwitz",
    "tracking",
    "conservation",
)
INSIDE = (*PROOF_KINDS, "layout")
COUNT = 160


@pytest.fixture(scope="module")
def files(certified):
    return read_files(certified("smc", CHECKS))


@pytest.fixture(scope="module")
def others(certified):
    return read_files(certified("adaptive", ("no_go", "surface_hurwitz")))


@pytest.fixture(scope="module")
def judge(design, files):
    problem = load_problem(design("smc"))
    return Judge(lambda text: decide(problem, text), files)


def wrong(judge, files, others, kinds, count=COUNT):
    found = judge.count(mutants(files, others, count, seed=1, kinds={kind: KINDS[kind] for kind in kinds}))
    assert set(found) == set(kinds)  # every kind has something to change
    return [(kind, mutant.name, said) for kind, one in found.items() for said, mutant in one.faults]


# --- the program


@pytest.mark.slow
def test_nothing_false_is_accepted_among_the_findings(judge, files, others):
    assert wrong(judge, files, others, INSIDE) == []


@pytest.mark.slow
def test_nothing_false_is_accepted_of_any_kind(judge, files, others):
    assert wrong(judge, files, others, [kind for kind in KINDS if kind not in INSIDE]) == []


def test_the_genuine_files_and_other_layouts_are_accepted(judge, files):
    assert set(judge.genuine) == set(CHECKS)
    found = judge.count(mutants(files, {}, 20, kinds={"layout": KINDS["layout"]}))["layout"]
    assert found.identical > 5
    assert not found.faults


def test_the_command_counts_by_kind(design, certified, tmp_path, capsys):
    folder = certified("smc", CHECKS)
    words = [str(design("smc")), str(folder), "--count", "6", "--kind", "layout", "--keep", str(tmp_path)]
    assert main(words) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["kind", "tried", "identical", "refused", "wrong", "worst", "CPU"]
    assert lines[1].split()[:2] == ["layout", "6"]
    assert lines[-1] == "6 forged files, 0 answered wrongly"


# --- the judge, with checkers that are wrong on purpose


def gullible(**changes):
    """A checker that believes every file that can be read, its proofs as well."""

    def ask(text):
        try:
            content = json.loads(text)
            stated = content["status"]
            shown = (json.dumps(content["findings"]),)
        except (ValueError, TypeError, KeyError, RecursionError):
            return Decision(accepted=False, status="", shown=(), printed="no certificate")
        found = {"accepted": True, "status": stated, "shown": shown, "printed": "all is well"}
        return Decision(**{**found, **changes})

    return ask


@pytest.mark.parametrize(
    "kind", [kind for kind in KINDS if kind not in ("layout", "around the text", "nested deeply")]
)
def test_a_checker_that_believes_the_words_is_seen(kind, files, others):
    assert wrong(Judge(gullible(), files), files, others, [kind], 25)


def test_a_checker_that_shows_another_statement_is_seen(files, others):
    answers = iter(range(10**6))

    def ask(text):
        return gullible(shown=(f"statement {next(answers)}",))(text)

    assert wrong(Judge(ask, files), files, others, ["layout"], 5)


def test_a_status_that_changed_is_seen(files):
    judge = Judge(gullible(), files)
    forged = Mutant(
        kind="status", name="x", text=files["gain_positive.json"].replace('"PROVED"', '"REFUTED"', 1)
    )
    assert "accepted as REFUTED" in judge.fault(forged)[0]


def test_a_traceback_is_seen(files):
    judge = Judge(gullible(), files)

    def fail(_text):
        raise RecursionError("deep")

    judge.ask = fail
    assert judge.fault(Mutant(kind="raw JSON", name="x", text="{}"))[0] == "RecursionError: deep"


@pytest.mark.parametrize("letter", ["\x1b", "\u202e", "\ud800", "\x00", "\u200b", "\r"])
def test_what_reaches_the_terminal_raw_is_seen(letter, files):
    judge = Judge(gullible(), files)
    judge.ask = gullible(accepted=False, printed=f"unit {letter}[2J")
    forged = Mutant(kind="witness", name="x", text=files["gain_positive.json"])
    assert "prints" in judge.fault(forged)[0]


def test_a_refused_genuine_proof_is_an_error(files):
    with pytest.raises(ValueError, match="is not accepted"):
        Judge(gullible(accepted=False), files)


# --- texts


def test_the_same_seed_forges_the_same_texts(files, others):
    first, second = (list(mutants(files, others, 60, seed=4)) for _ in range(2))
    assert first == second
    assert len({each.text for each in first}) > 50
    assert first != list(mutants(files, others, 60, seed=5))


def test_layouts_say_the_same_and_all_else_does_not(files, others):
    for mutant in mutants(files, others, 40, kinds={"layout": KINDS["layout"]}):
        assert says(mutant.text) == says(files[mutant.name])
    for mutant in mutants(files, others, 80, kinds={"words": KINDS["words"], "witness": KINDS["witness"]}):
        assert says(mutant.text) != says(files[mutant.name])


def test_numbers_and_words_are_told_apart():
    assert says('{"a": 0.5}') == says('{"a":5e-1}')
    assert says('{"a": 1}') != says('{"a": true}')
    assert says('{"a": 1}') != says('{"a": "1"}')
    assert says('{"a": 0.14}') != says('{"a": 0.14000000000000002}')
    assert says('{"findings": [1], "a": NaN}') != says('{"a": "NaN"}')
    for text in ('{"a": 1, "a": 2}', "[1]", '{"a": 1} x', "\ufeff{}", '{"a": ' * 5000):
        with pytest.raises(Ambiguous):
            says(text)


@pytest.mark.parametrize("kind", list(PROOF_KINDS))
def test_each_kind_changes_what_was_found(kind, files):
    name = "conservation.json" if kind == "numbers of samples" else "no_go.json"
    before = json.loads(files[name])["findings"]
    for mutant in mutants({name: files[name]}, files, 6, kinds={kind: KINDS[kind]}):
        assert json.loads(mutant.text)["findings"] != before
        assert says(mutant.text) == says(files[name])
