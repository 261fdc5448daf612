"""The record of traces of a stop: columns with units, as arrays, data frame, dataset or file."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wspd_design.parameters.later import later

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Traces:
    """Traces of one stop over time, a column for each quantity of each wheelset, with their units.

    Names end in the unit, as the keys of JSON do, and in the wheelset, counted from 1 at the front. What a law sees,
    commands and remembers is held from one sample to the next; all else is interpolated where times are asked for.

    Attributes
    ----------
    table : ndarray [see ``units``]
        Record array, one row for each time.
    units : dict[ str, str ]
        Of the columns; empty for a ratio, and for what a law remembers without telling a unit.
    about : dict[str, str]
        What was simulated, with which seed.
    """

    table: "NDArray[Any]"
    units: dict[str, str]
    about: dict[str, str]

    def __repr__(self) -> str:
        """Say in one line what this is."""
        return f"<Traces of {self.about['controller']}: {len(self.table)} rows, {len(self.units)} columns>"

    def __getitem__(self, name: str) -> "NDArray[np.float64]":
        """Return a column."""
        if name not in self.units:
            raise KeyError(f"{name}; there are {', '.join(self.units)}")
        column: NDArray[np.float64] = self.table[name]
        return column

    def _repr_html_(self) -> str:
        return str(later("notebook.stops", "traces_card")(self))

    def to_pandas(self) -> Any:
        """Return a ``pandas.DataFrame`` over time [s], units in ``attrs``; needs the extra ``frames``."""
        return later("notebook.frames", "frame_of_traces")(self)

    def to_xarray(self) -> Any:
        """Return an ``xarray.Dataset`` over time [s] and wheelset, with units; needs the extra ``frames``."""
        return later("notebook.frames", "dataset_of_traces")(self)

    def write(self, path: str | Path) -> None:
        """Write a file; the ending of its name, ``.csv``, ``.parquet`` or ``.mat``, chooses the format.

        Raises
        ------
        UserError
            If the ending is another one, the file cannot be written, or Parquet needs a package that is missing.
        """
        later("exchange.table_files", "write_traces")(self, Path(path))
