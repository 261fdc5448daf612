"""Numbers that stops draw: the right distributions, whatever is drawn beside them and however stops are divided."""

import itertools
import math
from dataclasses import fields, replace

import numpy as np
import pytest
from scipy import stats

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_entries, load_rail
from wspd_design.plants.names import plant_of
from wspd_design.simulation.draws import About, Choice, Deck, Draw, Normal, Uniform, drawable, within_bounds
from wspd_design.simulation.records import Scenario, Sensing

MASS = Draw(name="vehicle.mass", distribution=Uniform(low=70e3, high=80e3))
NOISE = Draw(
    name="stop.sensing.speed_noise", distribution=Normal(mean=0.05, deviation=0.02, low=0.0, high=0.08)
)
PULSES = Draw(name="stop.sensing.pulses_per_turn", distribution=Choice(values=(80.0, 100.0, 200.0)))
SPEED = Draw(name="stop.initial_speed", distribution=Uniform(low=10.0, high=30.0))
FILL = Draw(name="vehicle.brake.fill_time", distribution=Uniform(low=0.3, high=0.9))
MU = Draw(name="rail.mu0", distribution=Uniform(low=0.2, high=0.3))


@pytest.fixture(scope="module")
def scenario():
    return Scenario(rail=load_rail("polach-wet"), initial_speed=20.0, seed=5)


@pytest.fixture(scope="module")
def deal(er24pc, scenario):
    def deck(*draws, stop=scenario, plant="planar"):
        return Deck(plant_of(plant, er24pc), stop, draws)

    return deck


@pytest.mark.parametrize("cuts", [(1,), (3, 4, 5), (16, 128), (127,), tuple(range(1, 300))])
def test_a_division_changes_no_bit(deal, cuts):
    deck = deal(MASS, NOISE, PULSES)
    whole = deck.values(0, 300)
    ends = (0, *cuts, 300)
    parts = np.vstack([deck.values(a, b - a) for a, b in itertools.pairwise(ends)])
    assert parts.tobytes() == whole.tobytes()


def test_a_number_is_the_same_beside_others_and_another_with_another_seed(deal, scenario):
    alone = deal(NOISE).values(0, 50)[:, 0]
    np.testing.assert_array_equal(deal(MASS, NOISE, SPEED).values(0, 50)[:, 1], alone)
    assert not np.isin(deal(NOISE, stop=replace(scenario, seed=6)).values(0, 50), alone).any()


def test_distributions_are_what_they_are_called(deal):
    """Against those of scipy.stats: Kolmogorov-Smirnov, and chi squared for the choice."""
    count = 4000
    mass, noise, pulses = deal(MASS, NOISE, PULSES).values(0, count).T
    assert stats.kstest(mass, stats.uniform(70e3, 10e3).cdf).pvalue > 0.01
    cut = stats.truncnorm((0.0 - 0.05) / 0.02, (0.08 - 0.05) / 0.02, loc=0.05, scale=0.02)
    assert stats.kstest(noise, cut.cdf).pvalue > 0.01
    assert stats.kstest(noise, stats.norm(0.05, 0.02).cdf).pvalue < 1e-6  # the cut is seen
    values, found = np.unique(pulses, return_counts=True)
    assert values.tolist() == [80.0, 100.0, 200.0]
    assert stats.chisquare(found).pvalue > 0.01
    assert abs(np.corrcoef([mass, noise, pulses])[np.triu_indices(3, 1)]).max() < 0.05
    assert abs(np.corrcoef(mass[1:], mass[:-1])[0, 1]) < 0.05  # nor are neighbours alike


def test_numbers_reach_their_records(deal, scenario):
    deck = deal(MASS, NOISE, PULSES, SPEED, FILL, MU)
    values, cases = deck.values(7, 20), deck.cases(7, 20)
    for (plant, stop), row, run in zip(cases, values, range(7, 27), strict=True):
        vehicle = plant.vehicle
        found = (vehicle.mass, stop.sensing.speed_noise, stop.sensing.pulses_per_turn)
        assert (*found, stop.initial_speed, vehicle.brake.fill_time, stop.rail.mu0) == tuple(row)
        assert isinstance(stop.sensing.pulses_per_turn, int)
        assert stop.seed == scenario.seed + run
        assert vehicle.body_mass + 2.0 * vehicle.bogie_mass == pytest.approx(vehicle.mass, rel=1e-12)
        assert replace(stop.rail, mu0=scenario.rail.mu0) == scenario.rail


def test_a_number_that_was_written_without_a_point_is_not_rounded(deal, scenario):
    grade = Draw(name="stop.grade", distribution=Uniform(low=-0.01, high=0.01))
    drawn = [stop.grade for _, stop in deal(grade, stop=replace(scenario, grade=0)).cases(0, 9)]
    assert len(set(drawn)) == 9


def test_every_number_of_a_stop_can_be_drawn(scenario):
    names = drawable(scenario, "stop")
    numbers = [field.name for field in fields(Sensing) if field.type in (int, float)]
    assert len(numbers) >= 4
    assert {f"stop.sensing.{name}" for name in numbers} <= set(names)
    assert {"stop.initial_speed", "stop.grade", "stop.start.slip"} <= set(names)
    assert "stop.seed" not in names


