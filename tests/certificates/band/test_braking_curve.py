"""Stops from rolling at the corners of the box: what the braking curve leaves to the valve, on an independent plant."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

import wspd_design as wd
from tests.certificates.band.conftest import problem_of
from tests.certificates.band.sampled_runs import BESIDE, BOX, Law, rolling, sampled
from wspd_design.design.tracking_gains import CURVE_SHARE

ENDS = (*BOX, "supply rate")
LONGEST = 6.0  # s, until each of these wheels has reached its reference and comes back


def largest_slip(problem, share):
    """Largest slip of all corners, with a share of what the slowest valve can vent on the braking curve."""
    points = {name: np.full(2 ** len(ENDS), problem.nominal(name)) for name in BESIDE}
    corners = np.array(list(product(*(problem.span(name) for name in ENDS)))).T
    points |= dict(zip(ENDS, corners, strict=True)) | {"speed": np.full(corners.shape[1], problem.speeds[1])}
    designed = problem.controller
    core = replace(designed.core, torque_slew=share / CURVE_SHARE * designed.core.torque_slew)
    law, largest = Law(replace(designed, core=core), problem.slip), 0.0
    runs = rolling(problem, law, points)
    for _ in range(round(LONGEST / law.h)):
        runs, _, highest = sampled(law, runs)
        largest = max(largest, float(highest.max()))
    assert len(runs.number) == corners.shape[1]  # none has stopped
    return largest


@pytest.mark.parametrize(("rail", "planted"), [("polach-wet", 0.16), ("low-adhesion", 0.145)])
def test_wheels_do_not_run_beyond_a_reference_beyond_the_peak(rail, planted):
    """Plant the old rule: a curve that asks for all that the valve can vent leaves nothing for falling friction."""
    problem = problem_of(1.0, rail=wd.load_rail(rail))
    assert problem.slip < largest_slip(problem, CURVE_SHARE) < problem.slip + 0.003
    assert largest_slip(problem, 1.0) > planted
