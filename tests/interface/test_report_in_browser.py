"""The HTML of a report in Chromium, as a reader with a mouse, a keyboard, a phone or a screen reader meets it.

Without the Debian package ``chromium`` all of this is skipped, and without ``axe-core`` of npm the check of
accessibility; ``.ci/run`` installs both.
"""

import csv
import io
import os
import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from tests.unit.reporting.sample_report import sample
from wspd_design.reporting.blocks import Attachment, Figure, KeyNumbers, Paragraph
from wspd_design.reporting.html import render_html
from wspd_design.reporting.text import rich

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
AXE = (
    Path(os.environ.get("NODE_MODULES", Path.home() / ".cache/wspd-tests/node_modules"))
    / "axe-core/axe.min.js"
)
WIDTHS = (390, 768, 1024, 1440)  # px
NAME = "w" * 400 + " \u202elive \u05e9\u05dc\u05d5\u05dd \u673a\u8f66 \U0001f600"

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium: apt-get install chromium")


@pytest.fixture(scope="module")
def browser():
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture(scope="module")
def html():
    document = sample()
    drawn = next(each for each in document.blocks if isinstance(each, Figure))
    traces = Attachment(
        name="stop.csv", media_type="text/csv", content="time,slip\n0,0.1\n", description="the traces"
    )
    blocks = tuple(replace(each, data="stop.csv") if each is drawn else each for each in document.blocks)
    return render_html(replace(document, blocks=blocks, attachments=(*document.attachments, traces)))


@pytest.fixture
def page(browser: Browser, html: str):
    """A page that may neither complain nor ask for anything."""
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    opened = context.new_page()
    said: list[str] = []
    opened.on("console", lambda message: said.append(message.text))
    opened.on("pageerror", lambda error: said.append(str(error)))
    opened.on("request", lambda request: said.append(request.url) if request.url != "about:blank" else None)
    opened.set_content(html)
    yield opened
    context.close()
    assert said == []


def open_at(browser: Browser, text: str, width: int, **options: object) -> Page:
    opened = browser.new_context(viewport={"width": width, "height": 844}, **options).new_page()
    opened.set_content(text)
    return opened


def reading(page: Page) -> dict[str, list[str]]:
    """What stands at the cursor of the first figure, by line."""
    rows = page.locator("#slip-figure .tools tr").evaluate_all(
        "rows => rows.map(row => [...row.cells].map(cell => cell.textContent))"
    )
    return {row[0]: row[1:] for row in rows}


def ticks(page: Page) -> list[float]:
    return [float(text) for text in page.locator("#slip-figure .ticks text").all_text_contents()]


# Layout


@pytest.mark.parametrize("width", WIDTHS)
def test_the_verdict_stands_above_the_contents(browser: Browser, html: str, width: int) -> None:
    page = open_at(browser, html, width)
    verdict, contents = (page.locator(each).bounding_box() for each in ("header .verdict", "nav"))
    assert verdict is not None
    assert contents is not None
    assert verdict["y"] < 400
    beside = contents["x"] + contents["width"] <= verdict["x"]
    assert beside or verdict["y"] + verdict["height"] <= contents["y"]
    page.context.close()


@pytest.mark.parametrize("width", WIDTHS)
def test_no_name_makes_the_page_wider_than_the_window(browser: Browser, width: int) -> None:
    document = sample()
    wide = rich(f"${' + '.join(['lambda'] * 40)}$")
    blocks = (Paragraph(text=NAME), Paragraph(text=wide), *document.blocks)
    page = open_at(browser, render_html(replace(document, title=NAME, subtitle=NAME, blocks=blocks)), width)
    assert page.evaluate("document.documentElement.scrollWidth") == width
    shown = page.locator("h1").inner_text()
    assert "[U+202E]live" in shown
    assert "\u673a\u8f66 \U0001f600" in shown
    page.context.close()


