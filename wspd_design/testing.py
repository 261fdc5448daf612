"""Statements about stability in the tests of users: ``assert_certified("mine.toml", "reaching")``."""

from pathlib import Path

from wspd_design.certificates.kernel.file import FOLDER
from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.design.records import Design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle

_LEVELS = (Status.EVIDENCE, Status.PROVED)
"""From the weaker support of a claim to the stronger."""


def assert_certified(
    design: Design | Problem | str | Path,
    *names: str,
    vehicle: Vehicle | str | Path | None = None,
    rail: Rail | str | Path | None = None,
    at_least: Status = Status.PROVED,
    limitation: bool = False,
    effort: float = 1.0,
) -> tuple[Certificate, ...]:
    """Assert that checks of a design succeed.

    What ``wspd certify`` has kept beside a design file is taken if the checkers accept it again; only what is missing
    is searched.

    Parameters
    ----------
    design : Design, str, Path or Problem
        A design, its file, or a problem that you made for a controller of your own.
    *names : str
        Checks, as ``wspd verify`` names them.
    vehicle, rail : Vehicle, Rail, str or Path, optional
        Records, shipped names or files; those of the design by default.
    at_least : Status
        PROVED, or EVIDENCE, which a proof meets as well.
    limitation : bool
        Whether the proof of what the loop cannot do, LIMITATION, is what you ask for.
    effort : float
        Of the searches, as a multiple of the usual work.

    Returns
    -------
    tuple of Certificate
        One for each check.

    Raises
    ------
    AssertionError
        If a check finds less; the message is its explanation with the worst point.
    UserError
        If a name is unknown or nothing is asked for.
    """
    __tracebackhide__ = True  # pytest shows the line of the user's test
    if at_least not in _LEVELS:
        raise UserError(f"at_least = {at_least.name} must be PROVED or EVIDENCE")
    allowed = (Status.LIMITATION,) if limitation else _LEVELS[_LEVELS.index(at_least) :]
    return _expect(_problem(design, vehicle, rail), names, allowed, _stored(design), effort)


def assert_refuted(
    design: Design | Problem | str | Path,
    *names: str,
    vehicle: Vehicle | str | Path | None = None,
    rail: Rail | str | Path | None = None,
    effort: float = 1.0,
) -> tuple[Certificate, ...]:
    """Assert that checks of a design are refuted; parameters and errors as in :func:`assert_certified`."""
    __tracebackhide__ = True
    return _expect(_problem(design, vehicle, rail), names, (Status.REFUTED,), _stored(design), effort)


def _stored(design: Design | Problem | str | Path) -> Path | None:
    """Return where wspd certify keeps what is proved about a design file."""
    return Path(design).with_suffix(FOLDER) if isinstance(design, (str, Path)) else None


def _expect(
    problem: Problem, names: tuple[str, ...], allowed: tuple[Status, ...], stored: Path | None, effort: float
) -> tuple[Certificate, ...]:
    from wspd_design.certificates import suite
    from wspd_design.certificates.search.budget import Budget

    __tracebackhide__ = True
    if not names:
        raise UserError(f"no check is named; available: {', '.join(suite.NAMES)}")
    certificates = suite.verify(problem, only=names, budget=Budget(effort=effort), stored=stored)
    failed = [_message(each, allowed) for each in certificates if each.status not in allowed]
    if failed:
        raise AssertionError("\n\n".join(failed))
    return certificates


def _problem(
    design: Design | Problem | str | Path,
    vehicle: Vehicle | str | Path | None,
    rail: Rail | str | Path | None,
) -> Problem:
    from wspd_design.design.case import CaseOptions, case_of
    from wspd_design.design.file import read_design
    from wspd_design.design.problem import stability_problem

    if isinstance(design, Problem):
        if vehicle is not None or rail is not None:
            raise UserError("a problem has its own vehicle and rail; leave vehicle and rail out")
        return design
    options = CaseOptions(vehicle=vehicle, rail=rail)
    made = design if isinstance(design, Design) else read_design(design)
    case = case_of(made, options, where=made.name if isinstance(design, Design) else str(design))
    return stability_problem(case.vehicle, case.rail, case.controller, case.specification)


def _message(certificate: Certificate, allowed: tuple[Status, ...]) -> str:
    """Say what was asked for, what was found, and where it is worst."""
    asked = " or ".join(status.name for status in allowed)
    lines = [
        f"{certificate.name} is {certificate.status.name}, asked for {asked}: {certificate.claim}",
        certificate.explanation,
    ]
    lines += [f"{each.status.name}: {each.text}" for each in certificate.hypotheses]
    if certificate.margin is not None:
        lines.append(f"margin {_margin(certificate.margin)}")
    if certificate.worst_point:
        lines.append(f"worst point: {_place(certificate.worst_point)}")
    return "\n  ".join(lines)


def _margin(margin: Range) -> str:
    low, high = ("open" if end is None else f"{end:.4g}" for end in (margin.low, margin.high))
    return f"{low} to {high} {margin.unit}".removesuffix(" -")


def _place(points: tuple[Point, ...]) -> str:
    return ", ".join(f"{each.name} {each.value:.4g} {each.unit}".removesuffix(" -") for each in points)
