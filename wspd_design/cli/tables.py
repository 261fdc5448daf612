"""Tables of results in files: CSV, or Parquet by the optional DuckDB."""

import csv
import errno
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wspd_design.cli.output import check_output, write_file
from wspd_design.parameters.errors import UserError

if TYPE_CHECKING:
    from numpy.typing import NDArray

FORMATS = (".csv", ".parquet")
PARQUET_INSTALLATION = 'pip install "wspd-design[parquet]"'


def check_table(path: Path, *, force: bool) -> None:
    """Refuse a file that could not be written later: wrong place, unknown format, no Parquet here.

    Parameters
    ----------
    path : Path
        The file to be; its ending chooses the format.
    force : bool
        Whether an existing file may be replaced.
    """
    check_output(path, force=force)
    ending = path.suffix.lower()
    if ending not in FORMATS:
        raise UserError(f"{path} must end in {' or '.join(FORMATS)}, which chooses the format")
    if ending == ".parquet" and find_spec("duckdb") is None:
        raise UserError(f"{path}: Parquet needs DuckDB, which is not installed: {PARQUET_INSTALLATION}")


def write_table(path: Path, table: "NDArray[Any]", *, force: bool) -> None:
    """Write a structured array, whole or not at all; numbers keep all their digits."""
    write = _write_parquet if path.suffix.lower() == ".parquet" else _write_csv
    write_file(path, lambda target: write(target, table), force=force)


def _write_csv(path: Path, table: "NDArray[Any]") -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(table.dtype.names or ())
        writer.writerows(table.tolist())


def _write_parquet(path: Path, table: "NDArray[Any]") -> None:
    import duckdb
    import numpy as np

    columns = {name: np.ascontiguousarray(table[name]) for name in table.dtype.names or ()}
    try:
        with duckdb.connect() as database:
            database.register("result", columns)
            target = str(path).replace("'", "''")
            database.execute(f"COPY (SELECT * FROM result) TO '{target}' (FORMAT PARQUET)")
    except duckdb.Error as error:
        raise OSError(errno.EIO, str(error)) from None
