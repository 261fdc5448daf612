"""The shipped numbers: complete, sourced, and equal to what the paper and the calibration state."""

import math
from itertools import pairwise

import pytest

from wspd_design.parameters import loading
from wspd_design.parameters.entry import STATUSES
from wspd_design.parameters.files import data_file, read_toml
from wspd_design.parameters.schema import PRESETS
from wspd_design.plants.multibody.loading import available_multibodies, load_multibody

MULTIBODIES = [("multibody", name) for name in available_multibodies()]
ALL_FILES = [
    (kind, name)
    for kind in ("constants", "vehicle", "rail", "controller", "track")
    for name in loading.available(kind)
]


def load(kind, name):
    return load_multibody(name) if kind == "multibody" else loading.load_entries(kind, name)


@pytest.mark.parametrize(("kind", "name"), ALL_FILES + MULTIBODIES)
def test_every_number_has_a_known_source_a_place_and_a_status(kind, name):
    parameters = load(kind, name)
    assert parameters.title != name
    for entry in parameters.entries.values():
        assert entry.source in loading.sources(), entry.name
        assert entry.status in STATUSES, entry.name
        assert entry.at, entry.name
        if entry.bounds is not None:
            assert entry.bounds[0] <= entry.value <= entry.bounds[1], entry.name
        if entry.status == "printed":
            assert entry.source == "paper", entry.name
        if entry.status == "calibrated":
            assert entry.source in ("team-calibration", "contact-software"), entry.name


def test_every_source_is_used():
    used = {e.source for file in ALL_FILES + MULTIBODIES for e in load(*file).entries.values()}
    assert used == set(loading.sources())


def test_sources_say_how_they_are_known():
    assert {source.access for source in loading.sources().values()} == {"seen", "recalled", "inferred"}
    kinds = {"paper", "book", "standard", "software", "calibration", "reference", "team"}
    assert {source.kind for source in loading.sources().values()} <= kinds


def test_no_file_is_left_out():
    others = ("schemas", "specifications", "requirements")
    folders = [each for each in data_file().iterdir() if each.is_dir() and each.name not in others]
    shipped = {path.name for folder in folders for path in folder.iterdir()}
    assert {f"{name}.toml" for kind, name in ALL_FILES + MULTIBODIES if kind != "constants"} == shipped


# Table 6 of the paper, in its own units.
TABLE_6 = {
    "mass": (76841, "kg"),
    "wheelbase": (2700, "mm"),
    "brake.max_pressure": (6, "bar"),
    "brake.fill_time": (0.6, "s"),
    "brake.vent_time": (0.6, "s"),
    "brake.max_torque": (60, "kN m"),
}


@pytest.mark.parametrize("key", TABLE_6)
def test_table_6_of_the_paper(key):
    table = read_toml(data_file("vehicles", "er24pc.toml"), "er24pc.toml")
    for part in key.split("."):
        table = table[part]
    assert (table["value"], table["unit"]) == TABLE_6[key]
    assert table["status"] == "printed"


def test_derived_from_table_6():
    vehicle = loading.load_vehicle("er24pc")
    assert 2 * vehicle.wheel_radius == pytest.approx(1.100)
    assert vehicle.contact.shear_modulus == pytest.approx(210e9 / (2 * (1 + 0.25)))
    assert vehicle.contact.reference_load == pytest.approx(76841 * loading.constants().gravity / 8, rel=1e-12)


@pytest.mark.parametrize("name", ["er24pc", "er24pc-service"])
def test_body_and_bogies_make_up_the_mass(name):
    vehicle = loading.load_vehicle(name)
    assert vehicle.body_mass + 2 * vehicle.bogie_mass == vehicle.mass
    assert vehicle.wheelsets == 4


def test_contact_stiffness_of_the_calibrated_vehicle():
    c = loading.load_vehicle("er24pc").contact
    stiffness = math.pi * c.shear_modulus * c.semi_axis_rolling * c.semi_axis_lateral * c.kalker_c11 / 4
    assert stiffness == pytest.approx(1.107e7, rel=1e-3)


