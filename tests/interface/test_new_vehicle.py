"""``wspd new vehicle`` and ``wspd new rail``: answers by keys and by options, and what the files are."""

from contextlib import contextmanager

import pytest
from prompt_toolkit.application import create_app_session
from prompt_toolkit.input import create_pipe_input
from prompt_toolkit.output import DummyOutput

from wspd_design.analysis.stopping import full_adhesion_stop
from wspd_design.cli.wizard import session
from wspd_design.cli.wizard.vehicle_steps import vehicle_steps
from wspd_design.parameters.files import read_toml
from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle

ENTER, DOWN, UP, BACK, LEAVE, ERASE = "\r", "\x1b[B", "\x1b[A", "\x02", "\x03", "\x15"
QUESTIONS = len(vehicle_steps())

# A suburban car, as options and as keys.
CAR = {
    "--kind": "metro",
    "--mass": "40 t",
    "--laden-mass": "60 t",
    "--weighs": "no",
    "--axles": "4",
    "--bogie-spacing": "14 m",
    "--wheelbase": "2.2 m",
    "--wheel-diameter": "840 mm",
    "--rotating-mass": "10 %",
    "--speed": "100 km/h",
    "--deceleration": "1 m/s^2",
    "--build-up": "electro-pneumatic",
    "--build-up-delay": "200 ms",
    "--build-up-time": "1,2 s",
    "--fill-time": "0.3 s",
    "--vent-time": "100 ms",
}


@pytest.fixture
def answer(wspd, monkeypatch):
    """Start a wizard and send keys; returns the outcome of the command."""
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


def options_of(answers):
    return [word for pair in answers.items() for word in pair]


def test_all_answers_as_options_need_no_terminal(wspd, tmp_path):
    outcome = wspd("new", "vehicle", "car.toml", *options_of(CAR))
    assert (outcome.code, outcome.err) == (0, "")
    car, entries = load_vehicle("car.toml"), load_entries("vehicle", "car.toml").entries
    assert (car.mass, car.wheelsets, car.wheel_radius, car.bogie_spacing) == (40e3, 4, 0.42, 14.0)
    assert (car.brake.fill_time, car.brake.vent_time) == (0.3, 0.1)
    assert (car.brake.build_up_delay, car.brake.build_up_ramp) == (0.2, 1.2)
    assert 4 * car.wheelset_inertia / 0.42**2 == pytest.approx(4e3, rel=1e-3)
    assert full_adhesion_stop(car, 100 / 3.6).deceleration == pytest.approx(1.0, rel=1e-3)
    laden = load_vehicle("car.toml:laden")
    assert (laden.mass, laden.brake.max_torque) == (60e3, car.brake.max_torque)
    assert not any(entry.inherited for entry in entries.values())
    assert entries["mass"].source == "own answer"
    assert entries["brake.max_torque"].status == "derived"
    assert entries["body_height"].source == "vehicle metro"
    assert "EN 14531 backwards: 1 m/s2 from 100 km/h" in " ".join(outcome.out.split())
    assert [path.name for path in tmp_path.iterdir()] == ["car.toml"]


def test_the_same_answers_by_keys_give_the_same_file(answer, wspd, tmp_path):
    wspd("new", "vehicle", "a.toml", *options_of(CAR))
    lines = [
        f"{ERASE}{text}{ENTER}"
        for flag, text in CAR.items()
        if flag not in ("--kind", "--weighs", "--build-up")
    ]
    keys = DOWN * 3 + ENTER + lines[0] + lines[1] + DOWN + ENTER + "".join(lines[2:9]) + ENTER
    keys += "".join(lines[9:]) + ENTER
    outcome = answer(keys, "new", "vehicle", "b.toml")
    assert (outcome.code, outcome.err) == (0, "")
    a, b = (read_toml(tmp_path / name, name) for name in ("a.toml", "b.toml"))
    assert a == b


