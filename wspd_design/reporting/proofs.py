"""Proofs of a check as a report lists them: many of a kind, which differ in bound and range alone, in one row."""

import re
from collections.abc import Sequence
from dataclasses import replace

from wspd_design.certificates.records import Domain, Interval, Proof

MOST = 24
"""Proofs that are listed one by one."""
_BOUNDED = re.compile(r"(?P<what>.*) (?P<relation>[<>]=) (?P<bound>-?[0-9][-+.0-9e]*)(?P<unit>.*)")


def listed(proofs: Sequence[Proof]) -> tuple[Proof, ...]:
    """Return proofs to list: one for each, or where there are many one for each kind.

    A kind says that the same lies on the same side of a bound. Its row tells between which numbers the bounds lie, the
    hull of the ranges, how many proofs there are, and the sum of their boxes.

    Parameters
    ----------
    proofs : sequence of Proof
        Of one certificate.
    """
    if len(proofs) <= MOST:
        return tuple(proofs)
    kinds: dict[tuple[str, ...], list[Proof]] = {}
    for each in proofs:
        kinds.setdefault(_kind(each), []).append(each)
    return tuple(_row(each) for each in kinds.values())


def _kind(proof: Proof) -> tuple[str, ...]:
    found = _BOUNDED.fullmatch(proof.statement)
    if found is None or proof.domain is None:
        return (proof.text,)
    names = [each.name for each in (*proof.domain.varied, *proof.domain.held)]
    return (*found.group("what", "relation", "unit"), *names)


def _row(proofs: Sequence[Proof]) -> Proof:
    first, domains = proofs[0], [each.domain for each in proofs if each.domain is not None]
    if len(proofs) == 1 or len(domains) < len(proofs):
        return first
    matches = [found for each in proofs if (found := _BOUNDED.fullmatch(each.statement))]
    ends = sorted({found["bound"] for found in matches}, key=float)
    bounds = ends[0] if len(ends) == 1 else f"{ends[0]} to {ends[-1]}"
    what, relation, unit = matches[0].group("what", "relation", "unit")
    return Proof(
        statement=f"{what} {relation} {bounds}{unit}, in {len(proofs)} parts",
        domain=_hull(domains),
        boxes=sum(each.boxes for each in proofs),
    )


def _hull(domains: Sequence[Domain]) -> Domain:
    """Return the smallest domain that holds all of some that name the same quantities."""
    return replace(
        domains[0],
        varied=_over(*(each.varied for each in domains)),
        held=_over(*(each.held for each in domains)),
    )


def _over(*ranges: Sequence[Interval]) -> tuple[Interval, ...]:
    return tuple(
        replace(same[0], low=min(each.low for each in same), high=max(each.high for each in same))
        for same in zip(*ranges, strict=True)
    )
