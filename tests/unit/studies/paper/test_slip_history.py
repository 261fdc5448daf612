"""Figures of parts of a stop, on slips and torques made by hand."""

from dataclasses import replace

import numpy as np
import pytest

from tests.unit.reporting.sample_dossier import trial
from wspd_design.studies.paper.slip_history import slip_history

END = 10.0  # s, from 120 km/h at a constant deceleration
JUDGED = END * (1.0 - 10.0 / 120.0)


def _history(slip, torque=None):
    run = trial("mine").run
    time = np.linspace(0.0, END, 10_001)
    flat = np.zeros((len(time), 4))
    run = replace(
        run,
        time=time,
        speed=120.0 / 3.6 * (1.0 - time / END),
        slip=flat + slip(time)[:, np.newaxis],
        torque=flat + (0.0 if torque is None else torque(time)[:, np.newaxis]),
    )
    return slip_history(run, slip_reference=0.14, max_torque=60e3)


def test_a_slip_that_settles():
    found = _history(lambda t: np.where(t < 0.5 * JUDGED, 0.04, 0.14))
    assert found.early_rms == pytest.approx(0.1)
    assert found.late_rms == pytest.approx(0.0, abs=2e-3)
    assert found.late_ripple == pytest.approx(0.0, abs=2e-3)


def test_a_limit_cycle():
    found = _history(lambda t: 0.2 + 0.1 * np.sin(2.0 * np.pi * 3.0 * t))
    assert found.late_ripple == pytest.approx(0.1 / np.sqrt(2.0), rel=0.02)
    assert found.late_rms == pytest.approx(np.hypot(0.06, 0.1 / np.sqrt(2.0)), rel=0.02)


def test_standstill_counts_between_10_and_1_km_per_hour():
    slow = END * (1.0 - 1.0 / 120.0)
    found = _history(lambda t: np.where((t > JUDGED) & (t < slow), 0.44, np.where(t > slow, 1.0, 0.14)))
    assert found.standstill_rms == pytest.approx(0.3, rel=0.01)
    assert found.late_rms == pytest.approx(0.0, abs=2e-3)


def test_front_and_rear_are_told_apart():
    run = trial("mine").run
    slip = np.broadcast_to([0.1, 0.2, 0.3, 0.4], run.slip.shape)
    found = slip_history(replace(run, slip=slip), slip_reference=0.14, max_torque=60e3)
    assert (found.front_mean, found.rear_mean) == pytest.approx((0.15, 0.35))


@pytest.mark.parametrize(("swing", "frequency"), [(5e3, 2.0), (2.5e3, 0.0)])
def test_torque_cycles_need_a_tenth_of_the_maximum_torque(swing, frequency):
    # Peak to peak 10 kN m and 5 kN m; a tenth of 60 kN m lies between.
    found = _history(np.zeros_like, lambda t: 3e4 + swing * np.sin(2.0 * np.pi * 2.0 * t))
    assert found.torque_frequency == pytest.approx(frequency, abs=0.1)
