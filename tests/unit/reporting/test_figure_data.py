"""What a figure tells the script of the page: panels, scales, and which line is which."""

import json
import re
from html import unescape

import numpy as np

from wspd_design.reporting.figure_style import figure_style, figure_svg, new_figure
from wspd_design.reporting.figures.drawing import curve, note


def told(figure):
    svg = figure_svg(figure)
    found = re.search(r'data-figure="([^"]*)"', svg)
    return svg, json.loads(unescape(found[1])) if found else None


def two_panels():
    time = np.linspace(0.0, 10.0, 50)
    with figure_style():
        figure = new_figure(height=3.0)
        upper, lower = figure.subplots(2, 1, sharex=True)
        for index in range(2):
            curve(upper, time, time + index, index, label=f"axle {index + 1}")
            curve(lower, time, 2.0 * time + index, index)
        upper.set(ylabel="slip [-]", ylim=(0.0, 20.0))
        lower.set(
            xlabel="time [s]", ylabel="torque [kN m]", xlim=(0.0, 10.0), yscale="log", ylim=(1.0, 100.0)
        )
        upper.axhline(3.0)
        note(upper, "here", 5.0, 5.0)
    return figure


def test_panels_have_their_scales_and_share_the_name_of_x():
    _, record = told(two_panels())
    assert [panel["x"] for panel in record["panels"]] == [["time [s]", 0.0, 10.0, 0]] * 2
    assert [panel["y"] for panel in record["panels"]] == [
        ["slip [-]", 0.0, 20.0, 0],
        ["torque [kN m]", 1.0, 100.0, 1],
    ]


def test_a_box_is_where_the_curve_is_drawn():
    svg, record = told(two_panels())
    left, top, right, bottom = record["panels"][0]["box"]
    drawn = re.search(r'data-curve="0">\s*<path d="M([\d.]+) ([\d.]+)', svg)
    assert drawn is not None
    assert float(drawn[1]) == left  # at 0 s
    assert float(drawn[2]) == bottom  # at 0
    assert left < right
    assert top < bottom


def test_a_line_without_a_label_is_what_the_line_of_its_look_is():
    svg, record = told(two_panels())
    assert record["lines"] == ["axle 1", "axle 2"]
    assert re.findall(r'data-curve="(\d)"', svg) == ["0", "1", "0", "1"]  # no constant line
    assert svg.count("data-note") == 1
    assert svg.count("data-panel") == 2


def test_lines_of_one_look_and_two_names_are_two():
    with figure_style():
        figure = new_figure(height=2.0)
        for axes, name in zip(figure.subplots(1, 2), ("V", "pole"), strict=True):
            curve(axes, [0.0, 1.0, 2.0], [0.0, 1.0, 0.0], 0, label=name)
    svg, record = told(figure)
    assert record["lines"] == ["V", "pole"]
    assert re.findall(r'data-curve="(\d)"', svg) == ["0", "1"]


def test_a_panel_without_a_curve_moves_with_the_others_and_is_not_read():
    with figure_style():
        figure = new_figure(height=2.0)
        upper, lower = figure.subplots(2, 1, sharex=True)
        curve(upper, [0.0, 1.0, 2.0], [0.0, 1.0, 0.0], 0)
        lower.fill_between([0.0, 1.0], 0.0, 1.0)
        lower.set(ylabel="fill [-]")
    _, record = told(figure)
    assert [panel["y"][0] for panel in record["panels"]] == ["", ""]
    assert record["lines"] == [""]


def test_what_is_no_curve_over_x_says_nothing():
    angle = np.linspace(0.0, 6.0, 30)
    with figure_style():
        figure = new_figure(height=2.0)
        left, right = figure.subplots(1, 2)
        left.plot(np.cos(angle), np.sin(angle))
        right.barh([1, 2], [3.0, 4.0])
        right.plot([1.0, 2.0], [1.0, 2.0], "o")
    svg, record = told(figure)
    assert record is None
    assert "data-" not in svg


def test_the_name_of_x_may_stand_under_the_whole_figure():
    with figure_style():
        figure = new_figure(height=2.0)
        for axes in figure.subplots(1, 2, sharex=True):
            curve(axes, [0.0, 1.0, 2.0], [0.0, 1.0, 0.0], 0)
        figure.supxlabel("time [s]")
    _, record = told(figure)
    assert [panel["x"][0] for panel in record["panels"]] == ["time [s]", "time [s]"]


def test_what_a_collection_draws_stands_at_its_coordinates():
    """Matplotlib defines it far outside and moves it; a script that zooms must find it in place."""
    with figure_style():
        figure = new_figure(height=2.0)
        axes = figure.subplots()
        curve(axes, [0.0, 5.0, 10.0], [0.0, 1.0, 0.0], 0)
        axes.broken_barh(
            [(2.0, 3.0)], (0.9, 0.1), transform=axes.get_xaxis_transform(), color="#0072b2", linewidth=0
        )
        axes.set(xlim=(0.0, 10.0))
    svg, record = told(figure)
    left, top, right, _ = record["panels"][0]["box"]
    (drawn,) = re.finditer(r'<path d="M([\d.]+) ([\d.]+)[^>]*fill="#0072b2"[^>]*clip-path=', svg)
    assert float(drawn[1]) == np.round(left + 0.2 * (right - left), 2)
    assert top <= float(drawn[2])
    assert "used elsewhere" not in svg
