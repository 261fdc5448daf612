"""Wrong arguments of the public functions get one sentence that names the remedy."""

import math
import warnings
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import wspd_design as wd

RAIL = "polach-wet"


@pytest.fixture(scope="module")
def rail():
    return wd.load_rail(RAIL)


@pytest.fixture(scope="module")
def law(er24pc, rail):
    return wd.controller("none", er24pc, rail, wd.Specification())


@pytest.fixture(scope="module")
def stop(rail):
    return wd.Scenario.stop(from_kmh=20, rail=rail)


@pytest.fixture(scope="module")
def design(er24pc, rail):
    return wd.design_controller(er24pc, rail, wd.Specification(), law="smc")


NO_VEHICLE = r'takes a Vehicle, not the text "er24pc"; load it with load_vehicle\("er24pc"\)'
NO_RAIL = r'takes a Rail, not the text "polach-wet"; load it with load_rail\("polach-wet"\)'
NO_LAW = (
    r'takes a law, not the text "smc"; make it with controller\("smc", vehicle, rail, Specification\(\)\)'
)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda g: wd.simulate("er24pc", g.c, g.s), NO_VEHICLE),
        (lambda g: wd.trial("er24pc", g.c, g.s, slip_reference=0.14), NO_VEHICLE),
        (lambda g: wd.compare("er24pc", [g.c], g.s, slip_reference=0.14), NO_VEHICLE),
        (lambda g: wd.simulate_many("er24pc", g.c, g.s, count=1), NO_VEHICLE),
        (lambda g: wd.linearize("er24pc", g.r, slip=0.14, speed=20.0), NO_VEHICLE),
        (lambda g: wd.design_controller("er24pc", g.r, wd.Specification()), NO_VEHICLE),
        (lambda g: wd.slip_system("er24pc", g.r, speed_kmh=80.0), NO_VEHICLE),
        (lambda g: wd.linearize(g.v, RAIL, slip=0.14, speed=20.0), NO_RAIL),
        (lambda g: wd.design_controller(g.v, RAIL, wd.Specification()), NO_RAIL),
        (lambda _g: wd.Scenario.stop(from_kmh=120, rail=RAIL), NO_RAIL),
        (lambda _g: wd.Scenario(rail=RAIL, initial_speed=20.0), NO_RAIL),
        (lambda g: replace(g.s, axle_rails=(g.r, g.r, g.r, RAIL)), NO_RAIL),
        (lambda g: wd.simulate(g.v, "smc", g.s), NO_LAW),
        (lambda g: wd.simulate_many(g.v, "smc", g.s, count=1), NO_LAW),
        (lambda _g: wd.law_system("smc"), NO_LAW),
        (
            lambda g: wd.simulate(g.v, type(g.c), g.s),
            r"not the class Unprotected; make one of it, Unprotected\(",
        ),
        (
            lambda g: wd.simulate(g.v, None, g.s),
            "takes a law, not None; a law has sample_time, start, step",
        ),
        (
            lambda g: wd.simulate(g.v, g.c, "stop"),
            r'takes a Scenario, not the text "stop"; make one with Scenario',
        ),
        (
            lambda g: wd.simulate(g.r, g.c, g.s),
            r'takes a Vehicle, not a Rail; load it with load_vehicle\("NAME"\)',
        ),
        (lambda g: wd.simulate(g.v, g.c, g.r), "takes a Scenario, not a Rail"),
        (
            lambda g: wd.compare(g.v, g.c, g.s, slip_reference=0.14),
            r"a list of laws, not an Unprotected; .* \[law\]",
        ),
        (
            lambda g: wd.compare(g.v, "smc", g.s, slip_reference=0.14),
            r'a list of laws, not the text "smc"',
        ),
        (lambda g: wd.compare(g.v, [], g.s, slip_reference=0.14), "not an empty list"),
        (lambda g: wd.design_controller(g.v, g.r, 0.14), r"takes a Specification, not 0.14; make one"),
        (
            lambda g: wd.linearize(g.v, g.r, slip=0.14),
            "takes one speed: speed=22.2 in m/s, or speed_kmh=80",
        ),
        (lambda g: wd.linearize(g.v, g.r, slip=0.14, speed=20.0, speed_kmh=72.0), "takes one speed"),
        (
            lambda g: wd.linearize(g.v, g.r, slip=0.14, speed_kmh=600.0),
            "must be above 0 and below 150 m/s",
        ),
    ],
)
def test_what_is_no_record_is_told(er24pc, rail, law, stop, call, sentence):
    with pytest.raises(wd.UserError, match=sentence):
        call(SimpleNamespace(v=er24pc, r=rail, c=law, s=stop))


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda g: wd.certify(g.v), "a Design, a Problem or a name, not a Vehicle; of a law make a problem"),
        (lambda g: wd.certify(g.c), "not an Unprotected; .* stability_problem"),
        (lambda g: wd.verify(g.d), "verify takes a Problem, not a Design; .* or give the design to certify"),
        (lambda g: wd.certify(g.d, only="sampling"), r'must be a list of names; write only=\["sampling"\]'),
        (lambda g: wd.write_report(g.d, "a.html"), r"takes a Dossier, not a Design; make one, dossier\("),
        (
            lambda g: wd.dossier("smc", vehicle=g.v, rail=g.r, scenario=g.s),
            'dossier takes a law, not the text "smc"',
        ),
        (lambda g: wd.dossier(g.c, vehicle=g.v, rail=g.r, scenario="stop"), "dossier takes a Scenario"),
        (lambda g: g.d.build("er24pc", g.r), "Design.build takes a Vehicle"),
        (lambda g: g.d.build(g.v, RAIL), "Design.build takes a Rail"),
        (lambda g: wd.controller("smc", "er24pc", g.r, wd.Specification()), "controller takes a Vehicle"),
        (lambda g: wd.controller("smc", g.v, g.r, 0.14), "controller takes a Specification, not 0.14"),
        (
            lambda g: wd.stability_problem(g.v, g.r, "smc", wd.Specification()),
            "stability_problem takes a law",
        ),
        (lambda g: wd.ideal_stop("er24pc", g.s), "ideal_stop takes a Vehicle"),
        (lambda g: wd.ideal_stop(g.v, g.r), "ideal_stop takes a Scenario, not a Rail"),
        (lambda g: wd.load_vehicle(g.v), "load_vehicle takes a name or the path of a file, not a Vehicle"),
        (lambda _g: wd.load_rail(None), "load_rail takes a name or the path of a file, not None"),
        (
            lambda _g: wd.within_bounds("er24pc"),
            r'takes a ParameterSet, not .*; give load_entries\("vehicle"',
        ),
        (
            lambda g: wd.simulate_many(g.v, g.c, g.s, count=2, draws="vehicle.mass"),
            "draws takes a list of Draw",
        ),
        (lambda g: wd.simulate_many(g.v, g.c, g.s, count="2"), 'count of simulate_many is the text "2"'),
        (
            lambda g: wd.Scenario(rail=g.r, initial_speed="120 km/h"),
            'is the text "120 km/h"; give a number in m/s',
        ),
        (lambda g: wd.Scenario.stop(from_kmh="120", rail=g.r), 'is the text "120"; give a number in km/h'),
        (
            lambda g: wd.Scenario.stop(from_kmh=120, rail=g.r, seed=1.5),
            "seed = 1.5 of Scenario must be a whole",
        ),
        (lambda _g: wd.Specification(slip="14 %"), 'slip of Specification is the text "14 %"; give a number'),
        (lambda _g: wd.Specification(speeds=("10", 30.0)), 'speeds of Specification is the text "10"'),
        (lambda g: wd.linearize(g.v, g.r, slip="14 %", speed=20.0), 'slip of linearize is the text "14 %"'),
        (lambda g: wd.write_design("a.toml", g.d), "the path of the file comes second"),
    ],
)
def test_what_is_of_another_kind_is_told(er24pc, rail, law, stop, design, call, sentence):
    with pytest.raises(wd.UserError, match=sentence):
        call(SimpleNamespace(v=er24pc, r=rail, c=law, s=stop, d=design))