def test_key_numbers_stand_on_one_line_whatever_their_labels(browser: Browser) -> None:
    document = sample()
    tiles = next(each for each in document.summary if isinstance(each, KeyNumbers))
    long = replace(tiles.numbers[1], label="A label of so many words that it takes two lines or more")
    tiles = replace(tiles, numbers=(tiles.numbers[0], long, *tiles.numbers[2:]))
    page = open_at(browser, render_html(replace(document, summary=(tiles, *document.summary[1:]))), 1280)
    tops = page.locator(".key-numbers .value").evaluate_all(
        "all => all.map(each => each.getBoundingClientRect().y)"
    )
    assert len(tops) == 4
    assert max(tops) - min(tops) < 1.0
    page.context.close()


def test_no_caption_is_cut_on_a_phone(browser: Browser, html: str) -> None:
    page = open_at(browser, html, 390)
    boxes = page.locator("figcaption").evaluate_all(
        "captions => captions.map(each => [each.getBoundingClientRect().right, each.scrollWidth - each.clientWidth, "
        "each.closest('.scroll') === null])"
    )
    assert len(boxes) == 4
    assert all(right <= 390 and beyond <= 0 and outside for right, beyond, outside in boxes)
    page.context.close()


def test_the_page_is_read_without_its_script(browser: Browser, html: str) -> None:
    page = open_at(browser, html, 1280, java_script_enabled=False)
    for shown in ("Slip and torque of the four axles", "variant 59", "Provenance", "er24pc-wet.toml"):
        assert page.get_by_text(shown, exact=False).first.is_visible()
    assert page.locator("button").count() == 0
    page.context.close()


def test_a_script_that_is_not_its_own_does_not_run(browser: Browser, html: str) -> None:
    context = browser.new_context()
    page, said = context.new_page(), []
    page.on("console", lambda message: said.append(message.text))
    page.set_content(html.replace("</main>", "</main><script>document.title = 'planted'</script>"))
    assert page.title() != "planted"
    assert any("Content Security Policy" in each for each in said)
    context.close()


# Figures


def test_keys_move_the_cursor_and_the_readings_are_those_of_the_data(page: Page) -> None:
    page.locator("#slip-figure .picture").focus()
    for _ in range(5):
        page.keyboard.press("Shift+ArrowRight")
    told = reading(page)  # the axis goes from -0.5 to 10.5 s: half of it is 5 s
    assert told["time [s] 5.0"] == [r"slip $\lambda$ [-]"]
    for axle in range(1, 8):  # exp(-t / axle), drawn to hundredths of a point
        assert float(told[f"axle {axle}"][0]) == pytest.approx(2.718281828 ** (-5.0 / axle), abs=0.006)
    page.keyboard.press("ArrowLeft")
    assert "time [s] 4.9" in reading(page)


def test_the_cursor_stands_in_all_panels_and_in_the_other_figure(page: Page) -> None:
    box = page.locator("#slip-figure [data-panel='0']").bounding_box()
    assert box is not None
    page.locator("#slip-figure").scroll_into_view_if_needed()
    box = page.locator("#slip-figure svg[data-figure]").bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 3)
    drawn = page.locator(".cursor").evaluate_all(
        "lines => lines.map(line => line.getAttribute('d').split(' ')[0])"
    )
    assert len(drawn) == 4
    assert len(set(drawn)) == 1
    assert drawn[0].startswith("M")


def test_zoom_by_keys_and_by_mouse_moves_curves_and_ticks_together(page: Page) -> None:
    curve = page.locator("#slip-figure [data-curve='2'] path").first
    before = curve.get_attribute("d")
    page.locator("#slip-figure .picture").focus()
    page.keyboard.press("+")
    near = ticks(page)
    assert near == [3.0, 4.0, 5.0, 6.0, 7.0]
    assert curve.get_attribute("d") != before
    page.keyboard.press("Escape")
    assert page.locator("#slip-figure .ticks").count() == 0
    page.locator("#slip-figure").scroll_into_view_if_needed()
    box = page.locator("#slip-figure svg[data-figure]").bounding_box()
    assert box is not None
    middle, height = box["x"] + box["width"] / 2, box["y"] + box["height"] / 3
    page.mouse.move(middle, height)
    page.mouse.down()
    page.mouse.move(middle + box["width"] / 10, height)
    page.mouse.up()
    assert min(ticks(page)) >= 4.0
    assert max(ticks(page)) <= 7.0
    assert page.locator(".ticks").count() == 4  # the other figure shows the same
    page.locator("#slip-figure").get_by_role("button", name="Whole").click()
    assert page.locator(".ticks").count() == 0
    # The curve is where it was, to the hundredth of a point.
    numbers = [re.findall(r"[\d.]+", each or "")[:2] for each in (before, curve.get_attribute("d"))]
    assert numbers[0] == numbers[1]


