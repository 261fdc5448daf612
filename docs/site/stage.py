"""What Sphinx reads: the pages of ``docs/``, notebooks as they are, and pages that are made.

A page that is added to ``docs/`` needs nothing else: where no list of ``index.md`` names it, it stands in the last one.
"""

import re
import shutil
from pathlib import Path

from docs.site.api import api_page
from docs.site.commands import commands_page

SITE = Path(__file__).parent
DOCS = SITE.parent
ROOT = DOCS.parent

NOTEBOOKS = "notebooks"
FROM_ROOT = ("CHANGELOG.md", "CONTRIBUTING.md")
REST = "<!-- pages that no list names -->"
NOT_LINKED = "(?!https?:|mailto:|#)"
_ANCHOR = re.compile(r'^(?P<level>#+) <a id="(?P<id>[^"]+)"></a>(?P<title>.*)$', re.MULTILINE)
_LINK = re.compile(rf"\[(?P<text>[^\]]*)\]\(\s*{NOT_LINKED}(?P<path>[^)#\s]+)(?P<anchor>#[^)\s]*)?\)")
_COMMENT = re.compile(r"^<!-- (?:end|[a-z_]+) -->\n", re.MULTILINE)
_LISTED = re.compile(r"^```\{toctree\}\n(?P<body>.*?)^```$", re.MULTILINE | re.DOTALL)


def stage(folder: Path) -> None:
    """Write everything that Sphinx reads into a folder, which is made anew."""
    if folder.exists():
        shutil.rmtree(folder)
    folder.mkdir(parents=True)
    for path in pages():
        (folder / path.name).write_text(staged(path), encoding="utf-8")
    shutil.copytree(DOCS / NOTEBOOKS, folder / NOTEBOOKS)
    (folder / "api.md").write_text(api_page(), encoding="utf-8")
    (folder / "commands.md").write_text(commands_page(), encoding="utf-8")
    made = {path.relative_to(folder).with_suffix("").as_posix() for path in folder.rglob("*.md")}
    index = (SITE / "index.md").read_text(encoding="utf-8")
    (folder / "index.md").write_text(with_rest(index, made), encoding="utf-8")


def pages() -> list[Path]:
    """Return the files of all pages that are written by hand or by ``make derive``."""
    return [*sorted(DOCS.glob("*.md")), *(ROOT / name for name in FROM_ROOT)]


def staged(path: Path) -> str:
    """Return a page as Sphinx reads it: targets in place of HTML anchors, links only to what is on the site."""
    text = _ANCHOR.sub(r"(\g<id>)=\n\g<level> \g<title>", path.read_text(encoding="utf-8"))
    text = _COMMENT.sub("", text)
    return _LINK.sub(lambda link: _link(link, path), text)


def _link(link: re.Match[str], page: Path) -> str:
    target = (page.parent / link["path"]).resolve()
    if target in {each.resolve() for each in pages()}:
        return f"[{link['text']}]({target.name}{link['anchor'] or ''})"
    if target.is_relative_to(DOCS / NOTEBOOKS) and target.exists():
        return link[0]
    if not target.exists():
        raise FileNotFoundError(f"{page.name} links to {link['path']}, which does not exist")
    return link["text"]  # a file of the repository, which is not on the site


def with_rest(index: str, pages: set[str]) -> str:
    """Put the pages that no list names into the last one.

    Raises
    ------
    ValueError
        If a list names a page that does not exist, or the last list is missing.
    """
    listed = {line for body in _LISTED.findall(index) for line in body.splitlines() if line[:1].isalpha()}
    if listed - pages:
        raise ValueError(f"index.md lists pages that do not exist: {', '.join(sorted(listed - pages))}")
    if REST not in index:
        raise ValueError(f"index.md has no place for the other pages: {REST}")
    rest = sorted(pages - listed - {"index"})
    return index.replace(REST, "\n".join(rest))
