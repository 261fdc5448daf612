"""The vehicle, the rail and the controller in short, and the loop that they make."""

from collections.abc import Mapping
from functools import partial

from wspd_design.controllers.observers.sensors import TOLD, Sensors
from wspd_design.parameters.provenance import Entry, ParameterSet
from wspd_design.parameters.units import format_quantity
from wspd_design.plants.locomotive import LinearLocomotive, Locomotive
from wspd_design.plants.planar import Planar
from wspd_design.plants.quarter import Quarter
from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Definition, Definitions, Figure, Heading, Paragraph
from wspd_design.reporting.brakes import brake_text, lag_times
from wspd_design.reporting.figures.drawing import KMH, picture
from wspd_design.reporting.figures.loop import HEIGHT, Loop, loop_alt, loop_diagram
from wspd_design.reporting.formula_text import readable
from wspd_design.reporting.further_brakes import further_brakes
from wspd_design.reporting.running_gear import running_gear
from wspd_design.reporting.text import Text, rich
from wspd_design.simulation.description import disturbances_of, every_rail_of
from wspd_design.simulation.law_memory import reference_range
from wspd_design.simulation.runs import Run
from wspd_design.studies.dossier import Dossier


def case(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about what was designed, for what."""
    vehicle, rail, specification = dossier.vehicle, dossier.rail, dossier.specification
    low, high = (numbers.significant(speed * KMH) for speed in specification.speeds)
    slip_low, slip_high = specification.slips
    shown = {
        name: _value(vehicle, name)
        for name, entry in vehicle.entries.items()
        if name.startswith("brake.") and isinstance(entry.value, float)
    }
    friction = (
        f"{rail.title} ({rail.name}): friction coefficient {_value(rail, 'mu0')} without sliding, "
        f"{_value(rail, 'friction_ratio')} of it at large sliding speed, decay "
        f"{_value(rail, 'friction_decay')}"
    )
    rows: tuple[tuple[Text, Text], ...] = (
        ("Vehicle", f"{vehicle.title} ({vehicle.name})"),
        ("Running gear", running_gear(vehicle)),
        ("Mass", _value(vehicle, "mass")),
        ("Rotating inertia", f"{_value(vehicle, 'wheelset_inertia')} per wheelset"),
        ("Wheel radius", _value(vehicle, "wheel_radius")),
        ("Brake", brake_text(vehicle, shown)),
        *further_brakes(vehicle),
        ("Rail", friction),
        ("Controller", _controller(dossier)),
        ("Slip reference", _reference(dossier)),
        *([("Sensors", _sensors(specification.sensors))] if specification.sensors != TOLD else []),
        ("Range of the checks", f"{low} to {high} km/h, slip {slip_low:g} to {slip_high:g}"),
        ("Sample time", format_quantity(specification.sample_time, "ms")),
        ("Plant of the stops", _plant(dossier.trials[0].run)),
        ("Rails of the stops", every_rail_of(dossier.scenario)),
        ("Disturbances of the stops", readable(disturbances_of(dossier.scenario)) or "none"),
    )
    return (
        Heading(text="Vehicle, rail and controller", anchor="case"),
        Definitions(rows=tuple(Definition(term=term, text=text) for term, text in rows)),
        Paragraph(
            text=rich(
                "[](#loop) shows the loop that everything below speaks about. Every number with its unit, bounds, "
                "status and source stands in [](#sources)."
            )
        ),
        _loop(dossier),
    )


def _loop(dossier: Dossier) -> Figure:
    """Draw the loop of the stops."""
    entries, specification = dossier.vehicle.entries, dossier.specification
    times = lag_times(dossier.vehicle)
    lag = (
        ""
        if times is None
        else f", lags of {_plain(entries, 'fill_time')} and {_plain(entries, 'vent_time')}"
    )
    loop = Loop(
        law=dossier.law.heading,
        period=format_quantity(specification.sample_time, "ms"),
        valves=f"fill, hold, vent{lag}" if times else "fill, hold, vent through orifices",
        brake=f"up to {_plain(entries, 'max_torque')} a wheelset",
        vehicle=f"{dossier.vehicle.name}, {_plant(dossier.trials[0].run).partition(':')[0]} model",
        rail=dossier.rail.name,
        measured=_measured(dossier),
        reads_brake=dossier.law.own or specification.sensors.pressures,
        disturbed=readable(disturbances_of(dossier.scenario)),
    )
    return Figure(
        svg=picture(partial(loop_diagram, loop=loop), height=HEIGHT),
        caption="The loop. Dashed and blue: what is sampled and held; solid: what moves all the time; green: what the "
        "law goes by.",
        alt=loop_alt(loop),
        anchor="loop",
    )


def _measured(dossier: Dossier) -> tuple[str, ...]:
    """Say what the law reads."""
    if dossier.law.own:
        return ("wheel speed", "train speed", "braking torque")
    sensors = dossier.specification.sensors
    speed = {
        "told": "train speed, told",
        "fastest-axle": "train speed, from the fastest wheelset",
        "wheels": "train speed, estimated from the wheels",
    }[sensors.speed]
    return (
        "wheel speeds",
        speed,
        *(["acceleration of the train"] if sensors.accelerometer else []),
        *(["pressure of the cylinders"] if sensors.pressures else []),
    )


def _plain(entries: Mapping[str, Entry], name: str) -> str:
    entry = entries[f"brake.{name}"]
    assert isinstance(entry.value, float)
    return numbers.quantity_in(entry.value, entry.unit)


def _controller(dossier: Dossier) -> str:
    law, design = dossier.law, dossier.design
    made = (
        f"its name is {law.name}; it commands {law.acts_on}"
        if design is None
        else f"design {design.name}, made on rail {design.rail}"
    )
    return f"{law.heading}, {law.origin}; {made}"


def _reference(dossier: Dossier) -> str:
    """Say which slip the law holds, and about which one the checks speak."""
    specification = dossier.specification
    checked = f"{specification.slip:g}, tolerance {specification.slip_tolerance:g}"
    own = reference_range(dossier.trials[0].run)
    if own is None or own[0] == own[1]:
        return checked
    low, high = (numbers.significant(each, 3) for each in own)
    return f"moves with the train speed, {low} to {high} in the stop; the checks speak about {checked}"


def _sensors(sensors: Sensors) -> str:
    """Say what the laws go by."""
    source = {
        "told": "train speed told",
        "fastest-axle": "train speed from the fastest wheelset",
        "wheels": "train speed from all wheels",
    }
    said = [
        source[sensors.speed],
        *(["an accelerometer"] if sensors.accelerometer else []),
        *(["a grade that is estimated"] if sensors.grade else []),
        "pressure sensors" if sensors.pressures else "no pressure sensors",
    ]
    return f"{numbers.listing(said)}; the laws that it is compared with go by the same"


def _plant(run: Run) -> str:
    axles = len(run.final_wheel_speeds)
    of_axles = {
        Quarter.name: f"one wheelset stands for all {axles}",
        Planar.name: f"{axles} wheelsets with load transfer",
        Locomotive.name: f"{axles} wheelsets with all degrees of freedom of the multibody file",
        LinearLocomotive.name: f"{axles} wheelsets with all degrees of freedom of the multibody file, linear springs",
    }
    return f"{run.plant}: {of_axles[run.plant]}"


def _value(parameters: ParameterSet, name: str) -> str:
    entry: Entry = parameters.entries[name]
    assert isinstance(entry.value, float)
    text = numbers.quantity_in(entry.value, entry.unit)
    if entry.bounds is None:
        return text
    low, high = (numbers.quantity_in(bound, entry.unit) for bound in entry.bounds)
    return f"{text} ({low} to {high})"
