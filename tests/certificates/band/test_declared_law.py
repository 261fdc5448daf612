"""Laws of users that declare their numbers: the one of the page is the declared one, and no other passes for it."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

import wspd_design as wd
from tests.certificates.band.conftest import LOCO
from wspd_design.certificates.theorems.band import SLIP_BAND
from wspd_design.certificates.theorems.slip_band.departure import corners, lock
from wspd_design.certificates.theorems.slip_band.statement import law_of
from wspd_design.certificates.theorems.way_in import SLIP_WAY_IN
from wspd_design.design.own_controller import load_controller
from wspd_design.design.problem import stability_problem

PAGE = (Path(__file__).parents[3] / "docs" / "own-controller.md").read_text()
(LAW,) = (
    text for text in re.findall(r"^```python\n(.*?)^```$", PAGE, re.M | re.S) if "observer_form" in text
)
LOW = wd.load_rail("low-adhesion")
FILLED = "Command(fill=fill, vent=vent)"
ROUNDED = "but for rounding"

# What is wrong -> (text in place of another, what the sentence says)
FAULTS = {
    "sign": (("+ self.pull * error", "- self.pull * error"), "for the share of filling"),
    "gain": (("approach_rate=self.pull", "approach_rate=0.9 * self.pull"), "for the share of filling"),
    "prediction": (("ahead=self.ahead", "ahead=0.4"), "for the share of filling"),
    "observer": (("forget * forget * surprise", "forget * surprise"), "for the observed speed of wheelset 1"),
    "friction": (
        ("(1.0 - forget) * (1.0 - forget)", "0.2 * (1.0 - forget)"),
        "for the observed friction torque of wheelset 1",
    ),
    "filter": (("keep = exp(-h / self.smoothing)", "keep = 0.9"), "for the acceleration of the train"),
    "valve": (
        ("clip(self.share * brake.fill_time", "clip(0.5 * brake.fill_time"),
        "for the share of filling",
    ),
    "mean": (("* end * vented\n", "* end\n"), "for the mean torque of wheelset"),
    "one wheelset": (
        (
            "commands.append(",
            "fill = fill if len(commands) != 2 else 0.9 * fill\n            commands.append(",
        ),
        "for the share of filling of wheelset 3",
    ),
    "coupled wheelsets": (
        (FILLED, "Command(fill=where(seen.pressures[0] > pressure, 0.9 * fill, fill), vent=vent)"),
        "share of filling",
    ),
    "rare branch": (
        (FILLED, "Command(fill=where(abs(error - 0.0123) < 1e-9, 1.0, fill), vent=vent)"),
        ROUNDED,
    ),
    "branch over speed": ((FILLED, "Command(fill=where(speed > 33.2, 0.0, fill), vent=vent)"), ROUNDED),
    "holds inside the range": ((FILLED, "Command(fill=where(speed < 3.0, 0.0, fill), vent=vent)"), ROUNDED),
    "no scale": (
        ("scale * seen.speed, 0.0)", "seen.speed, 0.0)"),
        "train speed, and the law that it declares",
    ),
    "worn wheels": (("0.9, 1.1)", "0.95, 1.05)"), "for the scale of the train speed"),
    "rounded before": (("forget = exp(-h * self.observer)", "forget = 0.5488116360940264"), ROUNDED),
    "fails": (("def observed(self, state: State)", "def observed(self, wrong: State)"), "NameError"),
    "other vehicle": (("full_pressure=brake.max_pressure", "full_pressure=3e5"), "another vehicle"),
    "negative drift": (("time_share=self.share", "time_share=self.share, slip_drift=-0.1"), "cannot be"),
}

# Laws that are the declared one where it counts
SAME = {
    "as it is": ("", ""),
    "other arithmetic": ("(tau - turning + self.pull * error) *", "(self.pull * error + (tau - turning)) *"),
    "holds below the range": (
        FILLED,
        "Command(fill=where(speed < 1.0, 0.0, fill), vent=where(speed < 1.0, 0.0, vent))",
    ),
    "lost sensors": (FILLED, "Command(fill=where(seen.healthy[0] > 0.5, fill, 0.0), vent=vent)"),
    "inverse logarithm": ("log(room / left)", "-log(left / room)"),
}


def problem_with(tmp_path, change=("", ""), *, slip=0.14):
    old, new = change
    assert old in LAW
    text = LAW.replace(old, new, 1) if old else LAW
    path = tmp_path / "own_band_law.py"
    path.write_text(text.replace("Number, clip, exp", "Number, clip, where, exp"))
    law = load_controller(f"{path}:Pull", vehicle=LOCO, rail=LOW, slip=slip)
    return stability_problem(LOCO, LOW, law, wd.Specification(slip=slip, speeds=(10.0 / 3.6, 120.0 / 3.6)))


@pytest.mark.parametrize("change", SAME)
def test_law_that_is_the_declared_one(change, tmp_path):
    problem = problem_with(tmp_path, SAME[change])
    assert SLIP_BAND.speaks_about(problem) == ""
    assert "no code but its own" in SLIP_WAY_IN.speaks_about(problem)


@pytest.mark.parametrize("fault", FAULTS)
def test_law_that_is_another_one_is_refused_in_one_sentence(fault, tmp_path):
    change, said = FAULTS[fault]
    reason = SLIP_BAND.speaks_about(problem_with(tmp_path, change))
    assert said in reason
    assert "\n" not in reason


def test_falling_slip_of_ones_own(tmp_path):
    """Declared as falling, and held so, with the rate of the reference that belongs to it."""
    falls = LAW.replace("slip=self.slip,", "slip=self.slip,\n            falls=True,").replace(
        "reference = (1.0 - self.slip) * speed",
        "slip = self.slip / sqrt(speed)\n        reference = (1.0 - slip) * speed",
    )
    right = falls.replace("turning = (1.0 - self.slip)", "turning = (1.0 - 0.5 * slip)")
    reasons = []
    for text in (right, falls):
        path = tmp_path / "own_band_law.py"
        path.write_text(text.replace("Number, clip, exp", "Number, clip, sqrt, exp"))
        law = load_controller(f"{path}:Pull", vehicle=LOCO, rail=LOW, slip=0.16)
        specification = wd.Specification(slip=0.16, speeds=(10.0 / 3.6, 120.0 / 3.6))
        reasons.append(SLIP_BAND.speaks_about(stability_problem(LOCO, LOW, law, specification)))
    assert reasons[0] == ""
    assert "for the share of filling" in reasons[1]


def test_other_slip_than_asked_for_and_laws_without_a_form(tmp_path):
    problem = problem_with(tmp_path)
    assert "holds slip 0.14" in SLIP_BAND.speaks_about(replace(problem, slip=0.15))
    page = re.findall(r"^```python\n(.*?)^```$", PAGE, re.M | re.S)[1]
    (tmp_path / "own_band_law.py").write_text(page)
    other = load_controller(f"{tmp_path / 'own_band_law.py'}:FastestWheelset", vehicle=LOCO, rail=LOW)
    assert "observer_form" in SLIP_BAND.speaks_about(replace(problem, controller=other))


def test_numbers_are_those_that_are_declared_and_no_stop_stands_in_for_the_law(tmp_path):
    problem = problem_with(tmp_path)
    numbers = law_of(problem.controller)
    assert (float(numbers.slip), float(numbers.approach_rate), numbers.torque_slew) == (0.14, 8.0, None)
    assert float(numbers.fill_time) == pytest.approx(0.6 * LOCO.brake.fill_time)
    assert lock(problem, {**next(corners(problem)), "speed": 20.0}) == {}
