"""The page of all commands: what ``wspd COMMAND --help`` prints, on a terminal of 88 columns."""

import io
import os
import re
from contextlib import redirect_stdout
from unittest.mock import patch

from wspd_design.cli.app import run
from wspd_design.cli.lazy import COMMANDS

_TERMINAL = {"COLUMNS": "88", "NO_COLOR": "1", "TERM": "dumb"}
_CONTROL = re.compile(r"\x1b\[[0-9;]*m")


def commands_page() -> str:
    """Return the page in Markdown."""
    parts = ["# Commands", "What `wspd COMMAND --help` prints. `wspd` alone starts the wizard."]
    for panel in dict.fromkeys(entry.panel for entry in COMMANDS.values()):
        parts.append(f"## {panel}")
        for name, entry in COMMANDS.items():
            if entry.panel == panel:
                parts += [f"### wspd {name}", f"```text\n{help_text(name)}\n```"]
    return "\n\n".join(parts) + "\n"


def help_text(name: str) -> str:
    """Return the help of a command."""
    out = io.StringIO()
    with patch.dict(os.environ, _TERMINAL), redirect_stdout(out):
        run([name, "--help"])
    lines = (line.rstrip() for line in _CONTROL.sub("", out.getvalue()).strip("\n").splitlines())
    return "\n".join(lines).strip("\n")
