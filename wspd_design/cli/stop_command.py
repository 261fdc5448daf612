"""From the words of ``wspd report`` to those of ``wspd simulate`` for the same stop."""

import shlex
from collections.abc import Sequence

from wspd_design.cli.lazy import COMMANDS

_OF_FILES = ("output", "force")


def stop_command(words: Sequence[str]) -> str:
    """Return the command that simulates the stop of a report.

    Parameters
    ----------
    words : sequence of str
        Of the command line after ``wspd report``.

    Returns
    -------
    str
        ``wspd simulate`` with all of them but the options that only a report has, and those of its files.
    """
    known = {name for option in COMMANDS["simulate"].load("simulate").params for name in option.opts}
    foreign = {
        name: not getattr(option, "is_flag", False)  # whether a value follows
        for option in COMMANDS["report"].load("report").params
        if not known.issuperset(option.opts) or option.name in _OF_FILES
        for name in option.opts
    }
    kept: list[str] = []
    waiting = iter(words)
    for word in waiting:
        name, equals, _ = word.partition("=")
        short = word[:2]
        if name in foreign:
            if foreign[name] and not equals:
                next(waiting, None)
        elif not (foreign.get(short) and not word.startswith("--")):  # -oFILE
            kept.append(word)
    return shlex.join(["wspd", "simulate", *kept])
