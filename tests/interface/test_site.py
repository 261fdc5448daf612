"""The documentation site: what is staged, that it is built without a warning, and that faults of it would be seen."""

import importlib.util
import inspect
import re
import subprocess
import sys
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path

import pytest

import wspd_design as wd
from docs.site import api, check, stage

ROOT = Path(__file__).parents[2]
SITE = ROOT / "docs" / "site"
CELL = re.compile(r"^```\{code-cell\}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CONFIGURED = re.compile(r"\A(?:---\n.*?^---\n|(?::\w+:[^\n]*\n)+)", re.MULTILINE | re.DOTALL)  # for its page
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.md"))


@dataclass(frozen=True, kw_only=True)
class Sample:
    """A record.

    Attributes
    ----------
    mass : float [kg]
        Of ``one`` body|bogie,
        complete.
    share : float [-]
    name : str or None

    Raises
    ------
    UserError
        Never.
    """

    mass: float
    share: float = 1.0
    name: str | None = None


def test_every_public_name_is_on_the_api_page():
    page = api.api_page()
    shown = set(re.findall(r"auto(?:class|function):: wspd_design\.(\w+)", page))
    assert {name for name in wd.__all__ if callable(getattr(wd, name))} - shown == set()
    assert "autofunction:: wspd_design.testing.assert_certified" in page


def test_attributes_become_a_table_with_units_and_defaults():
    rows = api.field_table(Sample).partition("meaning\n")[2]
    assert [re.sub(r"^ +(\* )?- ", "", line) for line in rows.splitlines()] == [
        *("``mass``", "``float``", "", "kg", "Of ``one`` body\\|bogie, complete."),
        *("``share``", "``float``", "``1.0``", "\\-", ""),
        *("``name``", "``str or None``", "``None``", "", ""),
    ]
    assert api.field_table(int) == ""
    left = api.without_attributes((inspect.getdoc(Sample) or "").splitlines())
    assert left == ["A record.", "", "Raises", "------", "UserError", "    Never."]
    assert api.without_attributes(["One line."]) == ["One line."]


def test_every_field_of_a_public_record_is_in_its_table():
    for name in wd.__all__:
        item = getattr(wd, name)
        if is_dataclass(item):
            stated = {each["name"] for each in api.attributes(inspect.getdoc(item) or "")}
            assert {field.name for field in fields(item)} - stated == set(), name


def test_a_staged_page_links_to_what_is_on_the_site(tmp_path):
    page = ROOT / "docs" / "theory.md"  # where it stands decides what its links mean
    text = page.read_text(encoding="utf-8")
    assert '<a id="band"></a>' in text
    assert "(band)=\n## " in stage.staged(page)
    readme = stage.staged(ROOT / "CONTRIBUTING.md")
    assert "(architecture.md)" in readme
    lost = tmp_path / "lost.md"
    lost.write_text("[none](nowhere.md)")
    with pytest.raises(FileNotFoundError, match=r"lost\.md links to nowhere\.md"):
        stage.staged(lost)
    lost.write_text("[a file](lost.md) and [a page](https://example.org)")
    assert stage.staged(lost) == "a file and [a page](https://example.org)"


def test_pages_that_no_list_names_stand_in_the_last_one():
    index = f"```{{toctree}}\n:hidden:\n\ntutorial\n```\n{stage.REST}\n"
    assert stage.with_rest(index, {"tutorial", "new", "index"}).endswith("```\nnew\n")
    with pytest.raises(ValueError, match="do not exist: tutorial"):
        stage.with_rest(index, {"new"})


def test_faults_of_a_site_are_seen(tmp_path):
    pages = {
        "index.html": '<a href="a.html#here">a</a> <a href="gone.html">b</a> <a href="https://example.org">c</a>',
        "a.html": '<p id="there"></p><script src="https://cdn.example.org/x.js"></script><img src="no.png">',
        "alone.html": '<a href="index.html">home</a>',
    }
    for name, text in pages.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "s.css").write_text('@import "https://fonts.example.org/x"; a { background: url(local.png) }')
    assert check.faults(tmp_path) == [
        "a.html: asks https://cdn.example.org/x.js",
        "a.html: no.png is missing",
        "a.html: no.png has no words for those who do not see it",
        "index.html: a.html#here names no place of that page",
        "index.html: gone.html leads nowhere",
        "alone.html: no page leads here",
        "s.css: asks https://fonts.example.org/x",
    ]


def built(tmp_path, *options):
    """Build the site, and return the pages and the cells of its notebooks."""
    command = [sys.executable, str(SITE / "build.py"), str(tmp_path / "site"), *options]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    pages = {path.stem for path in (tmp_path / "site").glob("*.html")}
    assert {path.stem for path in (ROOT / "docs").glob("*.md")} <= pages
    for path in NOTEBOOKS:
        page = (tmp_path / "site" / "notebooks" / f"{path.stem}.html").read_text(encoding="utf-8")
        yield page, cells(path)


def cells(path):
    return CELL.findall(path.read_text(encoding="utf-8"))


def draws(cell):
    return cell.endswith(";\n")


SPHINX = pytest.mark.skipif(
    importlib.util.find_spec("sphinx") is None, reason="the extra docs is not installed"
)


@pytest.mark.slow
@SPHINX
def test_the_site_is_built(tmp_path):
    for page, code in built(tmp_path, "--without-notebooks"):
        assert page.count('class="cell_input') == len(code) > 0


@pytest.mark.slow
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_the_cells_of_a_notebook_run(path, tmp_path, monkeypatch):
    """In this process, with few drawn stops and the first of the checks; each figure is drawn and has its words."""
    pyplot = pytest.importorskip("matplotlib.pyplot")
    monkeypatch.chdir(tmp_path)
    pyplot.switch_backend("agg")
    many, certify = wd.simulate_many, wd.certify
    monkeypatch.setattr(wd, "simulate_many", lambda *case, **given: many(*case, **{**given, "count": 8}))
    monkeypatch.setattr(
        wd, "certify", lambda *case, **given: certify(*case, **{**given, "only": given["only"][:1]})
    )
    space, plots = {}, 0
    for cell in cells(path):
        code = CONFIGURED.sub("", cell)
        assert not draws(cell) or "alt: >-" in cell
        exec(compile(code, str(path), "exec"), space)
        assert bool(pyplot.get_fignums()) == draws(cell)
        for number in pyplot.get_fignums():
            pyplot.figure(number).canvas.draw()
            plots += 1
        pyplot.close("all")
    assert plots > 0


# In CI: the site is built without them, and the cells run without Jupyter (the two above).
@pytest.mark.reference
@SPHINX
def test_the_site_is_built_and_its_notebooks_run(tmp_path):
    for page, code in built(tmp_path):
        assert page.count("<img") >= sum(map(draws, code)) > 0
