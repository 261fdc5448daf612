"""Maps of a margin: what is drawn, and what is said of it."""

from dataclasses import replace

import numpy as np
import pytest

from wspd_design.certificates import domain, reaching
from wspd_design.certificates.margin_map import margin_map as sample_map
from wspd_design.certificates.records import Map
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.loading import load_rail
from wspd_design.reporting.figure_style import figure_style, new_figure
from wspd_design.reporting.figures.maps import map_alt, map_caption, margin_map

SHOWN = Map(
    name="height",
    x_label="speed [km/h]",
    y_label="slip [-]",
    value_label="height [m]",
    x=(10.0, 30.0, 90.0),
    y=(0.1, 0.2),
    values=((1.0, 2.0, 3.0), (2.0, 4.0, 6.0)),
    limit=3.5,
    worst=(90.0, 0.2),
)


def _drawn(shown):
    with figure_style():
        figure = margin_map(new_figure(height=2.6), shown)
        figure.canvas.draw()
    return figure


def test_axes_and_bar_carry_their_units():
    axes, bar = _drawn(SHOWN).axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("speed [km/h]", "slip [-]")
    assert bar.get_ylabel() == "height [m]"
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["10", "20", "50"]


def _lines(figure):
    """Levels of the contour lines."""
    return [
        level
        for artist in figure.axes[0].collections
        if type(artist).__name__ == "QuadContourSet" and not artist.filled
        for level in artist.levels
    ]


def test_limit_is_drawn_where_it_lies_inside():
    assert _lines(_drawn(SHOWN)) == [3.5]
    assert "The line is the limit, 3.5." in map_caption(SHOWN)
    outside = replace(SHOWN, limit=7.0)
    assert _lines(_drawn(outside)) == []
    assert "lies outside the values shown" in map_caption(outside)
    assert "limit" not in map_caption(replace(SHOWN, limit=None))


def test_cross_marks_the_tightest_point():
    (cross,) = _drawn(SHOWN).axes[0].lines
    assert (cross.get_xdata()[0], cross.get_ydata()[0]) == SHOWN.worst
    assert _drawn(replace(SHOWN, worst=None)).axes[0].lines[:] == []
    assert "90, 0.2" in map_alt(SHOWN).replace("0.200", "0.2").replace("90.0", "90")


def test_words_hold_the_range_of_the_values():
    assert "between 1 and 6" in map_alt(SHOWN).replace(".00", "")


@pytest.fixture(scope="module")
def problem(er24pc):
    rail = load_rail("polach-wet")
    law = design_controller(er24pc, rail, Specification(), law="smc").build(er24pc, rail)
    return stability_problem(er24pc, rail, law, Specification())


def test_map_of_reaching_agrees_with_the_prover(problem):
    """Its largest value lies at the cross, and is what the prover enclosed."""
    verdict = reaching.check(problem)
    (shown,) = verdict.maps
    values = np.array(shown.values)
    row, column = np.unravel_index(values.argmax(), values.shape)
    assert shown.x[column] == pytest.approx(shown.worst[0], rel=0.1)
    assert shown.y[row] == pytest.approx(shown.worst[1], abs=0.02)
    needed = problem.controller.gains.switching_gain - verdict.margin.low
    assert values.max() <= needed
    assert values.max() == pytest.approx(needed, rel=1e-3)
    assert shown.limit == problem.controller.gains.switching_gain


def test_map_takes_the_worst_of_the_corners(problem):
    """Against single evaluations at one place of the grid."""

    def gain(points):
        return domain.dynamics(problem, points).gain

    shown = sample_map(
        "gain",
        "G",
        gain,
        domain.box(problem),
        over=domain.SLIP,
        limit=0.0,
        worst={"speed": 10.0, "slip": 0.1},
        largest=True,
    )
    light = problem.inertia_bounds[0]
    vehicle, rail = domain.varied(problem, problem.vehicle.mass, light, problem.rail.mu0)
    for row, column in ((0, 0), (7, 12), (-1, -1)):
        plant = slip_dynamics(vehicle, rail, shown.y[row], shown.x[column] / 3.6)
        assert shown.values[row][column] == pytest.approx(plant.gain, rel=1e-9)
