"""What would meet the requirements that a design misses: other laws and sample times by the same rules, tried.

Nothing is guessed: each alternative is designed, its loop is checked and it stops where the design stopped, or on the
same drawn stops. How many were tried is told.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from wspd_design.certificates.records import Certificate
from wspd_design.certificates.suite import verify
from wspd_design.controllers.protocol import Law
from wspd_design.design.catalog import controller_of
from wspd_design.design.judging import judge_law
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.design.requirements import Requirements
from wspd_design.design.selection import RULES, design_controller
from wspd_design.design.stop_requirements import LOOPS, MODEL, StopRequirements
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.simulation.comparison import Trial, trial
from wspd_design.simulation.records import Scenario
from wspd_design.studies.judgment import Judgment, Outcome, judged_stop
from wspd_design.studies.loop_growth import growth_of

FASTER = 5.0  # times, that the law is sampled as often in an alternative
SHORTEST = 5e-3  # s, sample time of one


@dataclass(frozen=True, slots=True, kw_only=True)
class Alternative:
    """Another law or sample time, with gains by its rules."""

    law: str
    sample_time: float  # s
    missed: tuple[str, ...]  # names of the requirements that it does not meet
    distance: float | None  # m, of the same stop; None on drawn stops
    silent: tuple[str, ...] = ()  # requirements that no check judges for this law


@dataclass(frozen=True, slots=True, kw_only=True)
class NextStep:
    """What was tried in place of a design that is not accepted; the best comes first."""

    tried: tuple[Alternative, ...]
    stops: int  # simulated for each

    @property
    def clears(self) -> tuple[Alternative, ...]:
        """Those that meet everything."""
        return tuple(each for each in self.tried if not each.missed)


def next_step(
    judged: Judgment,
    *,
    law: str | None,
    vehicle: Vehicle,
    vehicle_name: str,
    rail: Rail,
    asked: Specification,
    scenario: Scenario,
    plant: str,
    certificates: Sequence[Certificate],
    full_adhesion: float,
    compared: Sequence[tuple[Law, Trial]] = (),
    progress: Callable[[str], None] = lambda _stage: None,
) -> NextStep:
    """Try the other laws that have rules for their gains, and this one sampled five times as often.

    If none of them will do, the others are tried with that sample time, too.

    Parameters
    ----------
    judged : Judgment
        Of the design that is not accepted.
    law : str or None
        Its law; None for one that no rule made.
    vehicle, rail, asked, scenario, plant
        As of the design.
    vehicle_name : str
        Shipped name or path, for drawn stops.
    certificates : sequence of Certificate
        Of the design: what they say of the equations holds for every law.
    full_adhesion : float
        Distance of the same stop while no wheel slides [m].
    compared : sequence of tuple
        Laws whose same stop is simulated already, with it.
    progress : callable, optional
        Told each alternative before it is tried.
    """
    faster = max(asked.sample_time / FASTER, SHORTEST)
    of_model = {each.name: each for each in certificates if each.name in MODEL}
    wanted = judged.wanted

    def attempt(name: str, span: float) -> Alternative | None:
        progress(f"alternative: {name}, {span * 1e3:g} ms")
        specification = replace(asked, sample_time=span)
        try:
            made = design_controller(vehicle, rail, specification, law=name)
            built = controller_of(made, vehicle, rail)
        except UserError:  # no gains by these rules: no alternative
            return None
        if isinstance(wanted, Requirements):
            reached = judge_law(built, wanted, vehicle, vehicle_name, asked.speeds)
            missed = tuple(each.requirement for each in reached if each.met is False)
            return Alternative(law=name, sample_time=span, missed=missed, distance=None)
        problem = stability_problem(vehicle, rail, built, specification, seed=scenario.seed)
        checked = verify(problem, only=_of_the_law(wanted), figures=False)
        found = of_model | {each.name: each for each in checked}
        stop = next((each for law, each in compared if _same(law, built)), None)
        if stop is None:
            stop = trial(vehicle, built, scenario, slip_reference=asked.slip, plant=plant)
        result = judged_stop(
            wanted, stop, found, growth=growth_of(problem, checked), full_adhesion=full_adhesion
        )
        return Alternative(
            law=name,
            sample_time=span,
            missed=tuple(each.name for each in (*result.missed, *result.open)),
            distance=stop.metrics.distance,
            silent=tuple(
                each.name for each in result.rows if each.outcome is Outcome.TOLD and each.name == "loop"
            ),
        )

    others = [name for name in RULES if name != law]
    first = [(name, asked.sample_time) for name in others]
    if law in RULES and faster < asked.sample_time:
        first.append((law, faster))
    tried = [found for each in first if (found := attempt(*each)) is not None]
    if all(each.missed for each in tried) and faster < asked.sample_time:
        tried += [found for name in others if (found := attempt(name, faster)) is not None]
    return NextStep(
        tried=tuple(sorted(tried, key=lambda each: (len(each.missed), each.distance or 0.0))),
        stops=wanted.held_out.sets if isinstance(wanted, Requirements) else 1,
    )


def _same(law: Any, built: Any) -> bool:
    """Tell whether two laws do the same; how they are called does not matter."""
    return type(law) is type(built) and law == replace(built, name=law.name)


def _of_the_law(wanted: StopRequirements) -> tuple[str, ...]:
    """Return the checks that must be run again for another law."""
    return tuple(name for name in (*wanted.not_refuted, *wanted.certificates) if name not in MODEL) or LOOPS
