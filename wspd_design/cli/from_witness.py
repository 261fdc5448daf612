"""Stops that start at the witness of a certificate: from the file to the case and the scenario, and back to words."""

from dataclasses import dataclass, replace
from pathlib import Path

from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.fingerprint import model_hash
from wspd_design.certificates.theorems.slip_band.departure import settled_stop
from wspd_design.certificates.theorems.slip_band.statement import NAMES
from wspd_design.certificates.witness import Witness, plant_at, read_witness, start_at
from wspd_design.cli.console import console
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import Law
from wspd_design.design.case import Case
from wspd_design.design.certification import problem_of_case, read_certificate_file
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.units import KMH
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Run
from wspd_design.simulation.start import leaving_time

LEFT = 0.05
"""Change of the slip from which on it counts as having left the point where it began."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WitnessStart:
    """What a stop starts from."""

    witness: Witness
    vehicle: Vehicle
    rail: Rail
    controller: Law
    settled: bool  # whether the controller begins as if it had held the slip for long
    scenario: Scenario
    holding_torque: float  # N m per wheelset, whether the brake has it or not
    same_problem: bool  # whether the certificate is about the same numbers as the case


def read(path: Path) -> Witness:
    """Read the witness of a certificate file."""
    text = read_certificate_file(path)
    return read_witness(text, str(path))


def check_words(*, named: bool, speed: str | None, axle_rails: str | None, draws: bool) -> None:
    """Refuse options that contradict ``--from-witness``.

    Parameters
    ----------
    named : bool
        Whether a controller is named.
    speed, axle_rails : str or None
        What is written after the options.
    draws : bool
        Whether the parameters of many stops are to be drawn.
    """
    if not named:
        raise UserError(
            "--from-witness needs the design that the certificate is about; name it, for example "
            "wspd simulate mine.toml --from-witness mine.certificates/reaching.json"
        )
    if speed is not None:
        raise UserError(
            f'--speed "{speed}" contradicts --from-witness, which brings its speed; leave one out'
        )
    if axle_rails is not None:
        raise UserError(
            f'--axle-rails "{axle_rails}" contradicts --from-witness, whose mu0 is that of the rail below all '
            "wheels; leave one out"
        )
    if draws:
        raise UserError(
            "--runs draws numbers that --from-witness fixes; add --nominal to draw seeds only, or leave one out"
        )


def witness_start(case: Case, stop: Scenario, witness: Witness) -> WitnessStart:
    """Put a case at a witness: the controller stays what it is, vehicle and rail take the numbers of the point.

    What a band of slip fails at is a stop that begins with its observers settled: there the controller begins so, too.

    Parameters
    ----------
    case : Case
        Vehicle, rail and controller.
    stop : Scenario
        The stop as the other options describe it.
    witness : Witness
        The point.
    """
    problem = problem_of_case(case)
    vehicle, rail = plant_at(problem, witness)
    start, holding = start_at(witness, vehicle, rail, grade=stop.grade)
    controller, same = case.controller, witness.model_hash == model_hash(problem)
    settled = same and stop.grade == 0.0 and _begins_settled(problem, witness)
    if settled:
        at = settled_stop(problem, {**witness.numbers, "speed": witness.speed})
        controller, start, holding = at.law, at.start, at.holding
    return WitnessStart(
        witness=witness,
        vehicle=vehicle,
        rail=rail,
        controller=controller,
        settled=settled,
        scenario=replace(stop, rail=rail, initial_speed=witness.speed, start=start),
        holding_torque=holding,
        same_problem=same,
    )


def _begins_settled(problem: Problem, witness: Witness) -> bool:
    """Whether the witness is that of a band of slip, with all numbers that such a stop takes."""
    named = witness.numbers.keys() >= set(NAMES)
    return witness.check == "slip_band" and isinstance(problem.controller, Protection) and named


def show_start(made: WitnessStart) -> None:
    """Print what the stop starts from."""
    witness, start, out = made.witness, made.scenario.start, console()
    out.print(
        f"From the witness of {witness.check}, {witness.status.name}: slip {start.slip:.4g}, "
        f"{witness.speed * KMH:.4g} km/h, mass {made.vehicle.mass:.0f} kg, "
        f"wheelset inertia {made.vehicle.wheelset_inertia:.4g} kg m2, mu0 {made.rail.mu0:.4g}, full supply, and "
        f"{start.torque / 1e3:.4g} kN m per wheelset{_reason(made)}."
        + (" Observers and filters have settled there." if made.settled else ""),
        markup=False,
    )
    if not made.same_problem:
        out.print(
            "The certificate is about other numbers than this case: another design, vehicle or rail.",
            style="yellow",
        )


def _reason(made: WitnessStart) -> str:
    """Say why the stop starts with this torque."""
    holding, limit = made.holding_torque, made.vehicle.brake.max_torque
    if made.witness.torque is not None:
        return f", as the witness says; {holding / 1e3:.4g} kN m hold the slip there"
    if holding > limit:
        return f", all that the brake has; {holding / 1e3:.4g} kN m would hold the slip there"
    if holding < 0.0:
        return ": even a released wheel does not keep this slip"
    return ", which hold the slip there"


def show_leaving(run: Run) -> None:
    """Print when the slip has left the point where it began."""
    time = leaving_time(run, LEFT)
    console().print(
        f"The slip is never more than {LEFT:g} away from where it began."
        if time != time
        else f"The slip is {LEFT:g} away from where it began after {time:.3g} s, at "
        f"{_speed_at(run, time) * KMH:.3g} km/h."
    )


def _speed_at(run: Run, time: float) -> float:
    import numpy as np

    return float(np.interp(time, run.time, run.speed))
