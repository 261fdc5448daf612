"""SVG that can stand inside a page with a strict content security policy, next to other SVG.

Matplotlib writes ``style`` attributes, which such a policy refuses, a style sheet that would leak into the
page, and ids that collide as soon as two figures share a page.
"""

import re
from collections.abc import Mapping
from xml.etree import ElementTree

_SVG = "{http://www.w3.org/2000/svg}"
_XLINK_HREF = "{http://www.w3.org/1999/xlink}href"
_SCREEN_SCALE = 1.6  # CSS pixels per point: a fifth larger than on paper
_NUMBER = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")
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
            element.set("d", _NUMBER.sub(_rounded, element.attrib["d"]))
        for name, value in _declarations(element.attrib.pop("style", "")):
            element.set(name, value)
        if "font-family" in element.attrib:
            element.set("font-family", font_family)
        if reference := element.attrib.pop(_XLINK_HREF, ""):
            element.set("href", reference)
    # What Matplotlib says in the style sheet, for all elements.
    root.set("stroke-linejoin", "round")
    root.set("stroke-linecap", "butt")
    return _serialize(root)


def _rounded(number: re.Match[str]) -> str:
    """Write a coordinate to hundredths of a point, finer than any printer, which halves the file."""
    return f"{float(number[0]):.2f}".rstrip("0").rstrip(".")


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
