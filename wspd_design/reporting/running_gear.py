"""The running gear of a vehicle file in words."""

from wspd_design.parameters.provenance import ParameterSet
from wspd_design.reporting import numbers


def axle_shares(vehicle: ParameterSet) -> tuple[float, ...]:
    """Return the torque of the brake of each axle over that of an axle with share 1."""
    if "brake.axle_shares" not in vehicle.entries:
        return (1.0,)
    shares = vehicle.entries["brake.axle_shares"].value
    assert isinstance(shares, tuple)
    return tuple(float(share) for share in shares)  # type: ignore[arg-type]  # the schema says numbers


def running_gear(vehicle: ParameterSet) -> str:
    """Say on what a vehicle stands, such as "4 axles, two-axle bogies", and which axles brake otherwise."""
    axles, per = int(vehicle.number("wheelsets")), _count(vehicle, "axles_per_bogie", 2)
    kind = {1: "single axles", 2: "two-axle bogies", 3: "three-axle bogies"}[per]
    bodies = _count(vehicle, "bodies", 1)
    said = f"{axles} axles, {kind}" if per > 1 else f"{axles} {kind}"
    if bodies > 1:
        said += f" shared by {bodies} bodies"
    shares = axle_shares(vehicle)
    if len(set(shares)) > 1:
        said += f"; braking torque of the axles from the front: {numbers.listing([f'{share:g}' for share in shares])}"
        said += " of the largest" if max(shares) == 1.0 else " of that in the file"
    return said


def alike_note(vehicle: ParameterSet) -> str:
    """Say that a linearization counts wheelsets as alike, for a vehicle where they are not; nothing else."""
    if len(set(axle_shares(vehicle))) == 1 and _count(vehicle, "bodies", 1) == 1:
        return ""
    return (
        "The linearization counts all wheelsets as alike, with the mean load and the brake of an axle with share 1; "
        f"those of {vehicle.name} are not."
    )


def _count(vehicle: ParameterSet, name: str, default: int) -> int:
    return int(vehicle.number(name)) if name in vehicle.entries else default
