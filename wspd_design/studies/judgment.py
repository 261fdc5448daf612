"""What a design reaches of its requirements."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from wspd_design.certificates.records import Certificate, Status
from wspd_design.design.judging import judge
from wspd_design.design.records import Design
from wspd_design.design.requirements import Judged, Requirements
from wspd_design.parameters.records import Rail


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgment:
    """The requirements of a design, and what it reaches of them on stops that no search has seen."""

    requirements: Requirements
    judged: tuple[Judged, ...]

    @property
    def limited(self) -> tuple[Judged, ...]:
        """What has a limit, or must be proved."""
        return tuple(each for each in self.judged if each.met is not None)

    @property
    def missed(self) -> tuple[Judged, ...]:
        """What is beyond its limit, or not proved."""
        return tuple(each for each in self.judged if each.met is False)


def judgment(
    design: Design,
    rail: Rail,
    certificates: Sequence[Certificate],
    *,
    folder: Path,
    progress: Callable[[str], None] = lambda _stage: None,
) -> Judgment | None:
    """Judge a design on its held-out stops and by the checks that must be proved.

    Parameters
    ----------
    design : Design
        The design.
    rail : Rail
        Its design rail.
    certificates : sequence of Certificate
        All checks of it.
    folder : Path
        Of the design file.
    progress : callable, optional
        Told what is simulated.

    Returns
    -------
    Judgment or None
        None for a design that states no requirements.
    """
    wanted = design.requirements
    if wanted is None:
        return None
    progress(f"requirements on {wanted.held_out.sets} stops")
    proved = {each.name for each in certificates if each.status is Status.PROVED}
    titles = {each.name: each.title for each in certificates}
    return Judgment(
        requirements=wanted,
        judged=(
            *judge(design, rail, folder=folder),
            *(
                Judged(
                    requirement=name,
                    title=titles.get(name, name),
                    limit=None,
                    reached=None,
                    met=name in proved,
                )
                for name in wanted.certificates
            ),
        ),
    )