def test_the_load_of_an_empty_vehicle_is_not_drawn():
    coach = load_entries("vehicle", "coach")
    assert coach.entries["laden.mass"].bounds is not None
    names = [draw.name for draw in within_bounds(coach)]
    assert "vehicle.mass" in names
    assert [name for name in names if "laden" in name] == []


def test_bounds_of_files_become_draws():
    parameters = load_entries("vehicle", "er24pc"), load_entries("rail", "polach-wet")
    draws = {draw.name: draw.distribution.ends for draw in within_bounds(*parameters)}
    for each in parameters:
        for name, ends in each.bounds.items():
            assert draws.pop(f"{each.kind}.{name}") == pytest.approx(ends)
    assert draws == {}


@pytest.mark.parametrize(
    ("draws", "sentence"),
    [
        (
            (replace(MASS, name="vehicle.maas"),),
            '"vehicle.maas" is not a number .* did you mean "vehicle.mass"',
        ),
        ((replace(MASS, name="stop.seed"),), '"stop.seed" is not a number'),
        ((replace(MASS, name="vehicle.brake"),), '"vehicle.brake" is not a number'),
        ((MASS, FILL, MASS), "vehicle.mass is drawn twice"),
        (
            (replace(MU, distribution=Uniform(low=0.3, high=1.2)),),
            r"rail.mu0 is drawn down or up to 1.2; .* \(0, 1\]",
        ),
    ],
)
def test_what_cannot_be_drawn_is_refused(deal, draws, sentence):
    with pytest.raises(UserError, match=sentence):
        deal(*draws)


def test_records_refuse_what_a_draw_could_bring(deal):
    deck = deal(replace(SPEED, distribution=Uniform(low=100.0, high=200.0)))
    with pytest.raises(UserError, match="initial speed = 200 m/s"):
        deck.extremes()


def test_rails_of_single_axles_are_not_drawn(deal, scenario):
    own = replace(scenario, axle_rails=(scenario.rail,) * 4)
    with pytest.raises(UserError, match="would all become the same"):
        deal(MU, stop=own)
    assert deal(MASS, stop=own).cases(0, 1)[0][1].axle_rails == own.axle_rails


@pytest.mark.parametrize(
    "make",
    [
        lambda: Uniform(low=1.0, high=1.0),
        lambda: Uniform(low=0.0, high=math.inf),
        lambda: Normal(mean=0.0, deviation=0.0, low=-1.0, high=1.0),
        lambda: Normal(mean=2.0, deviation=1.0, low=-1.0, high=1.0),
        lambda: Normal(mean=0.0, deviation=1.0, low=1.0, high=-1.0),
        lambda: Choice(values=()),
        lambda: Choice(values=(math.nan,)),
    ],
)
def test_distributions_refuse_what_they_cannot_be(make):
    with pytest.raises(UserError):
        make()


def test_about_a_number_means_about_that_of_the_records(deal, er24pc, scenario):
    """The same as evenly between two numbers, whatever is drawn beside it."""
    about = [
        Draw(name="vehicle.mass", distribution=About(share=0.1)),
        Draw(name="vehicle.brake.fill_time", distribution=About(share=0.5)),
        Draw(name="rail.mu0", distribution=About(share=0.2)),
    ]
    between = [
        Draw(name="vehicle.mass", distribution=Uniform(low=0.9 * er24pc.mass, high=1.1 * er24pc.mass)),
        Draw(name="vehicle.brake.fill_time", distribution=Uniform(low=0.3, high=0.9)),
        Draw(
            name="rail.mu0", distribution=Uniform(low=0.8 * scenario.rail.mu0, high=1.2 * scenario.rail.mu0)
        ),
    ]
    assert deal(*about).values(0, 50) == pytest.approx(deal(*between).values(0, 50))
    downhill = replace(scenario, grade=-0.01)
    (low,), (high,) = (
        [deck.extremes()[end][1].grade]
        for deck in [deal(Draw(name="stop.grade", distribution=About(share=0.5)), stop=downhill)]
        for end in (0, 1)
    )
    assert (low, high) == pytest.approx((-0.015, -0.005))


@pytest.mark.parametrize(
    ("name", "share", "sentence"),
    [
        ("stop.sensing.speed_noise", 0.5, "is drawn about its nominal number, which is 0"),
        ("stop.sensing.dead_time", 0.5, "is drawn about its nominal number, which is 0"),
        ("vehicle.mass", 1.0, "vehicle.mass is drawn down or up to 0; it must be"),
    ],
)
def test_about_nothing_is_refused(deal, name, share, sentence):
    with pytest.raises(UserError, match=sentence):
        deal(Draw(name=name, distribution=About(share=share)))


@pytest.mark.parametrize("share", [0.0, -0.1, 1.1, math.nan, math.inf])
def test_a_share_that_cannot_be_is_refused(share):
    with pytest.raises(UserError, match="must lie in"):
        About(share=share)
