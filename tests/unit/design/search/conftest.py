"""A small task: short stops on two rails with a few draws."""

import pytest

from wspd_design.design.specification_file import read_task

TEXT = """schema = "wspd-specification/1"
name = "small"
law = "torque-feedback"
vehicle = "er24pc"
sample_time = "100 ms"

[requirements]
rails = ["polach-dry", "polach-wet"]
within_bounds = ["rail"]
held_out = { sets = 20, seed = 9000 }

[requirements.limits]
efficiency_mean = "80 %"
valve_switches = "12 1/s"

[requirements.stop]
initial_speed = "30 km/h"

[requirements.draw]
vehicle.brake.max_torque = { uniform = ["45 kN m", "75 kN m"] }
stop.sensing.speed_noise = { choice = ["0.02 m/s", "0.05 m/s"] }

[search]
evaluations = 20
sets = 20
seed = 1
"""


@pytest.fixture(scope="session")
def task(tmp_path_factory):
    path = tmp_path_factory.mktemp("task") / "small.toml"
    path.write_text(TEXT)
    return read_task(str(path))
