"""The way through the questions, with answers from a script in place of a terminal."""

import pytest

from wspd_design.cli.wizard.asked_design import OWN, split_speeds, wanted
from wspd_design.cli.wizard.design_steps import design_steps
from wspd_design.cli.wizard.draft import answers_text, read_draft, read_pairs, write_draft
from wspd_design.cli.wizard.flow import Back, Place, complete, walk
from wspd_design.cli.wizard.steps import SAVE, accept
from wspd_design.controllers.observers.sensors import TOLD, Sensors
from wspd_design.design.records import Specification
from wspd_design.parameters.errors import UserError

ALL = design_steps()
TITLES = ["vehicle", "rail", "law", "slip", "speeds", "sample_time", "tolerance", "requirements", "review"]


def step(key):
    return next(each for each in ALL if each.key == key)


def script(*replies):
    """Ask with prepared replies; None takes the suggestion. Records which question was asked."""
    asked, left = [], list(replies)

    def ask(question, _answers, suggestion, _place):
        asked.append(question.key)
        reply = left.pop(0) if left else None
        return suggestion if reply is None else reply

    return ask, asked


def test_all_defaults():
    ask, asked = script()
    answers = walk(ALL, {}, ask)
    assert asked == TITLES
    assert answers == complete(ALL, {})
    assert wanted(answers) == Specification()


def test_own_file_is_asked_for_only_where_it_was_chosen():
    ask, asked = script(OWN, "mine.toml")
    answers = walk(ALL, {}, ask)
    assert asked[:3] == ["vehicle", "vehicle_file", "rail"]
    assert answers["vehicle_file"] == "mine.toml"


def test_the_train_speed_is_asked_of_laws_of_a_vehicle_alone():
    ask, asked = script(None, None, "observer-smc", "wheels and accelerometer")
    answers = walk(ALL, {}, ask)
    assert asked == [*TITLES[:3], "sensors", *TITLES[3:]]
    assert wanted(answers).sensors == Sensors(speed="wheels", accelerometer=True)
    ask, asked = script("afsmc")
    del answers["law"]
    walk(ALL, answers, ask)
    assert "sensors" not in asked
    assert wanted(answers).sensors == TOLD


@pytest.mark.parametrize("option", step("sensors").options, ids=lambda option: option.value)
def test_every_source_of_the_train_speed_is_one(option):
    found = wanted(complete(ALL, {"law": "observer-smc", "sensors": option.value}))
    assert found.sensors.speed == option.value.partition(" ")[0]


def test_back_goes_to_the_question_that_was_asked_before():
    ask, asked = script(OWN, "mine.toml", Back.BACK, Back.BACK, "er24pc", Back.BACK)
    answers = walk(ALL, {}, ask)
    assert asked[:8] == [
        "vehicle",
        "vehicle_file",
        "rail",
        "vehicle_file",
        "vehicle",
        "rail",
        "vehicle",
        "rail",
    ]
    assert "vehicle_file" not in answers


def test_back_at_the_first_question_stays_there():
    ask, asked = script(Back.BACK, Back.BACK)
    walk(ALL, {}, ask)
    assert asked == ["vehicle", "vehicle", *TITLES]


def test_any_line_of_the_review_is_changed_and_nothing_else_asked():
    ask, asked = script(*[None] * 8, "slip", "0.2", SAVE)
    answers = walk(ALL, {}, ask)
    assert asked == [*TITLES, "slip", "review"]
    assert answers["slip"] == "0.2"


def test_back_from_a_line_of_the_review_leads_to_the_review():
    ask, asked = script(*[None] * 8, "slip", Back.BACK, SAVE)
    assert walk(ALL, {}, ask) == complete(ALL, {})
    assert asked == [*TITLES, "slip", "review"]
    ask, asked = script(*[None] * 8, Back.BACK, "paper", SAVE)
    walk(ALL, {}, ask)
    assert asked == [*TITLES, "requirements", "review"]


