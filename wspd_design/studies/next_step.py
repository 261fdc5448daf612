"""What would meet the requirements that a design misses: other laws and sample times by the same rules, tried.

Nothing is guessed: each alternative is designed, its loop is checked and it stops where the design stopped, or on the
same drawn stops. How many were tried is told.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from wspd_design.certificates.records import Certificate
from wspd_design.certificates.suite import verify
from wspd_design.design.catalog import controller_of
from wspd_design.design.judging import judge_law
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.design.requirements import Requirements
from wspd_design.design.selection import RULES, design_controller
from wspd_design.design.stop_requirements import LOOP, MODEL, StopRequirements
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.simulation.comparison import trial
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
    progress: Callable[[str], None] = lambda _stage: None,
) -> NextStep:
    """Try the laws that have rules for their gains, as sampled and sampled five times as often.

    Parameters
    ----------
    judged : Judgment
        Of the design that is not accepted.
    law : str or None
        Its law, which is tried with another sample time only; None for a law without rules.
    vehicle, rail, asked, scenario, plant
        As of the design.
    vehicle_name : str
        Shipped name or path, for drawn stops.
    certificates : sequence of Certificate
        Of the design: what they say of the equations holds for every law.
    full_adhesion : float
        Distance of the same stop while no wheel slides [m].
    progress : callable, optional
        Told each alternative before it is tried.
    """
    faster = max(asked.sample_time / FASTER, SHORTEST)
    wanted = judged.wanted
    of_stop = isinstance(wanted, StopRequirements)
    candidates = [
        (name, span)
        for span in dict.fromkeys((asked.sample_time, faster))
        for name in RULES
        if (name, span) != (law, asked.sample_time)
    ]
    if not of_stop:  # each has as many stops as the design itself
        candidates = [each for each in candidates if each[1] == asked.sample_time or each[0] == law]
    of_model = {each.name: each for each in certificates if each.name in MODEL}
    tried = []
    for name, span in candidates:
        progress(f"alternative: {name}, {span * 1e3:g} ms")
        specification = replace(asked, sample_time=span)
        try:
            made = design_controller(vehicle, rail, specification, law=name)
            built = controller_of(made, vehicle, rail)
        except UserError:  # no gains by these rules: no alternative
            continue
        if isinstance(wanted, Requirements):
            missed = [
                each.requirement
                for each in judge_law(built, wanted, vehicle, vehicle_name, asked.speeds)
                if each.met is False
            ]
            tried.append(Alternative(law=name, sample_time=span, missed=tuple(missed), distance=None))
            continue
        problem = stability_problem(vehicle, rail, built, specification, seed=scenario.seed)
        checked = verify(problem, only=_of_the_law(wanted), figures=False)
        found: Mapping[str, Certificate] = of_model | {each.name: each for each in checked}
        stop = trial(vehicle, built, scenario, slip_reference=asked.slip, plant=plant)
        result = judged_stop(
            wanted, stop, found, growth=growth_of(problem, checked), full_adhesion=full_adhesion
        )
        unmet = tuple(each.name for each in (*result.missed, *result.open))
        tried.append(
            Alternative(
                law=name,
                sample_time=span,
                missed=unmet,
                distance=stop.metrics.distance,
                silent=tuple(
                    each.name for each in result.rows if each.outcome is Outcome.TOLD and each.name == "loop"
                ),
            )
        )
    return NextStep(
        tried=tuple(sorted(tried, key=lambda each: (len(each.missed), each.distance or 0.0))),
        stops=wanted.held_out.sets if isinstance(wanted, Requirements) else 1,
    )


def _of_the_law(wanted: StopRequirements) -> tuple[str, ...]:
    """Return the checks that must be run again for another law."""
    return tuple(name for name in (*wanted.not_refuted, *wanted.certificates) if name not in MODEL) or (LOOP,)
