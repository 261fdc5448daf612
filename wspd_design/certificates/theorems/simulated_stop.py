"""Theorems about one simulated stop of the law that runs: it conserves momentum and energy, and tracks its reference.

A stop supports a claim as evidence. One that denies it is run again by whoever checks the file.
"""

import math
from collections.abc import Mapping
from functools import partial

from wspd_design.certificates.kernel.checker import Refused, Work
from wspd_design.certificates.kernel.finding import Place
from wspd_design.certificates.kernel.obligation import Inequality, Sampled, Special
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting.assumptions import ALL, OF_VALVES
from wspd_design.certificates.theorems.authority import out_of_reach
from wspd_design.certificates.theorems.evidence import supported
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis
from wspd_design.certificates.theorems.whom import every_law, surface_of
from wspd_design.controllers.offers import Surface
from wspd_design.parameters.gear import gear_of
from wspd_design.parameters.records import Vehicle
from wspd_design.parameters.units import KMH
from wspd_design.plants.planar import Planar
from wspd_design.plants.quarter import Quarter
from wspd_design.simulation.loop_input import JUDGING_SPEED
from wspd_design.simulation.metrics import energy_residual, metrics, momentum_residual
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending, Run
from wspd_design.simulation.stop import simulate

STOP_WORK = 2_000_000  # of a budget of operations: what a stop takes
MOMENTUM_LIMIT, ENERGY_LIMIT = 1e-6, 1e-5  # of the initial momentum and energy
NOT_FINITE = 1e300  # stands for a residual that is not a number: such a stop has no balance
SETTLED_SHARE = 0.5  # of the initial speed: build-up of the brake and the transient lie above it
TRACKED = ("time", "speed", "slip", "torque", "slip rms", "share outside", "lock time", "instants", "stopped")


def scenario_of(problem: Problem) -> Scenario:
    """Return the stop that these theorems speak about: from the highest speed, undisturbed."""
    if min(problem.speeds) <= 0.0:
        raise OutsideModel(f"the speeds {problem.speeds[0]:g} to {problem.speeds[1]:g} m/s must be positive")
    return Scenario(rail=problem.rail, initial_speed=problem.speeds[1])


def start_of_stop(problem: Problem) -> Place:
    """Where the one stop starts that these theorems speak about [m/s]."""
    return {"speed": problem.speeds[1]}


def plants(vehicle: Vehicle) -> tuple[str, ...]:
    """Return the plants that know a vehicle: axles that are not alike have no quarter, one axle moves no load."""
    known = {Planar.name: gear_of(vehicle).supports > 1, Quarter.name: vehicle.brakes_alike}
    return tuple(name for name, holds in known.items() if holds)


def residual_names(vehicle: Vehicle) -> tuple[str, ...]:
    """Return the names of the numbers that a stop on each plant gives."""
    return tuple(
        f"{quantity} residual, {plant}" for plant in plants(vehicle) for quantity in ("momentum", "energy")
    )


def residuals(problem: Problem) -> dict[str, float]:
    """Simulate a stop on each plant and compare what it lost with what forces and torques took."""
    found: dict[str, float] = {}
    for plant in plants(problem.vehicle):
        run = simulate(problem.vehicle, problem.controller, scenario_of(problem), plant=plant)
        pair = momentum_residual(run, problem.vehicle), energy_residual(run, problem.vehicle)
        for quantity, value in zip(("momentum", "energy"), pair, strict=True):
            found[f"{quantity} residual, {plant}"] = value if math.isfinite(value) else NOT_FINITE
    return found


def balances(numbers: Mapping[str, float]) -> bool:
    """Whether every residual is inside its limit."""
    return _used(numbers) <= 1.0


def _used(numbers: Mapping[str, float]) -> float:
    limits = {"momentum": MOMENTUM_LIMIT, "energy": ENERGY_LIMIT}
    return max(abs(value) / limits[name.split()[0]] for name, value in numbers.items())


def _denies_balance(problem: Problem, _place: Place, work: Work) -> Mapping[str, float]:
    work.spend(len(plants(problem.vehicle)) * STOP_WORK)
    numbers = residuals(problem)
    if balances(numbers):
        raise Refused("the stop denies nothing: its balances close")
    return numbers


