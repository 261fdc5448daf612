"""Figures: reproducible SVG without anything that a strict policy refuses or that leaks into the page."""

import re
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.unit.reporting.sample_report import slip_figure
from wspd_design.reporting.figure_style import INK, LINE_STYLES, SERIES, figure_style, new_figure
from wspd_design.reporting.svg import canonical, inline, size


@pytest.fixture(scope="module")
def svg() -> str:
    return slip_figure()


def _luminance(color: str) -> float:
    parts = [int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_the_same_figure_gives_the_same_characters(svg: str) -> None:
    assert slip_figure() == svg


def test_no_style_no_metadata_no_date(svg: str) -> None:
    assert not re.search(r'<style|[ "]style=', svg)
    assert "metadata" not in svg
    assert not re.search(r"20\d\d-\d\d-\d\d", svg)
    assert ElementTree.fromstring(svg).tag == "{http://www.w3.org/2000/svg}svg"


def test_text_stays_text_in_one_family(svg: str) -> None:
    texts = "".join(ElementTree.fromstring(svg).itertext())
    assert "time [s]" in texts
    assert set(re.findall(r'font-family="([^"]*)"', svg)) == {"DejaVu Sans"}
    assert set(re.findall(r'font-size="([^"]*)"', svg)) >= {"8px", "7.5px"}


def test_inlined_ids_are_prefixed_and_resolve(svg: str) -> None:
    placed = inline(svg, "F1-", {INK: "currentColor"}, 'what "it" shows')
    ids = re.findall(r'\bid="([^"]*)"', placed)
    references = re.findall(r'href="#([^"]*)"', placed) + re.findall(r"url\(#([^)]*)\)", placed)
    assert len(ids) == len(set(ids))
    assert all(each.startswith("F1-") for each in ids)
    assert references
    assert set(references) <= set(ids)
    assert any("clip-path" in line for line in placed.splitlines())


def test_inlined_svg_follows_the_page(svg: str) -> None:
    placed = inline(svg, "F1-", {INK: "currentColor"}, 'what "it" shows')
    root = ElementTree.fromstring(placed)
    assert INK not in placed
    assert root.get("role") == "img"
    assert root.get("aria-label") == 'what "it" shows'
    assert root.get("height") is None
    assert "http" not in placed


def test_size_is_that_on_paper(svg: str) -> None:
    assert size(svg) == pytest.approx((6.53 * 72, 3.4 * 72))


def test_a_style_sheet_does_not_survive() -> None:
    dirty = (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"><style>*{color:red}</style>'
        "<metadata>x</metadata>"
        "<text style=\"font: oblique bold 10px 'A', serif; fill: #123456\">t</text></svg>"
    )
    clean = ElementTree.fromstring(canonical(dirty, "DejaVu Sans"))
    (text,) = list(clean)
    assert text.attrib == {
        "font-style": "oblique",
        "font-weight": "bold",
        "font-size": "10px",
        "font-family": "DejaVu Sans",
        "fill": "#123456",
    }


def _path(data: str) -> str:
    svg = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"><path d="{data}"/></svg>'
    return next(iter(ElementTree.fromstring(canonical(svg, "A")))).attrib["d"]


def _vertices(data: str) -> list[tuple[float, float]]:
    """Points of a path of M, l and z, as a renderer adds them up."""
    here = start = (0.0, 0.0)
    found = []
    for command, numbers in re.findall(r"([Mlz])([^Mlz]*)", data):
        values = [float(each) for each in re.findall(r"-?(?:\d+\.?\d*|\.\d+)", numbers)]
        if command == "z":
            here = start
            continue
        x, y = values
        here = (x, y) if command == "M" else (here[0] + x, here[1] + y)
        start = here if command == "M" else start
        found.append(here)
    return found


POINTS = st.lists(st.tuples(st.floats(-2000.0, 2000.0), st.floats(-2000.0, 2000.0)), min_size=1, max_size=50)


@given(st.lists(POINTS, min_size=1, max_size=3))
def test_a_line_of_steps_is_the_same_line(lines: list[list[tuple[float, float]]]) -> None:
    parts = []
    for line in lines:
        (x, y), *rest = line
        parts += [f"M {x:.6f} {y:.6f}", *(f"L {a:.6f} {b:.6f}" for a, b in rest), "z"]
    shown = _vertices(_path(" \n".join(parts)))
    wanted = [point for line in lines for point in line]
    assert len(shown) == len(wanted)
    for point, place in zip(shown, wanted, strict=True):
        assert point == pytest.approx(place, abs=0.0051)


def test_curves_keep_their_commands() -> None:
    assert _path("M 0 0.123456 C 1.5 2 3 4.005 5 6 z") == "M 0 .12 C 1.5 2 3 4 5 6 z"


def test_every_series_has_a_color_and_a_line_style() -> None:
    assert len(SERIES) == len(LINE_STYLES) == len(set(SERIES)) == len(set(LINE_STYLES))
    assert all(1.05 / (_luminance(color) + 0.05) > 2.0 for color in SERIES)  # seen on white paper


def test_the_style_ends_with_its_block() -> None:
    import matplotlib

    before = dict(matplotlib.rcParams)
    with figure_style():
        assert matplotlib.rcParams["svg.fonttype"] == "none"
        new_figure(height=1.0)
    assert dict(matplotlib.rcParams) == before
