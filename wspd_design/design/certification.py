"""Certify designs and check certificates: what ``wspd certify`` and ``wspd check`` do, as functions."""

from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from wspd_design.certificates.kernel.file import FOLDER, certificate_text, file_name
from wspd_design.certificates.records import Certificate, Certificates, Problem, Status
from wspd_design.design.case import Case, CaseOptions, case_of, load_case
from wspd_design.design.catalog import is_design_file
from wspd_design.design.own_controller import is_own_controller
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.records import Rail, Vehicle
from wspd_design.parameters.taken import described
from wspd_design.parameters.writing import write_whole

if TYPE_CHECKING:
    from wspd_design.certificates.replay import Replayed

Loop: TypeAlias = Design | Problem | str | Path
"""A design, the path of its file, a controller's name, ``FILE.py:NAME``, or a problem made by hand."""


def certify(
    design: Loop,
    *,
    only: Collection[str] | None = None,
    vehicle: Vehicle | str | Path | None = None,
    rail: Rail | str | Path | None = None,
    effort: float = 1.0,
    folder: str | Path | None = None,
    stored: Path | None = None,
    progress: Callable[[str], None] = lambda _: None,
    found: Callable[[Certificate], object] = lambda _: None,
) -> Certificates:
    """Prove or refute what can be said about a design.

    What lies in the folder ``NAME.certificates`` beside a design file and is accepted is not searched again.

    Parameters
    ----------
    design : Design, Problem, str or Path
        A design, the path of its file, a controller's name, ``FILE.py:NAME``, or a problem.
    only : collection of str, optional
        Names of checks, as ``wspd verify`` names them; all by default.
    vehicle, rail : Vehicle, Rail, str or Path, optional
        Records, shipped names or files; those of the design by default.
    effort : float
        Of each search, as a multiple of the usual work, which is counted.
    folder : str or Path, optional
        Where to write one file for each check that speaks about the design, as soon as it is there; files of the same
        names are replaced. Nothing is written by default.
    stored : Path, optional
        Folder of certificates to take what is accepted from, in place of the one beside the design.
    progress : callable, optional
        Told what is being done.
    found : callable, optional
        Told each certificate as soon as it is there.

    Returns
    -------
    Certificates
        A tuple, one for each check.

    Raises
    ------
    UserError
        If a name is unknown, the design cannot be read or the folder cannot be written.
    """
    from wspd_design.certificates import suite
    from wspd_design.certificates.search.budget import Budget

    problem = problem_of(design, vehicle=vehicle, rail=rail)
    if not effort > 0.0:
        raise UserError(f"effort = {effort:g} must be above 0, a multiple of the usual work")

    def keep(certificate: Certificate) -> None:
        if folder is not None:
            write_certificates([certificate], Path(folder))
        found(certificate)

    return suite.verify(
        problem,
        only=only or None,
        progress=progress,
        budget=Budget(effort=effort),
        stored=stored or stored_beside(design),
        figures=False,
        found=keep,
    )


def check(
    certificate: Path | str,
    design: Loop,
    *,
    vehicle: Vehicle | str | Path | None = None,
    rail: Rail | str | Path | None = None,
) -> "Replayed":
    """Decide about a certificate again, without the program that found it.

    The whole certificate is made again from the design and the proofs; a file that says anything else is refused.

    Parameters
    ----------
    certificate : Path or str
        The file, or its text, which begins with a brace.
    design : Design, Problem, str or Path
        What was certified, as in :func:`certify`.
    vehicle, rail : Vehicle, Rail, str or Path, optional
        As in :func:`certify`.

    Returns
    -------
    Replayed
        Whether the file is accepted, why not, and the certificate as it was made again.

    Raises
    ------
    UserError
        If the file or the design cannot be read.
    """
    from wspd_design.certificates.replay import replay

    written = isinstance(certificate, str) and certificate.lstrip().startswith("{")
    text = str(certificate) if written else read_certificate_file(Path(certificate))
    return replay(problem_of(design, vehicle=vehicle, rail=rail), text)


def problem_of(
    design: Loop, *, vehicle: Vehicle | str | Path | None = None, rail: Rail | str | Path | None = None
) -> Problem:
    """Return the closed loop and domain that checks of a design speak about; parameters as in :func:`certify`."""
    if isinstance(design, Problem):
        if vehicle is not None or rail is not None:
            raise UserError("a problem has its own vehicle and rail; leave vehicle and rail out")
        return design
    if not isinstance(design, Design | str | Path):
        raise UserError(
            f"what is certified is a Design, a Problem or a name, not {described(design)}; of a law make a problem, "
            "stability_problem(vehicle, rail, law, Specification())"
        )
    options = CaseOptions(vehicle=vehicle, rail=rail)
    if isinstance(design, Design):
        return problem_of_case(case_of(design, options, where=design.name))
    return problem_of_case(load_case(str(design), options))


def problem_of_case(case: Case, *, seed: int = 0) -> Problem:
    """Return the closed loop and domain that checks of a case speak about."""
    return stability_problem(case.vehicle, case.rail, case.controller, case.specification, seed=seed)


def folder_beside(design: str | Path) -> Path:
    """Return the folder for what is kept about a design, beside its file if it has one."""
    name = str(design)
    return Path(name.rpartition(":")[0] if is_own_controller(name) else name).with_suffix(FOLDER)


def stored_beside(design: Loop) -> Path | None:
    """Return the folder of certificates beside a design file or an own controller, if there is one."""
    if not isinstance(design, (str, Path)) or not (
        is_design_file(str(design)) or is_own_controller(str(design))
    ):
        return None
    folder = folder_beside(design)
    return folder if folder.is_dir() else None


def refused_beside(
    name: str,
    design: Loop,
    *,
    vehicle: Vehicle | str | Path | None = None,
    rail: Rail | str | Path | None = None,
) -> str | None:
    """Say why the file of a check beside a design is not taken; None where there is no file.

    Parameters
    ----------
    name : str
        Of the check.
    design, vehicle, rail
        As in :func:`certify`.
    """
    folder = stored_beside(design)
    path = None if folder is None else folder / f"{name}.json"
    if path is None or not path.is_file():
        return None
    found = check(path, design, vehicle=vehicle, rail=rail)
    if found.certificate is not None and found.unchecked:
        return f"{found.certificate.status.name} is nothing that a checker decides"
    return found.reason


def write_certificates(certificates: Sequence[Certificate], folder: Path) -> dict[str, int]:
    """Write what speaks about the design, each check a file that appears when it is complete.

    Returns
    -------
    dict
        Size of each file [byte] by the name of the check.
    """
    kept = [each for each in certificates if each.status is not Status.NOT_APPLICABLE]
    texts = {each.name: (folder / file_name(each), certificate_text(each).encode()) for each in kept}
    try:
        if texts:
            folder.mkdir(exist_ok=True)
        for path, content in texts.values():
            write_whole(path, lambda target, content=content: target.write_bytes(content))  # type: ignore[misc]
    except OSError as error:
        raise UserError(f"folder {folder} cannot be written ({error.strerror}); choose another one") from None
    return {name: len(content) for name, (_, content) in texts.items()}


def read_certificate_file(path: Path) -> str:
    """Read a file; bytes that are not text are left to the checker to refuse."""
    from wspd_design.certificates.kernel.checker import MOST_BYTES

    try:
        with path.open("rb") as file:
            return file.read(MOST_BYTES + 1).decode("utf-8", errors="replace")
    except OSError as error:
        raise UserError(
            f"{path} cannot be read ({error.strerror}); name a file that wspd certify wrote"
        ) from None
