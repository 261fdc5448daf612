"""SVG that can stand inside a page with a strict content security policy, next to other SVG.

Matplotlib writes ``style`` attributes, which such a policy refuses, a style sheet that would leak into the
page, and ids that collide as soon as two figures share a page.
"""

import re
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
_FONT = re.compile(r"(?:(italic|oblique) )?(?:(bold|\d00) )?([\d.]+px) (.+)")


def canonical(svg: str, font_family: str) -> str:
    """Turn Matplotlib's SVG into one with plain attributes, one font family and no metadata.

    Parameters
    ----------
    svg : str
        SVG document as Matplotlib writes it with ``svg.fonttype = "none"``.
    font_family : str
        Font family of all text.

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
    _drop_unused_ids(root)
    # What Matplotlib says in the style sheet, for all elements.
    root.set("stroke-linejoin", "round")
    root.set("stroke-linecap", "butt")
    return _serialize(root)


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
