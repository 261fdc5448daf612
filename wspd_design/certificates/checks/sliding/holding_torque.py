"""The torque that holds the reference, for every law: nowhere below 0 from there on, and how much of T_max it takes."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.sliding.sliding_exists import never, torques
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.theorems.authority import out_of_reach
from wspd_design.certificates.theorems.holding import HOLDING_TORQUE, sides
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.units import KMH

PLOT_SPEEDS = 60


def search(problem: Problem) -> Mapping[str, Stated]:
    """Enclose the torque on both sides; prove that the brake never reaches the reference, if it does not."""
    return {**torques(sides(problem)), **never(out_of_reach(problem))}


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - of the nominal vehicle
    """Torque over speed beside the limit of the brake."""
    import numpy as np

    speeds = np.geomspace(*problem.speeds, PLOT_SPEEDS)
    plant = slip_dynamics(problem.vehicle, problem.rail, problem.slip, speeds)
    axes = ("speed [km/h]", "torque per wheelset [kN m]")
    return Figures(
        series=(
            series(f"holds slip {problem.slip:g}", *axes, speeds * KMH, -plant.drift / plant.gain / 1e3),
            level("T_max", *axes, speeds * KMH, problem.nominal("max torque") / 1e3),
        )
    )


CHECK = Check(theorem=HOLDING_TORQUE, search=search, figures=figures)
