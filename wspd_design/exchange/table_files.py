"""Tables in files: CSV, Parquet and MATLAB, columns named with their units, and what they are about where it fits.

The same numbers give the same bytes.
"""

import csv
import io
import json
import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wspd_design.exchange.columns import unit_of, with_unit
from wspd_design.exchange.version import program_version
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.writing import write_whole
from wspd_design.simulation.parquet import check_parquet, write_rows
from wspd_design.simulation.trace_table import Traces

if TYPE_CHECKING:
    from numpy.typing import NDArray

FORMATS = (".csv", ".parquet", ".mat")
_BLOCK = 1000  # rows that are Python objects at a time
_HEAD = 116  # bytes at the head of a MATLAB file that tell in words what it is, with the date
_LONGEST_NAME = 63  # of a variable of MATLAB


def check_format(path: Path) -> None:
    """Refuse an ending that chooses no format, and Parquet without what writes it."""
    ending = path.suffix.lower()
    if ending not in FORMATS:
        raise UserError(
            f"{path} must end in {', '.join(FORMATS[:-1])} or {FORMATS[-1]}, which chooses the format"
        )
    if ending == ".parquet":
        check_parquet(f"{path}: Parquet")


def write_blocks(path: Path, blocks: "Iterable[NDArray[Any]]", about: Mapping[str, str], ending: str) -> None:
    """Write structured arrays of the same columns below each other.

    Parameters
    ----------
    path : Path
        The file.
    blocks : iterable of ndarray
        They may be made while they are written; MATLAB alone needs them all at once.
    about : mapping
        What was simulated; Parquet and MATLAB keep it, with the version of the program and the units.
    ending : str
        Of the file to be, one of :data:`FORMATS`.
    """
    waiting = iter(blocks)
    first = next(waiting)
    names = first.dtype.names or ()
    units = {with_unit(name): unit_of(name) for name in names}
    spelled = {name: with_unit(name) for name in names}
    named = (_renamed(block, spelled) for block in chain([first], waiting))
    head = {"version": program_version(), **about}
    match ending:
        case ".parquet":
            with path.open("wb") as stream:
                write_rows(named, stream, {**head, "units": json.dumps(units)})
        case ".mat":
            _write_matlab(path, named, head, units)
        case _:
            _write_csv(path, named)


def write_traces(traces: Traces, path: Path) -> None:
    """Write traces to a file, whole or not at all; as of :meth:`wspd_design.Traces.write`."""
    check_format(path)
    if not path.parent.is_dir():
        raise UserError(f"folder {path.parent} does not exist; create it or choose another one")
    ending = path.suffix.lower()
    write_whole(path, lambda target: write_blocks(target, [traces.table], traces.about, ending))


def _renamed(block: "NDArray[Any]", names: Mapping[str, str]) -> "NDArray[Any]":
    """Give the columns names that end in their units."""
    from numpy.lib.recfunctions import rename_fields

    renamed: NDArray[Any] = rename_fields(block, dict(names))
    return renamed


def _write_csv(path: Path, blocks: "Iterator[NDArray[Any]]") -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        for number, block in enumerate(blocks):
            if number == 0:
                writer.writerow(block.dtype.names or ())
            for start in range(0, len(block), _BLOCK):
                writer.writerows(block[start : start + _BLOCK].tolist())


def _write_matlab(
    path: Path, blocks: "Iterator[NDArray[Any]]", about: Mapping[str, str], units: Mapping[str, str]
) -> None:
    """Write a column for each quantity, and the structures ``units`` and ``about``."""
    import numpy as np
    from scipy.io import savemat

    rows = np.concatenate(list(blocks))
    content = {_variable(name): _column(rows[name]) for name in rows.dtype.names or ()}
    memory = io.BytesIO()
    savemat(
        memory,
        {
            **content,
            "units": {_variable(name): unit or "-" for name, unit in units.items()},
            "about": {_variable(key): value for key, value in about.items()},
        },
        long_field_names=True,
        oned_as="column",
    )
    said = f"MATLAB 5.0 MAT-file, written by wspd {about['version']}".encode().ljust(_HEAD)[:_HEAD]
    path.write_bytes(said + memory.getvalue()[_HEAD:])


def _column(values: "NDArray[Any]") -> Any:
    """Words as a cell array, all else as numbers."""
    return values.astype(object) if values.dtype.kind == "U" else values


def _variable(name: str) -> str:
    """Name that MATLAB takes."""
    return re.sub(r"\W", "_", name)[:_LONGEST_NAME]
