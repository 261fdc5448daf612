"""From parameter files to the records that the physics and the controllers take."""

from collections.abc import Mapping
from dataclasses import MISSING, fields
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeVar

from wspd_design.parameters.bounds import Bounds
from wspd_design.parameters.brake_checks import check_further_brakes
from wspd_design.parameters.brakes import check_brake
from wspd_design.parameters.contradictions import (
    check_heights,
    notice_of_rail,
    notice_of_vehicle,
    tell,
)
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import (
    PROFILE_RAILS,
    available,
    beside,
    data_file,
    load_entries,
    read_toml,
)
from wspd_design.parameters.gear import contradiction, masses_contradict
from wspd_design.parameters.laden import LADEN
from wspd_design.parameters.provenance import ParameterSet, Source
from wspd_design.parameters.records import (
    Brake,
    Constants,
    Contact,
    DynamicBrake,
    KnorrBremseTable,
    MitsubishiTable,
    Pads,
    PaperGains,
    Rail,
    RailProfile,
    SpectrumCoefficients,
    Steel,
    TrackBrake,
    TrackSpectrum,
    TrenitaliaTable,
    Vehicle,
)
from wspd_design.parameters.schema import MITSUBISHI_LEVELS, PRESETS, TRACK_ROWS, Preset
from wspd_design.parameters.taken import described

__all__ = [
    "available",
    "constants",
    "load_entries",
    "load_knorr_bremse",
    "load_mitsubishi",
    "load_paper_gains",
    "load_rail",
    "load_rail_profile",
    "load_track_spectrum",
    "load_trenitalia",
    "load_vehicle",
    "sources",
    "steel",
    "vehicle_of",
]

_Record = TypeVar("_Record")


@cache
def constants() -> Constants:
    """Return gravity and the conventions near standstill."""
    return _build(Constants, _values(load_entries("constants", "constants")))


@cache
def steel() -> Steel:
    """Return the steel of wheels and rails, with the rail head."""
    return _build(Steel, _values(load_entries("constants", "steel")))


@cache
def sources() -> dict[str, Source]:
    """Return where the shipped numbers come from, by the key that their entries state."""
    document = read_toml(data_file("sources.toml"), "sources.toml")
    return {key: Source(key=key, **table) for key, table in document.items()}


def load_vehicle(name_or_path: str | Path) -> Vehicle:
    """Load a vehicle by its name, such as ``er24pc``, or from a ``.toml`` file.

    Parameters
    ----------
    name_or_path : str or Path
        Name of a shipped vehicle or path of a user's own file; with ``:laden`` after it the laden vehicle.

    Returns
    -------
    Vehicle
        All numbers in SI units.

    Raises
    ------
    UserError
        If there is no such vehicle, its file is wrong, or its running gear or masses contradict each other.
    """
    _check_name(name_or_path, "load_vehicle")
    parameters = load_entries("vehicle", name_or_path)
    vehicle = vehicle_of(parameters)
    if _is_own(name_or_path):
        tell(notice_of_vehicle(parameters, constants().gravity))
    return vehicle


def vehicle_of(parameters: ParameterSet) -> Vehicle:
    """Return the vehicle of the entries of a file.

    Raises
    ------
    UserError
        If the numbers contradict each other.
    """
    values = _values(parameters)
    counts = {
        name: _count(values[name], name, parameters.name)
        for name in ("wheelsets", "axles_per_bogie", "bodies")
        if name in values
    }
    check_brake(values, parameters.name)
    vehicle = _build(
        Vehicle,
        values | counts,
        name=parameters.name,
        brake=_build(Brake, values, "brake.", bounds=_bounds(parameters, "brake.")),
        contact=_build(Contact, values, "contact.", bounds=_bounds(parameters, "contact.")),
        pads=_part(Pads, parameters, "pads."),
        dynamic=_part(DynamicBrake, parameters, "dynamic."),
        track_brake=_part(TrackBrake, parameters, "track_brake."),
        bounds=_bounds(parameters),
    )
    _check_gear(vehicle)
    check_further_brakes(vehicle)
    check_heights(vehicle)
    return vehicle


