"""No figure cuts a curve without a word: how far it goes stands at the edge."""

import numpy as np
import pytest

from wspd_design.reporting.figure_style import figure_style, new_figure
from wspd_design.reporting.figures.drawing import curve, picture, tell_what_is_cut


def cut(limits, *, xlim=(0.0, 10.0), highest=1.0, scale="linear"):
    """What stands at the edges of a panel with a curve from -1 to so much."""
    time = np.linspace(0.0, 10.0, 101)
    with figure_style():
        axes = new_figure(height=2.0).subplots()
        curve(axes, time, np.where(time > 9.0, highest, np.where(time < 1.0, -1.0, 0.3)), 0)
        axes.set(xlim=xlim, yscale=scale, ylim=limits)
        tell_what_is_cut(axes)
    return [text.get_text() for text in axes.texts]


@pytest.mark.parametrize(
    ("limits", "told"),
    [
        ((-1.0, 1.0), []),
        ((-2.0, 2.0), []),
        ((-1.0, 0.48), ["▲ to 1"]),
        ((0.0, 1.0), ["▼ to −1"]),
        ((0.0, 0.48), ["▲ to 1", "▼ to −1"]),
        ((0.48, 0.0), ["▲ to 1", "▼ to −1"]),
        ((-1.0, 0.999), []),
    ],
)
def test_what_is_cut_is_told(limits, told):
    assert cut(limits) == told


def test_only_what_lies_in_the_picture_counts():
    assert cut((-1.0, 0.48), xlim=(0.0, 8.0)) == []
    assert cut((-1.0, 0.48), highest=np.inf) == []


def test_every_picture_tells_it():
    def draw(figure):
        axes = figure.subplots()
        curve(axes, [0.0, 1.0, 2.0], [0.0, 7.0, 0.0], 0)
        axes.set_ylim(0.0, 1.0)
        return figure

    assert "▲ to 7" in picture(draw, height=2.0)
