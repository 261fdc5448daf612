"""A user's own controller: the page about it, and what is refused."""

import doctest
import json
import re
import shlex
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[2] / "docs" / "own-controller.md").read_text()
BLOCKS = re.findall(r"^```(console|python)\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
FAR = ("--speed", "60 km/h")

SOUND = """
from dataclasses import dataclass
from wspd_design.controllers.protocol import Command
from wspd_design.model.number import where

@dataclass(frozen=True)
class Threshold:
    vehicle: object
    slip: float = 0.2
    sample_time: float = 0.05
    name: str = "threshold"

    def start(self, measurement):
        return ()

    def step(self, state, measurement):
        rim = self.vehicle.wheel_radius * measurement.wheel_speed
        vent = where(rim < (1.0 - self.slip) * measurement.speed, 1.0, 0.0)
        return (), Command(fill=1.0 - vent, vent=vent)

def by_function(vehicle, sample_time):
    return Threshold(vehicle, sample_time=sample_time, name="by function")

def any_options(**options):
    return Threshold(vehicle=by_name("er24pc"), name="any options")

def by_name(name="er24pc"):
    from wspd_design.parameters.loading import load_vehicle
    return load_vehicle(name)

ready = any_options()
"""

WHOLE = """
from dataclasses import dataclass
from wspd_design.controllers.protocol import Command
from wspd_design.model.number import maximum, where

@dataclass(frozen=True)
class Fastest:
    vehicle: object
    wheelsets: int
    slip: float = 0.2
    sample_time: float = 0.05
    name: str = "fastest"
    memory: tuple = ("train_speed",)

    def start(self, seen):
        return (self.fastest(seen),)

    def step(self, state, seen):
        speed = maximum(self.fastest(seen), state[0] - 2.0 * self.sample_time)
        return (speed,), tuple(self.command(speed, each) for each in seen.wheel_speeds)

    def fastest(self, seen):
        rim = self.vehicle.wheel_radius * seen.wheel_speeds[0]
        for each in seen.wheel_speeds[1:]:
            rim = maximum(rim, self.vehicle.wheel_radius * each)
        return rim

    def command(self, speed, wheel_speed):
        vent = where(self.vehicle.wheel_radius * wheel_speed < (1.0 - self.slip) * speed, 1.0, 0.0)
        return Command(fill=1.0 - vent, vent=vent)
"""

FAULTS_OF_WHOLE = {
    "commands one wheelset": (
        ("tuple(self.command(speed, each) for each in seen.wheel_speeds)", "self.command(speed, 40.0)"),
        "must return (state, (Command(fill=..., vent=...), ...))",
    ),
    "commands too few": (
        ("in seen.wheel_speeds)", "in seen.wheel_speeds[1:])"),
        "3 commands; it must return 4",
    ),
    "names too much": (('("train_speed",)', '("train_speed", "distance")'), "names 2 elements"),
    "fails": (("seen.wheel_speeds[1:]", "seen.wheel_speed[1:]"), "AttributeError"),
}

# What is wrong -> (text in place of another, what the sentence says)
FAULTS = {
    "no Python": (("def start", "dev start"), "own.py, line 13, is not Python"),
    "fails when it is loaded": (
        ("\ndef by_name", "\n1 / 0\ndef by_name"),
        "own.py, line 27: ZeroDivisionError",
    ),
    "asks for more": (("vehicle: object", "vehicle: object\n    gain: float"), 'asks for "gain"'),
    "has no step": (("def step", "def stop"), "lacks step"),
    "has no sample time": (("sample_time: float = 0.05", "sample_time: str = '50 ms'"), "'50 ms'"),
    "is sampled too slowly": (("= 0.05", "= 5.0"), "between 0.001 and 1 s"),
    "returns no command": (("Command(fill=1.0 - vent, vent=vent)", "vent"), "must return (state, Command"),
    "returns a tuple": (
        ("Command(fill=1.0 - vent, vent=vent)", "(vent, vent)"),
        "Command(fill=..., vent=...)",
    ),
    "forgets its state": (("return ()\n", "return (1.0,)\n"), "1 states and step 0"),
    "is not finite": (("fill=1.0 - vent", 'fill=float("nan")'), "not finite"),
    "fails in step": (("rim = ", "rim = math."), "own.py, line 17: NameError"),
    "fails on the way": (
        ("rim = ", "7.0 / bool(measurement.speed > 5.0)\n        rim = "),
        "own.py, line 17: ZeroDivisionError",
    ),
    "commands too much": (("fill=1.0 - vent", "fill=1.0 + vent"), "both must lie in [0, 1]"),
    "remembers aside": (
        ("rim = ", "object.__setattr__(self, 'slip', self.slip * 0.9)\n        rim = "),
        "changes from call to call",
    ),
    "is random": (
        ("vent = where", "import random\n        vent = random.random() * where"),
        "changes from call to call",
    ),
}


@pytest.fixture
def own(tmp_path):
    path = tmp_path / "own.py"
    path.write_text(SOUND)
    return path


@pytest.fixture
def page_file(tmp_path):
    texts = [text for kind, text in BLOCKS if kind == "python"]
    for name, text in zip(("slip_band.py", "fastest.py", "pull.py"), texts, strict=True):
        (tmp_path / name).write_text(text)


@pytest.mark.usefixtures("page_file")
def test_the_page_shows_what_comes_out(wspd):
    flags = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
    commands = [
        part.split("\n", 1)
        for kind, text in BLOCKS
        if kind == "console"
        for part in re.split(r"^\$ wspd ", text, flags=re.MULTILINE)[1:]
    ]
    assert len(commands) == 7
    for command, expected in commands:
        outcome = wspd(*shlex.split(command))
        assert (outcome.code, outcome.err) == (0, "")
        assert doctest.OutputChecker().check_output(expected, outcome.out, flags), outcome.out


@pytest.mark.usefixtures("page_file")
def test_the_example_of_the_page_is_compiled(wspd):
    outcome = wspd("simulate", "slip_band.py:SlipBand", *FAR, "--json")
    assert json.loads(outcome.out)["engine"] == "compiled"


@pytest.mark.parametrize("made", ["Threshold", "any_options", "ready"])
def test_all_ways_to_make_it(made, wspd, own):
    found = json.loads(wspd("simulate", f"{own.name}:{made}", *FAR, "--json").out)
    assert (found["sample_time_s"], found["engine"]) == (0.05, "compiled")
    again = json.loads(wspd("simulate", "--controller", f"{own}:{made}", *FAR, "--json").out)
    assert again["distance_m"] == found["distance_m"]


def test_options_reach_it(wspd, own):
    """A default holds until the option is written; what has no default follows the options' own defaults."""

    def simulated(*options):
        return json.loads(wspd("simulate", *options, *FAR, "--json").out)

    plain = simulated(f"{own.name}:Threshold")
    assert simulated(f"{own.name}:Threshold", "--sample-time", "10 ms")["sample_time_s"] == 0.01
    assert simulated(f"{own.name}:Threshold", "--slip", "0.2")["distance_m"] == plain["distance_m"]
    assert simulated(f"{own.name}:Threshold", "--slip", "0.1")["distance_m"] != plain["distance_m"]
    assert simulated(f"{own.name}:by_function")["sample_time_s"] == 0.1


def test_a_sample_time_that_it_does_not_take_is_refused(wspd, own):
    outcome = wspd("simulate", f"{own.name}:ready", "--sample-time", "10 ms")
    assert outcome.code == 2
    assert "leave --sample-time out" in outcome.err


def test_comparison_with_shipped_controllers(wspd, own):
    outcome = wspd("compare", f"{own.name}:by_function", "trenitalia:textbook", "trenitalia", *FAR, "--json")
    stops = json.loads(outcome.out)["stops"]
    assert [stop["controller"] for stop in stops] == ["by function", "trenitalia (textbook)", "trenitalia"]
    assert len({stop["distance_m"] for stop in stops}) == 3


def test_certificates_that_speak_about_it(wspd, own):
    outcome = wspd("verify", f"{own.name}:ready", "--only", "gain_positive")
    assert (outcome.code, outcome.err) == (0, "")
    assert outcome.out.startswith("any options on polach-wet")


def test_a_file_beside_it_can_be_imported(wspd, own, tmp_path):
    (tmp_path / "helper_of_own.py").write_text("SLIP = 0.2\n")
    own.write_text("from helper_of_own import SLIP\n" + own.read_text())
    assert wspd("simulate", f"{own.name}:ready", "--speed", "20 km/h").code == 0


@pytest.mark.parametrize("fault", FAULTS)
def test_one_sentence_about_a_fault(fault, wspd, own):
    (before, after), words = FAULTS[fault]
    assert before in SOUND
    own.write_text(SOUND.replace("\nready = any_options()\n", "\n").replace(before, after, 1))
    outcome = wspd("simulate", f"{own.name}:Threshold", *FAR)
    *notices, sentence = outcome.err.splitlines()
    assert outcome.code == 2
    assert outcome.out == ""
    assert words in sentence
    assert sentence.startswith("wspd: ")
    assert all("cannot be traced" in notice for notice in notices)
    assert "Traceback" not in outcome.err


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("own.py:Treshold", 'no "Treshold"; it defines Threshold'),
        ("own.py", "own.py:NAME"),
        ("missing.py:Threshold", "check the path"),
        ("own.py:by_name", "lacks"),
        ("own.py:dataclass", "does not make a controller"),
        ("own.py:__name__", "neither a controller nor"),
    ],
)
@pytest.mark.usefixtures("own")
def test_one_sentence_about_a_name(name, words, wspd):
    outcome = wspd("simulate", name)
    assert (outcome.code, outcome.out) == (2, "")
    assert words in outcome.err
    assert outcome.err.count("\n") == 1


