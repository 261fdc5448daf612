"""Measure what designs, proofs and reports cost, as ratios over the start of python-control on the same machine.

``make bench`` runs it with all others; ``python benchmarks/proofs.py`` runs it alone. One ``import control`` took 2.0 s
of CPU where the goals were set: 8 s for all proofs of a design, 2 s again, 7 s for a report after them, 15 s for the
demo.
"""

import sys
import tempfile
from pathlib import Path

from rows import Row, process_cpu

ROUNDS = 3
LAW, RAIL = "smc", "polach-wet"


def _round(folder: Path) -> dict[str, float]:
    """CPU time of each step, one after the other in a fresh folder [s]."""

    def wspd(*arguments: str) -> float:
        # Refuted claims and limitations are verdicts, which exit codes tell.
        run = f"import sys; from wspd_design.cli.app import run; sys.exit(run({list(arguments)!r}) not in (0, 1, 3))"
        return process_cpu(sys.executable, "-c", run)

    design, demo = str(folder / "design.toml"), str(folder / "demo.toml")
    made = wspd("design", "--law", LAW, "--rail", RAIL, "-o", design)
    return {
        "first": wspd("certify", design),
        "again": wspd("certify", design, "--force"),
        "check": wspd("check", str(folder / "design.certificates")),
        "report": wspd("report", design, "-o", str(folder / "design.html")),
        "demo": wspd("design", "--rail", RAIL, "-o", demo)
        + wspd("report", demo, "--rail", RAIL, "-o", str(folder / "demo.html"), "--pdf"),
        "design": made,
        "control": process_cpu(sys.executable, "-c", "import control"),
    }


def measure_proofs() -> list[Row]:
    """What a user waits for after a design is made; compiled loops are kept between the rounds."""
    seconds = []
    for round_ in range(ROUNDS):
        print(f"proofs, round {round_ + 1} of {ROUNDS}", file=sys.stderr)
        with tempfile.TemporaryDirectory() as folder:
            seconds.append(_round(Path(folder)))

    def row(key: str, what: str, goal: float, *, judged: bool = True) -> Row:
        return Row(
            what=f"{what} over `import control`",
            goal=goal,
            at_least=False,
            ratios=[each[key] / each["control"] for each in seconds],
            judged=judged,
        )

    return [
        row("first", f"`wspd certify` of the {LAW} design on {RAIL}", 4.0),
        row("again", "the same again, with its proofs beside the design", 1.0),
        row("check", "`wspd check` of these proofs", 3.0, judged=False),
        row("report", "HTML report after `wspd certify`", 3.5),
        row("demo", "the demo: design, report in HTML and PDF", 7.5),
    ]


if __name__ == "__main__":
    for each in measure_proofs():
        what, goal, spread, verdict, _ = each.cells()
        print(f"{verdict.strip('*'):10}  {spread:28}  {goal:20}  {what}")