@pytest.mark.parametrize("name", ["er24pc", "er24pc-service"])
def test_bounds_cover_the_contact_stiffness_of_other_profiles(name):
    parameters = loading.load_entries("vehicle", name)
    c = loading.load_vehicle(name).contact
    rolling = parameters.bounds["contact.semi_axis_rolling"]
    lateral = parameters.bounds["contact.semi_axis_lateral"]
    low, high = (c.shear_modulus * a * b * c.kalker_c11 for a, b in zip(rolling, lateral, strict=True))
    assert low < 1.4e7
    assert high > 2.35e7


def test_parts_of_the_service_locomotive_give_its_bogie():
    """Masses and heights of the parts: frame, wheelsets, axleboxes, gearboxes, stators, rotors."""
    parts = [(3600, 0.65), (4700, 0.55), (680, 0.55), (700, 0.55), (3800, 0.62), (900, 0.62)]
    vehicle = loading.load_vehicle("er24pc-service")
    assert sum(mass for mass, _ in parts) == vehicle.bogie_mass
    height = sum(mass * z for mass, z in parts) / vehicle.bogie_mass
    assert vehicle.bogie_height == pytest.approx(height, abs=5e-4)
    assert vehicle.wheelset_inertia == pytest.approx(225 + 15 * 5.5**2, abs=0.5)
    primary, secondary = 4 * 2.0e6, 2 * 0.70e6  # N/m per bogie
    stiffness = 2 * (vehicle.bogie_spacing / 2) ** 2 / (1 / primary + 1 / secondary)
    assert vehicle.body_pitch_frequency == pytest.approx(
        math.sqrt(stiffness / 1.23e6) / (2 * math.pi), rel=0.01
    )


POLACH_2005 = {  # mu0, A, B, kA, kS as an open program derives them from its friction coefficient u
    "polach-dry": (0.55, 0.4, 1.6 * 0.55 - 0.28, 2.8 * 0.55 - 0.54, 1.2 * 0.55 - 0.26),
    "polach-wet": (0.30, 0.4, 1.6 * 0.30 - 0.28, 2.8 * 0.30 - 0.54, 1.2 * 0.30 - 0.26),
}


@pytest.mark.parametrize("name", POLACH_2005)
def test_polach_sets(name):
    rail = loading.load_rail(name)
    values = (
        rail.mu0,
        rail.friction_ratio,
        rail.friction_decay,
        rail.adhesion_reduction,
        rail.slip_reduction,
    )
    assert values == pytest.approx(POLACH_2005[name], rel=1e-12)


@pytest.mark.parametrize(("name", "mu0"), [("table10-dry", 0.4174), ("table10-wet", 0.3288)])
def test_calibrated_friction_does_not_fall_with_speed(name, mu0):
    rail = loading.load_rail(name)
    assert (rail.mu0, rail.friction_ratio, rail.friction_decay) == (mu0, 1.0, 0.0)


def test_low_adhesion_is_marked_as_unverified():
    entries = loading.load_entries("rail", "low-adhesion").entries.values()
    assert {entry.status for entry in entries} == {"assumed"}
    assert all("not verified" in entry.at for entry in entries)


def test_paper_gains():
    gains = loading.load_paper_gains()
    assert (gains.proportional_gain, gains.integral_gain) == (1800, 550)
    assert (gains.weight_rate, gains.bound_rate, gains.initial_bound) == (10, 0.85, 1)
    assert gains.initial_weights == (-1, -0.5, 0, 0.5, 1)
    assert gains.centres[-1] == pytest.approx(1800 * 0.14)
    for (left, right), width in zip(pairwise(gains.centres), gains.widths, strict=False):
        assert math.exp(-(((right - left) / 2 / width) ** 2)) == pytest.approx(0.5)


@pytest.mark.parametrize("preset", PRESETS)
def test_slide_limits_of_knorr_bremse_are_continuous_at_60_km_h(preset):
    table = loading.load_knorr_bremse(preset)
    for slope, offset, cap in zip(table.slide_slopes, table.slide_offsets, table.slide_caps, strict=True):
        assert slope * 60 / 3.6 + offset == pytest.approx(cap)
    assert list(table.acceleration_limits) == sorted(table.acceleration_limits)
    assert len(table.decisions) == len(table.acceleration_limits) + 1
    assert {len(row) for row in table.decisions} == {len(table.slide_caps) + 1}
    assert table.pulses == (0, 0.33, 0.5, 1)


