"""The laden vehicle: what its file states of it in ``[laden.*]`` takes the place of the numbers of the empty one."""

from dataclasses import replace

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.provenance import Entry, ParameterSet

LADEN = ":laden"
"""After the name or path of a vehicle."""

_PLACES = {
    "laden.mass": "mass",
    "laden.body_height": "body_height",
    "laden.max_torque": "brake.max_torque",
}


def laden(empty: ParameterSet) -> ParameterSet:
    """Return the numbers of a laden vehicle: the load is part of the bodies, and what is not stated stays as it is.

    Raises
    ------
    UserError
        If the vehicle has no laden state, or weighs less with it.
    """
    entries = empty.entries
    if "laden.mass" not in entries:
        raise UserError(
            f"vehicle {empty.name} has no laden state; add [laden.mass] to its file, or leave out {LADEN}."
        )
    load = entries["laden.mass"].value - entries["mass"].value  # type: ignore[operator]  # the schema says numbers
    if load <= 0.0:
        raise UserError(
            f"laden.mass of vehicle {empty.name} is not above its mass; correct one of the two, or leave out {LADEN}."
        )
    stated = {place: replace(entries[name], name=place) for name, place in _PLACES.items() if name in entries}
    bodies = empty.number("bodies") if "bodies" in entries else 1.0
    heavier = {"body_mass": _heavier(entries["body_mass"], load / bodies, stated["mass"])}
    kept = {name: entry for name, entry in entries.items() if name not in _PLACES}
    return replace(
        empty, name=f"{empty.name}{LADEN}", title=f"{empty.title}, laden", entries=kept | stated | heavier
    )


def _heavier(body: Entry, load: float, mass: Entry) -> Entry:
    """Return the mass of a body with its load."""
    ends = body.bounds and (body.bounds[0] + load, body.bounds[1] + load)
    return replace(
        mass,
        name=body.name,
        value=body.value + load,  # type: ignore[operator]  # a number
        bounds=ends,
        at="body_mass of the empty vehicle and its load, laden.mass - mass",
        status="derived",
        note="",
    )
