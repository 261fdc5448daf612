"""Rows as Parquet, by pyarrow, which is installed with the extra ``parquet``.

pyarrow writes to memory, so that files are written in one place and a full disk is an ordinary error, and its keys
and values carry the marks of a store. Without threads and with fixed options the same rows give the same bytes.
"""

import io
from collections.abc import Iterable, Iterator, Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, BinaryIO

from wspd_design.parameters.errors import UserError

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MARK = "wspd."  # begins the keys of our marks among those of a file
PARQUET_INSTALLATION = 'pip install "wspd-design[parquet]"'


def check_parquet(what: str) -> None:
    """Refuse Parquet where pyarrow is not installed."""
    if find_spec("pyarrow") is None:
        raise UserError(f"{what} needs pyarrow, which is not installed: {PARQUET_INSTALLATION}")


def write_rows(blocks: "Iterable[NDArray[Any]]", target: BinaryIO, marks: Mapping[str, str]) -> None:
    """Write structured arrays of the same columns below each other, with marks."""
    from pyarrow import parquet

    waiting = iter(blocks)
    first = _arrow(next(waiting))
    with parquet.ParquetWriter(
        target,
        first.schema,
        compression="zstd",
        use_dictionary=False,
        write_statistics=False,
        store_schema=False,
    ) as writer:
        writer.add_key_value_metadata({f"{_MARK}{key}": value for key, value in marks.items()})
        writer.write_table(first)
        for block in waiting:
            writer.write_table(_arrow(block))


def rows_as_parquet(rows: "NDArray[Any]", marks: Mapping[str, str]) -> bytes:
    """Return the content of a Parquet file."""
    memory = io.BytesIO()
    write_rows([rows], memory, marks)
    return memory.getvalue()


def read_rows(source: BinaryIO, columns: list[tuple[str, str]]) -> "tuple[NDArray[Any], dict[str, str]]":
    """Return rows and marks; anything that is wrong with the file is a :class:`ValueError`."""
    import numpy as np
    import pyarrow as pa
    from pyarrow import parquet

    try:
        file = parquet.ParquetFile(source)
        table = file.read(use_threads=False)
        rows = np.zeros(table.num_rows, dtype=columns)
        if table.column_names != list(rows.dtype.names or ()):
            raise ValueError("other columns")
        for name in table.column_names:
            rows[name] = table.column(name).to_numpy()
    except (pa.ArrowException, OSError, TypeError, UnicodeDecodeError) as error:
        raise ValueError(str(error)) from None
    return rows, dict(_marks(file.metadata.metadata or {}))


def _marks(metadata: Mapping[bytes, bytes]) -> Iterator[tuple[str, str]]:
    for key, value in metadata.items():
        name = key.decode(errors="replace")
        if name.startswith(_MARK):
            yield name.removeprefix(_MARK), value.decode(errors="replace")


def _arrow(rows: "NDArray[Any]") -> Any:
    import numpy as np
    import pyarrow as pa

    return pa.table({name: pa.array(np.ascontiguousarray(rows[name])) for name in rows.dtype.names or ()})
