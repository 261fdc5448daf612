"""Pads, electrodynamic brake and track brake of a vehicle file: what is read, and what is refused in one sentence."""

import re
from pathlib import Path

import pytest

from wspd_design.parameters import loading
from wspd_design.parameters.brake_checks import SPEED_ROUNDING, TEMPERATURE_ROUNDING
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.schema import schema_of

BASE = 'base = "er24pc-service"\n'
PADS = """
[pads.speeds]
value = [0, 80, 160]
unit = "km/h"
[pads.speed_factors]
value = [1.0, 0.9, 0.8]
unit = "-"
"""
WARM = """
[pads.kind]
value = "tread"
[pads.temperatures]
value = [0, 200]
unit = "K"
[pads.temperature_factors]
value = [100, 80]
unit = "%"
"""
CAPACITY = '[pads.heat_capacity]\nvalue = 120\nunit = "kJ/K"\n'
DYNAMIC = """
[dynamic.torque]
value = 8
unit = "kN m"
[dynamic.power]
value = 300
unit = "kW"
[dynamic.build_up_time]
value = 0.5
unit = "s"
[dynamic.fade_speed]
value = 10
unit = "km/h"
[dynamic.cut_out_speed]
value = 4
unit = "km/h"
"""
MAGNETS = '[track_brake.force]\nvalue = 40\nunit = "kN"\n'
CUT_OUT = '[track_brake.cut_out_speed]\nvalue = {speed}\nunit = "km/h"\n'


@pytest.fixture
def load(tmp_path):
    def loaded(text):
        path = tmp_path / "mine.toml"
        path.write_text(BASE + text)
        return loading.load_vehicle(path)

    return loaded


def test_what_a_file_leaves_out_is_not_there(load):
    vehicle = load("")
    assert (vehicle.pads, vehicle.dynamic, vehicle.track_brake) == (None, None, None)


def test_all_of_them(load):
    vehicle = load(PADS + WARM + CAPACITY + DYNAMIC + MAGNETS + CUT_OUT.format(speed=50))
    assert vehicle.pads.kind == "tread"
    assert vehicle.pads.speeds == pytest.approx((0.0, 80 / 3.6, 160 / 3.6))
    assert vehicle.pads.temperature_factors == pytest.approx((1.0, 0.8))
    assert vehicle.pads.heat_capacity == 120e3
    assert (vehicle.dynamic.torque, vehicle.dynamic.power) == (8e3, 300e3)
    assert vehicle.dynamic.drop_slip == 1.0  # never
    assert vehicle.track_brake.force == 40e3
    assert vehicle.track_brake.cut_out_speed == pytest.approx(50 / 3.6)


def test_bounds_belong_to_their_part(load):
    vehicle = load(MAGNETS + "bounds = [30, 50]\n")
    assert vehicle.track_brake.bounds == {"force": (30e3, 50e3)}
    assert "force" not in vehicle.bounds


LONG = ", ".join(str(10 * k) for k in range(9))
WRONG = {
    "factors of other number": (
        PADS.replace("[1.0, 0.9, 0.8]", "[1.0, 0.9]"),
        r"\[pads.speeds\] and \[pads.speed_factors\] .* have 3 and 2 numbers",
    ),
    "speeds without factors": (PADS.partition("[pads.speed_factors]")[0], "have 3 and 0 numbers"),
    "speeds that do not rise": (PADS.replace("80, 160", "160, 80"), r"must rise; put them in order"),
    "a single speed": (
        PADS.replace("[0, 80, 160]", "[0]").replace("[1.0, 0.9, 0.8]", "[1]"),
        "has 1 numbers; give 2 to 8",
    ),
    "too many": (
        PADS.replace("0, 80, 160", LONG).replace("1.0, 0.9, 0.8", ", ".join("1" * 9)),
        "has 9 numbers; give 2 to 8",
    ),
    "no friction": (PADS.replace("0.8", "0"), r"pads.speed_factors.*must be above 0"),
    "temperatures without heat capacity": (WARM, r"lacks \[pads.heat_capacity\]"),
    "another word": (WARM.replace('"tread"', '"drum"'), r'must be one of "disc", "tread"'),
    "half of a brake": (
        DYNAMIC.partition("[dynamic.fade_speed]")[0],
        r"has \[dynamic.build_up_time\] but lacks \[dynamic.fade_speed\], \[dynamic.cut_out_speed\]",
    ),
    "fading upwards": (
        DYNAMIC.replace("value = 10", "value = 3"),
        "fade_speed .* must be above dynamic.cut_out",
    ),
    "torque at standstill": (
        DYNAMIC.replace("value = 4", "value = 1"),
        "dynamic.cut_out_speed .* at least 0.5 m/s",
    ),
    "magnets lifted at standstill": (
        MAGNETS + CUT_OUT.format(speed=2),
        "track_brake.cut_out_speed .* at least 1 m/s; raise it, or leave it out",
    ),
    "shares of other axles": (
        DYNAMIC + '[dynamic.axle_shares]\nvalue = [1, 1]\nunit = "-"\n',
        "dynamic.axle_shares .* must have 4 numbers, one for each wheelset, .* but has 2",
    ),
    "unit slip": (MAGNETS.replace('"kN"', '"N"'), "did you mean 40 kN?"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_ones_are_refused(load, case):
    text, sentence = WRONG[case]
    with pytest.raises(UserError, match=sentence) as caught:
        load(text)
    assert "mine" in str(caught.value)
    assert "\n" not in str(caught.value)


PAGE = (Path(__file__).parents[3] / "docs" / "further-brakes.md").read_text()


def test_the_files_of_the_page_are_read(load):
    blocks = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    assert len(blocks) == 3
    vehicle = load("".join(blocks))
    assert vehicle.pads.cooling == 60.0
    assert vehicle.dynamic.drop_slip == 0.2
    assert vehicle.track_brake.speed_factors == (1.2, 1.0, 0.8)
    named = {
        f"[{name}]"
        for name in schema_of("vehicle", "")
        if name.startswith(("pads.", "dynamic.", "track_brake."))
    }
    assert named == {name for name in named if name in PAGE}  # every entry stands on the page


def test_the_page_names_the_widths_of_the_rounding():
    assert f"within {SPEED_ROUNDING:g} m/s ({TEMPERATURE_ROUNDING:g} K for temperatures" in PAGE
