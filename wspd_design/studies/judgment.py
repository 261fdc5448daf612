"""What a design reaches of its requirements, each with the evidence for it, its margin and the source of its limit."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum

from wspd_design.certificates.records import Certificate, Status
from wspd_design.controllers.protocol import Law
from wspd_design.design.criteria import CRITERIA
from wspd_design.design.judging import judge_law
from wspd_design.design.requirements import Judged, Limit, Requirements, judged_by
from wspd_design.design.stop_requirements import LOOPS, MODEL, StopRequirements
from wspd_design.parameters.bounds import Ends
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Vehicle
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.runs import Ending
from wspd_design.studies.figures_of_stop import figures_of_stop
from wspd_design.studies.loop_growth import Growth, speaking

_HARMLESS = (Status.PROVED, Status.EVIDENCE, Status.NOT_APPLICABLE, Status.VACUOUS, Status.LIMITATION)
_PROOFS_OF_THE_LOOP = ("lpv_lyapunov", "sampled_invariance", "slip_band")
_TOLD = ("efficiency_worst", "stopping_distance", "slip_undershoot", "valve_switches", "vented_air")
"""Criteria that the report tells of a single stop without a limit."""


class Outcome(Enum):
    """What became of a requirement; the value says it in words."""

    MET = "met"
    MISSED = "not met"
    OPEN = "open"
    TOLD = "told, not required"


@dataclass(frozen=True, slots=True, kw_only=True)
class Requirement:
    """One row of the table of requirements."""

    id: str  # R1, R2, ... in the order of causes
    name: str  # of the criterion, or of what is asked of checks
    title: str
    limit: float | None  # SI; None without one, or where a check decides
    at_least: bool = False
    unit: str = "-"  # in which people tell limit and figure
    reached: float | None  # SI; None where there is no such figure
    perfect: float | None = None  # what a perfect law reaches in the same stop
    outcome: Outcome
    evidence: str  # what shows it
    checks: tuple[str, ...] = ()  # names of those that decide it
    source: str = ""  # of the limit
    verified: bool = False  # whether somebody compared the limit with its source
    remark: str = ""  # what the outcome rests on

    @property
    def margin(self) -> float | None:
        """Distance from the limit over it, positive where it is kept [-]; None without a limit above 0."""
        if self.limit is None or self.reached is None or not self.limit > 0.0:
            return None
        reserve = (self.reached - self.limit) if self.at_least else (self.limit - self.reached)
        return reserve / self.limit


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgment:
    """The requirements of a design and what it reaches of them, on one stop or on drawn ones."""

    name: str  # of the template, or of the table
    wanted: StopRequirements | Requirements
    rows: tuple[Requirement, ...]

    @property
    def limited(self) -> tuple[Requirement, ...]:
        """What is required."""
        return tuple(each for each in self.rows if each.outcome is not Outcome.TOLD)

    @property
    def missed(self) -> tuple[Requirement, ...]:
        """What is not reached, causes before their effects."""
        return self._with(Outcome.MISSED)

    @property
    def open(self) -> tuple[Requirement, ...]:
        """What is neither reached nor missed."""
        return self._with(Outcome.OPEN)

    @property
    def accepted(self) -> bool:
        """Whether everything that is required is reached."""
        return all(each.outcome is Outcome.MET for each in self.limited)

    @property
    def verdict(self) -> str:
        """One word: a requirement that is missed decides, then one that is open."""
        return "rejected" if self.missed else "accepted" if self.accepted else "undecided"

    @property
    def weakest(self) -> Requirement | None:
        """The first requirement that is missed, else the first open one, else the one with the smallest margin."""
        if self.missed or self.open:
            return (*self.missed, *self.open)[0]
        known = [each for each in self.limited if each.margin is not None]
        return min(known, key=lambda each: each.margin or 0.0, default=None)

    def _with(self, outcome: Outcome) -> tuple[Requirement, ...]:
        return tuple(each for each in self.rows if each.outcome is outcome)


def judgment(
    law: Law,
    wanted: StopRequirements | Requirements,
    *,
    vehicle: Vehicle,
    vehicle_name: str,
    speeds: Ends,
    own: Trial,
    certificates: Sequence[Certificate],
    growth: Growth | None,
    full_adhesion: float,
    progress: Callable[[str], None] = lambda _stage: None,
) -> Judgment:
    """Judge a law by its requirements.

    Parameters
    ----------
    law : Law
        The law.
    wanted : StopRequirements or Requirements
        On the stop of its report, or on drawn stops; paths of rails as seen from here.
    vehicle : Vehicle
        The vehicle.
    vehicle_name : str
        Shipped name or path, of which drawn stops vary the numbers; empty for a record that was made in Python.
    speeds : Ends
        Range of operation [m/s].
    own : Trial
        Its stop.
    certificates : sequence of Certificate
        All checks of it.
    growth : Growth or None
        Of a deviation near the reference; None where no check tells.
    full_adhesion : float
        Distance of the same stop while no wheel slides [m].
    progress : callable, optional
        Told what is simulated.

    Raises
    ------
    UserError
        If drawn stops are asked for of a vehicle without a file.
    """
    found = {each.name: each for each in certificates}
    if isinstance(wanted, StopRequirements):
        return judged_stop(wanted, own, found, growth=growth, full_adhesion=full_adhesion)
    if not vehicle_name:
        raise UserError(
            f"requirements on drawn stops need the file of vehicle {vehicle.name}; write it, and give its path"
        )
    progress(f"requirements on {wanted.held_out.sets} stops")
    judged = judge_law(law, wanted, vehicle, vehicle_name, speeds)
    return judged_drawn(wanted, judged, own, found)


def judged_drawn(
    wanted: Requirements, judged: Sequence[Judged], own: Trial, found: Mapping[str, Certificate]
) -> Judgment:
    """Put together what was reached on drawn stops and what checks say."""
    limits = {each.criterion: each for each in wanted.limits}
    evidence = f"{wanted.held_out.sets} simulated stops"
    rows = [
        _by_checks("sound", "equations and simulation are sound", MODEL, found),
        *(_row(each, limits.get(each.requirement), evidence) for each in judged if each.met is not None),
        *(_proved(name, found) for name in wanted.certificates),
        _stops(own),
        *(_row(each, None, evidence) for each in judged if each.met is None),
    ]
    return Judgment(name="own", wanted=wanted, rows=_numbered(rows))


def judged_stop(
    wanted: StopRequirements,
    own: Trial,
    found: Mapping[str, Certificate],
    *,
    growth: Growth | None,
    full_adhesion: float,
) -> Judgment:
    """Judge one stop and the checks beside it."""
    reached = figures_of_stop(own, full_adhesion)
    limits = {each.criterion: each for each in wanted.limits}
    told = {name: value for name, value in reached.items() if name in limits or name in _TOLD}
    others = [name for name in wanted.not_refuted if name not in (*MODEL, *LOOPS)]
    model = tuple(name for name in wanted.not_refuted if name in MODEL)
    evidence = "one simulated stop"
    by_name = {each.requirement: each for each in judged_by(wanted.limits, told)}
    judged = [
        replace(by_name[name], title=CRITERIA[name].title_of(one_stop=True))
        for name in (*limits, *(name for name in by_name if name not in limits))
    ]
    perfect = own.metrics.perfect_slip_rms
    rows = [
        *([_by_checks("sound", "equations and simulation are sound", model, found)] if model else []),
        *([_loop(found, growth)] if set(LOOPS) & set(wanted.not_refuted) else []),
        *(_by_checks(name, f"not refuted: {name}", (name,), found) for name in others),
        *(_proved(name, found) for name in wanted.certificates),
        *(_row(each, limits[each.requirement], evidence, perfect) for each in judged if each.met is not None),
        _stops(own),
        *(_row(each, None, evidence) for each in judged if each.met is None),
    ]
    return Judgment(name=wanted.name, wanted=wanted, rows=_numbered(rows))


def evidence_of(certificates: Sequence[Certificate]) -> str:
    """Say what kind of evidence some checks are."""
    statuses = {each.status for each in certificates}
    if Status.REFUTED in statuses:
        return "counterexample"
    kinds = [
        word
        for status, word in (
            (Status.PROVED, "proof"),
            (Status.LIMITATION, "proof"),
            (Status.EVIDENCE, "samples"),
        )
        if status in statuses
    ]
    return " and ".join(dict.fromkeys(kinds)) or "none"


def _by_checks(name: str, title: str, names: Sequence[str], found: Mapping[str, Certificate]) -> Requirement:
    """Judge what holds while no check of some refutes it and none of them is undecided."""
    known = [found[each] for each in names if each in found]
    refuted = [each.name for each in known if each.status is Status.REFUTED]
    undecided = [each.name for each in known if each.status not in _HARMLESS and each.name not in refuted]
    outcome = Outcome.MISSED if refuted else Outcome.OPEN if undecided or not known else Outcome.MET
    return Requirement(
        id="",
        name=name,
        title=title,
        limit=None,
        reached=None,
        outcome=outcome,
        evidence=evidence_of(known),
        checks=tuple(each.name for each in known if each.status is not Status.NOT_APPLICABLE),
        source="no evidence counts without it",
        remark=f"refuted: {', '.join(refuted)}"
        if refuted
        else f"undecided: {', '.join(undecided)}"
        if undecided
        else "",
    )


def _loop(found: Mapping[str, Certificate], growth: Growth | None) -> Requirement:
    """Judge the loop near its reference by a check of its sampled poles; else by a proof about the sampled loop."""
    check = speaking(found)
    speaks = check is not None
    proofs = tuple(
        each for each in found.values() if each.name in _PROOFS_OF_THE_LOOP and each.status is Status.PROVED
    )
    outcome, evidence, remark = Outcome.TOLD, "none", "no check speaks about this law"
    names: tuple[str, ...] = ()
    if check is not None:
        settled = {
            Status.REFUTED: Outcome.MISSED,
            Status.UNDECIDED: Outcome.OPEN,
        }
        outcome, evidence = settled.get(check.status, Outcome.MET), evidence_of([check])
        names, remark = (check.name,), "nominal parameters"
    elif proofs:
        outcome, evidence, names, remark = Outcome.MET, "proof", tuple(each.name for each in proofs), ""
    return Requirement(
        id="",
        name="loop",
        title="growth of a deviation per sample",
        limit=1.0 if growth is not None and speaks else None,
        reached=growth.factor if growth is not None and speaks else None,
        outcome=outcome,
        evidence=evidence,
        checks=names,
        source="stability of the sampled loop with its valve: below 1",
        remark=remark,
    )


def _proved(name: str, found: Mapping[str, Certificate]) -> Requirement:
    check = found.get(name)
    return Requirement(
        id="",
        name=name,
        title=f"proved: {(check.title if check else name)}",
        limit=None,
        reached=None,
        outcome=Outcome.MET if check is not None and check.status is Status.PROVED else Outcome.MISSED,
        evidence=evidence_of([check] if check else []),
        checks=(name,) if check is not None and check.status is not Status.NOT_APPLICABLE else (),
        source="asked for by the table",
        remark="" if check is None else check.status.name.lower().replace("_", " "),
    )


def _stops(own: Trial) -> Requirement:
    return Requirement(
        id="",
        name="standstill",
        title="the train comes to a standstill",
        limit=None,
        reached=None,
        outcome=Outcome.MET if own.run.ending is Ending.STOPPED else Outcome.MISSED,
        evidence="one simulated stop",
        source="what a brake is for",
        remark="" if own.run.ending is Ending.STOPPED else own.run.ending.value,
    )


def _row(judged: Judged, limit: Limit | None, evidence: str, perfect: float = math.nan) -> Requirement:
    rule = CRITERIA.get(judged.requirement)
    outcome = {True: Outcome.MET, False: Outcome.MISSED, None: Outcome.TOLD}[judged.met]
    known = judged.requirement == "slip_rms" and math.isfinite(perfect)
    lacking = judged.reached is None and judged.requirement in ("slip_rms", "slip_overshoot")
    if lacking and not known:
        outcome = Outcome.OPEN  # not even a perfect law is known to get there
    return Requirement(
        id="",
        name=judged.requirement,
        title=judged.title,
        limit=judged.limit,
        at_least=rule is not None and rule.at_least,
        unit="-" if rule is None else rule.unit,
        reached=judged.reached,
        perfect=perfect if known else None,
        outcome=outcome,
        evidence=evidence if rule is not None else "quadratic functions at corners",
        source="" if limit is None else limit.source or "chosen by the author of the table",
        verified=limit is not None and limit.verified,
        remark="the slip never reaches its reference" if lacking else "",
    )


def _numbered(rows: Sequence[Requirement]) -> tuple[Requirement, ...]:
    return tuple(replace(each, id=f"R{place}") for place, each in enumerate(rows, start=1))
