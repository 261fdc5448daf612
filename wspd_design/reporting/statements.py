"""Statements of checks as a report prints them: typeset, and with their domain by its name instead of its numbers."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from wspd_design.certificates.records import Certificate, Domain, Interval, Proof
from wspd_design.reporting.formula_text import with_formulas
from wspd_design.reporting.text import Inline, Link, Text, spans

DOMAINS = "domains"
"""Anchor of the table of the domains."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Statements:
    """The domains of a set of certificates, each named once: D1, D2 and so on, in the order of the certificates."""

    domains: Mapping[Domain, str]

    def name(self, domain: Domain) -> Link:
        """Return the name of a domain, which leads to the table."""
        return Link(anchor=DOMAINS, text=self.domains[domain])

    def claim(self, certificate: Certificate) -> Text:
        """Return the claim of a certificate."""
        domain = certificate.domain
        if domain is None:
            return with_formulas(certificate.claim)
        before, _, after = certificate.claim.partition(domain.text)
        return (*spans(with_formulas(before)), self.name(domain), *spans(with_formulas(after)))

    def proof(self, proof: Proof, certificate: Certificate) -> Text:
        """Return on what a proof holds: on the domain of its claim, but for what its own statement narrows."""
        if proof.domain is None:
            return ""
        whole = certificate.domain
        own = (*proof.domain.varied, *proof.domain.held)
        if whole is None:
            return with_formulas(proof.domain.text)
        narrowed = [each for each in own if each not in (*whole.varied, *whole.held)]
        if not narrowed:
            return (self.name(whole),)
        return (self.name(whole), " with ", *spans(with_formulas(", ".join(each.text for each in narrowed))))

    def quantities(self) -> tuple[Interval, ...]:
        """Return the ranges of all quantities that vary on a domain, and the values of those that are held only."""
        found: dict[str, Interval] = {}
        for domain in self.domains:
            found |= {each.name: each for each in domain.held if each.name not in found}
            found |= {each.name: each for each in domain.varied}
        return tuple(found.values())


def statements_of(certificates: Iterable[Certificate]) -> Statements:
    """Name the domains of certificates."""
    domains = dict.fromkeys(each.domain for each in certificates if each.domain is not None)
    return Statements(domains={domain: f"D{place}" for place, domain in enumerate(domains, 1)})


def linked(text: Text, anchors: Mapping[str, str]) -> Text:
    """Make links of the names of checks that stand in a text."""
    found: list[Inline] = []
    for part in spans(text):
        if not isinstance(part, str):
            found.append(part)
            continue
        rest = part
        while names := [name for name in anchors if name in rest]:
            first = min(names, key=lambda name: (rest.index(name), -len(name)))
            before, _, rest = rest.partition(first)
            found += [before] if before else []
            found.append(Link(anchor=anchors[first], text=first))
        found += [rest] if rest else []
    return tuple(found)
