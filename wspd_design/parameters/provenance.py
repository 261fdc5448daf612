"""Where the numbers of a file come from: value as it stands there, unit, source, status and bounds."""

from dataclasses import dataclass

from wspd_design.parameters.bounds import Bounds


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """One number of a parameter file with everything that is known about it.

    ``value`` and ``bounds`` are in SI units; ``unit`` is the unit that the file states. Words are kept as
    they are. A number without bounds is taken as exactly known.

    Attributes
    ----------
    name : str
    value : number, tuple of numbers, text or tuple of texts
    unit : str
    bounds : tuple[float, float] or None
    source : str
    at : str
    status : str
    note : str
    inherited : str
        Name of the file that it was taken from, where its own file does not state it.
    """

    name: str
    value: (
        float
        | tuple[float, ...]
        | tuple[tuple[float, ...], ...]
        | tuple[str, ...]
        | tuple[tuple[str, ...], ...]
        | str
    )
    unit: str
    bounds: tuple[float, float] | None
    source: str
    at: str
    status: str
    note: str
    inherited: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class ParameterSet:
    """All entries of one parameter file.

    Attributes
    ----------
    kind : str
    name : str
    title : str
    entries : dict[str, Entry]
    """

    kind: str
    name: str
    title: str
    entries: dict[str, Entry]

    @property
    def bounds(self) -> Bounds:
        """Lower and upper bound of every uncertain number, by its name [SI units]."""
        return Bounds.of(
            {name: entry.bounds for name, entry in self.entries.items() if entry.bounds is not None}
        )

    def number(self, name: str) -> float:
        """Return a number by its name [SI units]."""
        value = self.entries[name].value
        assert isinstance(value, float)
        return value


@dataclass(frozen=True, slots=True, kw_only=True)
class Source:
    """Where numbers come from, and how its content is known.

    Attributes
    ----------
    key : str
    title : str
    authors : str
    year : int
    kind : str
        Paper, book, standard, software, calibration, reference, team.
    access : str
        Seen, recalled, inferred.
    note : str
    """

    key: str
    title: str
    authors: str
    year: int
    kind: str
    access: str
    note: str
