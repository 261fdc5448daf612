"""What a vehicle can have sensors for."""

import pytest

from wspd_design.controllers.observers.sensors import SPEED_KINDS, Sensors
from wspd_design.parameters.errors import UserError


def test_every_source_can_be_named():
    assert [Sensors(speed=kind).speed for kind in SPEED_KINDS] == ["told", "fastest-axle", "wheels"]


def test_an_unknown_source_is_refused_with_the_known_ones():
    with pytest.raises(UserError, match='speed = "radar" must be one of "told", "fastest-axle", "wheels"'):
        Sensors(speed="radar")


@pytest.mark.parametrize("name", ["accelerometer", "grade"])
def test_what_only_the_filter_uses_is_refused_elsewhere(name):
    with pytest.raises(UserError, match=f'{name} = true goes with speed = "wheels", not with "told"'):
        Sensors(**{name: True})
