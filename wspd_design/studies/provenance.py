"""How a report was made: the command and files that make it again, the program, and the machine."""

import hashlib
import platform
import re
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, requires, version

from wspd_design.certificates.records import Certificate
from wspd_design.codegen.compiler import compiler_version
from wspd_design.studies.package import is_changed, package

DISTRIBUTION = "wspd-design"


@dataclass(frozen=True, slots=True, kw_only=True)
class InputFile:
    """A file that a report was made from, under the name of its attachment."""

    name: str
    text: str
    meaning: str

    @property
    def sha256(self) -> str:
        """As ``sha256sum`` prints it for the saved attachment."""
        return hashlib.sha256(self.text.encode()).hexdigest()


@dataclass(frozen=True, slots=True, kw_only=True)
class Provenance:
    """How to make a report again, and what it was made by."""

    command: str  # that makes it from its attachments; empty where only a program in Python does
    seed: int
    inputs: tuple[InputFile, ...]
    searches_cut: tuple[str, ...]  # checks of which a search was ended by its budget of counted work
    program_version: str
    package_sha256: str
    package_tree: str  # git's name of the folder of the package: its revision, whatever the commit
    changed: bool  # known not to be the files of the last commit of its clone
    compiler: str
    platform: str
    versions: tuple[tuple[str, str], ...]  # of Python and of every package that is required

    @property
    def input_hash(self) -> str:
        """SHA-256 of what ``sha256sum`` prints for the input files in their order."""
        lines = "".join(f"{each.sha256}  {each.name}\n" for each in self.inputs)
        return hashlib.sha256(lines.encode()).hexdigest()


def provenance(
    *, command: str, seed: int, inputs: Sequence[InputFile] = (), certificates: Sequence[Certificate] = ()
) -> Provenance:
    """Return the provenance of a report that is made here and now.

    Parameters
    ----------
    command : str
        That makes it again from the input files.
    seed : int
        Of all random numbers.
    inputs : sequence of InputFile
        What it was made from.
    certificates : sequence of Certificate
        All checks of it.
    """
    libc = " ".join(platform.libc_ver())
    return Provenance(
        command=command,
        seed=seed,
        inputs=tuple(inputs),
        searches_cut=tuple(each.name for each in certificates if each.cut),
        program_version=version(DISTRIBUTION),
        package_sha256=package().sha256,
        package_tree=package().tree,
        changed=is_changed(),
        compiler=compiler_version(),
        platform=f"{platform.system()} {platform.machine()}" + (f", {libc}" if libc.strip() else ""),
        versions=versions(),
    )


def versions() -> tuple[tuple[str, str], ...]:
    """Return the versions of Python and of every package that the program requires."""
    return (("Python", platform.python_version()), *((name, _version(name)) for name in required_packages()))


def required_packages() -> list[str]:
    """Return what the installed program says it needs, without the tools for its development."""
    needed = [text for text in requires(DISTRIBUTION) or () if "extra ==" not in text]
    return [re.split(r"[^\w.-]", text, maxsplit=1)[0] for text in needed]


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "missing"
