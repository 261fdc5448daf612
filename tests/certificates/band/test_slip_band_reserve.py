"""Windows in which holding the reference takes more of the brake than is claimed about, and their statement."""

from fractions import Fraction

import pytest
from flint import ctx

from tests.certificates.band.conftest import refused, told_of
from tests.certificates.band.courses import everywhere
from tests.certificates.band.forging import told_with
from wspd_design.certificates.records import Status
from wspd_design.certificates.search.slip_band.search import Sought, alone, exactly
from wspd_design.certificates.theorems.band import CELLS, RESERVED, contact_held
from wspd_design.certificates.theorems.slip_band.friction import FADINGS, SLOPES, Friction
from wspd_design.certificates.theorems.slip_band.loop import Conditions, loop_of
from wspd_design.certificates.theorems.slip_band.proof import Choice, read, write
from wspd_design.certificates.theorems.slip_band.statement import box_of, law_of, windows_of

pytestmark = pytest.mark.slow


def test_window_without_ellipsoid_is_refused_where_less_may_be_held(half, proof):
    """Nothing is left out of the claim with the full reserve, nor where holding may take less, nor above a gap."""
    slow = proof["cells"][0]
    for reserve, places, reason in (
        ("1.0", [0], "may take less"),
        ("0.9", [0], "may take less"),
        ("0.9", [1], "after a slower one"),
    ):
        forged = proof | {
            "reserve": reserve,
            "cells": [[None if k in places else n for k, n in enumerate(slow)]],
        }
        assert reason in refused(half, forged)
    for reserve in ("0.0", "1.1"):
        assert "1 at most" in refused(half, proof | {"reserve": reserve})


def test_windows_in_which_more_is_held_are_left_out_and_leave_the_claim_open(half, proved, proof):
    """On half of the wet box holding takes 31 % at 10 km/h and more: nothing is claimed there of less."""
    law = law_of(half.controller)
    friction = read(proof, len(windows_of(half))).friction
    sought = Sought(
        problem=contact_held(half),
        law=law,
        friction=friction,
        conditions=exactly(half, law)._replace(reserve=Fraction("0.3")),
    )
    held = write(alone(sought, Fraction(1)))
    assert held["cells"][0][0] is None
    assert held["cells"][0][-1] is not None
    assert "leaves out" in refused(half, held)
    numbers = told_of(half, held, reserved=True)
    assert numbers["reserve"] == 0.3
    assert "band 0 above" not in numbers
    told = told_with(half, proved, {CELLS: held})
    assert told.status is Status.UNDECIDED
    assert told.explanation.startswith("No ellipsoids were found")
    told = told_with(half, proved, {RESERVED: held})
    assert told.status is Status.PROVED
    assert "takes at most 30 % of the full pressure" in told.explanation


def test_clip_of_what_is_held_is_that_of_the_reserve(half):
    """Half of the wet box takes up to 69 %; a reserve takes what is beyond off the room for filling, and no more."""
    with ctx.workprec(128):
        law, box = law_of(half.controller), box_of(half, Fraction(1))
        friction = Friction(((-0.2, 0.02),) * len(SLOPES), (0.86, 0.91), ((-0.3, 0.0),) * len(FADINGS))
        exact = Conditions(supply=Fraction(1), delay=Fraction(0), noise=Fraction(0))
        found = {
            reserve: loop_of(
                contact_held(half),
                law,
                box,
                windows_of(half)[0],
                everywhere(friction),
                Choice(Fraction(1, 2), 0),
                exact._replace(reserve=reserve),
            )
            for reserve in map(Fraction, ("1", "0.9", "0.6", "0.5"))
        }
        full = float(law.full_torque / law.inertia * law.sample_time)
        least = float(law.sample_time) * 0.001 * float(law.full_torque / law.inertia)
        rooms = [float(each.limits[-1].bound.mid()) for each in found.values()]
        assert rooms[0] == pytest.approx(rooms[1])
        assert rooms[1] < rooms[2] < rooms[3] == pytest.approx(0.5 * full, abs=2.0 * least)
        assert len({each.holding for each in found.values()}) == 1
        assert 0.3 < found[Fraction(1)].holding < 0.45
