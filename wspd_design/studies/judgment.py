"""What a design reaches of its requirements."""

from dataclasses import dataclass

from wspd_design.design.requirements import Judged, Requirements


@dataclass(frozen=True, slots=True, kw_only=True)
class Judgment:
    """The requirements of a design and what it reaches of them on held-out stops."""

    requirements: Requirements
    judged: tuple[Judged, ...]
    effort: str  # how its gains were found, in sentences

    @property
    def limited(self) -> tuple[Judged, ...]:
        """What has a limit."""
        return tuple(each for each in self.judged if each.met is not None)

    @property
    def missed(self) -> tuple[Judged, ...]:
        """What is beyond its limit."""
        return tuple(each for each in self.judged if each.met is False)
