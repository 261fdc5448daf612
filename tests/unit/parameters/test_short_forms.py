"""Short forms, words that people use, what is taken over, and numbers that do not fit together."""

import warnings

import pytest

from wspd_design.parameters import loading
from wspd_design.parameters.contradictions import notice_of_rail
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.schema import schema_of
from wspd_design.parameters.words import CALLED, remedy_for

LONG = """base = "er24pc"
[mass]
value = 80
unit = "t"
[body_mass]
value = 50
unit = "t"
[wheelsets]
value = 4
unit = "-"
[brake.fill_time]
value = 300
unit = "ms"
"""
SHORT = 'base = "er24pc"\nmass = "80 t"\nbody_mass = "50 t"\nwheelsets = 4\nbrake.fill_time = "300 ms"\n'
GROUPED = (
    'base = "er24pc"\nmass = "80t"\nbody_mass = "50 t"\nwheelsets = "4"\n[brake]\nfill_time = "300 ms"\n'
)


@pytest.fixture
def write(tmp_path):
    def write_file(text, name="mine.toml"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write_file


@pytest.mark.parametrize("text", [SHORT, GROUPED])
def test_a_short_form_is_the_table_that_it_stands_for(write, text):
    long, short = write(LONG, "long.toml"), write(text, "short.toml")
    one, other = (loading.load_entries("vehicle", path).entries for path in (long, short))
    assert {k: (e.value, e.unit, e.bounds, e.status, e.source) for k, e in one.items()} == {
        k: (e.value, e.unit, e.bounds, e.status, e.source) for k, e in other.items()
    }
    assert other["mass"].source == "own file"
    assert loading.load_vehicle(short).mass == 80e3


def test_a_decimal_comma_and_a_share_in_short(write):
    rail = loading.load_rail(write('base = "polach-wet"\nmu0 = "12,5 %"\nfriction_decay = "0.3 s/m"\n'))
    assert (rail.mu0, rail.friction_decay) == (0.125, 0.3)


@pytest.mark.parametrize(
    ("line", "fragments"),
    [
        ('mass = "45"', ("mass", "no unit", "kg or t")),
        ("mass = 45", ("mass in", "is 45 without a unit", '"45 t"')),
        ('mass = "45 m"', ("unit of length, not of mass",)),
        ('mass = "45 tt"', ('did you mean "45 t"?',)),
        ('mass = "1e999 t"', ("not a finite number",)),
        ('mass = "80 kg"', ("did you mean 80 t?",)),
        ("mass = 1" + "0" * 400, ("not a finite number",)),
        ("mass = [45]", ("mass", "must be a number")),
        ("mass = true", ("mass", "must be a number")),
        ('wheel_radius = "920 m"', ("did you mean 920 mm?",)),
        ('wheel_diameter = "920 mm"', ('wheel_radius = "460 mm"',)),
        ('[wheel_diameter]\nvalue = 1.1\nunit = "m"', ('wheel_radius = "0.55 m"',)),
        ("wheel_diameter = 3", ("half of the diameter",)),
        ("axles = 4", ('"wheelsets"',)),
        ('T_F = "0.3 s"', ('"brake.fill_time"',)),
        ('T_V = "0.3 s"', ('"brake.vent_time"',)),
        ('fill_time = "0.3 s"', ('"brake.fill_time"',)),
        ('brake.T_max = "6 kN m"', ('"brake.max_torque"',)),
        ('deceleration = "1 m/s^2"', ("holds the torque", "brake.max_torque", "wspd new vehicle")),
        ('rotating_mass = "5 t"', ("wheelset_inertia",)),
        ("xyzzy = 3", ("take one of mass, wheelsets, axles_per_bogie",)),
        ('brake = "strong"', ("[brake.max_torque]",)),
        ('body_height = "0.6 m"', ("body_height = 0.6 m", "above bogie_height = 0.7 m")),
        ('wheelbase = "11 m"', ("wheelbase = 11 m", "bogie_spacing = 10.362 m")),
    ],
)
def test_what_a_vehicle_file_must_not_say(write, line, fragments):
    with pytest.raises(UserError) as caught:
        loading.load_vehicle(write(f'base = "er24pc"\n{line}\n'))
    message = str(caught.value)
    assert message.endswith((".", "?"))
    for fragment in ("mine", *fragments):
        assert fragment in message


@pytest.mark.parametrize(
    ("key", "right"),
    [
        ("mu", "mu0"),
        ("kA", "adhesion_reduction"),
        ("kS", "slip_reduction"),
        ("A", "friction_ratio"),
        ("B", "friction_decay"),
    ],
)
def test_words_for_a_rail(write, key, right):
    with pytest.raises(UserError, match=f'unknown key {key} .did you mean "{right}"'):
        loading.load_rail(write(f'base = "polach-wet"\n{key} = 0.3\n'))


@pytest.mark.parametrize("kind", ["vehicle", "rail"])
def test_every_word_leads_to_a_key(kind):
    known = [*schema_of(kind, ""), "profile"]
    for word, key in CALLED[kind].items():
        assert key in known
        if word not in known:
            assert f'"{key}"' in remedy_for(kind, word, 0, known)


def test_what_is_taken_over_is_marked(write):
    entries = loading.load_entries("vehicle", write(SHORT)).entries
    assert {key for key, entry in entries.items() if not entry.inherited} == {
        "mass",
        "body_mass",
        "wheelsets",
        "brake.fill_time",
    }
    assert {entry.inherited for entry in entries.values()} == {"", "er24pc"}


def test_a_demand_beyond_every_rail_is_told(write):
    metro = (
        'base = "er24pc"\nmass = "36 t"\nbody_mass = "24 t"\nbogie_mass = "6 t"\nwheel_radius = "425 mm"\n'
    )
    with pytest.warns(UserWarning, match="taken over from er24pc, is a wheel demand of 1.60"):
        loading.load_vehicle(write(metro))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        loading.load_vehicle(write(metro + 'brake.max_torque = "5.5 kN m"\n'))


def test_a_slip_reduction_above_the_adhesion_reduction_is_told(write):
    with pytest.warns(
        UserWarning, match="slip_reduction = 0.4 of rail mine is above adhesion_reduction = 0.3"
    ):
        loading.load_rail(write('base = "polach-wet"\nslip_reduction = 0.4\n'))
    assert "kS <= kA" in notice_of_rail(loading.load_rail("eurosprinter127"))
    assert notice_of_rail(loading.load_rail("polach-wet")) == ""
