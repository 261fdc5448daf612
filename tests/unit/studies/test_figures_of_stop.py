"""Figures of a stop by the rules of requirements, and the hazards that are told from it."""

from dataclasses import replace

import numpy as np
import pytest

from tests.unit.reporting.sample_dossier import faults, sample_dossier, trial
from wspd_design.reporting.sections.hazards import hazards as section
from wspd_design.simulation.runs import Ending
from wspd_design.studies.figures_of_stop import figures_of_stop, longest_release
from wspd_design.studies.hazards import hazards


def test_figures_are_those_of_the_records():
    made = trial("mine")
    found = figures_of_stop(made, 150.0)
    figures = made.metrics
    assert found["extension"] == pytest.approx(figures.distance / 150.0 - 1.0)
    assert found["efficiency_worst"] == figures.efficiency
    assert found["slip_rms"] == figures.held_slip_rms
    assert found["valve_switches"] == pytest.approx(figures.valve_switches / figures.stopping_time)
    assert "speed_error" not in found  # the law does not tell it
    endless = figures_of_stop(trial("mine", ending=Ending.TIME_LIMIT), 150.0)
    assert endless["efficiency_worst"] == 0.0


def test_a_release_is_counted_once_the_wheelset_has_braked():
    run = trial("mine").run
    torque = np.full_like(run.torque, 30e3)
    torque[run.time < 1.0] = 0.0  # build-up
    torque[(run.time >= 3.0) & (run.time < 5.0), 2] = 1e3
    assert longest_release(replace(run, torque=torque)) == pytest.approx(2.0, abs=0.06)
    torque[(run.time >= 3.0) & (run.time < 5.0), 2] = 4e3  # more than a tenth
    assert longest_release(replace(run, torque=torque)) == 0.0


def test_hazards_say_what_is_shown_and_what_is_not():
    dossier = sample_dossier()
    rows = {each.title: each for each in hazards(dossier.trials[0], faults(), dossier.vehicle)}
    assert rows["speed sensor lost"].shown == "sensor lost: 306 m, 2.0 % longer, longest lock 0.1 s"
    assert "0.5 s at a stretch" in rows["slide below the cut-out speed"].shown
    assert "no watchdog" in rows["brake released for long"].shown
    assert rows["wrong train speed"].shown == ""
    assert all(each.left for each in rows.values())
    without = {each.title: each for each in hazards(dossier.trials[0], None, dossier.vehicle)}
    assert without["speed sensor lost"].shown == ""
    _, _, table = section(dossier)
    shown = {row[1]: row[2] for row in table.rows}
    assert shown["adhesion changes suddenly"] == "nothing"
