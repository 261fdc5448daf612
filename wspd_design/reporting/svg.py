"""SVG that can stand inside a page with a strict content security policy, next to other SVG.

Matplotlib writes ``style`` attributes, which such a policy refuses, a style sheet that would leak into the
page, and ids that collide as soon as two figures share a page.
"""

import re
from collections import Counter
from collections.abc import Mapping
from xml.etree import ElementTree

from wspd_design.reporting.text import printable

_SVG = "{http://www.w3.org/2000/svg}"
_XLINK_HREF = "{http://www.w3.org/1999/xlink}href"
_SCREEN_SCALE = 1.6  # CSS pixels per point: a fifth larger than on paper
_HUNDREDTHS = 100
_NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")
_COORDINATE = r"-?\d+(?:\.\d+)?(?:e-?\d+)?"
_VERTEX = re.compile(rf"([MLz])\s*(?:({_COORDINATE})\s+({_COORDINATE})\s*)?")
_POLYLINE = re.compile(rf"(?:[ML]\s*{_COORDINATE}\s+{_COORDINATE}\s*|z\s*)+")
_REFERENCE = re.compile(r"#([\w.-]+)")
_START = re.compile(r"M(-?[\d.]+) (-?[\d.]+)")
_EMPTY = "used elsewhere"
_PART = re.compile(r"(?P<kind>panel|curve|xtick|note)[-_](?P<number>\d+)")
_FONT = re.compile(r"(?:(italic|oblique) )?(?:(bold|\d00) )?([\d.]+px) (.+)")


def canonical(svg: str, font_family: str, data: str = "") -> str:
    """Turn Matplotlib's SVG into one with plain attributes, one font family and no metadata.

    Parameters
    ----------
    svg : str
        SVG document as Matplotlib writes it with ``svg.fonttype = "none"``.
    font_family : str
        Font family of all text.
    data : str
        What the script of a page is told about the figure, of :func:`wspd_design.reporting.figure_data.data`.

    Returns
    -------
    str
        SVG document without XML declaration.
    """
    root = ElementTree.fromstring(svg)
    for parent in root.iter():
        for child in list(parent):
            if (
                child.tag == f"{_SVG}style"
                or not child.tag.startswith(_SVG)
                or child.tag == f"{_SVG}metadata"
            ):
                parent.remove(child)
    for element in root.iter():
        if "d" in element.attrib:
            element.set("d", _path(element.attrib["d"]))
        for name, value in _declarations(element.attrib.pop("style", "")):
            element.set(name, value)
        if "font-family" in element.attrib:
            element.set("font-family", font_family)
        if reference := element.attrib.pop(_XLINK_HREF, ""):
            element.set("href", reference)
        if element.text:
            element.text = printable(element.text)
    _place_single_uses(root)
    if data:
        root.set("data-figure", printable(data))
        _mark_parts(root)
    _drop_unused_ids(root)
    # What Matplotlib says in the style sheet, for all elements.
    root.set("stroke-linejoin", "round")
    root.set("stroke-linecap", "butt")
    return _serialize(root)


def _place_single_uses(root: ElementTree.Element) -> None:
    """Draw a path where it is used if that is at one place: then its coordinates are those of the figure.

    Matplotlib writes collections of paths as definitions far outside the picture, moved by their use.
    """
    references = Counter(element.get("href") for element in root.iter(f"{_SVG}use"))
    paths = {f"#{path.get('id')}": path for path in root.iter(f"{_SVG}path") if path.get("id")}
    for use in root.iter(f"{_SVG}use"):
        path = paths.get(use.get("href", ""))
        if path is None or references[use.get("href")] > 1 or use.get("x") != "0":
            continue
        moved = _moved_down(path.attrib["d"], float(use.attrib["y"]))
        if moved is None:
            continue
        use.tag = f"{_SVG}path"
        for name in ("x", "y", "href"):
            use.attrib.pop(name)
        use.attrib = {**path.attrib, **use.attrib, "d": moved}
        use.attrib.pop("id")
        path.tag = _EMPTY
    for parent in root.iter():
        for child in [each for each in parent if each.tag == _EMPTY]:
            parent.remove(child)
        if len(parent) == 1 and parent[0].tag == f"{_SVG}path" and "clip-path" in parent.attrib:
            parent[0].set("clip-path", parent.attrib.pop("clip-path"))


