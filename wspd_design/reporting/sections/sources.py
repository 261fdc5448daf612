"""Where every number comes from."""

from collections.abc import Sequence

from wspd_design.certificates.quantities import outside_claims, quantity_of
from wspd_design.parameters.loading import sources as known_sources
from wspd_design.parameters.provenance import Entry, ParameterSet
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Definition, Definitions, Heading, Paragraph, Table
from wspd_design.reporting.sections.design import gain_table
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Inline, Link
from wspd_design.studies.dossier import Dossier

WEAK = ("calibrated", "assumed")


def sources(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section that traces every number of vehicle, rails, controllers and constants."""
    sets = (dossier.vehicle, dossier.rail, *dossier.other_parameters)
    entries = [entry for each in sets for entry in each.entries.values()]
    weak = sum(entry.status in WEAK for entry in entries)
    gains = [
        (f"gains of {made.name}", f"gains-{index}") for index, made in enumerate(dossier.compared_designs, 1)
    ]
    found: list[Block] = [
        Heading(text="Sources", anchor="sources"),
        Paragraph(
            text=(
                f"All {len(entries)} numbers of the vehicle, the rails, the compared controllers and the constants; "
                f"{weak} of them are calibrated or assumed. A number without bounds is taken as exactly known. Of a "
                "number with bounds the tables say who varies it over all of them, and who holds it at its value. "
                "Where they stand: ",
                *_places([*((_called(each), _anchor(each)) for each in sets), *gains]),
                ".",
            )
        ),
    ]
    own = dossier.vehicle, dossier.rail
    found += [_table(each, dossier if each in own else None) for each in sets]
    found += [
        gain_table(made, caption=f"Gains of {made.name}, compared.", anchor=anchor)
        for made, (_, anchor) in zip(dossier.compared_designs, gains, strict=True)
    ]
    known = known_sources()
    keys = [key for key in dict.fromkeys(entry.source for entry in entries) if key in known]
    found.append(
        Paragraph(
            text="The sources. Seen: read in a public source; recalled: general knowledge of the field, not "
            "read; inferred: derived or computed from others."
        )
    )
    found.append(
        Definitions(
            rows=tuple(
                Definition(
                    term=key,
                    text=f"{known[key].authors} ({known[key].year}): {known[key].title} "
                    f"[{known[key].access}]. {known[key].note}".rstrip(),
                )
                for key in keys
            )
        )
    )
    return tuple(found)


def _places(tables: Sequence[tuple[str, str]]) -> tuple[Inline, ...]:
    """Say in which table each of some sets of numbers stands."""
    found: list[Inline] = []
    for name, anchor in tables:
        found += [", " if found else "", f"{name} in ", Link(anchor=anchor)]
    return tuple(found)


def _table(parameters: ParameterSet, dossier: Dossier | None) -> Table:
    """List the numbers of a set; of those that the checks and the drawn sets go by, say how they take the bounds."""
    used: list[ColumnOf[Entry]] = []
    if dossier is not None:
        used.append(
            ColumnOf(title="Within its bounds", read=lambda entry: _use(entry, parameters.kind, dossier))
        )
    return build(
        parameters.entries.values(),
        (
            ColumnOf(title="Number", read=lambda entry: _name(entry.name)),
            ColumnOf(title="Value", read=lambda entry: _value(entry.value, entry.unit)),
            ColumnOf(title="Bounds", read=lambda entry: _bounds(entry)),
            ColumnOf(title="Unit", read=lambda entry: numbers.unit(entry.unit) or "-"),
            *used,
            ColumnOf(title="Status", read=lambda entry: entry.status),
            ColumnOf(
                title="Source, place",
                read=lambda entry: f"{entry.source}: {entry.at}" + (f". {entry.note}" if entry.note else ""),
            ),
        ),
        caption=f"{_called(parameters)}: {parameters.title}.",
        anchor=_anchor(parameters),
    )


def _called(parameters: ParameterSet) -> str:
    return " ".join(dict.fromkeys((parameters.kind, parameters.name))).capitalize()


def _use(entry: Entry, kind: str, dossier: Dossier) -> str:
    """Say who varies a number within its bounds and who holds it."""
    if entry.bounds is None:
        return ""
    found, quantity = dossier.uncertainty, quantity_of(kind, entry.name)
    name = f"{kind}.{entry.name}"
    drawn, kept_back = found is not None and name in found.drawn, found is not None and name in found.held
    term = "" if quantity is None else quantity.name
    varied = sum(term in check.varied for check in dossier.certificates)
    held = sum(term in check.held for check in dossier.certificates)
    by = [*(["the drawn sets"] if drawn else []), *([numbers.count(varied, "check")] if varied else [])]
    kept = [*(["the drawn sets"] if kept_back else []), *([numbers.count(held, "check")] if held else [])]
    said = [
        *([f"varied by {numbers.listing(by)}"] if by else []),
        *([f"held by {numbers.listing(kept)}"] if kept else []),
        *([outside_claims(kind, entry.name)] if quantity is None else []),
    ]
    return "; ".join(filter(None, said))


def _name(key: str) -> str:
    """Write a key in words, which can break over lines."""
    return key.replace(".", ": ").replace("_", " ")


def _anchor(parameters: ParameterSet) -> str:
    """Return an anchor from a name that may hold anything."""
    name = "".join(c if c.isascii() and c.isalnum() else "-" for c in parameters.name.lower())
    return f"sources-{parameters.kind}-{name}"


def _bounds(entry: Entry) -> str:
    if entry.bounds is None:
        return ""
    return " to ".join(_value(bound, entry.unit) for bound in entry.bounds)


def _value(value: object, unit: str) -> str:
    """Write numbers in the unit of the file, without it; words stay as they are."""
    if isinstance(value, tuple):
        separator = "; " if value and isinstance(value[0], tuple) else ", "
        return separator.join(_value(each, unit) for each in value)
    if isinstance(value, str):
        return value
    assert isinstance(value, float)
    return numbers.quantity_in(value, unit).partition(" ")[0]
