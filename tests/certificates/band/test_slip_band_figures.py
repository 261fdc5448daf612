"""What the report shows beside a band of slip: the basin with runs that stay in it, and the cells of the proof."""

import json
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from wspd_design.certificates.checks.region import slip_band_figures
from wspd_design.certificates.kernel.finding import Effort
from wspd_design.certificates.records import Role
from wspd_design.certificates.theorems.band import CELLS
from wspd_design.certificates.theorems.slip_band.attempt import Attempt, effort_of
from wspd_design.certificates.theorems.slip_band.statement import windows_of
from wspd_design.reporting.figures.series import panels, series_alt, series_caption

pytestmark = pytest.mark.slow
CELL_AXES = "mu0 [-]", "max torque [kN m]"
EMPTY = Effort()


def shown(problem, certificate):
    return panels(slip_band_figures.figures(problem, certificate).series)


def outside(basin):
    """Farthest that runs get in the ellipsoid that stands before them, 1 being its edge."""
    farthest, ellipse = 0.0, None
    for each in basin:
        points = np.array([each.x, each.y])
        if each.role is Role.OUTLINE:
            center = points[:, :-1].mean(axis=1, keepdims=True)
            ellipse = center, np.linalg.inv(2.0 * np.cov(points[:, :-1], bias=True))
        else:
            center, form = ellipse
            size = np.einsum("ik,ij,jk->k", points - center, form, points - center)
            farthest = max(farthest, float(size.max()))
    return farthest


def test_runs_stay_in_the_ellipsoids_that_are_shown(half, proved, monkeypatch):
    basin = shown(half, proved)[slip_band_figures.BASIN]
    assert len(basin) == 2 * (1 + slip_band_figures.STARTS)
    assert 0.1 < outside(basin) < 1.01
    # An error of the wrong sign would be seen.
    slide, torque = slip_band_figures._scales(half)
    monkeypatch.setattr(slip_band_figures, "_scales", lambda _: (-slide, torque))
    assert outside(shown(half, proved)[slip_band_figures.BASIN]) > 1.1


def test_one_cell_that_is_the_box_is_not_shown(half, proved):
    assert CELL_AXES not in shown(half, proved)


def with_two_cells(proved, effort=EMPTY):
    """As if the proof had two cells on half of each range."""
    finding = proved.findings[CELLS]
    proof = json.loads(json.dumps(finding.stated.proof)) | {"share": "0.5", "steps": "t.."}
    proof["cells"] *= 2
    part = replace(finding, stated=replace(finding.stated, proof=proof, effort=effort))
    return replace(proved, findings={**proved.findings, CELLS: part})


def test_cells_are_shown_in_the_stated_ranges(half, proved):
    certificate = with_two_cells(proved)
    stated, lower, upper = shown(half, certificate)[CELL_AXES]
    low, high = (end / 1e3 for end in half.span("max torque"))
    assert (min(stated.y), max(stated.y)) == pytest.approx((low, high))
    middle = half.nominal("max torque") / 1e3
    assert (min(lower.y), max(lower.y)) == pytest.approx(((low + middle) / 2.0, middle))
    assert (min(upper.y), max(upper.y)) == pytest.approx((middle, (middle + high) / 2.0))
    assert (min(upper.x), max(upper.x)) == pytest.approx(
        [half.nominal("mu0") * each for each in (0.95, 1.05)]
    )
    words = series_alt((stated, lower, upper))
    assert "cells with ellipsoids: a closed region" in words
    assert words.endswith("2 of them.")


def ends(cell):
    return (min(cell.x), max(cell.x)), (min(cell.y), max(cell.y))


@pytest.mark.parametrize(
    ("share", "cut", "how"),
    [("3/4", False, "failed"), ("1", True, "not decided within the budget")],
)
def test_cell_at_which_a_larger_share_ended_is_shown_beside_those_that_closed(half, proved, share, cut, how):
    """The upper half of the pads, in the lower half of mu0, after the lower half of the pads has closed."""
    tried = Attempt(share=Fraction(share), steps="ut.", window=2, tried=9, cut=cut)
    certificate = with_two_cells(proved, effort_of(half, tried, proved=Fraction(1, 2)))
    found = slip_band_figures.figures(half, certificate)
    cells = panels(found.series)[CELL_AXES]
    assert [each.role for each in cells[:3]] == [Role.OUTLINE] * 3
    *larger, closed, failed = cells[3:]
    assert [each.role for each in (*larger, closed)] == [Role.TRIED] * (1 if share == "1" else 2)
    assert failed.role is Role.FAILED
    spread, percent = float(tried.share), f"{100.0 * float(tried.share):.3g} % of each range"
    ranges = []
    for name, scale in (("mu0", 1.0), ("max torque", 1e-3)):
        low, high = half.span(name)
        middle = half.nominal(name)
        ranges.append([scale * (middle + spread * (end - middle)) for end in (low, middle, high)])
    (least, between, _), (weak, usual, strong) = ranges
    assert np.array(ends(closed)) == pytest.approx(np.array(((least, between), (weak, usual))))
    assert np.array(ends(failed)) == pytest.approx(np.array(((least, between), (usual, strong))))
    low, high = (3.6 * speed for speed in windows_of(half)[2])
    name = f"{how} at {low:.0f} to {high:.0f} km/h on {percent}"
    assert failed.name == name
    assert "not proved" in closed.name
    assert series_caption(certificate.title, found.series).endswith(f"; hatched: {name}.")
    assert f"{name}: a closed region" in series_alt(found.series)
    assert slip_band_figures.TRIED_REMARK in found.remark


def test_ranges_that_were_halved_most_often_are_the_axes(half, proved):
    tried = Attempt(share=Fraction(1), steps="mvm.v", window=0, tried=9, cut=False)
    certificate = with_two_cells(proved, effort_of(half, tried, proved=Fraction(1, 2)))
    assert ("mass [kg]", "vent time [s]") in shown(half, certificate)


def test_an_end_that_is_not_known_is_told(half, proved):
    """As of a file that an earlier version wrote."""
    remark = slip_band_figures.figures(half, with_two_cells(proved)).remark
    # The numbers of the finding are those of the whole box; the proof that is drawn has a half.
    assert remark.endswith(slip_band_figures.UNKNOWN_REMARK)
    assert slip_band_figures.UNKNOWN_REMARK not in slip_band_figures.figures(half, proved).remark
