"""Theorem about what a law reads: the command of every wheelset with a brake must depend on how its own wheel turns."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from wspd_design.certificates.kernel.checker import FORMAT, Refused, Work
from wspd_design.certificates.kernel.obligation import Condition, Numbers, Obligation, Special
from wspd_design.certificates.records import Certificate, Problem, Status
from wspd_design.certificates.setting.feedback import HISTORIES, Measured, differs, measured, read_by_commands
from wspd_design.certificates.setting.traced_law import TracedLaw, trace
from wspd_design.certificates.theorems.theorem import Findings, Theorem, hypothesis

WHEEL_SPEED = "wheel speed"
WORK = 20_000


def traced(problem: Problem) -> TracedLaw:
    """Return the graph of the law of a problem that the theorem speaks about."""
    law = trace(problem.controller)
    assert not isinstance(law, str)
    return law


def _can_be_traced(problem: Problem) -> str:
    law = trace(problem.controller)
    return f"is not judged: {law}" if isinstance(law, str) else ""


def wheelsets_of(problem: Problem, law: TracedLaw) -> tuple[int, ...]:
    """Wheelsets that the law commands and that have a brake, counted from 1; a law of one stands for all."""
    if law.wheelsets is None:
        return (1,)
    return tuple(k for k, share in enumerate(problem.vehicle.brake_shares, start=1) if share > 0.0)


def _title(law: TracedLaw, wheelset: int) -> str:
    return "the wheelset" if law.wheelsets is None else f"wheelset {wheelset}"


def _obligations(problem: Problem) -> tuple[Obligation, ...]:
    law = traced(problem)
    read = read_by_commands(law)
    return tuple(
        obligation
        for each in wheelsets_of(problem, law)
        for obligation in (
            Condition(
                key=f"path, {each}",
                text=f"a path leads from the speed of its own wheel to the command of {_title(law, each)}",
                holds=_own(law, each) in read[each - 1],
            ),
            Special(
                key=f"histories, {each}",
                text="two histories that differ in the speed of this wheel alone give different commands",
                check=partial(_differ, law, each),
            ),
        )
    )


def _differ(law: TracedLaw, wheelset: int, proof: Mapping[str, Any], work: Work) -> Numbers:
    """Run the two histories that a proof names."""
    work.spend(WORK)
    number = proof.get("pair")
    if not isinstance(number, int) or proof != pair_of_histories(number):
        raise Refused("the proof must name one pair of histories by its number")
    if not differs(law, wheelset - 1, measured(law).index(_own(law, wheelset)), number):
        raise Refused("these two histories give the same commands")
    return {"pair": float(number)}


def pair_of_histories(number: int) -> dict[str, Any]:
    """Return the proof that a pair of histories gives different commands."""
    return {"format": FORMAT, "pair": number}


def found_pair(law: TracedLaw, wheelset: int) -> int | None:
    """Return the number of the first pair of histories that shows it, if there is one among those tried."""
    place = measured(law).index(_own(law, wheelset))
    return next((k for k in range(HISTORIES) if differs(law, wheelset - 1, place, k)), None)


def _own(law: TracedLaw, wheelset: int) -> Measured:
    return Measured(name=WHEEL_SPEED, wheelset=None if law.wheelsets is None else wheelset)


def _tell(problem: Problem, findings: Findings) -> Certificate:
    law = traced(problem)
    wheelsets = wheelsets_of(problem, law)
    blind = [each for each in wheelsets if findings[f"path, {each}"].status is Status.REFUTED]
    shown = all(findings[f"histories, {each}"].status is Status.PROVED for each in wheelsets)
    status = Status.REFUTED if blind else Status.PROVED if shown else Status.UNDECIDED
    read = read_by_commands(law)
    if blind:
        whose = ", ".join(_title(law, each) for each in blind)
        meaning = (
            f"The command of {whose} does not depend on how its own wheel turns: whether it slides or not changes "
            "nothing."
        )
    elif shown:
        meaning = "Each command was seen to change when the speed of its own wheel alone did."
    else:
        meaning = "A path leads there, and no two histories were found that show it."
    asked = [f"path, {each}" for each in wheelsets]
    asked += [f"histories, {each}" for each in wheelsets if each not in blind]
    return Certificate(
        claim=f"The command of {problem.controller.name} to "
        f"{'its wheelset' if law.wheelsets is None else 'every wheelset with a brake'} depends on the speed of this "
        "wheel, at the same sample or later; what the law reads before its first sample does not count.",
        status=status,
        explanation=f"{meaning} {_said(law, [read[each - 1] for each in wheelsets])}",
        hypotheses=tuple(hypothesis(findings[each].asked, findings[each]) for each in asked),
        method="paths of the graph of the step, followed through its memory; pairs of histories in doubles",
        reference="docs/theory.md#traced-loop",
    )


def _said(law: TracedLaw, read: Sequence[frozenset[Measured]]) -> str:
    """Say which measurements reach no command, some, or all."""
    kinds = dict.fromkeys(each.name for each in measured(law))
    used = {each.name for reads in read for each in reads}
    never = [name for name in kinds if name not in used]
    said = f"Commands read {_listed([name for name in kinds if name in used]) or 'nothing'}"
    if never:
        said += f"; nothing leads to them from {_listed(never)}"
    if law.wheelsets is not None and used:
        others = any(
            each.name == WHEEL_SPEED and each.wheelset is not None and each.wheelset - 1 != place
            for place, reads in enumerate(read)
            for each in reads
        )
        said += (
            ". They read the speeds of other wheels, too" if others else ". They read no other wheel's speed"
        )
    return f"{said}."


def _listed(names: Sequence[str]) -> str:
    *first, last = names or ("",)
    return f"{', '.join(first)} and {last}" if first else last


FEEDBACK = Theorem(
    name="feedback",
    title="What the commands depend on",
    claim="The command of every wheelset with a brake depends on the speed of its own wheel.",
    speaks_about=_can_be_traced,
    obligations=_obligations,
    tell=_tell,
    assumes=frozenset(),
)
