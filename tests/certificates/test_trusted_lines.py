"""What has to be trusted is counted: the README names the lines, and these are the lines."""

import re
from pathlib import Path

import grimp
import pytest

from wspd_design.certificates import replay
from wspd_design.certificates.kernel import checker

ROOT = Path(__file__).parents[2]
README = " ".join((ROOT / "README.md").read_text().split())


def path_of(module):
    path = ROOT.joinpath(*module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def lines(modules):
    return sum(len(path_of(module).read_text().splitlines()) for module in modules)


def behind(module):
    """Return a module and all of the package that it imports, within functions too."""
    return grimp.build_graph("wspd_design").find_upstream_modules(module) | {module}


def stated(pattern):
    found = re.search(pattern, README)
    assert found, pattern
    return int(found[1].replace(" ", ""))


@pytest.mark.parametrize(
    ("module", "pattern"),
    [
        (checker, r"one script of less than ([\d ]+) lines, `wspd_design/certificates/kernel/checker.py`"),
        (replay, r"what `wspd check` imports, less than ([\d ]+) lines"),
    ],
    ids=["script", "wspd check"],
)
def test_readme_counts_what_has_to_be_trusted(module, pattern):
    counted, most = lines(behind(module.__name__)), stated(pattern)
    assert 0.9 * most < counted < most


def test_the_script_stands_alone():
    assert behind(checker.__name__) == {checker.__name__}


def test_nothing_that_searches_is_trusted():
    trusted = behind(replay.__name__)
    assert not [
        each
        for each in trusted
        if each.startswith(
            tuple(f"wspd_design.certificates.{room}" for room in ("search", "checks", "suite"))
        )
    ]
