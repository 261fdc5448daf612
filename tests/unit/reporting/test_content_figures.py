"""Figures: labeled with units, reproducible, and thinned without losing what matters."""

import math
import re
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_hex
from matplotlib.text import Text

from tests.unit.reporting.sample_dossier import certificate, estimating, sample_dossier
from tests.unit.reporting.test_maps import SHOWN
from wspd_design.certificates.records import Role, Series, Status
from wspd_design.reporting.blocks import Figure
from wspd_design.reporting.figure_style import INK, MUTED, SERIES, figure_style, new_figure
from wspd_design.reporting.figures.comparison import distance_bars, distances_alt, slip_of_all
from wspd_design.reporting.figures.drawing import picture, thinned
from wspd_design.reporting.figures.estimate import estimate_alt, estimate_panels
from wspd_design.reporting.figures.further_brakes import further_brakes, panels
from wspd_design.reporting.figures.phase import phase_planes
from wspd_design.reporting.figures.poles import pole_map, pole_map_alt
from wspd_design.reporting.figures.series import (
    HATCH,
    axis_label,
    certificate_curves,
    series_alt,
    series_caption,
)
from wspd_design.reporting.figures.stop import LOCK_BAR, stop_traces
from wspd_design.reporting.figures.uncertainty import Bar, Panel, distributions, tornado
from wspd_design.reporting.sections.checks import checks
from wspd_design.simulation.law_memory import speed_estimate
from wspd_design.studies.paper.published import load_table10

DOSSIER = sample_dossier(rail="table10-dry")
SPECIFICATION = DOSSIER.design.specification
WITH_FURTHER_BRAKES = replace(
    DOSSIER.trials[0].run,
    dynamic_torque=0.5 * DOSSIER.trials[0].run.torque,
    track_brake_force=np.linspace(3e4, 0.0, len(DOSSIER.trials[0].run.time)),
    pad_temperature=np.abs(DOSSIER.trials[0].run.slip) * 100.0,
)
PANEL = Panel(
    label="stopping distance [m]", values=(280.0, 300.0, 305.0, 340.0), nominal=300.0, p05=280.0, p95=340.0
)
BAR = Bar(name="mu0", low="0.24", high="0.36", at_low=360.0, at_high=250.0)
ENDLESS = Bar(name="brake: max torque", low="51 kN m", high="69 kN m", at_low=math.inf, at_high=300.0)
TELLING = estimating(DOSSIER.trials[0]).run
DRAWN = {
    "pole map": lambda figure: pole_map(figure, DOSSIER.linearizations, SPECIFICATION.speeds, (0.6, 0.6)),
    "stop": lambda figure: stop_traces(
        figure, DOSSIER.trials[0], SPECIFICATION, wheel_radius=0.55, max_torque=60e3
    ),
    "further brakes": lambda figure: further_brakes(figure, WITH_FURTHER_BRAKES),
    "estimate": lambda figure: estimate_panels(figure, TELLING, speed_estimate(TELLING)),
    "phase planes": lambda figure: phase_planes(
        figure, DOSSIER.trials[0].run, DOSSIER.phase_plane, SPECIFICATION
    ),
    "distributions": lambda figure: distributions(figure, [PANEL, PANEL]),
    "series": lambda figure: certificate_curves(figure, DOSSIER.certificates[0].series),
    "slips": lambda figure: slip_of_all(figure, DOSSIER.trials, SPECIFICATION),
}
UNIT = re.compile(r".+ \[(-|%|[A-Za-z0-9/ ^²]+)\]$")


@pytest.fixture(scope="module", params=DRAWN)
def figure(request):
    """A figure as it is drawn, to be looked at."""
    with figure_style():
        drawn = new_figure(height=4.0)
        assert DRAWN[request.param](drawn) is drawn
        drawn.draw_without_rendering()
    return drawn


def test_axes_have_labels_with_units(figure):
    shared = figure.get_supxlabel()
    for axes in figure.axes:
        spec = axes.get_subplotspec()
        if spec.is_last_row():
            assert UNIT.match(axes.get_xlabel() or shared)
        if spec.is_first_col():
            assert UNIT.match(axes.get_ylabel())


