"""What a company prints on its reports: logo, names, document number and issue, read from a TOML file."""

import base64
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from wspd_design.design.requirements import check_keys
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import read_toml

ROLES = ("author", "reviewer", "approver")
"""Who signs, in this order."""

_TEXTS = ("organization", "document_number", "issue", *ROLES)
_LONGEST = 200  # characters of a text
_LARGEST = 500_000  # bytes of a logo, which every report carries
_PNG = b"\x89PNG\r\n\x1a\n"
_DATA = "data:"


@dataclass(frozen=True, slots=True, kw_only=True)
class Logo:
    """A picture as PNG or SVG."""

    format: str  # png or svg
    content: bytes

    @property
    def uri(self) -> str:
        """The picture as a data URI."""
        subtype = {"svg": "svg+xml"}.get(self.format, self.format)
        return f"{_DATA}image/{subtype};base64,{base64.b64encode(self.content).decode()}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Template:
    """What stands on a report beside its content; without a file all of it is left to be filled in by hand."""

    organization: str = ""
    document_number: str = ""
    issue: str = ""
    author: str = ""
    reviewer: str = ""
    approver: str = ""
    logo: Logo | None = None


BLANK = Template()


def read_template(path: str | Path) -> Template:
    """Read a template.

    Parameters
    ----------
    path : str or Path
        TOML file with any of ``organization``, ``document_number``, ``issue``, ``author``, ``reviewer``,
        ``approver`` and ``logo``, the path of a PNG or SVG file as seen from the folder of the template.

    Raises
    ------
    UserError
        If a file cannot be read, a key is unknown, a value is no text of one line, or the logo no picture.
    """
    path = Path(path)
    where = str(path)
    table = read_toml(path, where)
    check_keys(table, (*_TEXTS, "logo"), "", where)
    texts = {key: _text(table[key], key, where) for key in _TEXTS if key in table}
    return Template(**texts, logo=_logo(table, path.parent, where))


def template_text(template: Template) -> str:
    """Return a template as TOML with the logo in it: what :func:`read_template` reads without any other file."""
    written = [(key, getattr(template, key)) for key in _TEXTS]
    if template.logo is not None:
        written.append(("logo", template.logo.uri))
    return "".join(f"{key} = {_quoted(text)}\n" for key, text in written if text)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _text(value: Any, key: str, where: str) -> str:
    if not isinstance(value, str) or len(value) > _LONGEST or "\n" in value:
        raise UserError(
            f"{key} = {value!r:.80} in {where} must be a text of one line and at most {_LONGEST} characters"
        )
    return value.strip()


def _logo(table: dict[str, Any], folder: Path, where: str) -> Logo | None:
    if "logo" not in table:
        return None
    written = table["logo"]
    if not isinstance(written, str):
        raise UserError(f"logo = {written!r} in {where} must be the path of a PNG or SVG file")
    name = f'logo = "{written[:80]}" in {where}'
    try:
        if written.startswith(_DATA):
            content = base64.b64decode(written.partition(",")[2], validate=True)
        else:
            content = (folder / written).read_bytes()
    except (OSError, ValueError) as error:
        raise UserError(f"{name} cannot be read ({error}); check the path, as seen from that file") from None
    if len(content) > _LARGEST:
        raise UserError(
            f"{name} has {len(content)} bytes; at most {_LARGEST} are allowed, as every report carries it"
        )
    logo = Logo(format=_format(content, name), content=content)
    _check_that_it_can_be_set(logo, name)
    return logo


def _format(content: bytes, name: str) -> str:
    if content.startswith(_PNG):
        return "png"
    try:
        root = ElementTree.fromstring(content)
    except (ElementTree.ParseError, ValueError):
        root = None
    if root is None or root.tag.rpartition("}")[2] != "svg":
        raise UserError(f"{name} is neither PNG nor SVG; save it as one of them")
    return "svg"


def _check_that_it_can_be_set(logo: Logo, name: str) -> None:
    """Set the logo alone, so that a broken picture is told before minutes of work and not after them."""
    import typst

    source = f'#set page(height: auto)\n#image(bytes(json(bytes(sys.inputs.logo))), format: "{logo.format}")'
    try:
        typst.compile(
            source.encode(),
            format="pdf",
            sys_inputs={"logo": repr(list(logo.content))},
            ignore_system_fonts=True,
        )
    except typst.TypstError as error:
        raise UserError(f"{name} is damaged ({error}); save it anew as PNG") from None