@pytest.mark.parametrize(
    "kind", ["co-co", "coach", "er24pc-service", "freight-wagon", "metro", "two-axle-wagon"]
)
def test_a_vehicle_like_each_kind(wspd, kind):
    """Not one number is asked, and none is said to be an answer; the heavier one keeps the deceleration."""
    assert wspd("new", "vehicle", "plain.toml", "--yes", "--kind", kind).code == 0
    assert "own answer" not in {
        entry.source for entry in load_entries("vehicle", "plain.toml").entries.values()
    }
    mass = load_vehicle(kind).mass * 1.1
    assert wspd("new", "vehicle", "mine.toml", "--yes", "--kind", kind, "--mass", f"{mass:.0f} kg").code == 0
    plain, mine = load_vehicle("plain.toml"), load_vehicle("mine.toml")
    assert mine.brake.max_torque > plain.brake.max_torque
    speed = 120 / 3.6
    assert full_adhesion_stop(mine, speed).deceleration == pytest.approx(
        full_adhesion_stop(plain, speed).deceleration, rel=0.01
    )
    assert wspd("design", "--vehicle", "mine.toml", "--rail", "very-low", "-o", "d.toml").code == 0
    assert wspd("simulate", "d.toml", "--speed", "30 km/h").code == 0
    assert wspd("sources", "mine.toml").code == 0


@pytest.mark.parametrize(
    ("flag", "text", "fragments"),
    [
        ("--kind", "coch", ("kind", "one of co-co, coach")),
        ("--mass", "45", ("mass", "no unit", "45")),
        ("--mass", "45 kg", ("did you mean 45 t?",)),
        ("--laden-mass", "30 t", ("laden_mass", "above the empty mass of 40000 kg", "none")),
        ("--weighs", "maybe", ("weighs", "yes, no")),
        ("--axles", "5", ("multiple of 2", "metro")),
        ("--axles", "2", ("one bogie",)),
        ("--axles", "four", ("whole number",)),
        ("--wheel-diameter", "920 m", ("did you mean 920 mm?",)),
        ("--rotating-mass", "90 %", ("rotating_mass", "0.005 to 0.5")),
        ("--deceleration", "12 m/s^2", ("deceleration", "0.1 to 5")),
        ("--deceleration", "0.001 m/s^2", ("deceleration",)),
        ("--build-up", "wire", ("build_up", "main-pipe, electro-pneumatic")),
        ("--build-up-delay", "20 s", ("build_up_delay", "0 to 10")),
        ("--fill-time", "0.3", ("fill_time", "no unit")),
        ("--wheelbase", "20 m", ("wheelbase",)),
    ],
)
def test_a_wrong_answer_is_one_sentence_and_no_file(wspd, tmp_path, flag, text, fragments):
    outcome = wspd("new", "vehicle", "car.toml", *options_of(CAR | {flag: text}))
    assert outcome.code == 2
    assert outcome.err.count("\n") == 1
    for fragment in fragments:
        assert fragment in outcome.err
    assert list(tmp_path.iterdir()) == []


def test_a_speed_at_which_the_resistance_alone_brakes_more(wspd, tmp_path):
    slow = {"--deceleration": "0.1 m/s^2", "--speed": "500 km/h"}
    outcome = wspd("new", "vehicle", "car.toml", *options_of(CAR | slow))
    assert outcome.code == 2
    assert "needs no brake" in outcome.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("what", ["vehicle", "rail"])
def test_without_a_terminal(wspd, tmp_path, what):
    outcome = wspd("new", what, "--speed", "80 km/h")
    assert outcome.code == 2
    assert "needs a terminal" in outcome.err
    assert "--yes" in outcome.err
    (tmp_path / f"{what}.toml").write_text("mine")
    assert "--force" in wspd("new", what, "--yes").err
    assert (tmp_path / f"{what}.toml").read_text() == "mine"
    assert wspd("new", what, "--yes", "--force").code == 0
    assert "must end in .toml" in wspd("new", what, "mine.txt", "--yes").err


def test_options_of_a_design_are_none_of_a_vehicle(wspd):
    outcome = wspd("new", "--force", "vehicle")
    assert outcome.code == 2
    assert "wspd new vehicle --help" in outcome.err


def test_leaving_back_and_resume(answer, tmp_path):
    left = answer(f"{ENTER}{ERASE}50 t{ENTER}{ENTER}{ENTER}{LEAVE}", "new", "vehicle", "car.toml")
    assert left.code == 130
    assert "wspd new vehicle --resume car.toml.part" in left.out
    assert [path.name for path in tmp_path.iterdir()] == ["car.toml.part"]
    keys = f"{BACK * 3}{ERASE}51 t{ENTER * (QUESTIONS - 2)}"
    resumed = answer(keys, "new", "vehicle", "--resume", "car.toml.part")
    assert resumed.code == 0
    assert load_vehicle("car.toml").mass == 51e3
    assert [path.name for path in tmp_path.iterdir()] == ["car.toml"]


