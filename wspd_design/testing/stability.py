"""Statements about stability: ``assert_certified("mine.toml", "reaching")``."""

from pathlib import Path

from wspd_design.certificates.records import Certificate, Point, Problem, Range, Status
from wspd_design.design.certification import Loop, certify, refused_beside, stored_beside
from wspd_design.design.records import Design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.testing.running import SAMPLED, SEARCHED, located, record

_LEVELS = (Status.EVIDENCE, Status.PROVED)
"""From the weaker support of a claim to the stronger."""


def assert_certified(
    design: Loop,
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
        A design, its file, a controller's name, ``FILE.py:NAME``, or a problem that you made.
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
    return _expect(design, names, allowed, vehicle, rail, effort)


def assert_refuted(
    design: Loop,
    *names: str,
    vehicle: Vehicle | str | Path | None = None,
    rail: Rail | str | Path | None = None,
    effort: float = 1.0,
) -> tuple[Certificate, ...]:
    """Assert that checks of a design are refuted; parameters and errors as in :func:`assert_certified`."""
    __tracebackhide__ = True
    return _expect(design, names, (Status.REFUTED,), vehicle, rail, effort)


def _expect(
    design: Loop,
    names: tuple[str, ...],
    allowed: tuple[Status, ...],
    vehicle: Vehicle | str | Path | None,
    rail: Rail | str | Path | None,
    effort: float,
) -> tuple[Certificate, ...]:
    from wspd_design.certificates import suite

    __tracebackhide__ = True
    if not names:
        raise UserError(f"no check is named; available: {', '.join(suite.NAMES)}")
    design, vehicle, rail = located(design), located(vehicle), located(rail)  # type: ignore[assignment]
    try:
        certificates = certify(design, only=names, vehicle=vehicle, rail=rail, effort=effort)
        for each in certificates:
            _record(each, design, vehicle, rail)
    except UserError as error:
        raise UserError(str(error)) from None  # the sentence, without the way to where it was found
    failed = [_message(each, allowed) for each in certificates if each.status not in allowed]
    if failed:
        raise AssertionError("\n\n".join(failed))
    return certificates


def _record(
    certificate: Certificate,
    design: Loop,
    vehicle: Vehicle | str | Path | None,
    rail: Rail | str | Path | None,
) -> None:
    """Keep status and margin as figures of the running test, and why the check was searched, if it was."""
    name = f"{_named(design)}/{certificate.name}"
    record(f"{name}/status", certificate.status.name)
    margin = certificate.margin
    if margin is not None:
        unit = "" if margin.unit == "-" else f" [{margin.unit}]"
        for end, value in (("low", margin.low), ("high", margin.high)):
            if value is not None:
                record(f"{name}/margin {end}{unit}", f"{value:.6g}")
    if certificate.searched:
        sampled = certificate.status is Status.EVIDENCE
        why = SAMPLED if sampled else _why(certificate.name, design, vehicle, rail)
        record(f"{name}/{SEARCHED}", why)


def _why(
    name: str, design: Loop, vehicle: Vehicle | str | Path | None, rail: Rail | str | Path | None
) -> str:
    """Say why a check was searched."""
    if stored_beside(design) is None:
        return "no certificates lie beside it"
    reason = refused_beside(name, design, vehicle=vehicle, rail=rail)
    return "no certificate of it lies beside the design" if reason is None else f"its certificate: {reason}"


def _named(design: Loop) -> str:
    match design:
        case Design():
            return design.name
        case Problem():
            return design.controller.name
    return Path(design).name


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