def test_text_is_large_enough(figure):
    for axes in figure.axes:
        sizes = [text.get_fontsize() for text in axes.findobj(lambda a: hasattr(a, "get_fontsize"))]
        assert min(sizes) >= 7.0


def test_lines_differ_without_color(figure):
    for axes in figure.axes:
        labeled = [line for line in axes.get_lines() if not line.get_label().startswith("_")]
        looks = {(line.get_linestyle(), line.get_marker()) for line in labeled}
        assert len(looks) == len(labeled)


def test_the_estimate_and_its_errors_are_those_of_the_law():
    estimate = speed_estimate(TELLING)
    with figure_style():
        speed, error, distance = estimate_panels(new_figure(height=5.0), TELLING, estimate).axes
    train, told = speed.get_lines()
    assert train.get_ydata()[0] == pytest.approx(120.0)
    assert told.get_ydata()[0] == pytest.approx(126.0)
    assert np.nanmax(error.get_lines()[0].get_ydata()) == pytest.approx(5.0)
    assert distance.get_lines()[0].get_ydata()[-1] == pytest.approx(estimate.distance_error[-1])
    looks = [paths for paths in speed.collections if paths.get_paths()]
    assert [len(paths.get_paths()) for paths in looks] == [2]  # of the second wheelset alone
    said = estimate_alt(TELLING, estimate)
    assert "between 5 and 5 %" in said
    assert "released 2 times" in said


def test_a_moving_reference_is_drawn_as_the_law_holds_it():
    drawn = []
    for run in (DOSSIER.trials[0].run, TELLING):
        told = replace(DOSSIER.trials[0], run=run)
        with figure_style():
            axes = stop_traces(
                new_figure(height=8.0), told, SPECIFICATION, wheel_radius=0.55, max_torque=60e3
            ).axes[0]
        drawn.append(next(line for line in axes.get_lines() if line.get_color() == INK))
    constant, moving = (np.asarray(line.get_ydata()) for line in drawn)
    assert set(constant) == {SPECIFICATION.slip}
    assert (moving.min(), moving.max()) == pytest.approx((0.1, 0.199))


def test_distances_show_both_parts_and_the_paper():
    with figure_style():
        figure = distance_bars(new_figure(height=3.0), DOSSIER.trials, load_table10().on("table10-dry"))
    axes = figure.axes[0]
    assert axes.get_xlabel() == "distance [m]"
    widths = [patch.get_width() for patch in axes.patches]
    for index, trial in enumerate(DOSSIER.trials):
        assert widths[2 * index] == pytest.approx(trial.metrics.build_up_distance)
        assert widths[2 * index] + widths[2 * index + 1] == pytest.approx(trial.metrics.distance)
    mark, ideal = axes.get_lines()
    assert set(mark.get_xdata()) == {184.63}
    assert set(ideal.get_xdata()) == {174.25}


def test_distances_without_parts_are_whole_bars():
    unknown = [
        replace(each, metrics=replace(each.metrics, build_up_distance=math.nan)) for each in DOSSIER.trials
    ]
    with figure_style():
        axes = distance_bars(new_figure(height=3.0), unknown, {}).axes[0]
    assert [patch.get_width() for patch in axes.patches if patch.get_width()] == pytest.approx(
        [trial.metrics.distance for trial in DOSSIER.trials]
    )
    assert axes.get_legend_handles_labels()[1] == ["ideal stop"]
    assert "nan" not in distances_alt(unknown)


@pytest.mark.parametrize("count", [2, 8])
def test_long_names_stay_above_their_panels(count):
    one = DOSSIER.trials[0]
    long = replace(one, run=replace(one.run, controller="torque-feedback-er24pc-service-eurosprinter127"))
    with figure_style():
        figure = slip_of_all(new_figure(height=6.0), [long] * count, SPECIFICATION)
        figure.draw_without_rendering()
    titles = [text for text in figure.findobj(Text) if text.get_text().startswith("torque-feedback")]
    assert len(titles) == count
    extents = [title.get_window_extent() for title in titles]
    assert all(extent.x1 < figure.bbox.width for extent in extents)
    assert not any(one.overlaps(other) for one, other in combinations(extents, 2))


