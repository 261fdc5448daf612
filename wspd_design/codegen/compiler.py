"""C source to a loaded library: the compiler of the machine, and a cache by content.

The cache may be deleted at any time. Whatever goes wrong with it (no space, no permission, a damaged file), the
library is compiled again, in the end to a temporary folder.
"""

import ctypes
import hashlib
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from contextlib import suppress
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from wspd_design.parameters.errors import WspdError

# No -ffast-math: in the link step it switches flush-to-zero on for the whole Python process. Without contraction
# the bits do not depend on the instruction set.
PORTABLE_FLAGS = (
    "-O3",
    "-fno-math-errno",
    "-fno-trapping-math",
    "-ffp-contract=off",
    "-fopenmp-simd",
    "-fPIC",
    "-shared",
    "-std=gnu11",
)
COMPILER_INSTALLATION = 'pip install "wspd-design[compiler]"'
# Not every machine knows the first two. The third is of GCC: kernels of coupled plants touch thousands of numbers.
FLAGS = (
    "-march=native",
    "-mprefer-vector-width=512",
    "--param=loop-max-datarefs-for-datadeps=100000",
    *PORTABLE_FLAGS,
)


class NoCompilerError(WspdError, RuntimeError):
    """This machine has no working C compiler."""


@cache
def find_compiler() -> tuple[str, ...] | None:
    """Return the command of the C compiler, None without one.

    The environment's CC comes first, then cc, gcc, clang, and the one that pip installs as ``ziglang``.
    """
    for command in (os.environ.get("CC", ""), "cc", "gcc", "clang"):
        name, *options = shlex.split(command) or ("",)
        if path := shutil.which(name):
            return (path, *options)
    return (sys.executable, "-m", "ziglang", "cc") if find_spec("ziglang") else None


def compiler_version() -> str:
    """Return the first line that the compiler of this machine says about itself, "none" without one."""
    compiler = find_compiler()
    if compiler is None:
        return "none"
    try:
        told = subprocess.run([*compiler, "--version"], capture_output=True, text=True, check=False).stdout
    except OSError:
        told = ""
    return next(iter(told.splitlines()), "version unknown")


def cache_folder() -> Path:
    """Return the user's cache folder for compiled code."""
    base = os.environ.get("XDG_CACHE_HOME")
    try:
        return (Path(base) if base else Path.home() / ".cache") / "wspd_design"
    except RuntimeError as error:  # a user without a home
        raise OSError(str(error)) from error


def load_library(source: str) -> ctypes.CDLL:
    """Compile a C source, or take it from the cache, and load it.

    Raises
    ------
    NoCompilerError
        If there is no compiler or it fails.
    """
    compiler = find_compiler()
    if compiler is None:
        raise NoCompilerError("no C compiler: neither CC nor cc, gcc, clang or ziglang is installed")
    try:
        return _from_cache(source, compiler) or _compile_aside(source, compiler)
    except OSError as error:
        raise NoCompilerError(f"the C compiler {compiler[0]} cannot be used: {error}") from error


def _from_cache(source: str, compiler: tuple[str, ...]) -> ctypes.CDLL | None:
    """Take the library from the cache, or put it there; None where that fails."""
    name = f"{_key(source, compiler)}.so"
    target = None
    try:
        folder = cache_folder()
        target = folder / name
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        if not target.exists():
            _compile_to(target, source, compiler)
        return _loaded(target)
    except OSError:
        # No folder, no space, or a damaged or unreadable file: the next run shall compile it again.
        if target is not None:
            with suppress(OSError):
                target.unlink(missing_ok=True)
        return None


def _compile_aside(source: str, compiler: tuple[str, ...]) -> ctypes.CDLL:
    with tempfile.TemporaryDirectory(prefix="wspd-") as folder:
        target = Path(folder) / "closed_loop.so"
        _compile_to(target, source, compiler)
        return _loaded(target)  # stays mapped after the file is gone


def _compile_to(target: Path, source: str, compiler: tuple[str, ...]) -> None:
    """Compile under a temporary name and rename, so that no other process sees half a library."""
    with tempfile.TemporaryDirectory(prefix=".build-", dir=target.parent) as folder:
        text, library = Path(folder) / "closed_loop.c", Path(folder) / "closed_loop.so"
        text.write_text(source, encoding="utf-8")
        for flags in (FLAGS, PORTABLE_FLAGS):
            command = [*compiler, *flags, str(text), "-o", str(library), "-lm"]
            result = subprocess.run(command, capture_output=True, text=True, check=False)
            if result.returncode == 0 and library.exists():
                break
        else:
            reason = next(iter(result.stderr.splitlines()), f"exit code {result.returncode}")
            raise NoCompilerError(f"the C compiler {compiler[0]} failed: {reason}")
        written = Path(folder) / "sha256"
        written.write_text(hashlib.sha256(library.read_bytes()).hexdigest())
        os.replace(written, target.with_suffix(".sha256"))
        os.replace(library, target)


def _loaded(target: Path) -> ctypes.CDLL:
    """Load a library whose content is the one that was compiled: loading a damaged one can crash the process."""
    expected = target.with_suffix(".sha256").read_text()
    if hashlib.sha256(target.read_bytes()).hexdigest() != expected:
        raise OSError("the cached library is damaged")
    return ctypes.CDLL(str(target))


@cache
def _machine(compiler: tuple[str, ...]) -> str:
    """What the compiled code depends on beside its source: compiler and instruction set."""
    version = subprocess.run([*compiler, "--version"], capture_output=True, text=True, check=False).stdout
    features = ""
    if sys.platform == "linux":
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        features = next((line for line in lines if line.startswith(("flags", "Features"))), "")
    return f"{version}\n{features}\n{sys.platform}"


def _key(source: str, compiler: tuple[str, ...]) -> str:
    return hashlib.sha256("\n".join((source, *FLAGS, *compiler, _machine(compiler))).encode()).hexdigest()[
        :32
    ]
