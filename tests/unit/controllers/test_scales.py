"""Factors of the industry's tables: neutral ones change nothing, others what they say and nothing else."""

from dataclasses import fields, replace

import pytest

from wspd_design.controllers.baselines.scales import KnorrBremseScales, MitsubishiScales, TrenitaliaScales
from wspd_design.controllers.family import with_presets
from wspd_design.parameters.loading import load_knorr_bremse, load_mitsubishi, load_trenitalia
from wspd_design.parameters.schema import PRESETS


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("family", with_presets(), ids=lambda family: family.name)
def test_neutral_factors_change_nothing(family, preset):
    table, scaled = family.tables(preset), family.scaled(family.tables(preset), family.scales())
    for field in fields(table):
        before, after = getattr(table, field.name), getattr(scaled, field.name)
        assert after == pytest.approx(before) if field.name.endswith("ratio") else after == before


@pytest.mark.parametrize("family", with_presets(), ids=lambda family: family.name)
def test_every_factor_changes_the_table(family):
    table = family.tables("textbook")
    for field in fields(family.scales):
        assert family.scaled(table, replace(family.scales(), **{field.name: 0.5})) != table


def test_knorr_bremse_by_hand():
    table = load_knorr_bremse("calibrated")
    (family,) = (each for each in with_presets() if each.name == "knorr-bremse")
    scaled = family.scaled(table, KnorrBremseScales(slide_limits=0.5, acceleration_limits=2.0, pulses=2.5))
    assert scaled.slide_offsets == pytest.approx((1.5 / 3.6, 3.0 / 3.6, 4.5 / 3.6))
    assert scaled.slide_caps == pytest.approx((5.0 / 3.6, 7.5 / 3.6, 10.0 / 3.6))
    assert scaled.acceleration_limits == pytest.approx((-16.78, -8.94, -1.08, 5.66, 14.64))
    assert scaled.pulses == pytest.approx((0.0, 0.825, 1.0, 1.0))
    assert scaled.decisions == table.decisions


def test_trenitalia_by_hand():
    (family,) = (each for each in with_presets() if each.name == "trenitalia")
    scaled = family.scaled(
        load_trenitalia("textbook"),
        TrenitaliaScales(slip_limits=0.5, acceleration_limits=3.0, fill_pulse=4.0, vent_pulse=2.0),
    )
    assert (scaled.lower_speed_ratio, scaled.upper_speed_ratio) == pytest.approx((0.89, 0.95))
    assert (scaled.acceleration_limit, scaled.deceleration_limit) == (6.0, -18.0)
    assert (scaled.fill_pulse, scaled.vent_pulse) == (1.0, 0.66)


def test_mitsubishi_by_hand():
    (family,) = (each for each in with_presets() if each.name == "mitsubishi")
    scaled = family.scaled(
        load_mitsubishi("textbook"),
        MitsubishiScales(slide_centres=0.1, rate_centres=2.0, duty_gain=0.5, duty_shift=0.25),
    )
    assert scaled.slide_centres == pytest.approx((0.0, 0.5 / 3.6, 1.0 / 3.6, 2.0 / 3.6))
    assert scaled.rate_centres == (-6.0, -4.0, -2.0, 0.0, 2.0, 4.0, 6.0)
    assert (scaled.duty_gain, scaled.duty_offset) == (0.5, 0.25)
