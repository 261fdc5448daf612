"""docs/audit.md leaves no finding out, and every test that it names exists."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "audit.md").read_text(encoding="utf-8")
NAMED = re.compile(r"`(?P<file>[a-z_/]+)?::(?P<test>[a-z_0-9]+)`")
FINDINGS = (
    *(f"A{k}" for k in range(1, 10)),
    "A7b",
    *(f"B{k}" for k in range(1, 6)),
    *(f"I{k}" for k in range(1, 11)),
    *(f"J{k}" for k in range(1, 10)),
    *(f"M{k}" for k in range(1, 9)),
    "M12",
)


def missing_tests(page: str) -> list[str]:
    """Return the tests that a page names and that do not exist; a name without a file is of the file before it."""
    missing, file = [], ""
    for found in NAMED.finditer(page):
        file = found["file"] or file
        folder, _, name = file.rpartition("/")
        path = ROOT / "tests" / folder / f"test_{name}.py"
        if not path.exists() or f"\ndef test_{found['test']}(" not in path.read_text(encoding="utf-8"):
            missing.append(f"{file}::{found['test']}")
    return missing


def test_every_finding_has_a_row():
    told = {name for line in PAGE.splitlines() if line.startswith("| ") for name in re.findall(r"\w+", line)}
    assert [name for name in FINDINGS if name not in told] == []


def test_every_test_that_is_named_exists():
    assert missing_tests(PAGE) == []
    assert missing_tests("`unit/audit_page::every_finding_has_a_row`, `::nobody_wrote_this`") == [
        "unit/audit_page::nobody_wrote_this"
    ]
