"""Formulas as SVG for the HTML page, set by Typst and therefore the same as in the PDF."""

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from xml.etree import ElementTree

from wspd_design.reporting.blocks import Equation
from wspd_design.reporting.text import Math

_SVG = "{http://www.w3.org/2000/svg}"
_XLINK_HREF = "{http://www.w3.org/1999/xlink}href"
_LONG_NUMBER = re.compile(r"-?\d+\.\d{3,}")
_FONT_SIZE = 11.0  # pt
_MARKER = "#010203"
_SOURCE = f"""
#set page(width: auto, height: auto, margin: 0pt, fill: none)
#set text(size: {_FONT_SIZE}pt, top-edge: "bounds", bottom-edge: "bounds")
#for (number, formula) in json(bytes(sys.inputs.formulas)).enumerate() {{
  if number > 0 {{ pagebreak() }}
  // A dot too small to see, of a color that no formula has: it shows where the baseline is.
  if not formula.block {{ box(width: 0.001pt, height: 0.001pt, fill: rgb("{_MARKER}")) }}
  math.equation(eval(formula.source, mode: "math"), block: formula.block)
}}
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class FormulaImage:
    """One formula as an ``<svg>`` element that refers to shared glyphs, and its depth below the line."""

    svg: str
    depth: float  # em


@dataclass(frozen=True, slots=True, kw_only=True)
class FormulaSet:
    """All formulas of a page and the glyphs that they share."""

    images: dict[tuple[str, bool], FormulaImage]
    glyphs: str

    def image(self, formula: Math | Equation) -> FormulaImage:
        """Return the image of a formula of the page."""
        return self.images[_key(formula)]


def _key(formula: Math | Equation) -> tuple[str, bool]:
    return formula.source, isinstance(formula, Equation)


def typeset(formulas: Iterable[Math | Equation]) -> FormulaSet:
    """Typeset formulas, each different one once."""
    import typst

    keys = list(dict.fromkeys(map(_key, formulas)))
    if not keys:
        return FormulaSet(images={}, glyphs="")
    request = json.dumps([{"source": source, "block": block} for source, block in keys])
    pages = typst.compile(
        _SOURCE.encode(), format="svg", sys_inputs={"formulas": request}, ignore_system_fonts=True
    )
    glyphs: dict[str, str] = {}
    # One page comes as it is, several come as a list.
    images = [_image(page, glyphs) for page in ([pages] if isinstance(pages, bytes) else pages)]
    return FormulaSet(
        images=dict(zip(keys, images, strict=True)), glyphs="".join(glyphs[name] for name in sorted(glyphs))
    )


def _image(page: bytes, glyphs: dict[str, str]) -> FormulaImage:
    """Take one page of Typst's SVG apart: glyphs to the shared store, the rest into an image."""
    root = ElementTree.fromstring(page)
    _, _, width, height = map(float, root.attrib["viewBox"].split())
    depth = 0.0
    for parent in list(root.iter()):
        for child in list(parent):
            if child.get("fill") == _MARKER:
                baseline = parent.get("transform", "translate(0 0)").rstrip(")").split()[-1]
                depth = height - float(baseline)
                parent.remove(child)
            elif child.tag == f"{_SVG}defs":
                for symbol in child:
                    symbol.set("id", _short(symbol.attrib["id"]))
                    glyphs.setdefault(symbol.attrib["id"], _markup(symbol))
                parent.remove(child)
            elif child.tag == f"{_SVG}use":
                child.set(_XLINK_HREF, f"#{_short(child.attrib[_XLINK_HREF].removeprefix('#'))}")
                for place in ("x", "y"):
                    if child.get(place) == "0":
                        del child.attrib[place]
    _tidy(root)
    root.attrib.clear()
    root.set("viewBox", f"0 0 {width:.3f} {height:.3f}")
    root.set("width", f"{width / _FONT_SIZE:.3f}em")
    root.set("height", f"{height / _FONT_SIZE:.3f}em")
    root.set("aria-hidden", "true")
    root.set("fill", "currentColor")
    return FormulaImage(svg=_markup(root), depth=round(depth / _FONT_SIZE, 2))


def _short(name: str) -> str:
    """Shorten the name of a glyph, a hash: a page holds hundreds of formulas, and each of them names its glyphs."""
    return name[:10]


def _tidy(root: ElementTree.Element) -> None:
    """Drop groups without content or with one glyph, and digits of places that no one sees."""
    for parent in list(root.iter()):
        for child in list(parent):
            if child.tag == f"{_SVG}g" and not len(child):
                parent.remove(child)
            elif child.tag == f"{_SVG}g" and _holds_one_glyph(child):
                (glyph,) = child
                glyph.attrib |= child.attrib
                if glyph.get("fill") == "#000000":
                    del glyph.attrib["fill"]  # that of the image
                parent[list(parent).index(child)] = glyph
        if "transform" in parent.attrib:
            parent.set(
                "transform",
                _LONG_NUMBER.sub(lambda found: f"{float(found[0]):.2f}", parent.attrib["transform"]),
            )


def _holds_one_glyph(group: ElementTree.Element) -> bool:
    return len(group) == 1 and group[0].tag == f"{_SVG}use" and "transform" not in group[0].attrib


def _markup(root: ElementTree.Element) -> str:
    """Serialize without namespaces, as HTML has it, in the color of the text around."""
    for element in root.iter():
        element.tag = element.tag.removeprefix(_SVG)
        if reference := element.attrib.pop(_XLINK_HREF, ""):
            element.set("href", reference)
        for name in ("fill", "stroke"):
            if element.get(name) == "#000000":
                element.set(name, "currentColor")
        element.attrib.pop("fill-rule", None)
    return ElementTree.tostring(root, encoding="unicode")
