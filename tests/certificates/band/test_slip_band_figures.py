"""What the report shows beside a band of slip: the basin with runs that stay in it, and the cells of the proof."""

import json
from dataclasses import replace

import numpy as np
import pytest

from wspd_design.certificates.checks.region import slip_band_figures
from wspd_design.certificates.records import Role
from wspd_design.certificates.theorems.band import CELLS
from wspd_design.reporting.figures.series import panels, series_alt

pytestmark = pytest.mark.slow


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
    assert slip_band_figures.CELL_AXES not in shown(half, proved)


def test_cells_are_shown_in_the_stated_ranges(half, proved):
    """As if the proof had two cells on half of each range."""
    finding = proved.findings[CELLS]
    proof = json.loads(json.dumps(finding.stated.proof)) | {"share": "0.5", "steps": "t.."}
    proof["cells"] *= 2
    part = replace(finding, stated=replace(finding.stated, proof=proof))
    certificate = replace(proved, findings={**proved.findings, CELLS: part})
    stated, lower, upper = shown(half, certificate)[slip_band_figures.CELL_AXES]
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
