"""What people call the numbers of a vehicle or a rail, and the keys that they have here."""

from collections.abc import Iterable, Mapping, Sequence
from difflib import get_close_matches

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.schema import Kind
from wspd_design.parameters.units import split_quantity

_VEHICLE = {
    "axles": "wheelsets",
    "n_axles": "wheelsets",
    "number_of_axles": "wheelsets",
    "weight": "mass",
    "tare": "mass",
    "mass_empty": "mass",
    "mass_laden": "laden.mass",
    "payload": "laden.mass",
    "load": "laden.mass",
    "r": "wheel_radius",
    "radius": "wheel_radius",
    "inertia": "wheelset_inertia",
    "j": "wheelset_inertia",
    "pivot_distance": "bogie_spacing",
    "pivot_spacing": "bogie_spacing",
    "bogie_distance": "bogie_spacing",
    "bogie_centres": "bogie_spacing",
    "bogie_centers": "bogie_spacing",
    "axle_distance": "wheelbase",
    "axle_spacing": "wheelbase",
    "bogie_wheelbase": "wheelbase",
    "h_cog": "body_height",
    "cog_height": "body_height",
    "drawbar_height": "traction_rod_height",
    "davis_a": "resistance_constant",
    "davis_b": "resistance_linear",
    "davis_c": "resistance_quadratic",
    "a": "resistance_constant",
    "b": "resistance_linear",
    "c": "resistance_quadratic",
    "a0": "resistance_constant",
    "a1": "resistance_linear",
    "a2": "resistance_quadratic",
    "t_max": "brake.max_torque",
    "torque": "brake.max_torque",
    "braking_torque": "brake.max_torque",
    "p_max": "brake.max_pressure",
    "p_cmax": "brake.max_pressure",
    "pressure": "brake.max_pressure",
    "cylinder_pressure": "brake.max_pressure",
    "t_f": "brake.fill_time",
    "filling_time": "brake.fill_time",
    "t_v": "brake.vent_time",
    "venting_time": "brake.vent_time",
    "release_time": "brake.vent_time",
    "build_up_time": "brake.build_up_ramp",
    "watchdog": "brake.longest_release",
    "c11": "contact.kalker_c11",
    "g": "contact.shear_modulus",
    "wheel_load": "contact.reference_load",
}
_RAIL = {
    "mu": "mu0",
    "mu_0": "mu0",
    "friction": "mu0",
    "friction_coefficient": "mu0",
    "adhesion": "mu0",
    "a": "friction_ratio",
    "b": "friction_decay",
    "gamma": "friction_decay",
    "ka": "adhesion_reduction",
    "k_a": "adhesion_reduction",
    "ks": "slip_reduction",
    "k_s": "slip_reduction",
    "patches": "profile",
    "sections": "profile",
}
_OTHER_QUANTITY = {
    "wheel_inertia": "a vehicle holds both wheels together: write wheelset_inertia with twice the number",
    "i_w": "a vehicle holds both wheels together: write wheelset_inertia with twice the number",
    "rotating_mass": "a vehicle holds the inertia: write wheelset_inertia, the rotating mass of one wheelset times "
    "wheel_radius^2",
    "deceleration": 'a vehicle holds the torque: write brake.max_torque; "wspd new vehicle" works it out',
    "braked_weight": 'a vehicle holds the torque: write brake.max_torque; "wspd new vehicle" works it out',
    "lambda": 'a vehicle holds the torque: write brake.max_torque; "wspd new vehicle" works it out',
    "gradient": "the track is no part of a vehicle: use --grade",
    "speed": "the stop is no part of a vehicle: use --speed",
    "max_speed": "the stop is no part of a vehicle: use --speed",
}
_OTHER_OF_RAIL = {
    "mu_inf": "a rail holds the ratio: write friction_ratio, mu_infinity over mu0",
    "mu_infinity": "a rail holds the ratio: write friction_ratio, mu_infinity over mu0",
    "gradient": "the grade is no part of a rail: use --grade",
    "grade": "the grade is no part of a rail: use --grade",
}
CALLED: Mapping[str, Mapping[str, str]] = {"vehicle": _VEHICLE, "rail": _RAIL}
"""The key that a word in small letters stands for, by the kind of file."""

_INSTEAD: Mapping[str, Mapping[str, str]] = {"vehicle": _OTHER_QUANTITY, "rail": _OTHER_OF_RAIL}


def remedy_for(kind: Kind, key: str, raw: object, known: Iterable[str]) -> str:
    """Say what a key that a file must not have should be: the end of a sentence.

    Parameters
    ----------
    kind : str
        What the file describes.
    key : str
        The unknown key, dotted.
    raw : object
        What stands there.
    known : iterable of str
        All keys and groups that such a file may have.
    """
    known = list(known)
    word = key.rpartition(".")[2].lower()
    if kind == "vehicle" and word in ("wheel_diameter", "diameter"):
        return f"; a vehicle holds the radius: write wheel_radius = {_half(raw)}."
    instead = _INSTEAD.get(kind, {}).get(word)
    if instead is not None:
        return f"; {instead}."
    called = CALLED.get(kind, {}).get(word)
    if called in known:
        return f' (did you mean "{called}"?); correct or remove it.'
    grouped = [each for each in known if each.rpartition(".")[2] == word and each != key]
    near = f' (did you mean "{grouped[0]}"?)' if len(grouped) == 1 else did_you_mean(key, known)
    if near:
        return f"{near}; correct or remove it."
    return f"; remove it or take one of {', '.join(known)}."


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Offer the nearest of the known words, in brackets; empty where none is near."""
    close = get_close_matches(word.lower(), list(known), n=1, cutoff=0.5)
    return f' (did you mean "{close[0]}"?)' if close else ""


def near_or_allowed(key: str, known: Sequence[str], prefix: str = "") -> str:
    """Offer the nearest of the keys that a table may have, or all of them: the end of a sentence."""
    close = get_close_matches(key.lower(), known, n=1, cutoff=0.5)
    return f"did you mean {prefix}{close[0]}?" if close else f"allowed: {', '.join(known)}"


def _half(raw: object) -> str:
    """Write half of a length that stands in a file, as well as it can be read."""
    table = raw if isinstance(raw, dict) else {}
    text = f"{table.get('value')} {table.get('unit')}" if table else str(raw)
    try:
        number, unit = split_quantity(text, "length", what="diameter")
    except UserError:
        return "half of the diameter"
    return f'"{number / 2.0:.10g} {unit}"'