def test_the_region_without_stable_equilibrium_is_marked():
    with figure_style():
        axes = pole_map(
            new_figure(height=3.0), DOSSIER.linearizations, SPECIFICATION.speeds, (0.6, 0.6)
        ).axes[0]
    levels = [line.get_ydata()[0] for line in axes.get_lines()]
    assert any(level == pytest.approx(1.0 / 0.6) for level in levels)
    assert any("no stable equilibrium" in text.get_text() for text in axes.texts)


def test_both_times_of_a_valve_and_the_one_of_its_average_are_marked():
    points = [replace(each, time_constant=0.2 + 0.01 * k) for k, each in enumerate(DOSSIER.linearizations)]
    with figure_style():
        axes = pole_map(new_figure(height=3.0), points, SPECIFICATION.speeds, (0.4, 0.15)).axes[0]
    drawn = [np.asarray(line.get_ydata(), dtype=float) for line in axes.get_lines()]
    for time in (0.4, 0.15):
        assert any(np.allclose(each, 1.0 / time) for each in drawn)
    rates = [1.0 / each.time_constant for each in points]
    assert any(each.shape == (len(points),) and np.allclose(each, rates) for each in drawn)
    said = pole_map_alt(points, SPECIFICATION.speeds, (0.4, 0.15))
    assert "3.23 to 5 1/s, between 1/fill time = 2.5 1/s and 1/vent time = 6.67 1/s" in said


def test_lock_intervals_and_tolerance_are_marked():
    with figure_style():
        figure = DRAWN["stop"](new_figure(height=6.0))
    slip = figure.axes[0]
    bars = [collection.get_paths() for collection in slip.collections]
    times = DOSSIER.trials[0].run.time
    assert [len(paths) for paths in bars] == [1, 2, 1, 1]  # at standstill all of them
    locked = bars[1][0].vertices
    assert locked[:, 0].min() == pytest.approx(times[200])
    assert locked[:, 0].max() == pytest.approx(times[239])
    # The second wheelset from the front has the second row from the top.
    assert locked[:, 1].min() == pytest.approx(1.0 - 2.0 * LOCK_BAR)
    heights = [(patch.get_y(), patch.get_y() + patch.get_height()) for patch in slip.patches]
    assert any(span == pytest.approx((0.09, 0.19)) for span in heights)


def test_pictures_are_reproducible():
    first = picture(DRAWN["stop"], height=5.0)
    assert first == picture(DRAWN["stop"], height=5.0)
    assert "DejaVu Sans" in first


def test_a_lyapunov_function_over_decades_is_drawn_on_a_logarithmic_scale():
    steep = _series("V", "V [-]", x=(0.0, 1.0), y=(1e-3, 10.0), role=Role.LYAPUNOV)
    flat = _series("Vexing speed", "V of the train [km/h]", x=(0.0, 1.0), y=(1e-3, 10.0))
    with figure_style():
        figure = certificate_curves(new_figure(height=4.0), (steep, flat))
    assert [axes.get_yscale() for axes in figure.axes] == ["log", "linear"]


def test_below_its_limit_a_lyapunov_function_may_vanish():
    values = (1.0, 0.1, 1e-9, 0.0)
    falling = _series("V", "V [-]", x=(0.0, 1.0, 2.0, 3.0), y=values, role=Role.LYAPUNOV)
    edge = _series("edge of the layer", "V [-]", x=(0.0, 3.0), y=(1e-3,) * 2, role=Role.LIMIT)
    axes = _curves(falling, edge).axes[0]
    assert axes.get_yscale() == "log"
    assert axes.get_ylim() == pytest.approx((1e-4, 2.0))


def _curves(*series):
    with figure_style():
        figure = certificate_curves(new_figure(height=4.0), series)
        figure.draw_without_rendering()
    return figure


def _series(name, y_label, x_label="time [s]", x=(0.0, 1.0, 2.0), y=(1.0, 2.0, 3.0), role=Role.CURVE):
    return Series(name=name, x_label=x_label, y_label=y_label, x=x, y=y, role=role)


