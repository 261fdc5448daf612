"""``wspd doctor``: whether this machine has all that the program needs."""

import ctypes
import os
import platform
import shlex
import shutil
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec
from typing import Annotated

import typer
from rich.text import Text

from wspd_design.cli.console import console, is_interactive, spaced, table
from wspd_design.cli.exit_codes import GOOD, REFUTED
from wspd_design.codegen import prebuilt
from wspd_design.codegen.closed_loop import closed_loop_source
from wspd_design.codegen.compiler import (
    COMPILER_INSTALLATION,
    NoCompilerError,
    cache_folder,
    compiler_version,
    find_compiler,
    load_library,
)
from wspd_design.codegen.kernels import plant_kernels
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.exchange.version import program_version
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.plants.names import DEFAULT_PLANT, plant_of
from wspd_design.simulation.parquet import PARQUET_INSTALLATION
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate
from wspd_design.studies.provenance import required_packages

_INSTALL_COMPILER = (
    "Without one, laws run in CasADi's virtual machine, and plants as well if none came with the package. "
    f"Install gcc or clang, set CC, or: {COMPILER_INSTALLATION}"
)
_TEST_SOURCE = "#include <math.h>\ndouble doctor(double x) { return sqrt(x); }\n"


@dataclass(frozen=True, slots=True, kw_only=True)
class Finding:
    """One thing that was looked at."""

    name: str
    found: str
    good: bool
    needed: bool = True
    remedy: str = ""


def doctor(
    report: Annotated[
        bool,
        typer.Option("--report", help="Print it as a text for bug reports, without paths or names of files."),
    ] = False,
) -> None:
    """Look whether all that is needed is there: packages, fonts, folders, compiler, terminal.

    Exit code 0 when nothing that is needed is missing, else 1.
    """
    findings = examine()
    missing = [finding.name for finding in findings if finding.needed and not finding.good]
    if report:
        from wspd_design.cli.bug_report import bug_report

        rows = [(each.name, f"{'' if each.good else '! '}{each.found}") for each in findings]
        print(bug_report(rows), end="")
        raise typer.Exit(REFUTED if missing else GOOD)
    shown = table("", "What", "Found")
    for finding in findings:
        sign, style = ("✓", "green") if finding.good else ("✗", "red") if finding.needed else ("-", "yellow")
        found = Text(finding.found)
        if not finding.good:
            found.append(f"\n{finding.remedy}", style="italic")
        shown.add_row(Text(sign, style=style), finding.name, found)
    out = console()
    out.print(spaced(shown))
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
        _compiled_code(),
        _plants(),
        _engine(),
        _parquet(),
        _terminal(),
    ]


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
    """Compile, load and call one function, as a closed loop is, but past the cache of earlier ones."""
    compiler = find_compiler()
    if compiler is None:
        return Finding(name="C compiler", found="none", good=False, needed=False, remedy=_INSTALL_COMPILER)
    works, found = False, shlex.join(compiler)
    try:
        found += f", {compiler_version()}; "
        with _empty_cache():
            function = load_library(_TEST_SOURCE).doctor
        function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double]
        works = function(9.0) == 3.0
        found += "a test program ran" if works else "a test program computed a wrong number"
    except (OSError, NoCompilerError) as error:
        found += str(error)
    return Finding(name="C compiler", found=found, good=works, needed=False, remedy=_INSTALL_COMPILER)


@contextmanager
def _empty_cache() -> Iterator[None]:
    """Let compiled code go to a folder that is removed afterwards."""
    name = "XDG_CACHE_HOME"
    before = os.environ.get(name)
    with tempfile.TemporaryDirectory(prefix="wspd-") as folder:
        os.environ[name] = folder
        try:
            yield
        finally:
            os.environ.pop(name)
            if before is not None:
                os.environ[name] = before


def _compiled_code() -> Finding:
    """Look at the cache of compiled loops; without one every start compiles again."""
    remedy = "Every start compiles again, about 2 s. Set XDG_CACHE_HOME to a folder that can be written."
    try:
        folder = cache_folder()
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        with tempfile.TemporaryFile(dir=folder):
            pass
        files = [path.stat().st_size for path in folder.glob("*.so")]
    except OSError as error:
        return Finding(name="compiled code", found=str(error), good=False, needed=False, remedy=remedy)
    found = f"{folder}, {len(files)} libraries, {sum(files) / 1e6:.1f} MB; may be deleted at any time"
    return Finding(name="compiled code", found=found, good=True)


def _plants() -> Finding:
    """Look for the compiled plants of a wheel, and whether they are those of this code."""
    best = next(iter(prebuilt.targets()), "this machine")
    number = len(list(prebuilt.folder().glob(f"*-{best}{prebuilt.SUFFIX}")))
    kernels = plant_kernels(plant_of(DEFAULT_PLANT, load_vehicle("er24pc")), disturbed=False)
    good = prebuilt.prebuilt_library(closed_loop_source(kernels, stops=1)) is not None
    found = f"{number} for {best} came with the package" if number else "none came with the package"
    remedy = "With a C compiler, a plant is compiled when it is first used, about 1 s."
    if number and not good:
        found += ", but they are not those of its code"
        remedy += " The package or CasADi was changed since; install both again."
    return Finding(name="compiled plants", found=found, good=good, needed=False, remedy=remedy)


def _engine() -> Finding:
    """Brake a train, and say what computed it."""
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=1.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = simulate(load_vehicle("er24pc"), Unprotected(name="none", sample_time=0.1), scenario)
    good = run.engine == "compiled"
    remedy = "Stops take longer than they could: see the C compiler above."
    return Finding(name="simulation", found=run.engine, good=good, needed=False, remedy=remedy)


def _parquet() -> Finding:
    good = find_spec("pyarrow") is not None
    found = f"pyarrow {version('pyarrow')}" if good else "none"
    remedy = f"Results can be written as CSV only, campaigns have no store; for both: {PARQUET_INSTALLATION}"
    return Finding(name="Parquet", found=found, good=good, needed=False, remedy=remedy)


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
