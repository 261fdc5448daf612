"""What the checks need to know of a law: its surface, its layer, and what it feeds back."""

from collections.abc import Iterable
from typing import TypeAlias

from wspd_design.certificates.records import Certificate, Hypothesis, Problem, Status
from wspd_design.controllers.adaptive_fuzzy import AdaptiveFuzzy
from wspd_design.controllers.protocol import Command, Controller, Measurement
from wspd_design.controllers.sliding_mode import SlidingMode

SlipLaw: TypeAlias = AdaptiveFuzzy | SlidingMode
"""Laws with a sliding surface in the slip."""

PROBE_SPEEDS = (3.0, 10.0, 20.0, 33.0)  # m/s
PROBE_SLIPS = (0.02, 0.08, 0.14, 0.25, 0.5)
PROBE_TORQUES = (0.0, 10e3, 40e3)  # N m
PROBE_WHEEL_CHANGES = (0.8, 0.95, 1.05, 1.2)  # earlier over present wheel speed


def surface_rate(law: SlipLaw) -> float:
    """Rate c = K_I / K_P of the error on the surface [1/s]."""
    if isinstance(law, SlidingMode):
        return law.gains.surface_rate
    return law.gains.integral_gain / law.gains.proportional_gain


def layer(law: SlipLaw) -> float:
    """Width Phi / K_P of the boundary layer, in slip [-]."""
    if isinstance(law, SlidingMode):
        return law.gains.boundary_layer
    return law.gains.boundary_layer / law.gains.proportional_gain


_WEAKNESS = (Status.UNDECIDED, Status.VACUOUS, Status.EVIDENCE, Status.PROVED)
"""From the weakest support of a theorem to the strongest."""


def of_theorem(hypotheses: Iterable[Hypothesis]) -> Status:
    """Status of what follows from hypotheses: that of the weakest.

    A hypothesis that is refuted takes the ground from the argument, not the truth from its conclusion: the theorem
    is undecided then.
    """
    found = [each.status for each in hypotheses]
    return min((s if s in _WEAKNESS else Status.UNDECIDED for s in found), key=_WEAKNESS.index)


def not_applicable(problem: Problem, name: str, claim: str, reason: str) -> Certificate:
    """Say that a claim does not speak about the controller, and why."""
    return Certificate(
        name=name,
        title=name,
        claim=claim,
        status=Status.NOT_APPLICABLE,
        explanation=f"{problem.controller.name} {reason}.",
        method="form of the law",
    )


def no_surface(problem: Problem, name: str, claim: str) -> Certificate:
    """Say that a claim speaks about laws with a sliding surface."""
    reason = "decides by what it measures, without a sliding surface"
    return not_applicable(problem, name, claim, reason)


def slip_feedback_only(problem: Problem) -> Hypothesis:
    """Examine whether a law feeds back neither torque nor wheel acceleration.

    The memory of the laws with a sliding surface holds integrals alone. Of any other law a command that
    depends on an earlier wheel speed may be feedback of acceleration.
    """
    law = problem.controller
    radius = problem.vehicle.wheel_radius
    text = f"{law.name} feeds back neither torque nor wheel acceleration"
    memory = not isinstance(law, (AdaptiveFuzzy, SlidingMode))
    for speed in PROBE_SPEEDS:
        for slip in PROBE_SLIPS:
            wheel = speed * (1.0 - slip) / radius
            plain = _command_after(law, speed, wheel, wheel, 0.0)
            others = [_command_after(law, speed, wheel, wheel, torque) for torque in PROBE_TORQUES]
            if memory:
                earlier = [share * wheel for share in PROBE_WHEEL_CHANGES]
                others += [_command_after(law, speed, before, wheel, 0.0) for before in earlier]
            if any(other != plain for other in others):
                return Hypothesis(text=text, status=Status.REFUTED)
    return Hypothesis(text=text, status=Status.EVIDENCE)


def _command_after(law: Controller, speed: float, earlier: float, present: float, torque: float) -> Command:
    """Command at the second of two samples."""
    first = Measurement(speed=speed, wheel_speed=earlier, torque=torque)
    state, _ = law.step(law.start(first), first)
    _, command = law.step(state, Measurement(speed=speed, wheel_speed=present, torque=torque))
    return command
