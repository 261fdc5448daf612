"""What kind of number each gain of a law is, stated once beside the field of its record."""

from dataclasses import MISSING, dataclass, fields
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from wspd_design.parameters.units import Dimension


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """Annotation of a gain: ``Annotated[float, Quantity(dimension="rate")]``."""

    dimension: Dimension
    counted: Dimension | None = (
        None  # the dimension when it is written in multiples of torque_unit, as in the paper
    )
    divisor: bool = False  # the law divides by it, so that it must be above 0
    per_rule: bool = False  # one number for each fuzzy rule


@dataclass(frozen=True, slots=True, kw_only=True)
class GainForm:
    """A gain of a law: its name, the type of its value, and what it measures."""

    name: str
    type: Any  # float, bool or tuple[float, ...]
    quantity: Quantity
    optional: bool = False  # the record has a default for it, which a design need not state


SLIP_REFERENCE = "slip_reference"
"""Field of every record of gains that belongs to the specification, not to the choice of the gains."""


def gain_forms(record: type) -> tuple[GainForm, ...]:
    """Return the gains of a record in their order, without the slip reference.

    Parameters
    ----------
    record : type
        Dataclass whose fields are annotated by a :class:`Quantity`; one without it is a plain ratio.
    """
    hints = get_type_hints(record, include_extras=True)
    forms = []
    for field in fields(record):
        if field.name == SLIP_REFERENCE:
            continue
        hint = hints[field.name]
        kind, *extras = get_args(hint) if get_origin(hint) is Annotated else (hint,)
        stated = next((each for each in extras if isinstance(each, Quantity)), Quantity(dimension="ratio"))
        optional = field.default is not MISSING
        forms.append(GainForm(name=field.name, type=kind, quantity=stated, optional=optional))
    return tuple(forms)
