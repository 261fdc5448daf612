"""Figures and words about vehicles with other numbers of axles than four."""

from dataclasses import replace

import pytest

from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_entries, load_rail
from wspd_design.reporting.figure_style import SERIES
from wspd_design.reporting.figures.drawing import look, picture
from wspd_design.reporting.figures.phase import phase_alt
from wspd_design.reporting.figures.stop import TRAIN, line_of, named, stop_traces
from wspd_design.reporting.running_gear import alike_note, running_gear
from wspd_design.simulation.comparison import compare
from wspd_design.simulation.records import Scenario


def test_no_two_of_32_wheelsets_look_alike_and_none_like_the_train():
    looks = [look(line_of(wheelset)) for wheelset in range(32)]
    assert len(set(looks)) == 32
    assert SERIES[TRAIN] not in {color for color, _ in looks}
    assert [color for color, _ in looks[:TRAIN]] == list(SERIES[:TRAIN])


@pytest.mark.parametrize("wheelsets", range(1, 33))
def test_a_legend_names_the_first_and_the_last_and_as_many_as_fit(wheelsets):
    found = named(wheelsets)
    assert found[0] == 0
    assert found[-1] == wheelsets - 1
    assert len(found) <= 8
    assert wheelsets > 8 or len(found) == wheelsets


@pytest.mark.parametrize("axles", [6, 12])
def test_the_traces_of_a_long_vehicle_with_an_axle_that_does_not_brake(er24pc, make_controller, axles):
    shares = (0.0, *(1.0,) * (axles - 1))
    mass = er24pc.mass * axles / 4
    vehicle = replace(
        er24pc,
        wheelsets=axles,
        mass=mass,
        body_mass=mass - axles // 2 * er24pc.bogie_mass,
        brake=replace(er24pc.brake, axle_shares=shares),
    )
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=8.0)
    (own,) = compare(vehicle, [make_controller("trenitalia")], scenario, slip_reference=0.14)
    assert own.run.first_braked == 1
    assert own.run.samples == own.run.axle_samples[1] != ()

    def draw(figure):
        return stop_traces(
            figure,
            own,
            Specification(),
            wheel_radius=vehicle.wheel_radius,
            max_torque=vehicle.brake.max_torque,
        )

    text = picture(draw, height=8.6)
    assert f">{axles} (rear)<" in text
    assert ">wheelset 1 (front)<" in text
    assert "Phase plane: torque from" in phase_alt(own.run, None)
    assert "to 0 kN m" not in phase_alt(own.run, None)


GEARS = {
    "": "4 axles, two-axle bogies",
    '[wheelsets]\nvalue = 6\nunit = "-"\n[axles_per_bogie]\nvalue = 3\nunit = "-"': "6 axles, three-axle bogies",
    '[wheelsets]\nvalue = 2\nunit = "-"\n[axles_per_bogie]\nvalue = 1\nunit = "-"': "2 single axles",
    '[wheelsets]\nvalue = 6\nunit = "-"\n[bodies]\nvalue = 2\nunit = "-"': "6 axles, two-axle "
    "bogies shared by 2 bodies",
    '[brake.axle_shares]\nvalue = [1, 0, 1, 0.5]\nunit = "-"': "4 axles, two-axle bogies; braking torque of the axles "
    "from the front: 1, 0, 1 and 0.5 of the largest",
}


@pytest.mark.parametrize("text", GEARS)
def test_the_running_gear_in_words(tmp_path, text):
    path = tmp_path / "own.toml"
    path.write_text(f'base = "er24pc"\n{text}')
    assert running_gear(load_entries("vehicle", path)) == GEARS[text]


def test_a_linearization_says_where_wheelsets_are_not_alike(tmp_path):
    notes = {}
    for text in GEARS:
        path = tmp_path / "own.toml"
        path.write_text(f'base = "er24pc"\n{text}')
        notes[GEARS[text]] = alike_note(load_entries("vehicle", path))
    assert [bool(note) for note in notes.values()] == [False, False, False, True, True]
    assert "own are not" in notes["6 axles, two-axle bogies shared by 2 bodies"]