def test_the_reading_is_the_same_when_zoomed(page: Page) -> None:
    page.locator("#slip-figure .picture").focus()
    for _ in range(5):
        page.keyboard.press("Shift+ArrowRight")
    before = reading(page)
    page.keyboard.press("+")
    page.keyboard.press("+")
    assert reading(page) == before


def test_the_legend_hides_a_line(page: Page) -> None:
    line = page.locator("#slip-figure [data-curve='1'] path").first
    toggle = page.locator("#slip-figure").get_by_role("button", name="axle 2")
    assert line.is_visible()
    toggle.press("Enter")
    assert toggle.get_attribute("aria-pressed") == "false"
    assert not line.is_visible()
    toggle.click()
    assert line.is_visible()


def test_a_figure_leads_to_the_file_of_its_numbers(page: Page) -> None:
    with page.expect_download() as download:
        page.locator("#slip-figure figcaption").get_by_role("link", name="stop.csv").click()
    assert download.value.suggested_filename == "stop.csv"
    assert Path(download.value.path()).read_text() == "time,slip\n0,0.1\n"


# Tables


def column(page: Page, place: int) -> list[str]:
    return page.locator(f"#stops tbody td:nth-child({place})").all_text_contents()


def test_a_column_is_sorted_by_its_numbers_and_back(page: Page) -> None:
    whole = column(page, 2)
    button = page.locator("#stops th").nth(1).get_by_role("button")
    head = page.locator("#stops th").nth(1)
    button.press("Enter")
    assert (column(page, 2), head.get_attribute("aria-sort")) == (sorted(whole, key=float), "ascending")
    button.click()
    assert (column(page, 2), head.get_attribute("aria-sort")) == (
        sorted(whole, key=float)[::-1],
        "descending",
    )
    page.locator("#stops th").nth(0).get_by_role("button").click()
    assert head.get_attribute("aria-sort") is None
    names = page.locator("#stops th").nth(0).get_by_role("button")
    names.click()
    names.click()
    assert column(page, 2) == whole


def test_a_table_is_saved_as_csv(page: Page) -> None:
    with page.expect_download() as download:
        page.locator("#checks").get_by_role("button", name="CSV").click()
    assert download.value.suggested_filename == "Table 1.csv"
    rows = list(csv.reader(io.StringIO(Path(download.value.path()).read_text())))
    assert rows[0] == ["id", "Claim", "Value 1/s", "Limit 1/s", "Result"]
    assert len(rows) == page.locator("#checks tr").count()
    assert rows[1][2:] == ["1.37", "1.67", "proved"]


# Accessibility


@pytest.mark.skipif(not AXE.exists(), reason=f"no axe-core in {AXE.parent}: npm install axe-core")
@pytest.mark.parametrize(
    ("width", "scheme"),
    [pytest.param(1280, "light", marks=pytest.mark.reference), (1280, "dark"), (390, "light")],
)
def test_axe_finds_nothing(browser: Browser, html: str, width: int, scheme: str) -> None:
    page = open_at(browser, html, width, color_scheme=scheme, bypass_csp=True)
    page.locator("#slip-figure .picture").press("ArrowRight")  # the reading is judged with the rest
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run()")
    assert [(each["id"], each["nodes"][0]["html"][:200]) for each in found["violations"]] == []
    assert len(found["passes"]) > 20
    page.context.close()


@pytest.mark.skipif(not AXE.exists(), reason=f"no axe-core in {AXE.parent}: npm install axe-core")
def test_axe_sees_a_planted_fault(browser: Browser, html: str) -> None:
    planted = html.replace("<body>", "<body><img src='data:image/png;base64,AA=='>")
    page = open_at(browser, planted, 1280, bypass_csp=True)
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run({ runOnly: ['image-alt'] })")
    assert [each["id"] for each in found["violations"]] == ["image-alt"]
    page.context.close()