@pytest.fixture
def whole(tmp_path):
    path = tmp_path / "whole.py"
    path.write_text(WHOLE)
    return path


def test_a_law_of_a_whole_vehicle(wspd, whole):
    found = json.loads(wspd("simulate", f"{whole.name}:Fastest", *FAR, "--json").out)
    assert found["ending"] == "stopped"
    assert found["engine"] == "compiled"
    assert found["speed_error"] > 0.0
    assert found["distance_error"] > 0.0
    assert found["slip_band"] is None


def test_sensors_of_ones_own_law(wspd, own, whole):
    """A law of one wheelset can be given another train speed; one of the vehicle works out its own."""
    plain, seeing = (
        json.loads(wspd("simulate", f"{own.name}:Threshold", *FAR, *options, "--json").out)
        for options in ((), ("--speed-source", "fastest-axle"))
    )
    assert plain["speed_error"] is None
    assert seeing["speed_error"] > 0.0
    for name, options in (
        (f"{whole.name}:Fastest", ("--speed-source", "told")),
        (f"{own.name}:Threshold", ("--reference", "falling")),
    ):
        outcome = wspd("simulate", name, *FAR, *options)
        assert outcome.code == 2
        assert "has its own sensors and reference" in outcome.err


@pytest.mark.parametrize("fault", FAULTS_OF_WHOLE)
def test_what_is_no_law_of_a_vehicle(fault, wspd, whole):
    (old, new), said = FAULTS_OF_WHOLE[fault]
    assert old in WHOLE
    whole.write_text(WHOLE.replace(old, new))
    outcome = wspd("simulate", f"{whole.name}:Fastest", *FAR)
    assert (outcome.code, outcome.out) == (2, "")
    assert said in outcome.err


def test_wheelsets_of_another_vehicle_are_refused(wspd, whole):
    whole.write_text(WHOLE + "\nmade = Fastest(vehicle=None, wheelsets=2)\n")
    outcome = wspd("simulate", f"{whole.name}:made", *FAR)
    assert outcome.code == 2
    assert "wheelsets = 2" in outcome.err
    assert "must be 4, as vehicle er24pc has" in outcome.err
