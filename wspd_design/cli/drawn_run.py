"""One of the stops that ``--runs`` simulates, alone: the numbers that it draws, and its case."""

from dataclasses import replace

from wspd_design.cli.campaign import drawn_by_runs
from wspd_design.cli.console import console
from wspd_design.design.case import Case
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import load_entries
from wspd_design.parameters.units import format_quantity
from wspd_design.plants.names import plant_of
from wspd_design.simulation.draws import Deck
from wspd_design.simulation.records import Scenario


def drawn_run(
    case: Case, stop: Scenario, number: int, *, plant: str
) -> tuple[Case, Scenario, dict[str, float]]:
    """Return case and stop with the numbers that a run draws; the law stays that of the nominal numbers.

    Parameters
    ----------
    case : Case
        Nominal vehicle and rail, and the law.
    stop : Scenario
        The nominal stop, with the seed of run 0.
    number : int
        Of the run.
    plant : {"planar", "quarter", "locomotive", "locomotive-linear"}
        Plant of the stop.

    Returns
    -------
    case, stop
        With vehicle, rail and seed of the run.
    drawn : dict
        The numbers by their names [SI units].
    """
    draws = drawn_by_runs(case, stop, plant)
    if not draws:
        raise UserError(
            f"vehicle {case.vehicle.name} and rail {case.rail.name} have no numbers with bounds to draw from; leave "
            "--only-run out, or give their files bounds"
        )
    deck = Deck(plant_of(plant, case.vehicle), stop, draws)
    ((drawn_plant, drawn_stop),) = deck.cases(number, 1)
    numbers = dict(zip((draw.name for draw in draws), deck.values(number, 1)[0].tolist(), strict=True))
    return replace(case, vehicle=drawn_plant.vehicle, rail=drawn_stop.rail), drawn_stop, numbers


def show_drawn(case: Case, drawn: dict[str, float], number: int) -> None:
    """Print the numbers of a run in the units of their files."""
    units = {
        f"{each.kind}.{name}": entry.unit
        for each in (load_entries("vehicle", case.vehicle_name), load_entries("rail", case.rail_name))
        for name, entry in each.entries.items()
    }
    said = (f"{name} {format_quantity(value, units[name])}" for name, value in drawn.items())
    console().print(f"Run {number} draws {', '.join(said)}.", markup=False)
