"""The Typer application and the one place where errors become exit codes."""

import errno
import os
import signal
import sys
import traceback
from collections.abc import Sequence
from typing import Annotated

import typer

from wspd_design.cli.exit_codes import BUG, INTERRUPTED, WRONG_USE
from wspd_design.cli.lazy import COMMANDS, LazyGroup
from wspd_design.cli.notices import plain_notices
from wspd_design.parameters.errors import UserError

# Newer versions of Typer carry their own copy of Click; the parent of this class is the usage error of either.
_USAGE_ERROR: type[Exception] = typer.BadParameter.__bases__[0]

app = typer.Typer(
    name="wspd",
    cls=LazyGroup,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _show_version(wanted: bool) -> None:
    if wanted:
        from wspd_design.exchange.version import program_version

        print(f"wspd {program_version()}")
        raise typer.Exit


@app.callback(
    invoke_without_command=True,
    epilog="Without a command the wizard starts. Exit codes: 0 good, 1 a check refuted, 2 wrong use, "
    "3 undecided, 130 interrupted.",
)
def _start(
    context: typer.Context,
    _version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version.")
    ] = False,
) -> None:
    """Design, prove and validate controllers for railway wheel slide protection."""
    if context.invoked_subcommand is None:
        from wspd_design.cli.commands import new

        new.design()


def run(arguments: Sequence[str]) -> int:
    """Run one command line and return its exit code.

    Parameters
    ----------
    arguments : sequence of str
        What follows ``wspd``.

    Returns
    -------
    int
        0 good, 1 a check refuted, 2 wrong use, 3 undecided, 130 interrupted, 70 a fault of the program.
    """
    try:
        with plain_notices():
            code = app(list(arguments), prog_name="wspd", standalone_mode=False)
    except UserError as error:
        return _refuse(str(error))
    except _USAGE_ERROR as error:
        return _refuse(_usage_sentence(error, arguments))
    except (KeyboardInterrupt, typer.Abort):
        return INTERRUPTED
    except Exception as error:
        from wspd_design.design.own_controller import fault_in_own_file

        fault = fault_in_own_file(error)
        if fault is not None:
            return _refuse(fault)
        if isinstance(error, OSError) and error.errno == errno.ENOSPC and error.filename is None:
            return _full_disk()  # the standard output stands on it; files have sentences of their own
        traceback.print_exc()
        print(
            "wspd: this is a fault of the program; please report it with the lines above and what "
            '"wspd doctor --report" prints.',
            file=sys.stderr,
        )
        return BUG
    return code if isinstance(code, int) else 0


def main() -> None:
    """Entry point of the console script ``wspd``."""
    if hasattr(signal, "SIGPIPE"):  # end silently, as other filters do, when the reader of a pipe is gone
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # a terminal without Unicode loses a sign, not the answer
    # Matrices are small here: threads of linear algebra would only wait for each other. NumPy reads this when it loads.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    code = run(sys.argv[1:])
    try:
        sys.stdout.flush()
    except OSError as error:
        if error.errno != errno.ENOSPC:
            raise
        code = _full_disk()
    sys.exit(code)


def _full_disk() -> int:
    """Say that the output could not be written, once: what is still in the buffer goes nowhere."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return _refuse("the output cannot be written (no space left on device); free some or send it elsewhere")


def _refuse(message: str) -> int:
    sentence = " ".join(message.split())
    print(f"wspd: {sentence}{'' if sentence.endswith(('.', '?', '!')) else '.'}", file=sys.stderr)
    return WRONG_USE


def _usage_sentence(error: Exception, arguments: Sequence[str]) -> str:
    """What Typer says about a wrong option, in one sentence with the place to look."""
    message: str = error.format_message()  # type: ignore[attr-defined]
    context = getattr(error, "ctx", None)
    # An option that lacks its value comes without the command that it stands in.
    named = next((word for word in arguments if word in COMMANDS), "")
    command = context.command_path if context is not None else f"wspd {named}".rstrip()
    joint = " See" if message.endswith("?") else "; see"
    return f"{message.rstrip('.')}{joint} {command} --help"
