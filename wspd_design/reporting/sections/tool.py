"""The program as a tool: the class it would have, what controls its faults, how it is tested, its limits."""

import hashlib
from importlib.resources import files

from wspd_design.reporting.blocks import Block, Bullets, Heading, Paragraph, Table
from wspd_design.reporting.tables import ColumnOf, build
from wspd_design.reporting.text import Text, rich
from wspd_design.studies.dossier import Dossier

TOOL = "tool-statement"
_USES = (
    (
        "Checks, certificates, simulated stops and this report",
        "It could hide a fault of the design. It puts nothing into the software of the brake.",
        "T2",
        "A checker that shares no code with the searches decides about every proof and witness, and a reader can let "
        "it decide again; single stops are repeated with half of their steps and balanced in momentum and energy; the "
        "whole report can be made again from its attachments.",
    ),
    (
        "Rules and searches that choose gains",
        "A wrong gain comes into the software of the brake where it is copied from the design.",
        "T3, or T2 where the gains are verified in the target by other means",
        "Each gain stands in the file of its design with the rule that chose it. The checks and stops of this "
        "report judge the law with these numbers, whoever chose them.",
    ),
)
"""Use, what a fault could do, class, and what controls the fault here."""


def tool(dossier: Dossier) -> tuple[Block, ...]:
    """Return the section."""
    made = dossier.provenance
    checker = files("wspd_design").joinpath("certificates/kernel/checker.py").read_bytes()
    state = " It is known to be changed since the last commit of its clone." if made.changed else ""
    items: tuple[Text, ...] = (
        rich(
            f"*Configuration.* wspd {made.program_version}, git tree `{made.package_tree[:12]}`, with the packages "
            f"that stand under [Provenance](#provenance).{state} All of it is named by its content, so that another "
            "program cannot have the same name."
        ),
        rich(
            f"*What has to be trusted for a proof.* python-flint and `certificates/kernel/checker.py`: "
            f"{len(checker.splitlines())} lines, SHA-256 `{hashlib.sha256(checker).hexdigest()}`. That a proved "
            "statement is about this design rests on the equations, laws and theorems of the package besides."
        ),
        rich(
            "*Tests.* They belong to the source tree: `make test` in a clone runs them. They compare the equations "
            "with their derivation, the stops with independent integrations, and the certificates with forged ones, "
            "and plant faults that have to be seen. This report was not made by the run that tests the program, and "
            "holds no result of it."
        ),
        rich(
            "*Known limits.* They stand under [](#limits). No code is exported, so that no generated code is part of "
            "this statement."
        ),
        rich(
            "*Qualification.* None: nobody outside of this project has validated the program, and no measured stop was "
            "compared with it."
        ),
    )
    return (
        Heading(text="Tool statement", anchor=TOOL),
        Paragraph(
            text=rich(
                "EN 50716, and before it EN 50128 and EN 50657, sort software tools in clause 6.7: T1 makes nothing "
                "that can come into the executable software, T2 tests or verifies and can only fail to show a fault, "
                "T3 makes what comes into it. Not verified: the standards were not read, the classes are told as tool "
                "vendors and guides describe them, and the assignment in [](#tool-classes) is ours."
            )
        ),
        _uses(),
        Bullets(items=items),
    )


def _uses() -> Table:
    return build(
        list(_USES),
        (
            ColumnOf(title="Use", read=lambda each: each[0]),
            ColumnOf(title="What a fault of the program could do", read=lambda each: each[1]),
            ColumnOf(title="Class, not verified", read=lambda each: each[2]),
            ColumnOf(title="What controls it here", read=lambda each: each[3]),
        ),
        caption="Uses of the program, and the class that each of them would have.",
        anchor="tool-classes",
    )
