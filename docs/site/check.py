"""What is wrong with a built site: links that lead nowhere, pages that none leads to, requests to other hosts, pictures
without words.
"""

import re
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit

_LOADS = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src", "video": "src"}
_STYLE_LOADS = re.compile(r"(?:url\(\s*['\"]?|@import\s+['\"])(?P<place>(?:https?:)?//[^'\")]+)")
_OWN_PAGES = ("search.html", "genindex.html", "py-modindex.html")
_POINTED_AT = ("canonical", "license")  # kinds of <link> that load nothing


class _Page(HTMLParser):
    """What a page links to, what it loads, and the targets that it has."""

    def __init__(self) -> None:
        super().__init__()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.targets: set[str] = {""}
        self.silent: list[str] = []  # pictures without a description of their own

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take what counts of a tag."""
        found = {name: value or "" for name, value in attrs}
        self.targets |= {found[name] for name in ("id", "name") if name in found}
        if tag == "a" and "href" in found:
            self.links.append(found["href"])
        if tag == "img" and (not found.get("alt") or found["alt"].endswith(found["src"].rpartition("/")[2])):
            self.silent.append(found["src"])
        if tag in _LOADS and _LOADS[tag] in found and found.get("rel") not in _POINTED_AT:
            self.loads.append(found[_LOADS[tag]])


def faults(site: Path) -> list[str]:
    """Return one line for each fault of the site in a folder."""
    pages = {path: _read(path) for path in sorted(site.rglob("*.html"))}
    found = [fault for path, page in pages.items() for fault in _faults(path, page, pages, site)]
    reached = {_target(path, link)[0] for path, page in pages.items() for link in page.links}
    found += [
        f"{path.relative_to(site)}: no page leads here"
        for path in pages
        if path not in reached and path.name not in _OWN_PAGES
    ]
    for style in sorted(site.rglob("*.css")):
        for load in _STYLE_LOADS.finditer(style.read_text(encoding="utf-8")):
            found.append(f"{style.relative_to(site)}: asks {load['place']}")
    return found


def _faults(path: Path, page: _Page, pages: dict[Path, _Page], site: Path) -> list[str]:
    name, found = path.relative_to(site), []
    for load in page.loads:
        if urlsplit(load).netloc:
            found.append(f"{name}: asks {load}")
        elif not load.startswith("data:") and not _target(path, load)[0].exists():
            found.append(f"{name}: {load} is missing")
    found += [f"{name}: {picture} has no words for those who do not see it" for picture in page.silent]
    for link in page.links:
        if urlsplit(link).scheme or urlsplit(link).netloc:
            continue
        target, anchor = _target(path, link)
        if not target.exists():
            found.append(f"{name}: {link} leads nowhere")
        elif target in pages and anchor not in pages[target].targets:
            found.append(f"{name}: {link} names no place of that page")
    return found


def _target(path: Path, link: str) -> tuple[Path, str]:
    place, anchor = urldefrag(link)
    plain = unquote(urlsplit(place).path)
    return ((path.parent / plain).resolve() if plain else path), unquote(anchor)


def _read(path: Path) -> _Page:
    page = _Page()
    page.feed(path.read_text(encoding="utf-8"))
    return page
