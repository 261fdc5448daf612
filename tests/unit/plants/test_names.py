"""Plants by name: each name makes the plant that bears it, and only what a stop needs is loaded."""

import subprocess
import sys

import pytest

from wspd_design.plants.names import PLANTS, plant_of

STOP = """
import sys
import wspd_design as wd
vehicle, rail = wd.load_vehicle("er24pc"), wd.load_rail("polach-wet")
law = wd.controller("none", vehicle, rail, wd.Specification())
wd.simulate(vehicle, law, wd.Scenario.stop(from_kmh=1, rail=rail))
print(*sys.modules)
"""


@pytest.mark.parametrize("name", PLANTS)
def test_a_name_makes_the_plant_that_bears_it(er24pc, name):
    assert plant_of(name, er24pc).name == name


def test_a_stop_on_a_small_plant_loads_no_multibody_vehicle():
    done = subprocess.run([sys.executable, "-c", STOP], capture_output=True, text=True, check=True)
    loaded = done.stdout.split()
    assert "wspd_design.plants.planar" in loaded
    assert not [name for name in loaded if "multibody" in name or "locomotive" in name]
