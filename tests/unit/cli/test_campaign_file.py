"""The file of a campaign: what it says becomes records, and every number of a stop can be drawn in it."""

import pytest

from wspd_design.cli.campaign_file import read_campaign
from wspd_design.design.draw_table import STOP_DIMENSIONS
from wspd_design.design.file import design_text
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
from wspd_design.parameters.units import units_of
from wspd_design.simulation.draws import Choice, Normal, Uniform, drawable
from wspd_design.simulation.records import Scenario, Sensing


@pytest.fixture
def read(tmp_path):
    def reading(text):
        path = tmp_path / "campaign.toml"
        path.write_text(text)
        return read_campaign(path)

    return reading


def test_defaults_are_those_of_a_stop(read):
    found = read("stops = 5")
    (series,) = found.series
    assert (found.stops, found.plant, found.check_every) == (5, "planar", 100)
    assert (series.case.controller.name, series.case.rail.name, series.draws) == ("afsmc", "polach-wet", ())
    assert series.scenario == Scenario(rail=load_rail("polach-wet"), initial_speed=120.0 / 3.6)


def test_everything_that_is_written_counts(read, tmp_path):
    vehicle, rail = load_vehicle("er24pc"), load_rail("polach-wet")
    made = design_controller(vehicle, rail, Specification(), law="smc")
    (tmp_path / "mine.toml").write_text(design_text(made))
    found = read(
        'stops = 7\ncontrollers = ["none", "mine.toml"]\nrails = ["polach-dry", "polach-wet"]\nplant = "quarter"\n'
        'speed = "72 km/h"\nseed = 9\ncheck_every = 3\nwithin_bounds = ["rail"]\n'
        '[disturbances]\ngrade = "5 permille"\npulses = 80\n'
        "[draw]\n"
        'rail.mu0 = { normal = ["0.3", "0.02"], within = ["25 %", "0.35"] }\n'
        '"vehicle.brake.fill_time" = { uniform = ["300 ms", "0.9 s"] }\n'
        "stop.sensing.pulses_per_turn = { choice = [80, 100] }\n"
    )
    assert (found.stops, found.plant, found.check_every) == (7, "quarter", 3)
    names = [(each.case.controller.name, each.case.rail.name) for each in found.series]
    assert [rail for _, rail in names] == ["polach-dry", "polach-wet"] * 2
    assert names[0][0] == names[1][0] == "none"
    stop = found.series[0].scenario
    assert (stop.initial_speed, stop.seed, stop.grade) == (20.0, 9, 0.005)
    assert stop.sensing == Sensing(pulses_per_turn=80)
    draws = {draw.name: draw.distribution for draw in found.series[0].draws}
    assert draws.pop("rail.mu0") == Normal(mean=0.3, deviation=0.02, low=0.25, high=0.35)
    assert draws.pop("vehicle.brake.fill_time") == Uniform(low=0.3, high=0.9)
    assert draws.pop("stop.sensing.pulses_per_turn") == Choice(values=(80.0, 100.0))
    bounds = load_entries("rail", "polach-dry").bounds
    assert set(draws) == {f"rail.{name}" for name, _ in bounds.items() if name != "mu0"}


def test_every_number_of_a_stop_has_its_unit():
    names = set(drawable(Scenario(rail=load_rail("polach-wet"), initial_speed=10.0), "stop"))
    assert names == set(STOP_DIMENSIONS)


def test_every_number_of_a_stop_can_be_drawn_from_a_file(read):
    for name, dimension in STOP_DIMENSIONS.items():
        (draw,) = (
            read(f'stops = 1\n[draw]\n{name} = {{ choice = ["1 {units_of(dimension)[0]}"] }}').series[0].draws
        )
        assert (draw.name, draw.distribution) == (name, Choice(values=(1.0,)))
