"""Claims on the edges of the box where the adhesion is extreme, and their findings combined into one verdict."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from wspd_design.certificates.kernel.claim import Claim
from wspd_design.certificates.kernel.finding import Finding
from wspd_design.certificates.kernel.obligation import Inequality
from wspd_design.certificates.records import Problem
from wspd_design.certificates.setting.adhesion_edges import Ranges, adhesion_edges
from wspd_design.certificates.theorems.theorem import all_of


def on_edges(
    key: str, problem: Problem, claim: Callable[[Ranges], Claim], *, most: bool, axle: bool
) -> tuple[Inequality, ...]:
    """Return a claim on all edges of the largest (or smallest) adhesion: together they are the claim on the domain.

    Parameters
    ----------
    key : str
        Of the claim; that of an edge has the name of its number added.
    problem : Problem
        With the bounds of rail and contact.
    claim : callable
        From the ranges of an edge to the claim there; its expression rises with the adhesion (or falls).
    most : bool
        Whether the claim is tightest where the adhesion is largest.
    axle : bool
        Whether it speaks about every axle.
    """
    edges = adhesion_edges(problem, most=most, axle=axle)
    return tuple(Inequality(key=f"{key}, {name}", claim=claim(ranges)) for name, ranges in edges.items())


def of_key(findings: Iterable[tuple[str, Finding]], key: str) -> tuple[Finding, ...]:
    """Return the findings about the edges of a claim."""
    return tuple(each for name, each in findings if name.startswith(f"{key}, "))


def together(findings: Sequence[Finding]) -> Finding:
    """Return what findings about parts of a domain say about the whole: the tightest, with the loosest bound."""
    upper = findings[0].relation == "<="
    tightest = max(findings, key=lambda each: each.low if upper else -each.high)
    return replace(
        tightest,
        status=all_of(*findings),
        low=tightest.low if upper else min(each.low for each in findings),
        high=max(each.high for each in findings) if upper else tightest.high,
        shown=tightest.shown if all(each.proved for each in findings) else "",
    )
