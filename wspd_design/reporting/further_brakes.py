"""Pads, electrodynamic brake and track brake of a vehicle file in words, where it has them."""

from wspd_design.parameters.provenance import ParameterSet
from wspd_design.reporting import numbers


def further_brakes(vehicle: ParameterSet) -> tuple[tuple[str, str], ...]:
    """Return what each of them is called and what it does."""
    rows = [
        ("Pads", _pads(vehicle)),
        ("Electrodynamic brake", _dynamic(vehicle)),
        ("Track brake", _magnets(vehicle)),
    ]
    return tuple((name, said) for name, said in rows if said)


def _pads(vehicle: ParameterSet) -> str:
    said = [
        f"friction {_ends(vehicle, f'pads.{factors}')} of that behind the torque over "
        f"{_ends(vehicle, f'pads.{over}')} {what}"
        for over, factors, what in (
            ("speeds", "speed_factors", "at the rim"),
            ("temperatures", "temperature_factors", "above the temperature before the stop"),
        )
        if f"pads.{over}" in vehicle.entries
    ]
    kind = vehicle.entries["pads.kind"].value if "pads.kind" in vehicle.entries else ""
    return "; ".join(([f"{kind} brake"] if kind else []) + said)


def _dynamic(vehicle: ParameterSet) -> str:
    if "dynamic.torque" not in vehicle.entries:
        return ""
    power = f" and {_number(vehicle, 'dynamic.power')}" if "dynamic.power" in vehicle.entries else ""
    drop = (
        f"drops out where the slip exceeds {_number(vehicle, 'dynamic.drop_slip')}"
        if "dynamic.drop_slip" in vehicle.entries
        else "never drops out"
    )
    return (
        f"at most {_number(vehicle, 'dynamic.torque')}{power} per wheelset; fades from "
        f"{_number(vehicle, 'dynamic.fade_speed')} to {_number(vehicle, 'dynamic.cut_out_speed')}; {drop}"
    )


def _magnets(vehicle: ParameterSet) -> str:
    if "track_brake.force" not in vehicle.entries:
        return ""
    known = "track_brake.cut_out_speed" in vehicle.entries
    until = f"above {_number(vehicle, 'track_brake.cut_out_speed')}" if known else "down to standstill"
    return f"{_number(vehicle, 'track_brake.force')} at the rail, {until}"


def _number(vehicle: ParameterSet, name: str) -> str:
    entry = vehicle.entries[name]
    assert isinstance(entry.value, float)
    return numbers.quantity_in(entry.value, entry.unit)


def _ends(vehicle: ParameterSet, name: str) -> str:
    """First and last number of a list."""
    entry = vehicle.entries[name]
    assert isinstance(entry.value, tuple)
    first, last = (numbers.quantity_in(float(entry.value[k]), entry.unit) for k in (0, -1))  # type: ignore[arg-type]
    return f"{first} to {last}"
