"""Brakes in vehicle files: what may be left out, what belongs together, and the example of the page."""

import re
from pathlib import Path

import pytest

from wspd_design.design.records import vehicle_hash
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_vehicle
from wspd_design.parameters.schema import schema_of

PAGE = (Path(__file__).parents[3] / "docs" / "brakes.md").read_text(encoding="utf-8")


@pytest.fixture
def write(tmp_path):
    """Write a vehicle with other brake entries than the ER24PC."""

    def make(**entries):
        text = 'base = "er24pc"\n'
        for name, value in entries.items():
            number, unit = value if isinstance(value, tuple) else (f'"{value}"', "-")
            text += f'[brake.{name}]\nvalue = {number}\nunit = "{unit}"\n'
        path = tmp_path / "mine.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return make


def test_the_example_of_the_page(tmp_path):
    (example,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    path = tmp_path / "coach.toml"
    path.write_text(example, encoding="utf-8")
    brake = load_vehicle(path).brake
    assert (brake.build_up, brake.valve) == ("electro-pneumatic", "orifice")
    assert (brake.build_up_delay, brake.build_up_ramp, brake.dead_time) == (0.2, 1.5, pytest.approx(0.03))
    assert (brake.cylinder_volume, brake.reservoir_volume) == (pytest.approx(0.012), pytest.approx(0.15))
    assert brake.supply_pressure == 8e5


def test_the_table_of_the_page_names_entries_of_vehicle_files():
    rows = re.findall(r"^\| ((?:`[a-z_]+`(?:, )?)+) \|", PAGE, re.MULTILINE)
    named = [name for row in rows for name in re.findall(r"`([a-z_]+)`", row)]
    assert len(named) == len(set(named)) == 16
    assert {f"brake.{name}" for name in named} < set(schema_of("vehicle", ""))


def test_what_is_left_out_is_not_there(er24pc, write):
    brake = er24pc.brake
    assert (brake.build_up, brake.valve, brake.supply_pressure) == ("main-pipe", "lag", brake.max_pressure)
    zero = (
        "hold_leak",
        "dead_time",
        "shortest_pulse",
        "longest_release",
        "cylinder_volume",
        "reservoir_volume",
    )
    assert {getattr(brake, name) for name in zero} == {0.0}
    assert vehicle_hash(load_vehicle(write(dead_time=("0.03", "s")))) != vehicle_hash(er24pc)


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ({"build_up": "electro-pneumatic"}, r"brake\.build_up_ramp is missing .* add it"),
        ({"build_up": "elektro"}, r'did you mean "electro-pneumatic"'),
        (
            {"build_up_ramp": ("1", "s")},
            r'build_up_ramp .* means nothing to a brake whose brake\.build_up is "main-pipe"',
        ),
        ({"critical_pressure_ratio": ("0.4", "-")}, r'means nothing .* brake\.valve is "lag"; remove it'),
        ({"reservoir_pressure": ("5", "bar")}, r"reservoir_pressure = 5 bar .* must not be below .* 6 bar"),
        ({"reservoir_volume": ("100", "l")}, r"cylinder_volume is missing"),
        (
            {"reservoir_volume": ("30", "l"), "cylinder_volume": ("10", "l")},
            r"reservoir_volume = 30 l .* must not be below the 40 l of its 4 x brake\.cylinder_volume",
        ),
        ({"cylinder_volume": ("12", "m^3")}, r"did you mean 12 l\?"),
        ({"dead_time": ("60", "s")}, r"did you mean 60 ms\?"),
        ({"supply_rate": ("2", "1/s"), "fill_time": ("0.5", "s")}, r"singular"),
    ],
)
def test_brakes_that_contradict_themselves(write, entries, said):
    with pytest.raises(UserError, match=said):
        load_vehicle(write(**entries))


def test_an_orifice_has_no_singular_filling(write):
    entries = {"valve": "orifice", "supply_rate": ("2", "1/s"), "fill_time": ("0.5", "s")}
    assert load_vehicle(write(**entries)).brake.valve == "orifice"
