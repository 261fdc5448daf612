"""Valve states of one sampling interval and their edges."""

from itertools import pairwise

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from wspd_design.controllers.protocol import Command
from wspd_design.model.brake import Valve
from wspd_design.simulation.stop import segments

ORDER = (Valve.FILL, Valve.VENT, Valve.HOLD)


@settings(max_examples=200, deadline=None)
@given(
    fill=st.floats(0.0, 1.0),
    share_of_rest=st.floats(0.0, 1.0),
    index=st.integers(0, 500),
    h=st.sampled_from((0.1, 0.02, 0.01, 0.005)),
)
@example(fill=1.0, share_of_rest=0.0, index=3, h=0.1)
@example(fill=0.3, share_of_rest=1.0, index=6, h=0.1)
@example(fill=0.0, share_of_rest=1.0, index=29, h=0.1)
def test_edges_cover_the_sample_exactly(fill, share_of_rest, index, h):
    vent = share_of_rest * (1.0 - fill)
    start, end = index * h, (index + 1) * h
    found = list(segments(Command(fill=fill, vent=vent), start, end))
    assert found[0][1] == start
    assert found[-1][2] == end
    assert all(a[2] == b[1] for a, b in pairwise(found))
    assert all(a < b for _, a, b in found)
    ranks = [ORDER.index(valve) for valve, _, _ in found]
    assert ranks == sorted(set(ranks))
    spans = {valve: (b - a) / (end - start) for valve, a, b in found}
    for valve, share in zip(ORDER, (fill, vent, 1.0 - fill - vent), strict=True):
        assert spans.get(valve, 0.0) == pytest.approx(share, abs=1e-9)


@pytest.mark.parametrize("h", [0.1, 0.02, 0.003])
@pytest.mark.parametrize(
    ("command", "valve"), [((1.0, 0.0), Valve.FILL), ((0.0, 1.0), Valve.VENT), ((0.0, 0.0), Valve.HOLD)]
)
def test_whole_samples_have_one_segment(h, command, valve):
    for index in range(500):
        start, end = index * h, (index + 1) * h
        assert list(segments(Command(*command), start, end)) == [(valve, start, end)]


@pytest.mark.parametrize("fill", [0.07, 0.33, 0.9, 1.0 / 3.0])
def test_pulse_width_leaves_no_sliver_of_hold(fill):
    for index in range(100):
        found = [v for v, _, _ in segments(Command(fill, 1.0 - fill), index * 0.1, (index + 1) * 0.1)]
        assert found == [Valve.FILL, Valve.VENT]
