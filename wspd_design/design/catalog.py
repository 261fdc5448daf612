"""Controllers by name: the paper's, the designed ones, the baselines, and design files."""

from dataclasses import replace
from difflib import get_close_matches
from pathlib import Path

from wspd_design.controllers.baselines.knorr_bremse import KnorrBremse
from wspd_design.controllers.baselines.mitsubishi import Mitsubishi
from wspd_design.controllers.baselines.trenitalia import Trenitalia
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.controllers.protocol import Controller
from wspd_design.design.file import read_design
from wspd_design.design.laws import GAINS_OF, law_of
from wspd_design.design.records import Design, Gain, Law, Specification, vehicle_hash
from wspd_design.design.selection import design_controller
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import (
    load_entries,
    load_knorr_bremse,
    load_mitsubishi,
    load_paper_gains,
    load_rail,
    load_trenitalia,
)
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.schema import PRESETS, Preset

CONTROLLERS = ("afsmc", "smc", "torque-feedback", "trenitalia", "knorr-bremse", "mitsubishi", "none")
"""Names that stand for a controller; the path of a design file stands for its own."""

BASELINES = ("trenitalia", "knorr-bremse", "mitsubishi")
"""Those of them whose tables come in presets."""


def controller(name_or_path: str, vehicle: Vehicle, rail: Rail, specification: Specification) -> Controller:
    """Build a controller from its name or from a design file.

    Parameters
    ----------
    name_or_path : str
        One of :data:`CONTROLLERS`, or the path of a design file ending in ``.toml``. The three controllers of
        the industry take a preset after a colon, ``trenitalia:textbook``; ``calibrated`` without one.
    vehicle : Vehicle
        The vehicle it shall brake.
    rail : Rail
        Design rail of ``smc`` and ``torque-feedback``. A design file brings its own.
    specification : Specification
        Slip reference, ranges and sample time. A design file brings its own.

    Raises
    ------
    UserError
        If there is no such controller, or the design file does not fit the vehicle.
    """
    if is_design_file(name_or_path):
        made = read_design(name_or_path)
        return made.build(vehicle, load_rail(made.rail))
    law = law_of(name_or_path)
    if law is not None:
        return named_design(law, vehicle, rail, specification).build(vehicle, rail)
    sampling, radius = specification.sample_time, vehicle.wheel_radius
    if name_or_path == "none":
        return Unprotected(name=name_or_path, sample_time=sampling)
    base, colon, preset_name = name_or_path.partition(":")
    if base in BASELINES:
        preset = _preset(base, preset_name if colon else "calibrated")
        match base:
            case "trenitalia":
                pulses = load_trenitalia(preset)
                return Trenitalia(name=name_or_path, sample_time=sampling, wheel_radius=radius, table=pulses)
            case "knorr-bremse":
                table = load_knorr_bremse(preset)
                return KnorrBremse(name=name_or_path, sample_time=sampling, wheel_radius=radius, table=table)
            case "mitsubishi":
                rules = load_mitsubishi(preset)
                return Mitsubishi(name=name_or_path, sample_time=sampling, wheel_radius=radius, table=rules)
    near = get_close_matches(name_or_path, CONTROLLERS, n=1)
    offer = f', did you mean "{near[0]}"?' if near else ""
    raise UserError(
        f'unknown controller "{name_or_path}"{offer}; available: {", ".join(CONTROLLERS)}, '
        "or the path of a design file ending in .toml"
    )


def _preset(base: str, name: str) -> Preset:
    for preset in PRESETS:
        if preset == name:
            return preset
    raise UserError(f'unknown preset "{name}" of {base}; write {" or ".join(f"{base}:{p}" for p in PRESETS)}')


def is_design_file(name_or_path: str) -> bool:
    """Tell whether a controller is given by a design file."""
    return Path(name_or_path).suffix == ".toml"


def named_design(law: Law, vehicle: Vehicle, rail: Rail, specification: Specification) -> Design:
    """Return the design behind the name of a law: ``afsmc`` with the printed gains, others by the rules."""
    if law == "afsmc":
        return paper_design(vehicle, rail, specification)
    return replace(design_controller(vehicle, rail, specification, law=law), name=law)


def paper_design(vehicle: Vehicle, rail: Rail, specification: Specification) -> Design:
    """Return the design with the gains that Section 7 of the paper prints."""
    printed = load_paper_gains()
    entries = load_entries("controller", "afsmc").entries
    gains = [
        Gain(
            name=name,
            value=getattr(printed, name),
            unit="N m" if name == "torque_unit" else entries[name].unit,
            why=f"{entries[name].status}: {entries[name].at}",
        )
        for name in GAINS_OF["afsmc"]
        if name in entries
    ]
    for name, text in (
        ("dead_zone", "eqs. (41), (42) adapt with s itself"),
        ("hold_when_saturated", "the paper adapts at all times"),
        ("scheduled_rates", "the rates of eqs. (41), (42) are constant"),
    ):
        gains.append(Gain(name=name, value=False, unit="-", why=f"printed: {text}"))
    order = GAINS_OF["afsmc"].index
    return Design(
        name="afsmc",
        law="afsmc",
        vehicle=vehicle.name,
        vehicle_hash=vehicle_hash(vehicle),
        rail=rail.name,
        specification=specification,
        gains=tuple(sorted(gains, key=lambda gain: order(gain.name))),
    )
