"""Maps of a margin: what is drawn, and what is said of it."""

from dataclasses import replace

import pytest

from wspd_design.certificates.records import Map
from wspd_design.reporting.figure_style import figure_style, new_figure
from wspd_design.reporting.figures.drawing import picture
from wspd_design.reporting.figures.maps import map_alt, map_caption, margin_map

SHOWN = Map(
    name="gain",
    x_label="speed [km/h]",
    y_label="slip [-]",
    value_label="gain that is needed [m/s2]",
    x=(10.0, 30.0, 90.0),
    y=(0.1, 0.2),
    values=((1.0, 2.0, 3.0), (2.0, 4.0, 6.0)),
    limit=3.5,
    worst=(90.0, 0.2),
)


def _drawn(shown):
    with figure_style():
        figure = margin_map(new_figure(height=2.6), shown)
        figure.draw_without_rendering()
    return figure


def _lines(figure):
    """Levels of the contour lines."""
    return [
        level
        for artist in figure.axes[0].collections
        if type(artist).__name__ == "QuadContourSet" and not artist.filled
        for level in artist.levels
    ]


def _legend(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def test_axes_and_bar_carry_their_units():
    axes, bar = _drawn(SHOWN).axes
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("speed [km/h]", "slip [-]")
    assert bar.get_ylabel() == "gain that is needed [m/s²]"
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["10", "20", "50"]


def test_limit_and_tightest_point_are_drawn_with_their_values():
    figure = _drawn(SHOWN)
    assert _lines(figure) == [3.5]
    (cross,) = figure.axes[0].lines
    assert (cross.get_xdata()[0], cross.get_ydata()[0]) == SHOWN.worst
    assert _legend(figure) == ["tightest: 6 m/s² at 90 km/h, slip 0.2", "the claim fails", "limit 3.5 m/s²"]
    assert "Hatched: there the claim fails." in map_caption(SHOWN)
    assert map_alt(SHOWN) == (
        "Map of gain that is needed over speed and slip: between 1 and 6 m/s²; the limit, 3.5 m/s², is a line "
        "inside the map; a cross marks the tightest point, 6 m/s² at 90 km/h, slip 0.2."
    )


@pytest.mark.parametrize(
    ("limit", "worst", "said"),
    [
        (7.0, (90.0, 0.2), "reached nowhere"),
        (0.0, (90.0, 0.2), "passed everywhere"),
        (0.0, (10.0, 0.1), "reached nowhere"),
        (7.0, (10.0, 0.1), "passed everywhere"),
    ],
)
def test_a_limit_outside_the_map_is_told(limit, worst, said):
    shown = replace(SHOWN, limit=limit, worst=worst)
    figure = _drawn(shown)
    assert _lines(figure) == []
    assert said in _legend(figure)[1]
    assert said in map_alt(shown)
    assert "Hatched" not in map_caption(shown)


def test_neither_limit_nor_tightest_point_is_made_up():
    shown = replace(SHOWN, limit=None, worst=None)
    figure = _drawn(shown)
    assert (_lines(figure), figure.axes[0].lines[:], _legend(figure)) == ([], [], [])
    for text in (map_caption(shown), map_alt(shown)):
        assert "limit" not in text
        assert "tightest point" not in text


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_tight_is_bright(sign):
    values = tuple(tuple(sign * value for value in row) for row in SHOWN.values)
    shown = replace(SHOWN, values=values, limit=sign * SHOWN.limit)
    filled = _drawn(shown).axes[0].collections[0]
    tight, slack = (sum(filled.cmap(filled.norm(value))[:3]) for value in (values[1][2], values[0][0]))
    assert tight > slack + 1.0


def test_a_flat_map_is_drawn():
    assert _lines(_drawn(replace(SHOWN, values=((2.0,) * 3,) * 2))) == []


def test_the_picture_is_reproducible_and_small():
    def draw(figure):
        return margin_map(figure, SHOWN)

    first = picture(draw, height=2.6)
    assert first == picture(draw, height=2.6)
    assert len(first) < 30_000
