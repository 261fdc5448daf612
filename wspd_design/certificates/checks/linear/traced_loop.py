"""Poles and margins of the sampled loop of any law, from the graph of its step."""

from collections.abc import Mapping

from wspd_design.certificates.checks.frame import Check, Figures, level, series
from wspd_design.certificates.checks.linear.margins import Loop, Margins, margins
from wspd_design.certificates.kernel.finding import Stated
from wspd_design.certificates.records import Certificate, Problem
from wspd_design.certificates.setting.traced_loop import SAME, Rest
from wspd_design.certificates.theorems.traced_loop import ROUNDING, TRACED_LOOP, rests
from wspd_design.parameters.units import KMH


def search(problem: Problem) -> Mapping[str, Stated]:
    """Say where the loop is slowest and where it bears least, or where a deviation grows most."""
    found = _resting(problem)
    worst = max(found, key=lambda each: each.radius)
    slips = [each.slip for each in found]
    numbers = {
        "speed": worst.speed,
        "slip": worst.slip,
        "radius": worst.radius,
        "speeds": float(len(found)),
        "lowest slip": min(slips),
        "highest slip": max(slips),
    }
    stated = {"poles": Stated(numbers=numbers)}
    if worst.radius > 1.0 + ROUNDING:
        return stated | {"growing": Stated(place={"speed": worst.speed})}
    borne = [(margins_at(each, problem.sample_time), each.speed) for each in found]
    known = [(each, speed) for each, speed in borne if each is not None]
    if len(known) < len(borne):
        return stated
    least, speed = min(known, key=lambda each: each[0].disk)
    return stated | {
        "margins": Stated(
            numbers={
                "speed": speed,
                "gain up": least.gain_up,
                "gain down": least.gain_down,
                "phase": least.phase,
                "delay": least.delay,
                "disk": least.disk,
            }
        )
    }


def margins_at(rest: Rest, sample_time: float) -> Margins | None:
    """Margins at the commands of the first wheelset, both changed alike; None where they follow two rules."""
    import numpy as np

    left, sizes, right = np.linalg.svd(rest.commanded, full_matrices=False)
    still = np.abs(np.linalg.eigvals(rest.opened) - 1.0) < SAME
    if sizes[1] > SAME * sizes[0] or np.sum(still) < rest.free:
        return None
    opened = Loop(rest.opened, rest.entered @ left[:, :1], -sizes[0] * right[:1], sample_time)
    return margins(opened, rest.free)


def figures(problem: Problem, certificate: Certificate) -> Figures:  # noqa: ARG001 - samples of the nominal loop
    """Largest pole over speed."""
    import numpy as np

    found = _resting(problem)
    at = np.array([each.speed * KMH for each in found])
    axes = ("speed [km/h]", "magnitude of the largest pole [-]")
    if len(found) < 2:
        return Figures()
    return Figures(
        series=(
            series("sampled loop", *axes, at, np.array([each.radius for each in found])),
            level("limit", *axes, at, 1.0),
        )
    )


def _resting(problem: Problem) -> list[Rest]:
    return [each for each in rests(problem) if isinstance(each, Rest)]


CHECK = Check(theorem=TRACED_LOOP, search=search, figures=figures)