def _balance_obligations(problem: Problem) -> tuple[Special | Sampled, ...]:
    scenario_of(problem)
    start = problem.speeds[1]
    text = f"momentum closes within {MOMENTUM_LIMIT:g} and energy within {ENERGY_LIMIT:g}"
    return (
        Special(
            key="loss",
            text=text,
            evaluate=partial(_denies_balance, problem),
            within={"speed": (start, start)},
        ),
        Sampled(key="stops", text=text, names=residual_names(problem.vehicle), holds=balances),
    )


def _tell_balance(problem: Problem, findings: Findings) -> Certificate:
    status = supported(findings["loss"], findings["stops"])
    numbers = findings["loss" if status is Status.REFUTED else "stops"].numbers
    names, simulated = residual_names(problem.vehicle), plants(problem.vehicle)
    where = tuple(Point(name=name, value=numbers[name], unit="-") for name in names if name in numbers)
    pairs = (
        f"{plant}: momentum {numbers[f'momentum residual, {plant}']:.2g}, "
        f"energy {numbers[f'energy residual, {plant}']:.2g}"
        for plant in simulated
        if numbers
    )
    return Certificate(
        claim=f"In the simulated stops of {problem.controller.name} from {problem.speeds[1] * KMH:.3g} km/h on "
        f"{problem.rail.name}, with the nominal parameters, momentum is conserved within {MOMENTUM_LIMIT:g} and energy "
        f"within {ENERGY_LIMIT:g} of what the train has at the start.",
        status=status,
        explanation=("; ".join(pairs) or "No stop is stated")
        + "."
        + (
            " The claim is about simulated stops: the witness is the stop itself."
            if status is Status.REFUTED
            else ""
        ),
        margin=Range(low=None, high=1.0 - _used(numbers), unit="of the limits") if numbers else None,
        worst_point=where,
        witness=where if status is Status.REFUTED else (),
        assumptions=("nominal parameters", "exact measurement"),
        method="integrals of torque, resistance, damping and sliding along the simulated stop against the change of "
        f"momentum and kinetic energy; one stop on each plant: {', '.join(simulated)}",
        reference="eqs. (1), (2); Table 10; docs/theory.md#bound",
    )


CONSERVATION = Theorem(
    name="conservation",
    title="Momentum and energy of the stop",
    claim="A simulated stop conserves momentum and energy.",
    speaks_about=every_law,
    obligations=_balance_obligations,
    tell=_tell_balance,
    assumes=frozenset(),
)


def tracked_stop(problem: Problem) -> tuple[Run, dict[str, float]]:
    """Simulate a stop and judge the slip error by the reference of the law once the transient is over.

    Returns
    -------
    run : Run
        The stop.
    numbers : dict
        Named as in ``TRACKED``, at the judged instant with the largest error.
    """
    import numpy as np

    law, scenario = surface_of(problem), scenario_of(problem)
    bound, reference = 2.0 * law.layer, law.slip_reference
    run = simulate(problem.vehicle, problem.controller, scenario, plant="quarter")
    errors = np.abs(run.slip[:, 0] - reference)
    judged = np.flatnonzero(
        (run.speed <= SETTLED_SHARE * problem.speeds[1]) & (run.speed >= problem.speeds[0])
    )
    if judged.size == 0:  # never slow enough: the last instant shows it
        judged = np.array([len(run.time) - 1])
    worst = int(judged[np.argmax(errors[judged])])
    found = metrics(run, problem.vehicle, scenario, slip_reference=reference)
    numbers = {
        "time": float(run.time[worst]),
        "speed": float(run.speed[worst]),
        "slip": float(run.slip[worst, 0]),
        "torque": float(run.torque[worst, 0]),
        "slip rms": float(found.slip_rms),
        "share outside": float(np.mean(errors[judged] > bound)),
        "lock time": float(found.lock_time),
        "instants": float(judged.size),
        "stopped": float(run.ending is Ending.STOPPED),
    }
    return run, {name: value if math.isfinite(value) else NOT_FINITE for name, value in numbers.items()}


def stays(problem: Problem, numbers: Mapping[str, float]) -> bool:
    """Whether the slip stays within 2 Phi/K_P of the reference until the train stands."""
    law = surface_of(problem)
    return abs(numbers["slip"] - law.slip_reference) <= 2.0 * law.layer and numbers["stopped"] == 1.0


