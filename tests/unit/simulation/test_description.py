"""Scenarios in words: few changes of rail one by one, many in short."""

import pytest

from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.description import every_rail_of, rails_of
from wspd_design.simulation.records import Patch, Scenario


@pytest.mark.parametrize(
    ("rails", "said"),
    [
        ((), "polach-wet"),
        (("very-low", "polach-wet"), "polach-wet, very-low from 10 m, polach-wet from 20 m"),
        (("polach-wet",) * 4, "5 stretches of polach-wet"),
        (("very-low", "polach-wet") * 2, "5 stretches of polach-wet and very-low"),
        (
            ("very-low", "polach-dry", "very-low", "polach-wet"),
            "5 stretches of polach-wet, very-low and polach-dry",
        ),
    ],
)
def test_rails_of_a_stop(rails, said):
    patches = tuple(
        Patch(start=10.0 * place, rail=load_rail(name)) for place, name in enumerate(rails, start=1)
    )
    stop = Scenario(rail=load_rail("polach-wet"), initial_speed=20.0, patches=patches)
    assert rails_of(stop) == said
    assert every_rail_of(stop).count(" from ") == len(rails)
