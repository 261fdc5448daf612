"""The calibrated numbers are the fixed point of the committed search; a number that is moved is found again."""

import pytest

from wspd_design.parameters import loading
from wspd_design.parameters.files import data_file
from wspd_design.studies import calibration
from wspd_design.studies.calibration import FITTED, STEP, better_neighbour, calibrate, objective, shipped

CASE = shipped()
NAMES = [f"{number.file}.{number.entry}" for number in FITTED]


def test_calibrated_are_exactly_the_numbers_that_are_fitted():
    stated = {
        f"{path.stem}.{name}"
        for path in data_file().rglob("*.toml")
        if path.parent.name in ("vehicles", "rails", "controllers")
        for name, entry in loading.load_entries(path.parent.name[:-1], path.stem).entries.items()
        if (entry.status, entry.source) == ("calibrated", "team-calibration")
    }
    assert stated == set(NAMES)


@pytest.mark.parametrize("number", FITTED, ids=NAMES)
def test_shipped_number_is_a_fixed_point(number):
    assert better_neighbour(CASE, number) is None
    assert objective(CASE, number) < 0.01


@pytest.mark.parametrize(
    ("number", "steps"), [(FITTED[1], 2), (FITTED[3], -2)], ids=["table10-dry.mu0", "mitsubishi.duty_offset"]
)
def test_moved_number_is_found_again(number, steps):
    value = number.read(CASE)
    moved = number.write(CASE, value * STEP**steps)
    assert better_neighbour(moved, number) is not None
    assert number.read(calibrate(moved, [number])) == pytest.approx(value, rel=1e-12)


def test_search_that_never_rests_ends(monkeypatch):
    monkeypatch.setattr(calibration, "better_neighbour", lambda case, _: case)
    with pytest.raises(RuntimeError, match="still moves after 50 passes"):
        calibrate(CASE, FITTED[:1])
