"""docs/report.md explains the sections that a report has, in their order, by options that the command has."""

import re
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest

from tests.unit.reporting.sample_dossier import faults, sample_dossier, sample_ladder, uncertainty
from wspd_design.reporting.blocks import Heading
from wspd_design.reporting.report import report_document

pytestmark = pytest.mark.usefixtures("blank_figures")

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs/report.md").read_text()


def test_the_page_names_every_section_in_the_order_of_the_report():
    dossier = replace(
        sample_dossier(), uncertainty=uncertainty(), robustness=faults(), ladder=sample_ladder()
    )
    document = report_document(dossier, datetime(2026, 1, 2, tzinfo=UTC))
    sections = [each.text for each in document.blocks if isinstance(each, Heading) and each.level == 1]
    table = PAGE.partition("## Its sections")[2].partition("\n## ")[0]
    named = re.findall(r"^\| (.+?) \|", table, re.MULTILINE)
    assert [each for each in named[1:] if each in sections] == sections
    # The checks of the sample rest on no theorem of the theory page.
    assert set(named[1:]) - set(sections) == {"Theorems behind the checks"}


def test_the_page_names_options_that_the_command_has():
    command = (ROOT / "wspd_design/cli/commands/report.py").read_text()
    options = set(re.findall(r"(--[a-z][a-z-]+)", PAGE))
    assert {"--replay", "--diff", "--requirements", "--template"} <= options
    assert options <= set(re.findall(r'"(--[a-z-]+)"', command))