def _count(value: float, name: str, vehicle: str) -> int:
    if value != int(value):
        raise UserError(f"{name} = {value:g} in vehicle {vehicle} must be a whole number; correct it.")
    return int(value)


def _check_gear(vehicle: Vehicle) -> None:
    """Refuse a running gear that contradicts itself, and masses that do not add up."""
    wrong = contradiction(vehicle)
    if wrong:
        raise UserError(f"vehicle {vehicle.name}: {wrong}.")
    masses = masses_contradict(vehicle)
    if masses:
        raise UserError(f"{masses}; change the three together.")


def _part(record: type[_Record], parameters: ParameterSet, prefix: str) -> _Record | None:
    """Build a part that a vehicle may have, None where its file has no entry of it."""
    values = _values(parameters)
    given = {name.removeprefix(prefix) for name in values if name.startswith(prefix)}
    if not given:
        return None
    needed = (field.name for field in fields(record) if field.default is MISSING)  # type: ignore[arg-type]
    missing = [f"[{prefix}{name}]" for name in needed if name not in given]
    if missing:
        raise UserError(
            f"vehicle {parameters.name} has [{prefix}{min(given)}] but lacks {', '.join(missing)}; add "
            f"{'it' if len(missing) == 1 else 'them'}, or leave out all of {prefix.rstrip('.')}."
        )
    return _build(record, values, prefix, bounds=_bounds(parameters, prefix))


def load_rail(name_or_path: str | Path) -> Rail:
    """Load a rail condition by its name, such as ``polach-wet``, or from a ``.toml`` file.

    Parameters
    ----------
    name_or_path : str or Path
        Name of a shipped rail condition or path of a user's own file.

    Returns
    -------
    Rail
        Coefficients of eqs. (5)-(7) in SI units.

    Raises
    ------
    UserError
        If there is no such rail, its file is wrong, or it changes along the track.
    """
    _check_name(name_or_path, "load_rail")
    parameters = load_entries("rail", name_or_path)
    if PROFILE_RAILS in parameters.entries:
        rails = parameters.entries[PROFILE_RAILS].value
        assert isinstance(rails, tuple)
        raise UserError(
            f"rail {parameters.name} changes along the track, and one adhesion is asked for here; take one of "
            f"{', '.join(dict.fromkeys(map(str, rails)))}."
        )
    rail = _build(Rail, _values(parameters), name=parameters.name, bounds=parameters.bounds)
    if _is_own(name_or_path):
        tell(notice_of_rail(rail))
    return rail


def load_rail_profile(name_or_path: str | Path) -> RailProfile:
    """Load rails along the track, such as ``patchy``, or from a ``.toml`` file; another rail is one from 0 m on.

    Parameters
    ----------
    name_or_path : str or Path
        Name of a shipped rail condition or path of a user's own file.

    Returns
    -------
    RailProfile
        Where each rail starts.

    Raises
    ------
    UserError
        If there is no such rail, its file is wrong, or the starts do not fit.
    """
    parameters = load_entries("rail", name_or_path)
    if PROFILE_RAILS not in parameters.entries:
        return RailProfile(name=parameters.name, starts=(0.0,), rails=(str(name_or_path),))
    values = _values(parameters)
    starts, rails = values.get("profile.starts", ()), values[PROFILE_RAILS]
    if len(starts) != len(rails) or starts[0] != 0.0 or any(a >= b for a, b in pairwise(starts)):
        raise UserError(
            f"profile.starts = {', '.join(f'{start:g} m' for start in starts) or 'nothing'} of rail {parameters.name} "
            f"must be {len(rails)} places that rise from 0 m, one for each of its rails; correct them."
        )
    folder = Path(name_or_path).parent
    return RailProfile(
        name=parameters.name, starts=starts, rails=tuple(beside(rail, folder) for rail in rails)
    )


