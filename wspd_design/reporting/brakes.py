"""A brake in words, from the entries of its vehicle."""

from wspd_design.parameters.provenance import ParameterSet
from wspd_design.reporting.text import Text


def lag_times(vehicle: ParameterSet) -> tuple[float, float] | None:
    """Return fill and vent time of a valve that is a lag [s]; None for orifices."""
    if _word(vehicle, "brake.valve") == "orifice":
        return None
    return vehicle.number("brake.fill_time"), vehicle.number("brake.vent_time")


def brake_text(vehicle: ParameterSet, shown: dict[str, str]) -> Text:
    """Say what a brake is made of.

    Parameters
    ----------
    vehicle : ParameterSet
        The vehicle.
    shown : dict of str
        Its numbers as text, by the names of their entries.
    """
    fill, vent = shown["brake.fill_time"], shown["brake.vent_time"]
    valves = (
        f"fills with a time constant of {fill}, vents with {vent}"
        if lag_times(vehicle)
        else f"orifices whose choked flow fills with {fill} and vents with {vent}"
    )
    parts = [f"{shown['brake.max_torque']} per wheelset; {valves}"]
    if _word(vehicle, "brake.build_up") == "electro-pneumatic":
        delay = f" after {shown['brake.build_up_delay']}" if "brake.build_up_delay" in shown else ""
        parts.append(f"electro-pneumatic build-up in {shown['brake.build_up_ramp']}{delay}")
    parts += [f"{words} {shown[name]}" for name, words in _FURTHER.items() if name in shown]
    return "; ".join(parts)


_FURTHER = {
    "brake.hold_leak": "leak of a held cylinder",
    "brake.dead_time": "dead time",
    "brake.shortest_pulse": "shortest pulse",
    "brake.longest_release": "watchdog after",
    "brake.cylinder_volume": "cylinders of a wheelset",
    "brake.reservoir_volume": "reservoir of the vehicle",
    "brake.reservoir_pressure": "its pressure at the start",
}


def _word(vehicle: ParameterSet, name: str) -> str:
    entry = vehicle.entries.get(name)
    return "" if entry is None else str(entry.value)
