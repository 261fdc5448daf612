"""Points of a search and the designs that belong to them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wspd_design.controllers.family import with_numbers
from wspd_design.design.finding import space_of
from wspd_design.design.ranges import USUAL
from wspd_design.design.records import Specification
from wspd_design.design.search.variables import Variable, design_at, variables_of
from wspd_design.design.selection import search_ranges, shipped_design
from wspd_design.parameters.loading import load_rail

LAWS = [family.name for family in with_numbers()]


@pytest.fixture(scope="module")
def start(er24pc):
    def of(law):
        return shipped_design(law, er24pc, load_rail("polach-wet"), Specification(sample_time=0.02))

    return of


@pytest.mark.parametrize("law", LAWS)
def test_the_start_is_the_design_itself(start, law):
    base = start(law)
    variables = variables_of(base, search_ranges(law))
    assert design_at(base, variables, [each.start for each in variables]) == base
    assert all(each.low <= each.start <= each.high for each in variables)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("share", [0.0, 1.0])
def test_both_ends_of_all_ranges_can_be_built(start, er24pc, law, share):
    base, rail = start(law), load_rail("polach-wet")
    space = space_of(base, er24pc, rail)
    variables, point = space.variables, (share,) * len(space.variables)
    at_end = design_at(base, variables, space.values(point))
    assert space.law_at(point) == at_end.build(er24pc, rail) != base.build(er24pc, rail)
    unsearched = {gain.name for gain in base.gains} - {each.name for each in variables}
    assert all(at_end.gain(name) == base.gain(name) for name in unsearched)


def test_a_factor_multiplies_every_number_of_a_list(start):
    base = start("afsmc")
    variables = variables_of(base, search_ranges("afsmc"))
    values = [2.0 if each.name == "initial_weights" else each.start for each in variables]
    assert design_at(base, variables, values).gain("initial_weights") == (-2.0, -1.0, 0.0, 1.0, 2.0)


def test_a_law_without_stated_ranges_gets_the_usual_one(start):
    variables = variables_of(start("smc"), {})
    assert [each.name for each in variables] == ["surface_rate", "switching_gain", "boundary_layer"]
    assert {(each.low, each.high, each.start, each.why) for each in variables} == {
        (0.25, 4.0, 1.0, USUAL.why)
    }


@given(share=st.floats(0.0, 1.0), log=st.booleans())
def test_value_and_share_are_inverse(share, log):
    variable = Variable(name="x", unit="-", low=0.2, high=5.0, start=1.0, log=log, factor=False, why="")
    assert 0.2 * (1 - 1e-12) <= variable.value(share) <= 5.0 * (1 + 1e-12)
    assert variable.share(variable.value(share)) == pytest.approx(share, abs=1e-12)


def test_middle_of_a_range():
    even = Variable(name="x", unit="-", low=1.0, high=9.0, start=1.0, log=False, factor=False, why="")
    log = Variable(name="x", unit="-", low=1.0, high=9.0, start=1.0, log=True, factor=False, why="")
    assert even.value(0.5) == 5.0
    assert log.value(0.5) == pytest.approx(3.0)