def test_a_changed_line_opens_what_follows_from_it_and_what_no_longer_fits(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('base = "er24pc"\n')
    ask, asked = script(*[None] * 8, "vehicle", OWN, str(path), "slip", "0.97", "0.02", SAVE)
    answers = walk(ALL, {}, ask)
    assert asked[9:] == ["vehicle", "vehicle_file", "review", "slip", "tolerance", "review"]
    assert (answers["vehicle_file"], answers["tolerance"]) == (str(path), "0.02")
    ask, asked = script("vehicle", "er24pc", SAVE)
    assert "vehicle_file" not in walk(ALL, answers, ask)
    assert asked == ["review", "vehicle", "review"]


def test_each_question_knows_its_place():
    places = []

    def ask(question, _answers, suggestion, place):
        places.append((question.key, place))
        return {"law": "observer-smc"}.get(question.key, suggestion)

    walk(ALL, {}, ask)
    assert places[:3] == [("vehicle", Place(1, 9)), ("rail", Place(2, 9)), ("law", Place(3, 9))]
    assert places[3] == ("sensors", Place(4, 10))
    assert places[-1] == ("review", Place(10, 10))


def test_interruption_leaves_the_answers_with_the_caller():
    def ask(question, _answers, suggestion, _place):
        if question.key == "law":
            raise KeyboardInterrupt
        return suggestion

    answers = {}
    with pytest.raises(KeyboardInterrupt):
        walk(ALL, answers, ask)
    assert answers == {"vehicle": "er24pc", "rail": "polach-wet"}


def test_resume_begins_at_the_first_open_or_wrong_answer():
    ask, asked = script()
    walk(ALL, {"vehicle": "er24pc", "rail": "polach-wet"}, ask)
    assert asked[0] == "law"
    ask, asked = script("0.2")
    walk(ALL, complete(ALL, {}) | {"slip": "2"}, ask)
    assert asked[0] == "slip"
    ask, asked = script(Back.BACK)
    walk(ALL, complete(ALL, {}), ask)
    assert asked == ["review", "requirements", "review"]


def test_answers_that_are_given_are_not_asked_but_can_be_gone_back_to():
    ask, asked = script()
    walk(ALL, {"law": "smc", "speeds": "10 to 80 km/h"}, ask)
    assert asked == ["vehicle", "rail", "slip", "sample_time", "tolerance", "requirements", "review"]
    ask, asked = script(Back.BACK, None, None)
    walk(ALL, {"vehicle": "er24pc", "rail": "polach-wet", "slip": "0.2"}, ask)
    assert asked[:5] == ["law", "rail", "law", "speeds", "sample_time"]


def test_draft_round_trip(tmp_path):
    answers = {"vehicle": OWN, "vehicle_file": 'C:\\a "b".toml', "slip": "14 %"}
    write_draft(answers, tmp_path / "a.part")
    assert read_draft(tmp_path / "a.part", ALL) == answers


def test_a_file_of_answers_is_read_back_and_says_what_each_means(tmp_path):
    answers = complete(ALL, {"rail": "polach-dry"})
    path = tmp_path / "answers.toml"
    path.write_text(answers_text(ALL, answers, "wspd new"))
    assert read_draft(path, ALL) == answers
    assert "# Slip reference. The slip that the controller holds." in path.read_text()


@pytest.mark.parametrize(
    ("pairs", "words"),
    [
        (["slipp=0.1"], "unknown answer slipp; did you mean slip"),
        (["slip"], "must be an answer with its key"),
        (["slip="], "must be an answer with its key"),
        (["slip=0.1", "slip=0.2"], "twice"),
        (["review=save"], "unknown answer review"),
    ],
)
def test_wrong_pairs_are_refused(pairs, words):
    with pytest.raises(UserError, match=words):
        read_pairs(pairs, ALL)


def test_pairs_may_hold_an_equals_sign():
    assert read_pairs(["vehicle_file=a=b.toml"], ALL) == {"vehicle_file": "a=b.toml"}


def test_complete_refuses_a_wrong_answer():
    with pytest.raises(UserError, match="vehicle"):
        complete(ALL, {"vehicle": "er24cp"})
    with pytest.raises(UserError, match=r"\.toml"):
        complete(ALL, {"rail": OWN})


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("10 km/h to 120 km/h", ("10 km/h", "120 km/h")),
        ("10 to 120 km/h", ("10 km/h", "120 km/h")),
        ("10-160 km/h", ("10 km/h", "160 km/h")),
        ("10 km/h \u2013 160 km/h", ("10 km/h", "160 km/h")),
        ("5 to 75 mph", ("5 mph", "75 mph")),
        ("2,5 to 33,3 m/s", ("2,5 m/s", "33,3 m/s")),
        ("3 m/s to 120 km/h", ("3 m/s", "120 km/h")),
    ],
)
def test_split_speeds(text, parts):
    assert split_speeds(text) == parts


@pytest.mark.parametrize(
    ("key", "text", "words"),
    [
        ("slip", "1.4", r"\(0, 1\)"),
        ("slip", "", "plain number or %"),
        ("speeds", "10 km/h", "two speeds"),
        ("speeds", "10-50-120 km/h", "two speeds"),
        ("speeds", "-10 km/h", "two speeds"),
        ("speeds", "120 to 10 km/h", "rise"),
        ("speeds", "10 to 120", "no unit"),
        ("sample_time", "100", "no unit"),
        ("sample_time", "5 s", "1 ms and 1 s"),
        ("tolerance", "0.9", "tolerance"),
        ("law", "pid", "afsmc, smc"),
        ("vehicle_file", "er24pc", r"\.toml"),
        ("rail_file", "missing.toml", "does not exist"),
    ],
)
def test_what_is_not_accepted(key, text, words):
    with pytest.raises(UserError, match=words):
        accept(step(key), text, complete(ALL, {}))


def test_preview_shows_si_units():
    answers = complete(ALL, {})
    assert accept(step("slip"), "14 %", answers) == "0.14"
    assert accept(step("speeds"), "36 to 72 km/h", answers) == "10 m/s to 20 m/s"
    assert accept(step("sample_time"), "20 ms", answers) == "0.02 s"
    assert accept(step("tolerance"), "4 %", answers) == "slip 0.1 to 0.18"


def test_an_early_answer_is_not_refused_for_a_later_one():
    """A slip near 1 is accepted although the tolerance given before no longer fits; that is asked again."""
    answers = complete(ALL, {})
    assert accept(step("slip"), "0.97", answers) == "0.97"
    with pytest.raises(UserError, match="tolerance"):
        accept(step("tolerance"), answers["tolerance"], answers | {"slip": "0.97"})
