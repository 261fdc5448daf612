"""Every figure and table of a report is referred to, every reference leads somewhere, and no curve is drawn twice."""

from collections import Counter
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from tests.unit.reporting.sample_dossier import certificate, estimating, faults, sample_dossier, uncertainty
from tests.unit.reporting.test_maps import SHOWN
from wspd_design.certificates.records import Role, Series, Status
from wspd_design.reporting.blocks import Figure, Heading, Paragraph, Table
from wspd_design.reporting.figures.poles import AXES, beside_nominal
from wspd_design.reporting.numbering import unreferenced
from wspd_design.reporting.report import report_document

DATE = datetime(2026, 1, 2, tzinfo=UTC)


def pole(name: str, y: tuple[float, float], role: Role = Role.CURVE) -> Series:
    x_label, y_label = AXES
    return Series(name=name, x_label=x_label, y_label=y_label, x=(10.0, 120.0), y=y, role=role)


def dossiers():
    plain = sample_dossier()
    checked = certificate("pole", Status.REFUTED, maps=(SHOWN,), series=(pole("nominal", (1.0, 2.0)),))
    yield plain
    yield replace(
        plain, robustness=faults(), uncertainty=uncertainty(), certificates=(*plain.certificates, checked)
    )
    yield replace(plain, trials=(estimating(plain.trials[0]), *plain.trials[1:]), phase_plane=None)
    yield sample_dossier(rail="table10-dry")


@pytest.mark.usefixtures("blank_figures")
@pytest.mark.parametrize(
    "dossier", list(dossiers()), ids=["plain", "faults and maps", "estimate", "the paper's rail"]
)
def test_every_figure_and_table_is_referred_to(dossier):
    document = report_document(dossier, DATE)
    assert unreferenced(document) == ()
    shown = [each for each in document.blocks if isinstance(each, Figure | Table)]
    assert len(shown) > 10
    assert all(each.anchor for each in shown)


@pytest.mark.usefixtures("blank_figures")
def test_a_figure_without_a_reference_is_found():
    document = report_document(sample_dossier(()), DATE)
    lost = Figure(svg="<svg/>", caption="Lost.", alt="Nothing.", anchor="lost")
    heading = Heading(text="More", anchor="more")
    planted = replace(document, blocks=(*document.blocks, heading, Paragraph(text="Nothing."), lost))
    (label,) = unreferenced(planted)
    assert label.startswith("Figure ")


def test_no_picture_stands_twice():
    """The curves of two checks about the slip pole go into one figure; nothing else is drawn again."""
    limit = pole("p_max", (1.05, 1.05), Role.LIMIT)
    curves = (pole("nominal", (1.0, 2.0)), pole("worst of the bounds", (1.5, 2.5)), limit)
    checks = tuple(certificate(name, Status.REFUTED, series=curves) for name in ("one", "two"))
    own = certificate("three", Status.EVIDENCE)
    document = report_document(replace(sample_dossier(()), certificates=(*checks, own)), DATE)
    pictures = Counter(each.svg for each in document.blocks if isinstance(each, Figure))
    assert max(pictures.values()) == 1
    assert [each.name for each in beside_nominal(checks, ())] == ["worst of the bounds", "p_max, 1.05 1/s"]
    anchors = [each.anchor for each in document.blocks if isinstance(each, Figure)]
    assert "check-three-curves" in anchors
    assert not {"check-one-curves", "check-two-curves"} & set(anchors)
