"""Whom a theorem speaks about: the step that runs has to be the law of the theorem, whatever its class says."""

from typing import cast

from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.traced_law import law_of_theorem
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.offers import Surface
from wspd_design.controllers.sliding_mode import SlidingMode

SLIDING, ADAPTIVE = "smc", "afsmc"
"""Families of the laws with a sliding surface in the slip."""


def every_law(problem: Problem) -> str:  # noqa: ARG001 - about every design
    """Speak about every design."""
    return ""


def sliding_mode(problem: Problem) -> str:
    """Speak about the sliding mode with a friction model."""
    return _why_not(problem, SLIDING)


def adaptive(problem: Problem) -> str:
    """Speak about the adaptive fuzzy law, printed or repaired."""
    return _why_not(problem, ADAPTIVE)


def with_surface(problem: Problem) -> str:
    """Speak about both laws with a sliding surface in the slip."""
    if not isinstance(problem.controller, Surface):
        return "decides by what it measures, without a sliding surface"
    reasons = [_why_not(problem, family) for family in (SLIDING, ADAPTIVE)]
    return "" if "" in reasons else " or ".join(reasons)


def sliding_law(problem: Problem) -> SlidingMode:
    """Return the controller of a problem that :func:`sliding_mode` speaks about: its gains and its model are known."""
    return cast(SlidingMode, problem.controller)


def adaptive_law(problem: Problem) -> AdaptiveFuzzy:
    """Return the controller of a problem that :func:`adaptive` speaks about."""
    return cast(AdaptiveFuzzy, problem.controller)


def surface_of(problem: Problem) -> Surface:
    """Return the controller of a problem that :func:`with_surface` speaks about."""
    return cast(Surface, problem.controller)


def _why_not(problem: Problem, family: str) -> str:
    reason = law_of_theorem(problem, family)
    return f"is not judged: {reason}" if reason else ""
