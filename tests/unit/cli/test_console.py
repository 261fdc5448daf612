"""Output that programs read, and streams that are no terminal."""

import json

import pytest

from wspd_design.cli.console import ProgressLines, StageLines, console, print_json, progress, progress_bar


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_a_number_that_is_not_finite_becomes_null(value, capsys):
    print_json({"a": value, "b": [value, 1.0], "c": {"d": (value,)}, "e": 0.1})
    found = json.loads(capsys.readouterr().out)
    assert found == {"a": None, "b": [None, 1.0], "c": {"d": [None]}, "e": 0.1}


def test_numbers_survive(capsys):
    print_json({"x": 0.1 + 0.2})
    assert json.loads(capsys.readouterr().out)["x"] == 0.1 + 0.2


@pytest.mark.parametrize("term", ["dumb", "xterm"])
def test_width_is_that_of_the_terminal(term, monkeypatch):
    """Rich alone assumes 80 columns where ``TERM=dumb``."""
    monkeypatch.setenv("TERM", term)
    monkeypatch.setenv("COLUMNS", "60")
    monkeypatch.setenv("FORCE_COLOR", "1")  # Rich then takes the stream for a terminal
    assert console().is_dumb_terminal == (term == "dumb")
    assert console().width == 60


def test_progress_is_silent_without_a_terminal(capsys):
    with progress() as tell:
        tell("stage")
    assert capsys.readouterr() == ("", "")


def test_progress_bar(capsys, monkeypatch):
    with progress_bar("4 stops", 4) as tell:
        tell(2)
    assert capsys.readouterr() == ("", "")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("FORCE_COLOR", "1")  # Rich then takes the stream for a terminal
    with progress_bar("4 stops [all]", 4) as tell:
        tell(2)
    out, err = capsys.readouterr()
    assert out == ""
    assert "4 stops [all]" in err
    assert "2/4" in err


class Clock:
    """Time that passes as it is told."""

    def __init__(self):
        self.now = 1000.0

    def __call__(self):
        return self.now


def test_progress_in_lines_is_one_a_minute_with_the_remaining_time(capsys):
    clock = Clock()
    tell = ProgressLines("stops", 10_000, clock=clock)
    clock.now += 100.0  # until the first chunk: what a store gave back says nothing about the time
    tell(4000)
    assert capsys.readouterr().err == ""
    for second in range(1, 121):
        clock.now += 1.0
        tell(4000 + 10 * second)
    assert capsys.readouterr().err.splitlines() == [
        "stops: 4600 of 10000 (46 %), about 9 min left",
        "stops: 5200 of 10000 (52 %), about 8 min left",
    ]
    clock.now += 60.0
    tell(5200)  # nothing came: nothing is known about the rest
    assert capsys.readouterr().err == "stops: 5200 of 10000 (52 %)\n"
    clock.now += 600.0
    tell(5210)
    assert capsys.readouterr().err == "stops: 5210 of 10000 (52 %), about 79.8 h left\n"


def test_stages_in_lines_are_one_a_minute(capsys):
    """A verification was silent for minutes in the log of a CI job."""
    clock = Clock()
    tell = StageLines(clock=clock)
    for second in range(150):
        clock.now += 1.0
        tell(f"reaching: {second} %")
    assert capsys.readouterr().err.splitlines() == ["reaching: 59 % ...", "reaching: 119 % ..."]
