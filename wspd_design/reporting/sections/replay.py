"""How to make a report again and have all of it checked: one command, from nothing but its attachments."""

from wspd_design.reporting import numbers
from wspd_design.reporting.blocks import Block, Code, Definition, Heading, Paragraph, Table
from wspd_design.reporting.made_by import made_by
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import CodeSpan, Text, rich
from wspd_design.studies.dossier import Dossier
from wspd_design.studies.provenance import Provenance

REPLAY = "replay"
DIGITS = 16  # of a SHA-256 that a table shows; SHA256SUMS has all


def replay(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section about replay; a report that no command makes has its certificates to check, and says so."""
    made = dossier.provenance
    again: tuple[Block, ...] = (
        Paragraph(
            text=rich(
                "No command makes this report again: a program in Python made it by `wspd_design.dossier` and "
                "`wspd_design.write_report`. The attached file of a check is decided again where the law was made: by "
                "`wspd_design.check`, with the problem that `wspd_design.stability_problem` makes of law, vehicle, "
                "rail and specification."
            )
        ),
    )
    if made.command:
        again = (
            Paragraph(
                text=rich(
                    "The first command takes the files out of this report, makes it again in a folder of its own, and "
                    "tells the first number, verdict or byte that differs. The second one lets the checkers decide "
                    "again about every attached certificate, without the programs that found the proofs."
                )
            ),
            Code(text="wspd report --replay report.html\nwspd check report.html"),
        )
    return (
        Heading(text="Replay", anchor=REPLAY),
        *again,
        Paragraph(
            text=rich(
                "By hand: save all attachments into one folder. `sha256sum --check SHA256SUMS` tells whether they are "
                "whole, the command in `command.txt` makes the report from them, and `report.json` holds its numbers "
                "in full length; [](#input-files) lists what it was made from. Of what the report says of itself, only "
                "the date does not follow from the attached files and from what it was made by; "
                "`SOURCE_DATE_EPOCH` sets it."
                if made.command
                else "By hand: save all attachments into one folder. `sha256sum --check SHA256SUMS` tells whether they "
                "are whole, `report.json` holds the numbers in full length, and [](#input-files) lists what it was "
                "made from."
            )
        ),
        _inputs(made),
    )


def _inputs(made: Provenance) -> Table:
    return build(
        list(made.inputs),
        (
            ColumnOf(title="File", read=lambda each: (CodeSpan(text=each.name),)),
            ColumnOf(title="What it is", read=lambda each: each.meaning),
            ColumnOf(title="SHA-256 begins", read=lambda each: (CodeSpan(text=each.sha256[:DIGITS]),)),
        ),
        caption="What the report was made from; all of it is attached, with the whole SHA-256 of each file.",
        anchor="input-files",
    )


def provenance(dossier: Dossier) -> tuple[Definition, ...]:
    """Return how the report was made."""
    made = dossier.provenance
    by_hand: Text = "none; a program in Python made the report"
    named = " ".join(each.name for each in made.inputs)
    return (
        Definition(term="Command", text=(CodeSpan(text=made.command),) if made.command else by_hand),
        Definition(term="To make it again", text=rich(f"See [](#{REPLAY}).")),
        *made_by(made),
        Definition(term="Seed", text=str(made.seed)),
        Definition(
            term="Inputs, SHA-256",
            text=(CodeSpan(text=made.input_hash), ", ", CodeSpan(text=f"sha256sum {named} | sha256sum")),
        ),
        Definition(term="Searches cut by their budget", text=searches_cut(made)),
        *_fingerprints(dossier),
    )


def _fingerprints(dossier: Dossier) -> tuple[Definition, ...]:
    if dossier.design is None:
        return (Definition(term="Law, fingerprint", text=dossier.law.fingerprint),)
    return (
        Definition(term="Vehicle, fingerprint in the design", text=dossier.design.vehicle_hash),
        Definition(term="Design rail, fingerprint in the design", text=dossier.design.rail_hash),
    )


def searches_cut(made: Provenance) -> str:
    """Say how many searches gave up; their budget is counted in steps, so that a busy machine changes nothing."""
    cut = made.searches_cut
    return f"{len(cut)}{f' ({numbers.listing(list(cut))})' if cut else ''}; work is counted, not timed"
