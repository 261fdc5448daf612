"""What the numbers of pads, electrodynamic brake and track brake must fulfil together."""

from itertools import pairwise
from typing import Final

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import DynamicBrake, Pads, TrackBrake, Vehicle

MOST_POINTS: Final = 8
"""Points of a table of factors, at most: its numbers are inputs of a loop that is compiled once."""

SPEED_ROUNDING: Final = 0.5
"""Speed about a corner within which it is rounded [m/s], so that integration keeps its order."""

TEMPERATURE_ROUNDING: Final = 10.0
"""The same for corners over temperature [K]."""


def check_further_brakes(vehicle: Vehicle) -> None:
    """Refuse numbers of pads, electrodynamic brake and track brake that do not go together.

    Raises
    ------
    UserError
        With what is wrong in one sentence.
    """
    if vehicle.pads is not None:
        _check_pads(vehicle.pads, vehicle.name)
    if vehicle.dynamic is not None:
        _check_dynamic(vehicle.dynamic, vehicle.wheelsets, vehicle.name)
    if vehicle.track_brake is not None:
        _check_track_brake(vehicle.track_brake, vehicle.name)


def _check_pads(pads: Pads, vehicle: str) -> None:
    """Refuse tables that are none, and temperatures without what they heat."""
    _check_table("pads.speeds", pads.speeds, "pads.speed_factors", pads.speed_factors, vehicle)
    factors = ("pads.temperature_factors", pads.temperature_factors)
    _check_table("pads.temperatures", pads.temperatures, *factors, vehicle)
    if pads.temperatures and not pads.heat_capacity < float("inf"):
        raise UserError(
            f"vehicle {vehicle} has [pads.temperatures] but lacks [pads.heat_capacity], by which the pads get warm; "
            "add it."
        )


def _check_dynamic(brake: DynamicBrake, wheelsets: int, vehicle: str) -> None:
    """Refuse an electrodynamic brake that does not fade from one speed to a lower one, and shares of other axles."""
    shares = brake.axle_shares
    if shares and (len(shares) != wheelsets or max(shares) == 0.0):
        raise UserError(
            f"dynamic.axle_shares of vehicle {vehicle} must have {wheelsets} numbers, one for each wheelset, and one "
            f"above 0 at least, but has {len(shares)}; 0 is an axle without a motor."
        )
    _check_cut_out("dynamic", brake.cut_out_speed, SPEED_ROUNDING, vehicle)
    if not brake.fade_speed > brake.cut_out_speed:
        raise UserError(
            f"dynamic.fade_speed = {brake.fade_speed:g} m/s of vehicle {vehicle} must be above dynamic.cut_out_speed "
            f"= {brake.cut_out_speed:g} m/s: between them the torque goes to zero."
        )


def _check_track_brake(brake: TrackBrake, vehicle: str) -> None:
    """Refuse a table that is none, and magnets that would be lifted at standstill."""
    factors = ("track_brake.speed_factors", brake.speed_factors)
    _check_table("track_brake.speeds", brake.speeds, *factors, vehicle)
    if brake.cut_out_speed != 0.0:
        _check_cut_out("track_brake", brake.cut_out_speed, 2.0 * SPEED_ROUNDING, vehicle)


def _check_cut_out(part: str, speed: float, least: float, vehicle: str) -> None:
    if speed < least:
        raise UserError(
            f"{part}.cut_out_speed = {speed:g} m/s of vehicle {vehicle} must be at least {least:g} m/s; raise it"
            + (
                ", or leave it out for magnets that stay down to standstill."
                if part == "track_brake"
                else "."
            )
        )


def _check_table(
    name: str, points: tuple[float, ...], other: str, values: tuple[float, ...], vehicle: str
) -> None:
    if len(points) != len(values):
        raise UserError(
            f"[{name}] and [{other}] of vehicle {vehicle} have {len(points)} and {len(values)} numbers; give as many "
            "of one as of the other."
        )
    if len(points) == 1 or len(points) > MOST_POINTS:
        raise UserError(f"[{name}] of vehicle {vehicle} has {len(points)} numbers; give 2 to {MOST_POINTS}.")
    if any(before >= after for before, after in pairwise(points)):
        listed = ", ".join(f"{point:g}" for point in points)
        raise UserError(f"[{name}] of vehicle {vehicle} = {listed} in SI units must rise; put them in order.")
