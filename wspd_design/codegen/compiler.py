"""C source to a loaded library: the compiler of the machine, and a cache by content.

The cache may be deleted at any time. Whatever goes wrong with it (no space, no permission, a damaged file), the
library is compiled again, in the end to a temporary folder.
"""

import ctypes
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

# No -ffast-math: in the link step it switches flush-to-zero on for the whole Python process. Without contraction
# the bits do not depend on the instruction set.
FLAGS = (
    "-O3",
    "-march=native",
    "-mprefer-vector-width=512",
    "-fno-math-errno",
    "-fno-trapping-math",
    "-ffp-contract=off",
    "-fopenmp-simd",
    "-fPIC",
    "-shared",
    "-std=gnu11",
)


class NoCompilerError(RuntimeError):
    """This machine has no working C compiler."""


@cache
def find_compiler() -> str | None:
    """Return the C compiler: the environment's CC, then cc, gcc, clang; None without one."""
    for name in (os.environ.get("CC"), "cc", "gcc", "clang"):
        if name and (path := shutil.which(name)):
            return path
    return None


def cache_folder() -> Path:
    """Return the user's cache folder for compiled code."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(base) / "wspd_design"


def load_library(source: str) -> ctypes.CDLL:
    """Compile a C source, or take it from the cache, and load it.

    Raises
    ------
    NoCompilerError
        If there is no compiler or it fails.
    """
    compiler = find_compiler()
    if compiler is None:
        raise NoCompilerError("no C compiler: neither CC nor cc, gcc or clang is installed")
    name = _key(source, compiler) + ".so"
    for folder in (_prepared(cache_folder()), None):
        if folder is None:
            return _compile_aside(source, compiler)
        target = folder / name
        try:
            if not target.exists():
                _compile_to(target, source, compiler)
            return _loaded(target)
        except OSError:
            # A damaged or unreadable file, or no space: once more, away from the cache.
            target.unlink(missing_ok=True)
    raise AssertionError("unreachable")


def _compile_aside(source: str, compiler: str) -> ctypes.CDLL:
    with tempfile.TemporaryDirectory(prefix="wspd-") as folder:
        target = Path(folder) / "closed_loop.so"
        _compile_to(target, source, compiler)
        return _loaded(target)  # stays mapped after the file is gone


def _compile_to(target: Path, source: str, compiler: str) -> None:
    """Compile under a temporary name and rename, so that no other process sees half a library."""
    with tempfile.TemporaryDirectory(prefix=".build-", dir=target.parent) as folder:
        text, library = Path(folder) / "closed_loop.c", Path(folder) / "closed_loop.so"
        text.write_text(source)
        command = [compiler, *FLAGS, str(text), "-o", str(library), "-lm"]
        result = subprocess.run(command, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            first = next(iter(result.stderr.splitlines()), "")
            raise NoCompilerError(f"{compiler} failed: {first}")
        digest = hashlib.sha256(library.read_bytes()).hexdigest()
        check = target.with_suffix(".sha256")
        written = Path(folder) / "sha256"
        written.write_text(digest)
        os.replace(written, check)
        os.replace(library, target)


def _loaded(target: Path) -> ctypes.CDLL:
    """Load a library whose content is the one that was compiled: loading a damaged one can crash the process."""
    expected = target.with_suffix(".sha256").read_text()
    if hashlib.sha256(target.read_bytes()).hexdigest() != expected:
        raise OSError("the cached library is damaged")
    return ctypes.CDLL(str(target))


def _prepared(folder: Path) -> Path | None:
    """Make the cache folder; None where it cannot be used."""
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError:
        return None
    return folder if os.access(folder, os.W_OK | os.X_OK) else None


@cache
def _machine(compiler: str) -> str:
    """What the compiled code depends on beside its source: compiler and instruction set."""
    version = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=False).stdout
    features = ""
    if sys.platform == "linux":
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        features = next((line for line in lines if line.startswith(("flags", "Features"))), "")
    return f"{version}\n{features}\n{sys.platform}"


def _key(source: str, compiler: str) -> str:
    return hashlib.sha256("\n".join((source, *FLAGS, _machine(compiler))).encode()).hexdigest()[:32]
