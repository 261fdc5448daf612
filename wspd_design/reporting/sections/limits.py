"""What the report does not show, and how to make it again."""

from dataclasses import replace

from wspd_design.parameters.provenance import ParameterSet
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Bullets, Heading
from wspd_design.reporting.formula_text import readable
from wspd_design.reporting.sections.other_conditions import VARIANTS
from wspd_design.reporting.sections.robustness import FAULTS
from wspd_design.reporting.text import Link, Text
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.description import disturbances_of, rails_of
from wspd_design.simulation.records import Sensing
from wspd_design.simulation.runs import Run
from wspd_design.studies.dossier import Dossier

EVERYWHERE: tuple[str, ...] = (
    "Stops and checks sit on numbers whose status the sources tell: the agreement with a real vehicle is unknown.",
    "EN 15595 and other standards are not checked: no statement about conformity is made.",
    "Sampled checks prove nothing between their samples; see the resolution of each.",
)

_WHOLE = (
    "Most masses and stiffnesses of the multibody file are estimates; curves are not modeled, a locked wheel does not "
    "turn backwards, and a grade pulls at the center of the body."
)
OF_PLANT = {
    "quarter": "One wheelset stands for all, with the same load: weight transfer, and wheelsets that "
    "slide differently, are not shown.",
    "planar": "Bodies and bogies pitch about a quasi-static weight transfer without the moment by which turning "
    "wheelsets are slowed down; suspension, lateral motion and curves are not modeled.",
    "locomotive": _WHOLE,
    "locomotive-linear": f"Suspension and inertia are expanded about rest. {_WHOLE}",
}


def limits(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about limits."""
    run: Run = dossier.trials[0].run
    items: list[Text] = [OF_PLANT[run.plant], *_digits(dossier.trials), *_of_scenario(dossier)]
    return (
        Heading(text="What this report does not show", anchor="limits"),
        Bullets(items=(*items, *_elsewhere(dossier), *_of_brakes(dossier.vehicle), *EVERYWHERE)),
    )


def _of_scenario(dossier: Dossier) -> list[str]:
    """Say what the stops leave out of track, measurement and valve, and that the checks know no disturbance."""
    scenario = dossier.scenario
    track = [
        "straight",
        *(["level"] if scenario.grade == 0.0 else []),
        *([] if scenario.patches or scenario.axle_rails else ["in one condition from end to end"]),
    ]
    sensing = scenario.sensing
    exact = replace(sensing, dead_time=None, shortest_pulse=None) == Sensing()
    disturbances = readable(disturbances_of(scenario))
    return [
        f"In the stop of this report the track is {numbers.listing(track)}; no cleaning of the rail by the wheels "
        "ahead, no sand.",
        "Speeds and torque are measured without error, delay or quantization, and the train speed is known."
        if exact
        else "Speeds and torque have the stated disturbances of their measurement and no other ones.",
        _of_valves(dossier),
        *(
            [
                f"The rail changes along the track in the stops ({rails_of(scenario)}); the checks speak about one "
                "rail."
            ]
            if scenario.patches
            else []
        ),
        *(
            [f"The stops are disturbed ({disturbances}); the checks know nothing of it."]
            if disturbances
            else []
        ),
    ]


def _elsewhere(dossier: Dossier) -> list[Text]:
    """Refer to the stops in which one of these conditions is another."""
    places = [
        *([Link(anchor=VARIANTS)] if dossier.uncertainty is not None else []),
        *([Link(anchor=FAULTS)] if dossier.robustness is not None else []),
    ]
    if not places:
        return []
    and_ = (" and ",) if len(places) == 2 else ()
    listed = (*places[:1], *and_, *places[1:])
    return [
        (
            "Other rails, sensor errors, dead times and faults are tried one at a time, in ",
            *listed,
            "; no two of them together.",
        )
    ]


def _of_brakes(vehicle: ParameterSet) -> list[Text]:
    """Say what of pads, electrodynamic brake and track brake is left out."""
    has = {name.partition(".")[0] for name in vehicle.entries}
    fades = {"pads.speeds", "pads.temperatures"} & set(vehicle.entries)
    said: list[Text] = [
        "Wear of the pads, and flats, are not modeled."
        if fades
        else "Friction of the pads is constant; heat, wear and flats are not modeled."
    ]
    if "dynamic" in has:
        said.append(
            "The electrodynamic brake knows the slip exactly, and where it dropped out it stays out to the end of "
            "the stop: an assumption."
        )
    if "track_brake" in has:
        said.append("The magnets of the track brake do not clean the rail for the wheels behind them.")
    return said


def _of_valves(dossier: Dossier) -> str:
    """Say what the valves are and what of them is left out."""
    has = dossier.vehicle.entries
    by_stop = dossier.scenario.sensing.dead_time
    dead_time = "brake.dead_time" in has if by_stop is None else by_stop
    orifice = "brake.valve" in has and has["brake.valve"].value == "orifice"
    left_out = [
        *([] if dead_time else ["dead times"]),
        *([] if "brake.hold_leak" in has else ["leakage"]),
        *([] if "brake.reservoir_volume" in has else ["a limit of the air supply"]),
    ]
    what = "is an orifice of ISO 6358" if orifice else "follows its time constants"
    said = ", and ".join(filter(None, (", ".join(left_out[:-1]), *left_out[-1:])))
    rest = f"; {said} {'are' if left_out[1:] else 'is'} not modeled" if left_out else ""
    return f"The valve {what}{rest}."


def _digits(trials: tuple[Trial, ...]) -> list[Text]:
    """Name the stops that have fewer digits than a table could print."""
    spreads = [
        f"{each.run.controller} by {numbers.significant(each.check.spread, 2)} m"
        for each in trials
        if each.check.sensitive
    ]
    unresolved = [each.run.controller for each in trials if each.check.unresolved]
    said: list[Text] = []
    if spreads:
        said.append(
            "Digits that a sensitive loop does not have: initial speeds that differ by millionths spread the distance "
            f"of {numbers.listing(spreads)}."
        )
    if unresolved:
        said.append(
            f"The stops of {numbers.listing(unresolved)} to their last step: half of the shortest steps still "
            "change them."
        )
    return said
