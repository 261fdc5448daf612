"""A stop of Section 7 on a larger model: judged by the ideal stop of the small one, with its steps halved."""

from dataclasses import replace

import pytest

from wspd_design.parameters.loading import load_rail
from wspd_design.plants.quarter import Quarter
from wspd_design.simulation.comparison import trial
from wspd_design.simulation.records import Scenario
from wspd_design.studies.paper.locomotive import checked_trial


def test_the_ideal_stop_is_that_of_the_small_model(er24pc, make_controller):
    """So that an efficiency exists on every model, and conclusions about it are not judged by what is not known."""
    law = make_controller("afsmc", rail="polach-wet")
    stop = Scenario.stop(from_kmh=40.0, rail=load_rail("polach-wet"))
    small = trial(er24pc, law, stop, slip_reference=0.14)
    planted = replace(small, metrics=replace(small.metrics, ideal_stop=30.0))
    found = checked_trial(Quarter(er24pc), law, stop, planted)
    assert found.run.plant == "quarter"
    assert found.metrics.efficiency == pytest.approx(30.0 / found.metrics.distance)
    assert 0.0 < found.check.distance < 1e-6
    assert found.slip_reference == small.slip_reference
