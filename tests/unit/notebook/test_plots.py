"""Plots take axes and return them, name their units, show and save nothing."""

import re

import matplotlib as mpl
import numpy as np
import pytest

import wspd_design as wd
from wspd_design.controllers.observers.sensors import Sensors

mpl.use("Agg")
plt = pytest.importorskip("matplotlib.pyplot")

PLOTS = {
    **{f"run {what}": lambda s, what=what, **k: s.run.plot(what, **k) for what in ("slip", "speed", "valve")},
    **{
        f"trial {what}": lambda s, what=what, **k: s.trial.plot(what, **k)
        for what in ("slip", "torque", "pressure", "load")
    },
    **{
        f"comparison {what}": lambda s, what=what, **k: s.trials.plot(what, **k)
        for what in ("distance", "slip", "speed", "pressure")
    },
    "linearization": lambda s, **k: s.linearization.plot(**k),
    "poles": lambda s, **k: wd.plot_poles(
        [wd.linearize(s.vehicle, s.rail, slip=0.14, speed_kmh=v) for v in (90.0, 30.0)], **k
    ),
    "campaign": lambda s, **k: s.campaign.plot(**k),
    "campaign of axles": lambda s, **k: s.campaign.plot("longest_lock_s", **k),
    "rail": lambda s, **k: s.rail.plot(s.vehicle, **k),
}


@pytest.fixture(autouse=True)
def nothing_is_shown(monkeypatch):
    def refuse(*_arguments, **_options):
        raise AssertionError("a plot shows or saves by itself")

    monkeypatch.setattr(plt, "show", refuse)
    monkeypatch.setattr(mpl.figure.Figure, "show", refuse)
    yield
    plt.close("all")


@pytest.mark.parametrize("name", PLOTS)
def test_a_plot_draws_on_the_axes_that_it_gets(shown, name):
    figure, (left, right) = plt.subplots(1, 2)
    found = PLOTS[name](shown, ax=right)
    assert found is right
    assert plt.get_fignums() == [figure.number]
    assert not left.has_data()
    assert right.has_data()


@pytest.mark.parametrize("name", PLOTS)
def test_a_plot_makes_axes_of_its_own_and_names_units(shown, name):
    before = dict(mpl.rcParams)
    axes = PLOTS[name](shown)
    assert len(plt.get_fignums()) == 1
    labels = [axes.get_xlabel(), axes.get_ylabel()]
    measured = [label for label in labels if label not in ("", "number of stops")]
    assert measured
    assert all(re.search(r"\[.+\]", label) for label in measured)
    assert dict(mpl.rcParams) == before
    axes.figure.canvas.draw()  # labels and layout fit


def test_curves_are_the_traces(shown):
    axes = shown.trials.plot("pressure", wheelset=4)
    for line, trial in zip(axes.get_lines(), shown.trials, strict=True):
        expected = np.interp(line.get_xdata(), trial.run.time, trial.run.cylinder_pressure[:, 3] / 1e5)
        assert line.get_ydata() == pytest.approx(expected, abs=1e-9)
        assert line.get_label() == trial.run.controller


def test_adhesion_at_no_slip_speed_is_that_of_the_model(shown):
    axes = shown.rail.plot(shown.vehicle, speeds_kmh=(100.0,))
    (line,) = axes.get_lines()
    from wspd_design.simulation.peak import peak_adhesion

    slips, peaks = peak_adhesion(shown.vehicle, shown.rail, np.array([100.0 / 3.6]))
    assert line.get_ydata().max() == pytest.approx(peaks[0], rel=1e-3)
    assert line.get_xdata()[np.argmax(line.get_ydata())] == pytest.approx(slips[0], rel=0.05)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda s: s.trial.plot("slipp"), r'no trace "slipp" to plot; did you mean "slip"\?'),
        (lambda s: s.run.plot("estimate"), "estimates no train speed: it is told it"),
        (lambda s: s.trials.plot("valve"), r'no trace "valve" to plot; .*There are distance, slip'),
        (lambda s: s.trials.plot("slip", wheelset=5), "wheelset = 5 must lie between 1 and 4"),
        (
            lambda s: s.campaign.plot("distance"),
            r'no figure "distance" in this campaign; did you mean "distance_m"',
        ),
        (lambda s: s.trial.plot(ax=plt.figure()), "ax takes one Axes of Matplotlib, not a Figure"),
        (lambda s: s.trial.plot(ax=plt.subplots(2)[1]), "ax takes one Axes of Matplotlib, not a ndarray"),
        (lambda s: wd.plot_poles([s.linearization]), "two linearizations or more, not 1"),
        (lambda s: s.rail.plot("er24pc"), r'Rail.plot takes a Vehicle, not the text "er24pc"'),
        (lambda s: s.rail.plot(s.vehicle, speeds_kmh=(0.0,)), "must be one or more speeds above 0"),
    ],
)
def test_what_cannot_be_plotted_gets_a_sentence(shown, call, sentence):
    with pytest.raises(wd.UserError, match=sentence):
        call(shown)


def test_an_estimate_is_drawn_beside_the_truth(shown):
    sensors = Sensors(speed="wheels")
    specification = wd.Specification(sample_time=0.02, sensors=sensors)
    law = wd.controller("observer-smc", shown.vehicle, shown.rail, specification)
    run = wd.simulate(shown.vehicle, law, wd.Scenario.stop(from_kmh=30, rail=shown.rail))
    axes = run.plot("estimate")
    true, estimated = axes.get_lines()
    place = run.memory.index("train_speed")
    assert estimated.get_ydata()[0] == pytest.approx(3.6 * run.samples[0].state[place])
    assert true.get_ydata()[0] == pytest.approx(30.0)
    assert "[km/h]" in axes.get_ylabel()