def load_paper_gains() -> PaperGains:
    """Return the gains that the paper prints for its adaptive fuzzy sliding-mode controller."""
    return _build(PaperGains, _values(load_entries("controller", "afsmc")))


def load_trenitalia(preset: Preset) -> TrenitaliaTable:
    """Return the Trenitalia controller, as calibrated on Table 10 or from conventional practice."""
    return _build(TrenitaliaTable, _preset_values("trenitalia", preset))


def load_knorr_bremse(preset: Preset) -> KnorrBremseTable:
    """Return the Knorr-Bremse controller, as calibrated on Table 10 or from conventional practice."""
    return _build(KnorrBremseTable, _preset_values("knorr-bremse", preset))


def load_mitsubishi(preset: Preset) -> MitsubishiTable:
    """Return the Mitsubishi controller, as calibrated on Table 10 or from conventional practice.

    The words of Table 5 become the output levels of the preset.
    """
    values = _preset_values("mitsubishi", preset)
    levels = {word: values[f"levels.{word}"] for word in MITSUBISHI_LEVELS}
    rules = tuple(tuple(levels[word] for word in row) for row in values["rules"])
    return _build(MitsubishiTable, values, rules=rules)


def load_track_spectrum(name: str) -> TrackSpectrum:
    """Load the spectra of track irregularities, such as ``erri-b176``.

    Parameters
    ----------
    name : str
        Name of a shipped set.

    Returns
    -------
    TrackSpectrum
        Coefficients of eq. (49) for W in rad/m, and the band of wavelengths [m].

    Raises
    ------
    UserError
        If there is no such set.
    """
    parameters = load_entries("track", name)
    values = _values(parameters)
    # A displacement has beta2 = gamma6 = 0 and an angle beta0 = 0 by the form of their spectra.
    rows = {
        row: SpectrumCoefficients(
            **{f.name: values.get(f"{row}.{f.name}", 0.0) for f in fields(SpectrumCoefficients)}
        )
        for row in TRACK_ROWS
    }
    return _build(TrackSpectrum, values, name=parameters.name, rows=rows, one_sided=values["sides"] == 1.0)


def _check_name(name_or_path: object, by: str) -> None:
    if not isinstance(name_or_path, str | Path):
        raise UserError(f"{by} takes a name or the path of a file, not {described(name_or_path)}")


def _is_own(name_or_path: str | Path) -> bool:
    return str(name_or_path).removesuffix(LADEN).endswith(".toml")


def _values(parameters: ParameterSet) -> dict[str, Any]:
    return {name: entry.value for name, entry in parameters.entries.items()}


def _bounds(parameters: ParameterSet, prefix: str = "") -> Bounds:
    """Bounds of the numbers of one record; those of the parts of a vehicle begin with the name of the part."""
    named = {
        name.removeprefix(prefix): ends for name, ends in parameters.bounds.items() if name.startswith(prefix)
    }
    return Bounds.of({name: ends for name, ends in named.items() if "." not in name})


def _preset_values(controller: str, preset: Preset) -> dict[str, Any]:
    """Return what all presets of a controller share, and what this one adds."""
    if preset not in PRESETS:
        raise UserError(f'unknown preset "{preset}" of {controller}; available: {", ".join(PRESETS)}.')
    values = _values(load_entries("controller", controller))
    prefix = f"{preset}."
    return values | {
        name.removeprefix(prefix): value for name, value in values.items() if name.startswith(prefix)
    }


def _build(record: type[_Record], values: Mapping[str, Any], prefix: str = "", **known: object) -> _Record:
    """Fill a record with the values of the same names; ``known`` are the fields that no file holds.

    What a file leaves out keeps the default of its field; the schema tells what may be left out.
    """
    names = (field.name for field in fields(record) if field.name not in known)  # type: ignore[arg-type]
    return record(**{name: values[prefix + name] for name in names if prefix + name in values}, **known)
