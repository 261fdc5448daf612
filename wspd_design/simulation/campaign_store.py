"""The store of a campaign: one Parquet file for each finished chunk, so that nothing finished is computed twice.

A file is named by the content key of its campaign and the runs in it, appears when it is whole, and carries the
SHA-256 of its rows. What is not such a file is recognized when it is read.
"""

import hashlib
import io
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.writing import write_whole
from wspd_design.simulation.parquet import read_rows, rows_as_parquet

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SHORT = 16  # digits of the key in names of files


class Store:
    """Chunks of one campaign in a folder that it may share with others, and with other machines."""

    def __init__(self, folder: Path, key: str) -> None:
        self.folder, self._key = folder, key
        self.remade: list[str] = []  # one sentence for each file that has to be made anew
        try:
            folder.mkdir(exist_ok=True)
        except OSError as error:
            raise UserError(
                f"the store {folder} cannot be made ({error.strerror}); choose a folder in one that exists and is "
                "writable"
            ) from None

    def path(self, first: int, count: int) -> Path:
        """Return the file of a chunk."""
        return self.folder / f"{self._key[:_SHORT]}-{first:010d}-{count}.parquet"

    def write(self, first: int, rows: "NDArray[Any]") -> None:
        """Keep the rows of a chunk."""
        content = rows_as_parquet(rows, self._marks(first, rows))
        write_whole(self.path(first, len(rows)), lambda part: part.write_bytes(content))

    def read(self, first: int, count: int, columns: list[tuple[str, str]]) -> "NDArray[Any] | None":
        """Return the rows of a chunk; None if they are not here, or not what was written."""
        path = self.path(first, count)
        try:
            content = path.read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            raise UserError(f"{path} cannot be read ({error.strerror}); mend its permissions") from None
        try:
            rows, marks = read_rows(io.BytesIO(content), columns)
        except ValueError:
            self._remake(path, "is damaged or not a file of rows")
            return None
        if marks.get("campaign") != self._key:
            self._remake(path, "belongs to another campaign")
        elif marks != self._marks(first, rows) or len(rows) != count:
            self._remake(path, "holds other rows than were written")
        else:
            return rows
        return None

    def clear(self) -> None:
        """Remove what killed writers left behind, once all chunks are there."""
        for part in self.folder.glob(f".{self._key[:_SHORT]}-*.part"):
            with suppress(OSError):
                part.unlink()

    def _remake(self, path: Path, why: str) -> None:
        self.remade.append(f"{path} {why}; its stops are simulated anew")

    def _marks(self, first: int, rows: "NDArray[Any]") -> dict[str, str]:
        digest = hashlib.sha256(rows.tobytes()).hexdigest()
        return {"campaign": self._key, "first": str(first), "rows_sha256": digest}
