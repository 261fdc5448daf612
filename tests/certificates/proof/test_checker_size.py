"""The checker stays small enough to be read in one sitting, and computes with exact numbers and balls alone."""

import ast
import io
import tokenize
from pathlib import Path

from wspd_design.certificates.kernel import checker, enclosures, identity

FILES = [Path(module.__file__) for module in (checker, enclosures, identity)]
MOST_LINES = 300
ALLOWED = {
    "collections.abc",
    "dataclasses",
    "flint",
    "fractions",
    "hashlib",
    "json",
    "math",
    "time",
    "typing",
    "wspd_design.certificates.kernel.enclosures",
    "wspd_design.certificates.kernel.claim",
    "wspd_design.certificates.kernel.identity",
}
LAYOUT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
}


def lines_of_code(text):
    """Number of lines that hold code: no blank lines, comments or docstrings."""
    remarks = {
        line
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        for line in range(node.lineno, node.end_lineno + 1)
    }
    found = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in LAYOUT:
            found.update(range(token.start[0], token.end[0] + 1))
    return len(found - remarks)


def test_lines_are_counted():
    assert (
        lines_of_code(
            '"""Text.\n\nMore."""\n\n# remark\nx = (\n    1\n)\n\ndef f():\n    "doc"\n    return 1\n'
        )
        == 5
    )


def test_checker_is_small():
    assert sum(lines_of_code(path.read_text()) for path in FILES) < MOST_LINES


def test_checker_imports_nothing_to_compute_with_but_balls_and_fractions():
    for path in FILES:
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                assert {name.name for name in node.names} <= ALLOWED
            if isinstance(node, ast.ImportFrom):
                assert node.module in ALLOWED
