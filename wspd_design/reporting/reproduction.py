"""The page about the paper: its Section 7, computed again, with what holds and what does not."""

from collections.abc import Callable
from datetime import datetime
from pathlib import Path

from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_entries
from wspd_design.reporting.blocks import Block, Bullets, Definition, Document, Heading
from wspd_design.reporting.made_by import made_by
from wspd_design.reporting.output import write_document
from wspd_design.reporting.paper.figures import figures
from wspd_design.reporting.paper.inferred import inferred
from wspd_design.reporting.paper.locomotive import locomotive as on_locomotive
from wspd_design.reporting.paper.model import model
from wspd_design.reporting.paper.parts import parts
from wspd_design.reporting.paper.table10 import table10
from wspd_design.reporting.paper.track import track
from wspd_design.reporting.paper.verdicts import conclusions, summary, verdict
from wspd_design.reporting.report import report_time
from wspd_design.reporting.text import CodeSpan, rich
from wspd_design.studies.inferred import mark
from wspd_design.studies.paper.reproduction import Reproduction, reproduce

NAME = "paper"
SECTIONS = (conclusions, table10, parts, figures, track)


def write_reproduction(
    folder: Path, progress: Callable[[str], object], *, locomotive: bool = True
) -> tuple[Path, ...]:
    """Compute Section 7 of the paper again and write the page about it, as HTML and as PDF.

    Parameters
    ----------
    folder : Path
        Where the files go; it is made if it does not exist.
    progress : callable
        Told each stage before it starts.
    locomotive : bool
        Whether to simulate the stops on the multibody model, too.

    Returns
    -------
    tuple of Path
        The files that were written.

    Raises
    ------
    UserError
        If the folder cannot be made or written.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserError(
            f"folder {folder} cannot be made ({error.strerror}); choose one that can be written"
        ) from error
    timestamp = report_time()
    small = "" if locomotive else " --small"
    made = reproduce(progress, command=f"wspd reproduce{small} -o {folder.as_posix()}", locomotive=locomotive)
    progress("typesetting")
    document = reproduction_document(made, timestamp)
    paths = (folder / f"{NAME}.html", folder / f"{NAME}.pdf")
    for path in paths:
        write_document(document, path)
    return paths


def reproduction_document(made: Reproduction, timestamp: datetime) -> Document:
    """Return the page about the paper, not yet rendered."""
    return Document(
        title="The paper, computed again",
        subtitle="Section 7: an adaptive fuzzy sliding-mode law beside three rule tables on the ER24PC, four-axle "
        "locomotive, from 120 km/h",
        status_line=f"wspd {made.provenance.program_version} · {timestamp:%Y-%m-%d %H:%M} UTC · "
        f"package {made.provenance.package_sha256[:12]}",
        verdict=verdict(made),
        summary=summary(made),
        blocks=(
            *(block for section in SECTIONS for block in section(made)),
            *_on_locomotive(made),
            *_limits(made),
        ),
        provenance=_provenance(made),
        attachments=(),
        timestamp=timestamp,
        author=f"wspd {made.provenance.program_version}",
        keywords=("wheel slide protection", "reproduction", "ER24PC"),
    )


def _on_locomotive(made: Reproduction) -> tuple[Block, ...]:
    """Return the sections about the multibody model; none where its stops were left out."""
    found = made.locomotive
    if found is None:
        return ()
    return (
        *model(found.model, load_entries("vehicle", made.small.vehicle.name)),
        *on_locomotive(made.small, found),
        *inferred(found.model, found.tornado),
    )


def _limits(made: Reproduction) -> tuple[Block, ...]:
    sensitive = {each.controller for each in made.small.evidence.stops if each.check.sensitive}
    return (
        Heading(text="What this page does not show", anchor="limits"),
        Bullets(
            items=(
                "The paper's simulation itself: the data of its 82 degrees of freedom, its friction and its rule "
                "tables are not printed. Ours has four axles with weight transfer and data fitted to Table 10; see the "
                "sources of any report for each number."
                + (
                    f" {made.locomotive.model.name} is a reconstruction: that it has as many degrees of freedom does "
                    f"not make it the paper's model. {mark(made.locomotive.model)}"
                    if made.locomotive
                    else ""
                ),
                "The rule tables of Knorr-Bremse and Mitsubishi are lost and were reconstructed: what stands here "
                "about them is about the reconstruction.",
                f"Digits that are not there: the closed loops of {', '.join(sorted(sensitive))} can be sensitive, "
                "and then amplify what nobody can measure. Such distances carry half their spread."
                if sensitive
                else "No closed loop is sensitive; all distances are good to a millionth.",
                "Speeds are measured exactly and the train speed is known, as in the paper.",
            )
        ),
    )


def _provenance(made: Reproduction) -> tuple[Definition, ...]:
    origin = made.provenance
    return (
        Definition(term="Command", text=(CodeSpan(text=origin.command),)),
        Definition(
            term="To make it again",
            text=rich(
                "Run the command with the program and the packages below; everything else ships with the program. With "
                "`SOURCE_DATE_EPOCH` set, it gives the same file, byte for byte."
            ),
        ),
        *made_by(origin),
        Definition(term="Seed of the track", text=str(origin.seed)),
    )