def test_numbers_of_numpy_are_numbers(er24pc, rail):
    stop = wd.Scenario.stop(from_kmh=np.int64(20), rail=rail, seed=np.int64(3))
    law = wd.controller("none", er24pc, rail, wd.Specification(slip=np.float32(0.14)))
    heavy = replace(er24pc, wheelsets=np.int64(4))
    assert wd.simulate(heavy, law, stop).totals.distance > 0.0


def test_a_design_is_built_first(er24pc, stop, design):
    with pytest.raises(
        wd.UserError, match=r"takes a law, not a Design; build it, design.build\(vehicle, rail\)"
    ):
        wd.simulate(er24pc, design, stop)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"mass": -1.0}, "mass of vehicle er24pc = -1 kg must be above 0"),
        ({"mass": math.nan}, "mass of vehicle er24pc = nan kg must be finite"),
        ({"mass": "76 t"}, 'mass of vehicle er24pc is the text "76 t"; give a number in SI units'),
        ({"wheel_radius": 0.0}, "wheel_radius of vehicle er24pc = 0 m must be above 0"),
        (
            {"mass": 60e3},
            r"mass = 60000 kg .* must equal body_mass \+ 2 bogie_mass = 76841 kg; change the three",
        ),
        ({"wheelsets": 5}, "wheelsets = 5 must be a multiple of axles_per_bogie = 2"),
        ({"wheelbase": 30.0}, "wheelbase = 30 m of a bogie must be above 0 and below bogie_spacing"),
    ],
)
@pytest.mark.filterwarnings("ignore:wheelbase of vehicle")
def test_a_vehicle_that_cannot_be_is_told(er24pc, law, stop, changes, sentence):
    with pytest.raises(wd.UserError, match=sentence):
        wd.simulate(replace(er24pc, **changes), law, stop)


