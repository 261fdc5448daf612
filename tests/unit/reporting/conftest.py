"""What tests of the words of a report share."""

from html import escape

import pytest


@pytest.fixture(scope="module")
def blank_figures():
    """Put figures together, but keep their words alone: rendering takes most of the time of a document."""

    def words(figure):
        from matplotlib.text import Text

        said = " ".join(text.get_text() for text in figure.findobj(Text))
        head = '<svg xmlns="http://www.w3.org/2000/svg" width="10pt" height="10pt" viewBox="0 0 10 10">'
        return f"{head}<text>{escape(said)}</text></svg>"

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("wspd_design.reporting.figures.drawing.figure_svg", words)
        yield
