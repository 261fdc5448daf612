"""Key figures of a stop in the units in which people read them, with the digits that their spread leaves them."""

import math

from wspd_design.parameters.provenance import Entry
from wspd_design.reporting import numbers
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.key_figures import KEY_FIGURES, KeyFigure
from wspd_design.studies.uncertainty import Uncertainty

NO_STANDSTILL = "no standstill"
_READ = {"-": (100.0, "%")}
"""Factor and unit of figures that people read in another unit than that of the records."""
_RATIOS = ("slip_rms", "slip_max")
"""Ratios that are told as they are."""


def entries_of(dossier: Dossier) -> dict[str, Entry]:
    """Return the numbers of vehicle and rail by the names of the drawing."""
    return {
        f"{each.kind}.{name}": entry
        for each in (dossier.vehicle, dossier.rail)
        for name, entry in each.entries.items()
    }


def words_of(name: str) -> str:
    """Write the name of a drawn number in words."""
    return name.partition(".")[2].replace(".", ": ").replace("_", " ")


def scaled(rule: KeyFigure, value: float) -> float:
    """Return a figure in the unit in which people read it."""
    return value if rule.name in _RATIOS else value * _READ.get(rule.unit, (1.0, ""))[0]


def unit_of(rule: KeyFigure) -> str:
    """Return that unit."""
    return rule.unit if rule.name in _RATIOS else _READ.get(rule.unit, (1.0, rule.unit))[1]


def shown(found: Uncertainty, name: str, value: float) -> str:
    """Write a key figure with the digits that its spread leaves it."""
    rule, spread = KEY_FIGURES[name], found.spread_of(name)
    if math.isinf(value):
        return NO_STANDSTILL
    width = math.nan if spread is None else spread.width
    return numbers.resolved(scaled(rule, value), scaled(rule, width))


def capitalized(words: str) -> str:
    """Begin with a capital."""
    return words[0].upper() + words[1:]


def titled(rule: KeyFigure) -> str:
    """Return the title of a key figure with its unit."""
    unit = numbers.unit(unit_of(rule))
    return f"{capitalized(rule.title)}{f' [{unit}]' if unit else ''}"


def distance_of_stop(dossier: Dossier) -> str:
    """Write the distance of the nominal stop [m]."""
    own, found = dossier.trials[0], dossier.uncertainty
    if found is None:
        return numbers.settled(own.metrics.distance, own.check.spread, 1)
    return shown(found, "distance", own.metrics.distance)
