"""The law that a report is about, in words: a design, a law of the program without gains, or one of the user's own."""

from dataclasses import dataclass
from pathlib import PurePath

from wspd_design.certificates.setting.feedback import TRAIN_SPEED, read_names
from wspd_design.certificates.setting.traced_law import trace
from wspd_design.controllers.family import FAMILIES, Family
from wspd_design.controllers.protocol import Law, acts_on_vehicle
from wspd_design.design.own_controller import is_own_controller
from wspd_design.design.records import Design
from wspd_design.parameters.fingerprint import fingerprint


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportedLaw:
    """What is known about a law before anything is computed."""

    name: str
    title: str  # a noun phrase, as it stands within a sentence
    origin: str  # where it comes from
    own: bool  # whether it comes from outside of this program
    called: str  # what commands call it beside the files of its report; empty where they cannot
    equations: tuple[
        str, ...
    ]  # numbers of the paper's equations that it rests on, besides those of the plant
    acts_on: str  # one wheelset, or all of them
    fingerprint: str  # of all that decides what it does
    reads: (
        tuple[str, ...] | None
    )  # what its commands depend on, after its start; None where it cannot be traced

    @property
    def told_speed(self) -> bool:
        """Whether a command may depend on the train speed that the law is told."""
        return self.reads is None or TRAIN_SPEED in self.reads

    @property
    def heading(self) -> str:
        """Title at the start of a sentence."""
        return self.title[0].upper() + self.title[1:]


def reported_law(law: Law, made: Design | None, *, written: str) -> ReportedLaw:
    """Describe a law.

    Parameters
    ----------
    law : Law
        The controller that runs.
    made : Design or None
        The design that it was built from.
    written : str
        Name by which the user called a law without a design, ``FILE.py:NAME`` for one of a file; empty for one that
        was made in Python.

    Raises
    ------
    UserError
        If something in the law has no content that can be told.
    """
    family = FAMILIES.get(written.partition(":")[0] if made is None else made.law)
    title, origin = _words(family, written)
    traced = trace(law)
    return ReportedLaw(
        name=law.name if made is None else made.name,
        title=title,
        origin=origin,
        own=family is None,
        called=_called(made, written),
        equations=() if family is None else family.equations,
        acts_on="all wheelsets of the vehicle together" if acts_on_vehicle(law) else "one wheelset",
        fingerprint=fingerprint(law),
        reads=None if isinstance(traced, str) else read_names(traced),
    )


def _called(made: Design | None, written: str) -> str:
    if made is not None:
        return "design.toml"
    file, colon, name = written.rpartition(":")
    return f"{PurePath(file).name}{colon}{name}" if is_own_controller(written) else written


def _words(family: Family | None, written: str) -> tuple[str, str]:
    if family is not None:
        return family.title, family.origin
    return "law of one's own", f"from {written}" if written else "made in Python"
