"""Libraries of plants that come with a wheel: compiled for several instruction sets, chosen when they are loaded.

A library is named by the hash of its source. What today's code emits is found, or nothing is.
"""

import ctypes
import hashlib
import platform
import sys
from functools import cache
from importlib.resources import files
from pathlib import Path

SUFFIX = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
CPU_LEVEL = "cpu-level"
"""Name of the library that tells the level of an x86-64 processor."""


def folder() -> Path:
    """Return the folder of the libraries; it need not exist."""
    return Path(str(files("wspd_design"))) / "codegen" / "prebuilt"


def library_name(source: str, target: str) -> str:
    """Return the name, without its suffix, of the library of a source for an instruction set."""
    return f"{hashlib.sha256(source.encode()).hexdigest()[:32]}-{target}"


def prebuilt_library(source: str) -> ctypes.CDLL | None:
    """Load the library of a source for the best instruction set of this machine, None if there is none."""
    for target in targets():
        path = folder() / f"{library_name(source, target)}{SUFFIX}"
        if path.exists():
            return ctypes.CDLL(str(path))
    return None


@cache
def targets() -> tuple[str, ...]:
    """Return the instruction sets that this machine runs, the best one first."""
    machine = platform.machine().lower()
    if machine in ("arm64", "aarch64"):
        return ("arm64",)
    if machine not in ("x86_64", "amd64"):
        return ()
    path = folder() / f"{CPU_LEVEL}{SUFFIX}"
    level = ctypes.CDLL(str(path)).wspd_cpu_level() if path.exists() else 1
    return tuple(
        name for least, name in ((4, "x86-64-v4"), (3, "x86-64-v3"), (1, "x86-64")) if level >= least
    )
