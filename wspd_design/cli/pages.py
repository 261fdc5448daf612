"""The pages of documentation that come with the program: beside the package in a clone, under share/doc elsewhere."""

import re
from collections.abc import Mapping
from importlib.metadata import files as installed_files
from importlib.resources import files
from pathlib import Path

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.words import did_you_mean

_INSTALLED = ("share", "doc", "wspd-design")
_ANCHOR = re.compile(r'<a id="(?P<id>[^"]+)"></a>')
_HEADING = re.compile(r"^(?P<level>#+) (?P<title>.+)$")
_FENCE = "```"


def pages() -> Mapping[str, Path]:
    """Return the file of every page by its name, sorted."""
    root = Path(str(files("wspd_design"))).parent
    clone = [*(root / "docs").glob("*.md"), root / "CHANGELOG.md"]
    # A folder of this name may lie beside any installed package; that of a clone lies beside its project file.
    found = clone if (root / "pyproject.toml").is_file() else _installed()
    return {path.stem.lower(): path for path in sorted(found, key=lambda path: path.stem.lower())}


def _installed() -> list[Path]:
    return [
        Path(str(file.locate()))
        for file in installed_files("wspd-design") or ()
        if file.parts[-4:-1] == _INSTALLED and file.suffix == ".md"
    ]


def page_text(cited: str) -> str:
    """Return a page, or a section of it, as sentences cite it.

    Parameters
    ----------
    cited : str
        ``own-controller``, ``docs/own-controller.md`` or, for a section, ``theory#band``.

    Raises
    ------
    UserError
        If there is no such page or section.
    """
    name, _, section = cited.removeprefix("docs/").partition("#")
    name = name.removesuffix(".md")
    found = pages()
    if not found:
        raise UserError("this installation came without its pages; install wspd-design again with pip")
    if name not in found:
        raise UserError(
            f'there is no page "{name}"{did_you_mean(name, list(found))}; pages: {", ".join(found)}'
        )
    text = found[name].read_text(encoding="utf-8")
    return _section(text, section, name) if section else _ANCHOR.sub("", text)


def title(path: Path) -> str:
    """Return the title of a page."""
    headings = _headings(path.read_text(encoding="utf-8").splitlines())
    return next((found["title"] for found in headings.values()), path.stem)


def _section(text: str, wanted: str, name: str) -> str:
    """Return a section by its anchor or by its heading as links spell it, with all below it."""
    lines = text.splitlines()
    headings = _headings(lines)
    names = {_link(heading["title"]): line for line, heading in headings.items()}
    if wanted not in names:
        raise UserError(
            f'{name} has no section "{wanted}"{did_you_mean(wanted, list(names))}; '
            f"sections: {', '.join(names)}"
        )
    first = names[wanted]
    level = len(headings[first]["level"])
    after = (line for line, each in headings.items() if line > first and len(each["level"]) <= level)
    return _ANCHOR.sub("", "\n".join(lines[first : next(after, None)])) + "\n"


def _headings(lines: list[str]) -> dict[int, re.Match[str]]:
    """Return the headings by the number of their line; a comment in a block of code is none."""
    found, in_block = {}, False
    for number, line in enumerate(lines):
        in_block ^= line.lstrip().startswith(_FENCE)
        heading = _HEADING.match(line)
        if heading and not in_block:
            found[number] = heading
    return found


def _link(heading: str) -> str:
    anchor = _ANCHOR.search(heading)
    return anchor["id"] if anchor else re.sub(r"[^\w -]", "", heading).strip().lower().replace(" ", "-")