def test_limits_are_drawn_in_ink_and_named():
    limit = _series("1/tau", "pole [1/s]", x=(0.0, 2.0), y=(1.67, 1.67), role=Role.LIMIT)
    axes = _curves(_series("nominal", "pole [1/s]"), limit).axes[0]
    drawn, line = axes.get_lines()
    assert (drawn.get_color() == INK, line.get_color()) == (False, INK)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["nominal", "1/τ"]
    assert "1/tau: a line at pole [1/s] 1.67" in series_alt((limit,))


def test_panels_over_the_same_quantity_share_its_axis():
    same = _curves(_series("slip", "slip [-]"), _series("V", "V of the law [-]"))
    assert [axes.get_xlabel() for axes in same.axes] == ["", "time [s]"]
    assert same.axes[0].get_legend() is None  # the axis says it
    assert same.axes[1].get_legend() is not None
    other = _curves(_series("slip", "slip [-]"), _series("slip", "slip [-]", x_label="speed [km/h]"))
    assert [axes.get_xlabel() for axes in other.axes] == ["time [s]", "speed [km/h]"]
    curves = (_series("a", "slip [-]"), _series("b", "torque [kN m]"), _series("c", "k [1/s]", "c [1/s]"))
    caption = series_caption("Check one", curves)
    assert caption == "Check one: slip and torque over time and k over c."


def test_an_outline_becomes_a_region():
    corners = (0.1, 0.2, 0.2, 0.1, 0.1), (1.0, 1.0, 2.0, 2.0, 1.0)
    square = _series("set", "torque [kN m]", "slip [-]", *corners, role=Role.OUTLINE)
    line = _series("reference", "torque [kN m]", "slip [-]", (0.14, 0.14), (0.0, 60.0), role=Role.LIMIT)
    axes = _curves(square, line).axes[0]
    (patch,) = axes.patches
    assert patch.get_extents().width > 0.0
    assert axes.get_lines()[1].get_color() == INK
    assert "closed region with slip from 0.1 to 0.2" in series_alt((square,))


def test_a_region_that_failed_is_hatched_and_one_that_was_tried_is_empty():
    """Neither has the color of something that is shown, whatever stands before it."""
    corners = (0.1, 0.2, 0.2, 0.1, 0.1), (1.0, 1.0, 2.0, 2.0, 1.0)
    roles = Role.OUTLINE, Role.TRIED, Role.FAILED
    squares = [_series(each.name, "torque [kN m]", "slip [-]", *corners, role=each) for each in roles]
    axes = _curves(*squares).axes[0]
    filled, failed = axes.patches
    assert (failed.get_hatch(), failed.get_facecolor()[-1]) == (HATCH, 0.0)
    assert filled.get_hatch() is None
    assert filled.get_facecolor()[-1] > 0.0
    assert to_hex(failed.get_edgecolor()) == INK
    assert [line.get_color() for line in axes.get_lines()] == [SERIES[0], MUTED]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [each.name for each in roles]
    assert series_caption("Check", squares) == "Check: torque over slip; hatched: FAILED."


def test_long_labels_stay_inside_and_units_are_set():
    assert axis_label("W0 [m/s2]") == "W0 [m/s²]"
    assert axis_label("slip [-]") == "slip [-]"
    figure = _curves(_series("a", "recoverable deviation of the slip from its reference [-]"))
    label = figure.axes[0].yaxis.label.get_window_extent()
    assert 0.0 <= label.y0 <= label.y1 <= figure.bbox.height


def test_maps_stand_before_curves_unless_the_check_does_not_apply():
    checked = certificate("one", Status.PROVED, maps=(SHOWN,))
    found = sample_dossier(())
    shown = [each for each in checks(replace(found, certificates=(checked,))) if isinstance(each, Figure)]
    assert [each.anchor for each in shown] == ["check-one-map-1", "check-one-curves"]
    silent = replace(checked, status=Status.NOT_APPLICABLE)
    assert not any(isinstance(each, Figure) for each in checks(replace(found, certificates=(silent,))))


