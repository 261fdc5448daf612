"""Which program this is: the content of its files, whether they came from a clone, a wheel or a folder.

Nothing here depends on how the package was installed, so that the same files have the same identity everywhere.
"""

import hashlib
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from wspd_design.parameters.files import data_file

_BUILT = (".pyc", ".so", ".dll", ".dylib")  # what machines make of the files
_PREBUILT = "prebuilt"  # folder of compiled plants, which only wheels have; made of the same files


@dataclass(frozen=True, slots=True, kw_only=True)
class Package:
    """Identity of the files of a package."""

    sha256: str  # of the lines "SHA-256  PATH" of all files, sorted, as sha256sum prints them
    tree: str  # git's name of the folder, which every commit with just these files has


@cache
def package() -> Package:
    """Return the identity of this program."""
    return identity(_root())


def identity(folder: Path) -> Package:
    """Return the identity of the files below a folder, as a clone has them."""
    lines = [
        f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {folder.name}/{path.relative_to(folder).as_posix()}\n"
        for path in sorted(_files(folder), key=lambda path: path.relative_to(folder).as_posix())
    ]
    return Package(sha256=hashlib.sha256("".join(lines).encode()).hexdigest(), tree=_tree(folder).hex())


@cache
def is_changed() -> bool:
    """Tell whether the files are those of a clone, but not of its last commit; without git nobody can tell."""
    root = _root()
    command = ["git", "-C", str(root.parent), "rev-parse", f"HEAD:./{root.name}"]
    try:
        told = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError:
        return False
    return told.returncode == 0 and told.stdout.strip() != package().tree


def _root() -> Path:
    return Path(str(data_file())).parent


def _is_source(path: Path) -> bool:
    return (
        not path.name.startswith(".")
        and path.name not in ("__pycache__", _PREBUILT)
        and path.suffix not in _BUILT
    )


def _files(folder: Path) -> list[Path]:
    found = []
    for path in filter(_is_source, folder.iterdir()):
        found += _files(path) if path.is_dir() else [path]
    return found


def _tree(folder: Path) -> bytes:
    """Name a folder as git does: SHA-1 of the names of what is in it; empty folders do not count."""
    entries = {}
    for path in filter(_is_source, folder.iterdir()):
        if not path.is_dir():
            entries[path.name] = b"100644 " + path.name.encode() + b"\0" + _object(b"blob", path.read_bytes())
        elif _files(path):
            entries[f"{path.name}/"] = b"40000 " + path.name.encode() + b"\0" + _tree(path)
    return _object(b"tree", b"".join(entry for _, entry in sorted(entries.items())))


def _object(kind: bytes, content: bytes) -> bytes:
    head = kind + b" " + str(len(content)).encode() + b"\0"
    return hashlib.sha1(head + content, usedforsecurity=False).digest()