def _denies_tracking(problem: Problem, _place: Place, work: Work) -> Mapping[str, float]:
    work.spend(STOP_WORK)
    _, numbers = tracked_stop(problem)
    if stays(problem, numbers):
        raise Refused("the stop denies nothing: its slip stays near the reference")
    return numbers


def _tracking_obligations(problem: Problem) -> tuple[Special | Sampled | Inequality, ...]:
    scenario_of(problem)
    start = problem.speeds[1]
    text = "the slip stays near the reference in the simulated stop"
    return (
        Special(
            key="stray",
            text=text,
            evaluate=partial(_denies_tracking, problem),
            within={"speed": (start, start)},
        ),
        Sampled(key="stop", text=text, names=TRACKED, holds=partial(stays, problem)),
        *out_of_reach(problem, axle=False),
    )


def _tell_tracking(problem: Problem, findings: Findings) -> Certificate:
    law, never = surface_of(problem), findings["out of reach, nominal"]
    status = (
        Status.VACUOUS if never.status is Status.PROVED else supported(findings["stray"], findings["stop"])
    )
    numbers = findings["stray" if findings["stray"].numbers else "stop"].numbers
    bound, reference, settled = 2.0 * law.layer, law.slip_reference, SETTLED_SHARE * problem.speeds[1]
    where = tuple(
        Point(name=name, value=numbers[key] * scale, unit=unit)
        for name, key, scale, unit in (
            ("time", "time", 1.0, "s"),
            ("speed", "speed", KMH, "km/h"),
            ("slip", "slip", 1.0, "-"),
            ("torque", "torque", 1.0, "N m"),
            ("slip rms about the reference", "slip rms", 1.0, "-"),
        )
        if numbers
    )
    seen = (
        f"The slip is {numbers['slip']:.3f} where it is farthest from its reference {reference:g}, and outside the "
        f"bound at {numbers['share outside']:.0%} of {numbers['instants']:.0f} judged instants; its rms about the "
        f"reference above {JUDGING_SPEED * KMH:.0f} km/h is {numbers['slip rms']:.3f}. The wheels lock for "
        f"{numbers['lock time']:.2g} s; {'the train stops' if numbers['stopped'] else 'the train does not stop'}."
        if numbers
        else "No stop is stated."
    )
    if status is Status.VACUOUS:
        seen = (
            "The brake never reaches the reference: even full torque is less than what would hold slip "
            f"{reference:g} at any speed, so that wheel slide protection is idle. {seen}"
        )
    elif status is Status.REFUTED:
        seen += (
            " The claim is about a simulated stop: the witness is this stop itself; the step check of wspd "
        )
        seen += "simulate says how far its steps can be trusted."
    return Certificate(
        claim="In the simulated stop of the quarter model with nominal parameters, sampling, valves and "
        f"wheel lock, the slip error stays below 2 Phi/K_P = {bound:.3g} around the reference {reference:g} of the law "
        f"from {settled * KMH:.3g} km/h, half of the initial speed, down to {problem.speeds[0] * KMH:.3g} km/h on "
        f"{problem.rail.name}.",
        status=status,
        explanation=seen,
        margin=Range(low=None, high=bound - abs(numbers["slip"] - reference), unit="-") if numbers else None,
        worst_point=where,
        witness=where if status is Status.REFUTED else (),
        hypotheses=(hypothesis("the brake never reaches the reference", never),)
        if status is Status.VACUOUS
        else (),
        assumptions=(
            "quarter model, nominal parameters",
            "exact measurement",
            "the integral of the error has decayed: 2 Phi/K_P bounds the error only after the transient",
        ),
        method="simulation of one stop, valve edge to valve edge",
        reference="eqs. (25), (37); docs/theory.md#layer",
    )


def _with_layer(problem: Problem) -> str:
    """Speak about every law that offers a layer, whatever it does: the law that runs is simulated."""
    return "" if isinstance(problem.controller, Surface) else "has no boundary layer"


TRACKING = Theorem(
    name="tracking",
    title="Slip of the sampled loop",
    claim="The slip error stays below 2 Phi/K_P.",
    speaks_about=_with_layer,
    obligations=_tracking_obligations,
    tell=_tell_tracking,
    assumes=ALL - OF_VALVES,  # the stop has the valves of the vehicle
)
