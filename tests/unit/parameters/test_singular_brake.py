"""The filling law (8), (9) has a double pole where the supply and the cylinder are equally fast."""

import pytest

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_vehicle


def vehicle_file(tmp_path, supply_rate):
    path = tmp_path / "mine.toml"
    path.write_text(f'base = "er24pc"\n[brake.supply_rate]\nvalue = {supply_rate!r}\nunit = "1/s"\n')
    return path


def test_equal_time_constants_are_refused_in_one_sentence(tmp_path):
    with pytest.raises(UserError, match=r"supply_rate times fill_time = 1 .* differ from 1"):
        load_vehicle(vehicle_file(tmp_path, 1.0 / 0.6))


def test_a_little_beside_it_is_fine(tmp_path):
    assert load_vehicle(vehicle_file(tmp_path, 1.001 / 0.6)).brake.supply_rate == 1.001 / 0.6
