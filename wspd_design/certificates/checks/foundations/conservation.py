"""The simulated stop conserves momentum and energy, or it is no stop of this vehicle."""

from wspd_design.certificates.checks.frame import certified
from wspd_design.certificates.outside import OutsideModel
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.certificates.setting.domain import KMH
from wspd_design.simulation.metrics import energy_residual, momentum_residual
from wspd_design.simulation.records import PLANTS, Scenario
from wspd_design.simulation.stop import simulate

NAME, TITLE = "conservation", "Momentum and energy of the stop"
MOMENTUM_LIMIT, ENERGY_LIMIT = 1e-6, 1e-5  # of the initial momentum and energy


@certified(name=NAME, title=TITLE)
def check(problem: Problem) -> Certificate:
    """Simulate a stop on each plant and compare what it lost with what forces and torques took."""
    if min(problem.speeds) <= 0.0:
        raise OutsideModel(f"the speeds {problem.speeds[0]:g} to {problem.speeds[1]:g} m/s must be positive")
    scenario = Scenario(rail=problem.rail, initial_speed=problem.speeds[1])
    residuals: dict[str, tuple[float, float]] = {}
    for plant in PLANTS:
        run = simulate(problem.vehicle, problem.controller, scenario, plant=plant)
        residuals[plant] = momentum_residual(run, problem.vehicle), energy_residual(run, problem.vehicle)
    where = tuple(
        Point(name=f"{quantity} residual, {plant}", value=value, unit="-")
        for plant, pair in residuals.items()
        for quantity, value in zip(("momentum", "energy"), pair, strict=True)
    )
    # NaN is no balance: a comparison with it is false.
    closed = all(
        abs(momentum) <= MOMENTUM_LIMIT and abs(energy) <= ENERGY_LIMIT
        for momentum, energy in residuals.values()
    )
    used = max(
        max(abs(momentum) / MOMENTUM_LIMIT, abs(energy) / ENERGY_LIMIT)
        for momentum, energy in residuals.values()
    )
    return Certificate(
        name=NAME,
        title=TITLE,
        claim=f"In the stop of {problem.controller.name} from {problem.speeds[1] * KMH:.3g} km/h on "
        f"{problem.rail.name} momentum is conserved within {MOMENTUM_LIMIT:g} and energy within "
        f"{ENERGY_LIMIT:g} of what the train has at the start.",
        status=Status.EVIDENCE if closed else Status.REFUTED,
        explanation="; ".join(
            f"{plant}: momentum {momentum:.2g}, energy {energy:.2g}"
            for plant, (momentum, energy) in residuals.items()
        )
        + "."
        + ("" if closed else " The claim is about simulated stops: the witness is the stop itself."),
        margin=Range(low=None, high=1.0 - used if closed else min(0.0, 1.0 - used), unit="of the limits"),
        worst_point=where,
        witness=() if closed else where,
        assumptions=("nominal parameters", "exact measurement"),
        method="integrals of torque, resistance, damping and sliding along the simulated stop against the change "
        "of momentum and kinetic energy",
        resolution=f"one stop on each plant: {', '.join(residuals)}",
        reference="eqs. (1), (2); Table 10; docs/theory.md#bound",
    )
