"""``wspd docs`` has every page that a sentence of the program cites, in a clone and in an installation."""

import re
from pathlib import Path

import pytest

from wspd_design.cli import pages
from wspd_design.cli.app import run
from wspd_design.parameters.errors import UserError

ROOT = Path(__file__).parents[2]
FILE = re.compile(r"docs/[a-z-]+\.md(?:#[a-z-]+)?")
COMMAND = re.compile(r"wspd docs ([a-z-]+(?:\.md)?(?:#[a-z-]+)?)")


def cited(folder=ROOT / "wspd_design"):
    """Pages and sections that the sources of the program name, by file or by command."""
    found = set()
    for path in (*folder.rglob("*.py"), *folder.rglob("*.toml")):
        text = path.read_text(encoding="utf-8")
        found |= {*FILE.findall(text), *COMMAND.findall(text)}
    return sorted(found)


@pytest.mark.parametrize("name", cited())
def test_what_sentences_cite_is_there(name):
    assert pages.page_text(name).startswith("#")


def test_sentences_do_cite_pages_and_sections():
    assert {"own-controller", "json", "docs/theory.md#band"} <= set(cited())


def test_every_page_is_listed_with_its_title(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "100")
    assert run(["docs"]) == 0
    out = capsys.readouterr().out
    assert "own-controller" in out
    assert "Your own controller" in out
    assert all(path.stem in out for path in (ROOT / "docs").glob("*.md"))


def test_a_section_ends_where_the_next_begins(capsys):
    assert run(["docs", "docs/own-controller.md#a-law-of-the-whole-vehicle"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("## A law of the whole vehicle\n")
    assert "fastest.py" in out
    assert "What disturbs a stop" not in out
    assert run(["docs", "theory#band"]) == 0
    out = capsys.readouterr().out
    assert "<a id" not in out
    assert out.count("\n## ") == 0


def test_a_comment_in_a_block_of_code_is_no_heading():
    lines = ["# Title", "```toml", "# mine.toml", "```", "## Next"]
    assert list(pages._headings(lines)) == [0, 4]


@pytest.mark.parametrize(
    ("page", "sentence"),
    [("own-controler", 'did you mean "own-controller"'), ("theory#bnd", 'did you mean "band"')],
)
def test_a_typo_gets_the_nearest(page, sentence, capsys):
    assert run(["docs", page]) == 2
    assert sentence in capsys.readouterr().err


def test_an_installation_without_pages_says_so(monkeypatch):
    monkeypatch.setattr(pages, "pages", dict)
    with pytest.raises(UserError, match="came without its pages"):
        pages.page_text("tutorial")
