"""``wspd doctor``: whether this machine has all that the program needs."""

import os
import platform
import re
import shutil
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, requires, version

import typer
from rich.text import Text

from wspd_design.cli.console import console, is_interactive, program_version, spaced, table
from wspd_design.cli.exit_codes import GOOD, REFUTED

COMPILERS = ("cc", "gcc", "clang", "cl")


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One thing that was looked at."""

    name: str
    found: str
    good: bool
    needed: bool = True
    remedy: str = ""


def doctor() -> None:
    """Look whether all that is needed is there: packages, fonts, folders, terminal.

    Exit code 0 when nothing that is needed is missing, else 1.
    """
    findings = examine()
    shown = table("", "What", "Found")
    for finding in findings:
        sign, style = ("✓", "green") if finding.good else ("✗", "red") if finding.needed else ("-", "yellow")
        found = Text(finding.found)
        if not finding.good:
            found.append(f"\n{finding.remedy}", style="italic")
        shown.add_row(Text(sign, style=style), finding.name, found)
    out = console()
    out.print(spaced(shown))
    missing = [finding.name for finding in findings if finding.needed and not finding.good]
    out.print(
        f"Missing: {', '.join(missing)}." if missing else "All that is needed is there.",
        style="bold red" if missing else "bold green",
    )
    raise typer.Exit(REFUTED if missing else GOOD)


def examine() -> list[Finding]:
    """Look at everything, one after the other."""
    return [
        Finding(name="wspd", found=program_version(), good=True),
        Finding(
            name="Python",
            found=platform.python_version(),
            good=sys.version_info >= (3, 11),
            remedy="Python 3.11 or newer is needed.",
        ),
        *map(_package, required_packages()),
        _typesetting(),
        _folder("temporary files", tempfile.gettempdir, "Set TMPDIR to a folder that can be written."),
        _folder("font cache", _font_cache, "Set MPLCONFIGDIR to a folder that can be written."),
        _compiler(),
        _terminal(),
    ]


def required_packages() -> list[str]:
    """Return what the installed program says it needs, without the tools for its development."""
    requirements = [text for text in requires("wspd-design") or () if "extra ==" not in text]
    return [re.split(r"[^\w.-]", text, maxsplit=1)[0] for text in requirements]


def _package(name: str) -> Finding:
    try:
        return Finding(name=name, found=version(name), good=True)
    except PackageNotFoundError:
        return Finding(name=name, found="not installed", good=False, remedy=f"pip install {name}")


def _typesetting() -> Finding:
    """Set one formula, which needs the fonts inside the typst package."""
    remedy = "The PDF report needs it: pip install --force-reinstall typst"
    try:
        import typst

        page: bytes = typst.compile(b"$ dot(lambda) = F + G T $")
    except Exception as error:  # whatever is wrong with a foreign package, it is the finding
        return Finding(
            name="typesetting", found=str(error) or type(error).__name__, good=False, remedy=remedy
        )
    return Finding(
        name="typesetting",
        found="a formula was set with the fonts of typst",
        good=page.startswith(b"%PDF"),
        remedy=remedy,
    )


def _folder(name: str, locate: Callable[[], str], remedy: str) -> Finding:
    try:
        folder = locate()
        with tempfile.TemporaryFile(dir=folder):
            pass
    except (OSError, ImportError) as error:
        return Finding(name=name, found=str(error), good=False, remedy=remedy)
    return Finding(name=name, found=folder, good=True)


def _font_cache() -> str:
    import matplotlib

    return str(matplotlib.get_cachedir())


def _compiler() -> Finding:
    environment = os.environ.get("CC")
    found = next(filter(None, map(shutil.which, filter(None, (environment, *COMPILERS)))), None)
    return Finding(
        name="C compiler",
        found=found or "none",
        good=found is not None,
        needed=False,
        remedy="This version computes without one; a later one compiles the closed loop.",
    )


def _terminal() -> Finding:
    columns = shutil.get_terminal_size().columns
    found = f"{columns} columns, {sys.stdout.encoding}, TERM={os.environ.get('TERM', '')}"
    return Finding(
        name="terminal",
        found=found,
        good=is_interactive(),
        needed=False,
        remedy='None: the wizard cannot ask here; "wspd new --yes" takes all defaults.',
    )
