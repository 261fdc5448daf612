"""What a claim varies and what it holds, in the words of its sentence."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from wspd_design.certificates.quantities import AXLE, STATE
from wspd_design.certificates.records import Domain, Problem
from wspd_design.certificates.setting import domain


@dataclass(frozen=True, slots=True, kw_only=True)
class Scope:
    """On which numbers a claim is made."""

    text: str
    domain: Domain  # whose words end the text
    varied: tuple[str, ...]  # over all of their range
    held: tuple[str, ...]  # at their nominal value, though they have a range

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all coordinates of a point of the domain."""
        return (*STATE, *self.varied)


def scope(problem: Problem, uses: Sequence[str], hold: Iterable[str] = ()) -> Scope:
    """Say on which numbers a claim is made that depends on ``uses`` and holds some of them.

    Parameters
    ----------
    problem : Problem
        Domain, vehicle and rail.
    uses : sequence of str
        Names in the table of the quantities.
    hold : iterable of str
        Those of them that keep their nominal value.
    """
    kept = set(hold)
    wide = tuple(name for name in domain.uncertain(problem) if name in uses)
    varied = tuple(name for name in wide if name not in kept)
    held = tuple(name for name in wide if name in kept)
    state = tuple(name for name in STATE if name in uses)
    who = (
        "for every axle, with a load transfer that follows the deceleration without delay, "
        if set(AXLE) <= set(uses)
        else "for the axle at static load, "
        if "mu0" in uses
        else ""
    )
    where = domain.domain_of(problem, (*state, *varied), held)
    return Scope(text=f"{who}on {where.text}", domain=where, varied=varied, held=held)