def _moved_down(path: str, by: float) -> str | None:
    """Move a path as :func:`_path` writes it; None for any other, whose coordinates may all be absolute."""
    if re.search(r"[^Mlz\d\s.-]", path):
        return None
    return _START.sub(
        lambda start: f"M{start[1]} {_written(round(_HUNDREDTHS * (float(start[2]) + by)))}", path
    )


def _mark_parts(root: ElementTree.Element) -> None:
    """Name the parts of a figure that a script moves: panels, curves, ticks of x and notes at places of the data."""
    for element in root.iter():
        if part := _PART.fullmatch(element.get("id", "")):
            element.set(f"data-{part['kind']}", part["number"] if part["kind"] in ("panel", "curve") else "")


def _drop_unused_ids(root: ElementTree.Element) -> None:
    """Remove the ids that nothing refers to, a tenth of the file."""
    used = {
        name
        for element in root.iter()
        for value in element.attrib.values()
        for name in _REFERENCE.findall(value)
    }
    for element in root.iter():
        if element.get("id") not in used:
            element.attrib.pop("id", None)


def _path(data: str) -> str:
    """Write coordinates to hundredths of a point, finer than any printer; lines as steps, which are shorter.

    The steps add up to the rounded coordinates, so that no error grows along a line.
    """
    if not _POLYLINE.fullmatch(data):
        return _NUMBER.sub(lambda number: _written(round(_HUNDREDTHS * float(number[0]))), data)
    parts: list[str] = []
    here = start = (0, 0)
    for command, x, y in _VERTEX.findall(data):
        if command == "z":
            parts.append("z")
            here = start
            continue
        place = round(_HUNDREDTHS * float(x)), round(_HUNDREDTHS * float(y))
        if command == "M":
            parts.append(f"M{_written(place[0])} {_written(place[1])}")
            start = place
        else:
            step = _written(place[0] - here[0]), _written(place[1] - here[1])
            parts.append(f"l{step[0]}{'' if step[1].startswith('-') else ' '}{step[1]}")
        here = place
    return "".join(parts)


def _written(hundredths: int) -> str:
    """Write a number of hundredths as a short decimal, -50 as ``-.5``."""
    text = f"{abs(hundredths) / _HUNDREDTHS:.2f}".rstrip("0").rstrip(".")
    return ("-" if hundredths < 0 else "") + (text.removeprefix("0") or "0")


def _declarations(style: str) -> list[tuple[str, str]]:
    """Split a ``style`` attribute into presentation attributes; there is none for ``font``."""
    declarations = []
    for declaration in filter(None, style.split(";")):
        name, _, value = (part.strip() for part in declaration.partition(":"))
        if name == "font" and (font := _FONT.fullmatch(value)):
            names = ("font-style", "font-weight", "font-size", "font-family")
            declarations += [(key, part) for key, part in zip(names, font.groups(), strict=True) if part]
        else:
            declarations.append((name, value))
    return declarations


def inline(svg: str, prefix: str, colors: Mapping[str, str], label: str) -> str:
    """Prepare a canonical SVG for a place inside an HTML page.

    Parameters
    ----------
    svg : str
        What :func:`canonical` returned.
    prefix : str
        Put before every id, so that figures on the same page do not collide.
    colors : mapping of str to str
        CSS value for each hexadecimal color that has to follow the color scheme.
    label : str
        Alternative text.

    Returns
    -------
    str
        An ``<svg>`` element that scales with the page.
    """
    root = ElementTree.fromstring(svg)
    width, _ = size(svg)
    for element in root.iter():
        element.tag = element.tag.removeprefix(_SVG)
        for name, value in element.attrib.items():
            if name == "id":
                element.set(name, prefix + value)
            elif name == "href" and value.startswith("#"):
                element.set(name, f"#{prefix}{value[1:]}")
            else:
                element.set(name, colors.get(value.lower(), value.replace("url(#", f"url(#{prefix}")))
    for name in ("height", "version"):
        root.attrib.pop(name, None)
    root.set("width", f"{width * _SCREEN_SCALE:.0f}")
    root.set("role", "img")
    root.set("aria-label", label)
    return _serialize(root)


def size(svg: str) -> tuple[float, float]:
    """Return the width and height of an SVG document whose view box is in points [pt]."""
    _, _, width, height = ElementTree.fromstring(svg).attrib["viewBox"].split()
    return float(width), float(height)


def _serialize(root: ElementTree.Element) -> str:
    ElementTree.register_namespace("", _SVG.strip("{}"))
    return ElementTree.tostring(root, encoding="unicode")