def test_parts_of_a_vehicle_count_as_well(er24pc, law, stop):
    for brake, sentence in (
        (replace(er24pc.brake, fill_time=-0.1), "brake.fill_time of vehicle er24pc = -0.1 s must be above 0"),
        (
            replace(er24pc.brake, axle_shares=(1.0, -1.0, 1.0, 1.0)),
            "brake.axle_shares of vehicle er24pc = -1",
        ),
    ):
        with pytest.raises(wd.UserError, match=sentence):
            wd.simulate(replace(er24pc, brake=brake), law, stop)


def test_a_rail_that_cannot_be_is_told(rail):
    with pytest.raises(wd.UserError, match=r"mu0 of rail polach-wet = -0.3 must be in \(0, 1\]"):
        wd.Scenario.stop(from_kmh=120, rail=replace(rail, mu0=-0.3))


def test_a_quarter_has_no_body_whose_mass_could_contradict(er24pc, law, stop):
    heavy = replace(er24pc, mass=80e3)
    assert wd.simulate(heavy, law, stop, plant="quarter").totals.distance > 0.0
    assert wd.linearize(heavy, stop.rail, slip=0.14, speed=20.0).slip_pole != 0.0


def test_what_no_railway_has_is_a_warning(er24pc, stop):
    light = replace(er24pc, mass=76.8, body_mass=46.8, bogie_mass=15.0)
    with pytest.warns(
        UserWarning, match=r"mass of vehicle er24pc = 76.8 kg; railways have 2000 to 1e\+06 kg"
    ):
        wd.linearize(light, stop.rail, slip=0.14, speed=20.0)


def test_kilometres_per_hour_in_place_of_metres_per_second_are_noticed(er24pc, rail):
    with pytest.warns(UserWarning, match=r"speed = 80 m/s is 288 km/h; for 80 km/h write speed_kmh=80"):
        wd.linearize(er24pc, rail, slip=0.14, speed=80)
    with pytest.warns(
        UserWarning, match=r"initial speed = 120 m/s is 432 km/h, .* write Scenario.stop\(from_kmh=120"
    ):
        wd.Scenario(rail=rail, initial_speed=120)
    with pytest.warns(UserWarning, match=r"highest speed of the range = 120 m/s is 432 km/h"):
        wd.Specification(speeds=(10, 120))
    with pytest.warns(
        UserWarning, match=r"initial speed = 80 m/s is 288 km/h; for 80 km/h write Scenario.stop\(from_kmh=80"
    ):
        wd.Scenario(rail=rail, initial_speed=80)
    with pytest.warns(UserWarning, match=r"highest speed of the range = 80 m/s is 288 km/h; for km/h write"):
        wd.Specification(speeds=(3, 80))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fast = wd.linearize(er24pc, rail, slip=0.14, speed_kmh=288)  # meant
        replace(wd.Scenario.stop(from_kmh=288, rail=rail), seed=1)  # so is the 80.0 m/s in it
        wd.Scenario(rail=rail, initial_speed=30)  # a speed of trains in m/s, too
    assert fast.speed == 80.0
    assert (
        wd.linearize(er24pc, rail, slip=0.14, speed_kmh=72).slip_pole
        == wd.linearize(er24pc, rail, slip=0.14, speed=20.0).slip_pole
    )


def test_a_long_text_is_cut():
    with pytest.raises(wd.UserError, match=r'not the text "x{40}\.\.\."'):
        wd.Scenario.stop(from_kmh=120, rail="x" * 100)


def test_laws_are_judged_about_the_slip_of_the_first_that_holds_one(er24pc, rail, stop):
    from wspd_design.controllers.offers import slip_reference_of

    holding = wd.controller("smc", er24pc, rail, wd.Specification(slip=0.1))
    none = wd.controller("none", er24pc, rail, wd.Specification())
    assert slip_reference_of(holding) == 0.1
    assert [each.slip_reference for each in wd.compare(er24pc, [none, holding], stop)] == [0.1, 0.1]
    with pytest.raises(wd.UserError, match=r"no law here holds a slip .* give slip_reference=0.14"):
        wd.compare(er24pc, [none], stop)
    assert wd.trial(er24pc, holding, stop).slip_reference == 0.1


def test_baselines_are_those_of_the_industry(er24pc, rail):
    laws = wd.baselines(er24pc, rail, wd.Specification(sample_time=0.02))
    assert [law.name for law in laws] == ["trenitalia", "knorr-bremse", "mitsubishi"]
    assert {law.sample_time for law in laws} == {0.02}
    (first, *_) = wd.baselines(wd.load_vehicle("coach"), rail)
    assert first.name == "trenitalia (textbook)"
