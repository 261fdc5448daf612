"""The constraint of the gain search: one quadratic function for each corner of the box, or none."""

from dataclasses import replace

import pytest

import wspd_design as wd
from wspd_design.design.stability import closes

SPEEDS = (10.0 / 3.6, 120.0 / 3.6)
LOCO = wd.load_vehicle("er24pc")
WET = wd.load_rail("polach-wet")
SPECIFICATION = wd.Specification(sample_time=0.02)


@pytest.fixture(scope="module")
def law():
    return wd.design_controller(LOCO, WET, SPECIFICATION, law="observer-smc").build(LOCO, WET)


def with_gains(law, **gains):
    return replace(law, core=replace(law.core, tracking=replace(law.core.tracking, **gains)))


def test_designed_law_closes_on_the_whole_box_of_the_wet_rail(law):
    found = closes(law, LOCO, WET, speeds=SPEEDS)
    assert found is not None
    assert 0.9 < found < 1.0


def test_inversion_with_nominal_times_does_not(law):
    """A valve that is twice as fast as the nominal one goes twice the wanted way."""
    nominal = replace(law, valve=replace(law.valve, time_share=1.0))
    assert closes(nominal, LOCO, WET, speeds=SPEEDS) is None
    assert closes(nominal, LOCO, WET, speeds=SPEEDS, share=0.0) is not None


def test_gain_that_is_too_high_does_not(law):
    assert closes(with_gains(law, approach_rate=300.0), LOCO, WET, speeds=SPEEDS, share=0.0) is None


def test_dead_time_of_the_valve_counts(law):
    quick = with_gains(law, approach_rate=60.0)

    def found(dead_time):
        vehicle = replace(LOCO, brake=replace(LOCO.brake, dead_time=dead_time))
        return closes(quick, vehicle, WET, speeds=SPEEDS, share=0.0)

    assert found(0.0) < found(0.01) < 1.0
    assert found(0.019) is None
    assert found(0.02) is None  # no pulse ends in its sample


def test_supply_that_rises_counts(law):
    quick = with_gains(law, approach_rate=60.0)

    def found(**supply):
        vehicle = replace(LOCO, brake=replace(LOCO.brake, **supply))
        return closes(quick, vehicle, WET, speeds=SPEEDS, share=0.0)

    assert found(build_up="direct") < found() < 1.0
    assert found(supply_rate=10.0) is None


def test_smaller_box_is_not_harder(law):
    shares = [
        closes(law, LOCO, wd.load_rail("polach-dry"), speeds=SPEEDS, share=each) for each in (0.0, 0.25, 1.0)
    ]
    assert [each is not None for each in shares] == sorted(
        [each is not None for each in shares], reverse=True
    )
    assert shares[0] is not None
    assert shares[-1] is None


def test_other_law_has_no_such_statement():
    other = wd.design_controller(LOCO, WET, SPECIFICATION, law="smc").build(LOCO, WET)
    assert closes(other, LOCO, WET, speeds=SPEEDS) is None
