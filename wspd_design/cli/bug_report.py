"""What a bug report needs to know about an installation, without anything that is private to its user."""

import os
import platform
import re
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, distribution

from wspd_design.exchange.version import program_version
from wspd_design.studies.package import is_changed, package

# With the option of a compiler that it may stand behind, as in -I/home/me.
_PATH = re.compile(r"(?:-\w+|(?<![\w.])(?:[A-Za-z]:)?)(?:[\\/][^\s\\/:;,'\"()\[\]]+)+[\\/]?")
HIDDEN = "(path)"
NOTE = "Paths are hidden; names of users, machines, designs and vehicles are not in it."


def bug_report(findings: Iterable[tuple[str, str]]) -> str:
    """Return a text to paste into a bug report.

    Parameters
    ----------
    findings : iterable of (str, str)
        What was looked at, and what was found there.
    """
    known = package()
    changed = "changed since the last commit" if is_changed() else "as built or committed"
    rows = [
        ("wspd-design", f"{program_version()}, {_installed()}"),
        ("package SHA-256", known.sha256),
        ("package tree", f"{known.tree}, {changed}"),
        ("platform", platform.platform()),
        ("Python", f"{platform.python_implementation()} {platform.python_version()}"),
        *((name, found) for name, found in findings if name not in ("wspd", "Python")),
    ]
    width = max(len(name) for name, _ in rows)
    lines = [f"{name:<{width}}  {without_paths(' '.join(found.split()))}" for name, found in rows]
    return "\n".join((*lines, "", NOTE, ""))


def without_paths(text: str) -> str:
    """Return a text with every path of a file or folder hidden."""
    # The paths that the environment names may have spaces in them; the rest of such a path has none.
    for known in sorted(filter(os.path.isabs, os.environ.values()), key=len, reverse=True):
        text = text.replace(known, "/hidden") if len(known) > 1 else text
    return _PATH.sub(HIDDEN, text)


def _installed() -> str:
    try:
        found = distribution("wspd-design")
    except PackageNotFoundError:
        return "not installed"
    source = found.read_text("direct_url.json") or ""
    if '"editable": true' in source:
        return "editable installation"
    return "installed from a file or folder" if source else "installed from an index"
