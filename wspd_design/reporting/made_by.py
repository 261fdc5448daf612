"""What a report was made by, as rows of its provenance: the program, the machine, and every package."""

from wspd_design.reporting.blocks import Definition
from wspd_design.reporting.text import CodeSpan
from wspd_design.studies.provenance import Provenance


def made_by(made: Provenance) -> tuple[Definition, ...]:
    """Return the rows; the words say how to find each hash again."""
    state = "not that of the last commit of its clone" if made.changed else ""
    return (
        Definition(
            term="Program",
            text=(
                f"wspd {made.program_version}, git tree ",
                CodeSpan(text=made.package_tree),
                f" of the folder wspd_design{state and ', '}{state}; ",
                CodeSpan(text=f"git log -m -t --find-object={made.package_tree[:12]}"),
                " names the commit",
            ),
        ),
        Definition(
            term="Package, SHA-256",
            text=(
                CodeSpan(text=made.package_sha256),
                ", in a clone: ",
                CodeSpan(text="git ls-files wspd_design | LC_ALL=C sort | xargs sha256sum | sha256sum"),
            ),
        ),
        Definition(term="Compiler", text=made.compiler),
        Definition(term="Machine", text=made.platform),
        Definition(term="Packages", text=", ".join(f"{name} {number}" for name, number in made.versions)),
    )