@pytest.mark.parametrize("preset", PRESETS)
def test_decisions_of_knorr_bremse_are_monotone(preset):
    """More slide never asks for more pressure, and more acceleration never for less."""
    decisions = loading.load_knorr_bremse(preset).decisions
    assert all(a >= b for row in decisions for a, b in pairwise(row))
    assert all(a <= b for above, below in pairwise(decisions) for a, b in zip(above, below, strict=True))


def test_mitsubishi_rules_become_the_levels_of_the_preset():
    calibrated, textbook = (loading.load_mitsubishi(preset) for preset in PRESETS)
    assert calibrated.rules[0] == pytest.approx((1, 1, 1 / 3, 1 / 3))  # BNB: IB IB IS IS
    assert calibrated.rules[4] == pytest.approx((-1 / 3, 0, -1 / 3, -2 / 3))  # BPS: DS ZO DS DM, as printed
    assert textbook.rules[6] == pytest.approx((0.25, 0.25, 0.25, 0.0))  # BPB: DM DM DM DB
    assert (len(textbook.rules), len(textbook.rules[0])) == (7, 4)
    assert calibrated.slide_centres[0] == pytest.approx(0.48 / 3.6)
    assert (calibrated.duty_offset, calibrated.duty_gain) == (0.841, 1.831)
    assert (textbook.duty_offset, textbook.duty_gain) == (0, 1)


@pytest.mark.parametrize("preset", PRESETS)
def test_trenitalia_thresholds_of_eq_16(preset):
    table = loading.load_trenitalia(preset)
    assert (table.lower_speed_ratio, table.upper_speed_ratio) == (0.78, 0.90)
    assert table.deceleration_limit < -3.9  # below the deceleration of the train itself


# Standard deviations in the band 3 to 25 m as published for the one-sided spectra: mm, mm, mrad.
DEVIATIONS = {
    "vertical-high": 1.61e-3,
    "lateral-high": 1.21e-3,
    "cross-level-high": 1.49e-3,
    "vertical-low": 0.98e-3,
    "lateral-low": 0.71e-3,
    "cross-level-low": 0.91e-3,
}


@pytest.mark.parametrize("row", DEVIATIONS)
def test_variance_of_the_track_spectra(row):
    spectrum = loading.load_track_spectrum("erri-b176")
    c = spectrum.rows[row]
    low, high = 2 * math.pi / spectrum.longest_wavelength, 2 * math.pi / spectrum.shortest_wavelength
    step = (high - low) / 4000
    variance = 0.0
    for k in range(4000):
        w2 = (low + (k + 0.5) * step) ** 2
        density = (c.beta0 + c.beta2 * w2) / (c.gamma0 + c.gamma2 * w2 + c.gamma4 * w2**2 + c.gamma6 * w2**3)
        variance += density * step
    assert spectrum.one_sided
    assert math.sqrt(variance) == pytest.approx(DEVIATIONS[row], abs=0.006e-3)


def test_cross_level_follows_from_the_vertical_spectrum():
    """Expand S_C = (A_V / b0^2) Wc^2 W^2 / ((W^2 + Wr^2)(W^2 + Wc^2)(W^2 + Ws^2))."""
    wc, wr, ws, b0, a_v = 0.8246**2, 0.0206**2, 0.4380**2, 0.75, 1.080e-6
    c = loading.load_track_spectrum("erri-b176").rows["cross-level-high"]
    assert c.beta2 == pytest.approx(a_v / b0**2 * wc, rel=1e-6)
    assert c.gamma0 == pytest.approx(wc * wr * ws, rel=2e-5)  # five digits are printed
    assert c.gamma2 == pytest.approx(wc * wr + wc * ws + wr * ws, rel=1e-6)
    assert c.gamma4 == pytest.approx(wc + wr + ws, rel=1e-6)