def test_another_kind_after_going_back_is_asked_for_its_own(answer):
    """Single axles have no wheelbase, which is then not asked for."""
    keys = f"{ENTER}{BACK}{DOWN * 4}{ENTER}{ENTER * (QUESTIONS - 3)}"
    assert answer(keys, "new", "vehicle", "wagon.toml").code == 0
    wagon = load_vehicle("wagon.toml")
    assert (wagon.axles_per_bogie, wagon.wheelsets) == (1, 2)


def test_line_by_line(wspd, monkeypatch):
    lines = iter(["metro", "40", "40 t", "<", "41 t", *[""] * QUESTIONS])
    monkeypatch.setattr(session, "is_interactive", lambda: True)
    monkeypatch.setattr("builtins.input", lambda _prompt: next(lines))
    monkeypatch.setenv("TERM", "dumb")
    outcome = wspd("new", "vehicle", "car.toml")
    assert (outcome.code, outcome.err) == (0, "")
    assert "\x1b" not in outcome.out
    assert "has no unit" in " ".join(outcome.out.split())
    assert load_vehicle("car.toml").mass == 41e3


def test_a_rail_by_its_peak(wspd):
    outcome = wspd(
        "new", "rail", "leaf.toml", "--yes", "--peak", "3 %", "--vehicle", "metro", "--speed", "80 km/h"
    )
    assert outcome.code == 0
    import numpy as np

    from wspd_design.simulation.peak import peak_adhesion

    _, peak = peak_adhesion(load_vehicle("metro"), load_rail("leaf.toml"), np.array([80 / 3.6]))
    assert peak[0] == pytest.approx(0.03, rel=1e-3)
    entries = load_entries("rail", "leaf.toml").entries
    assert (entries["mu0"].status, entries["slip_reduction"].source) == ("derived", "rail low-adhesion")
    assert (
        wspd("simulate", "none", "--vehicle", "metro", "--rail", "leaf.toml", "--speed", "20 km/h").code == 0
    )


@pytest.mark.parametrize(
    ("content", "fragment"),
    [
        ("0.1,0.2\n", "has 1 points"),
        ("slip,mu\n" + "0.1;0.2\n", "has 1 points"),
        ("slip,mu\n0.1,x\n", "line 2"),
        ("slip,mu\n10,0.2\n", "divide percent by 100"),
        ("slip,mu\n0.1\n", "must be a slip and an adhesion"),
        (None, "cannot be read"),
    ],
)
def test_a_wrong_curve(wspd, tmp_path, content, fragment):
    if content is not None:
        (tmp_path / "curve.csv").write_text(content)
    outcome = wspd("new", "rail", "leaf.toml", "--yes", "--curve", "curve.csv")
    assert outcome.code == 2
    assert fragment in outcome.err
    assert not (tmp_path / "leaf.toml").exists()


def test_a_rail_by_a_curve_tells_its_misfit(wspd, tmp_path):
    """Points of the shipped wet rail under the coach give its numbers back."""
    from wspd_design.model.adhesion import contact_stiffness, creep_force
    from wspd_design.model.slip import static_wheel_load

    coach, wet = load_vehicle("coach"), load_rail("polach-wet")
    load = float(static_wheel_load(coach))
    stiffness = contact_stiffness(coach.contact, load)
    rows = [
        f"{slip};{creep_force(slip, 20.0 * slip, load, wet, stiffness) / load}".replace(".", ",")
        for slip in (0.002, 0.005, 0.01, 0.02, 0.04, 0.08, 0.15, 0.3, 0.6)
    ]
    (tmp_path / "curve.csv").write_text("Schlupf;Kraftschluss\n" + "\n".join(rows))
    outcome = wspd("new", "rail", "wet.toml", "--yes", "--curve", "curve.csv", "--speed", "20 m/s")
    assert outcome.code == 0
    assert "over 9 points" in outcome.out
    found = load_rail("wet.toml")
    for name in ("mu0", "friction_ratio", "friction_decay", "adhesion_reduction", "slip_reduction"):
        assert getattr(found, name) == pytest.approx(getattr(wet, name), rel=2e-3)