@given(
    st.lists(st.floats(-1e6, 1e6), min_size=1, max_size=400),
    st.integers(6, 60),
)
def test_thinning_keeps_extremes_ends_and_order(values, most):
    y = np.array(values)
    x = np.arange(len(y), dtype=float)
    thin_x, thin_y = thinned(x, y, most)
    assert len(thin_x) <= max(most, 0) or len(y) <= most
    assert (thin_y.min(), thin_y.max()) == (y.min(), y.max())
    assert (thin_x[0], thin_x[-1]) == (x[0], x[-1])
    assert (np.diff(thin_x) > 0).all()
    assert (y[thin_x.astype(int)] == thin_y).all()


def test_thinning_keeps_a_spike_that_every_nth_point_would_lose():
    y = np.zeros(100_000)
    y[54_321] = 1.0
    _, thin_y = thinned(np.arange(100_000.0), y)
    assert len(thin_y) <= 2000
    assert thin_y.max() == 1.0


def test_a_stop_has_a_panel_for_each_brake_that_the_vehicle_has():
    run = WITH_FURTHER_BRAKES
    assert panels(DOSSIER.trials[0].run) == ()
    assert [panel.title.split()[0] for panel in panels(run)] == ["Torque", "Force", "Temperature"]
    (alone,) = panels(replace(DOSSIER.trials[0].run, track_brake_force=run.track_brake_force))
    assert alone.words == "The track brake pulls with at most 30 kN."
    with figure_style():
        drawn = further_brakes(new_figure(height=4.0), run)
    lines = [axes.get_lines() for axes in drawn.axes]
    assert [len(each) for each in lines] == [4, 1, 4]
    assert max(lines[0][0].get_ydata()) == pytest.approx(run.dynamic_torque[:, 0].max() / 1e3)
    assert max(lines[2][3].get_ydata()) == pytest.approx(run.pad_temperature[:, 3].max())


def _with_wheelsets(number):
    """The sample trial with so many wheelsets, which are its own ones again and again."""
    made = DOSSIER.trials[0]
    own = made.run
    again = [k % own.slip.shape[1] for k in range(number)]
    arrays = {each: getattr(own, each)[:, again] for each in ("wheel_speed", "slip", "torque", "wheel_load")}
    run = replace(own, **arrays, axle_samples=tuple(own.axle_samples[0] for _ in again))
    return replace(made, run=run)


@pytest.mark.parametrize("number", [2, 6, 7, 8, 32])
def test_wheelsets_of_any_number_have_curves_of_their_own(number):
    """Up to four had colors; the seventh was drawn as the train, the eighth ended in a traceback."""
    made = _with_wheelsets(number)
    with figure_style():
        drawn = stop_traces(new_figure(height=8.6), made, SPECIFICATION, wheel_radius=0.55, max_torque=60e3)
        drawn.draw_without_rendering()
        compared = slip_of_all(new_figure(height=5.0), [made, made], SPECIFICATION)
        compared.draw_without_rendering()
    slip, speed, *_ = drawn.axes
    looks = {(line.get_color(), str(line._dash_pattern)) for line in speed.lines}
    assert len(looks) == number + 1  # and the train
    names = [text.get_text() for text in slip.get_legend().get_texts()]
    assert len(set(names)) == len(names) == min(number, 8)  # of many every fourth or so is named
    assert (names[0], names[-1]) == (
        "wheelset 1 (front)",
        f"wheelset {number} (rear)" if number <= 4 else f"{number} (rear)",
    )
    for each, legend in ((drawn, slip.get_legend()), (compared, compared.legends[0])):
        box = legend.get_window_extent()
        assert 0.0 <= box.x0 < box.x1 <= each.bbox.width
        assert 0.0 <= box.y0 < box.y1 <= each.bbox.height


def test_a_bound_at_which_no_train_stops_is_told():
    with figure_style():
        figure = tornado(new_figure(height=2.0), [BAR, ENDLESS], 300.0, 0.5, "stopping distance [m]")
    texts = figure.findobj(Text)
    words = [text.get_text() for text in texts]
    assert "51 kN m: no standstill" in words
    assert {"0.24", "0.36", "stopping distance [m]"} <= set(words)
    assert "69 kN m" not in words  # its bar has no length
    assert min(text.get_fontsize() for text in texts) >= 7.0
