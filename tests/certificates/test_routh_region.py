"""The plotted border of (c, k) against the roots of the characteristic polynomial."""

import numpy as np
import pytest

from wspd_design.certificates.checks.linear import routh_lag
from wspd_design.certificates.setting.linear_loop import nominal
from wspd_design.design.catalog import controller
from wspd_design.design.problem import stability_problem
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_rail

LAG = 0.6  # s


def stable(law, pole, c, k):
    """Roots of the loop: with the slip pole cancelled, or with it left as it is."""
    integral = (
        [LAG, 1.0 - pole * LAG, c + k, k * c] if law == "smc" else [LAG, 1.0 - pole * LAG, k - pole, k * c]
    )
    return np.roots(integral).real.max() < 0.0


@pytest.fixture(
    scope="module", params=[("smc", "polach-dry"), ("smc", "polach-wet"), ("afsmc", "polach-wet")]
)
def shown(request, er24pc):
    name, rail_name = request.param
    rail, wanted = load_rail(rail_name), Specification()
    law = controller(name, er24pc, rail, wanted)
    shown = routh_lag.figures(stability_problem(er24pc, rail, law, wanted), None)  # samples need no verdict
    return name, rail, [each for each in shown.series if each.y_label == "k [1/s]"]


def test_loop_is_stable_on_the_named_side_of_the_border_only(shown, er24pc):
    name, rail, curves = shown
    borders = [each for each in curves if each.name.startswith("stable")]
    assert borders
    for border in borders:
        side, speed = border.name.split()[1], float(border.name.split()[-2]) / 3.6
        pole = float(nominal(er24pc, rail, 0.14, speed).pole)
        inner = [
            (c, k)
            for c, k in zip(border.x, border.y, strict=True)
            if min(border.y) < k < 0.99 * max(border.y)
        ]
        assert len(inner) > 5
        for c, k in inner[:: len(inner) // 5]:
            assert stable(name, pole, c, 0.97 * k) == (side == "below")
            assert stable(name, pole, c, 1.03 * k) == (side == "above")


def test_nothing_is_stable_where_the_pole_outruns_the_valve(shown):
    _, rail, curves = shown
    lost = [each.name for each in curves if each.name.startswith("nothing")]
    assert bool(lost) == (rail.name == "polach-dry")


def test_the_paper_is_shown_beside_another_law(shown):
    name, _, curves = shown
    (paper,) = (
        each
        for each in curves
        if each.name.startswith("the law, k =" if name == "afsmc" else "the paper's gains over speed")
    )
    assert paper.x == pytest.approx([550.0 / 1800.0] * len(paper.x), rel=1e-9)
