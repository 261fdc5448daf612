"""Wrong parameter files: one sentence that names the file, the key and the remedy."""

import os

import pytest

from wspd_design.parameters import loading
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.schema import schema_of

MASS = '[mass]\nvalue = 80\nunit = "t"\n'
RAIL = """
title = "Leaves"
[mu0]
value = 5
unit = "%"
bounds = [3, 8]
[friction_ratio]
value = 0.4
unit = "-"
[friction_decay]
value = 0.2
unit = "s/m"
[adhesion_reduction]
value = 0.3
unit = "-"
[slip_reduction]
value = 0.1
unit = "-"
"""


@pytest.fixture
def write(tmp_path):
    def write_file(text, name="my-rail.toml"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return write_file


def test_own_rail_needs_no_history(write):
    path = write(RAIL)
    assert loading.load_rail(path).mu0 == 0.05
    parameters = loading.load_entries("rail", str(path))
    assert (parameters.name, parameters.title) == ("my-rail", "Leaves")
    assert parameters.bounds == {"mu0": (0.03, 0.08)}
    entry = parameters.entries["mu0"]
    assert (entry.source, entry.at, entry.status) == ("own file", "my-rail.toml", "assumed")


def test_own_vehicle_states_only_what_differs(write):
    path = write('base = "er24pc"\n[brake.max_torque]\nvalue = 20\nunit = "kNm"\nsource = "type test"\n')
    vehicle, base = loading.load_vehicle(path), loading.load_vehicle("er24pc")
    assert vehicle.brake.max_torque == 20e3
    assert vehicle.brake.fill_time == base.brake.fill_time
    assert vehicle.contact == base.contact
    parameters = loading.load_entries("vehicle", path)
    assert parameters.entries["brake.max_torque"].source == "type test"
    assert "brake.max_torque" not in parameters.bounds  # those of the base belong to another number
    assert parameters.bounds["mass"] == loading.load_entries("vehicle", "er24pc").bounds["mass"]
    assert list(parameters.entries) == list(loading.load_entries("vehicle", "er24pc").entries)


@pytest.mark.parametrize(
    ("text", "fragments"),
    [
        (RAIL.replace("mu0", "muO"), ("unknown key muO", 'did you mean "mu0"')),
        (RAIL.replace("value = 0.4", "valeu = 0.4"), ("[friction_ratio]", "valeu", 'did you mean "value"')),
        (RAIL.replace('"s/m"', '"s/n"'), ("[friction_decay]", '"s/n"', 'did you mean "s/m"')),
        (RAIL.replace('"s/m"', '"m/s"'), ("[friction_decay]", "unit of speed", "s/m")),
        (RAIL.replace('unit = "s/m"\n', ""), ("[friction_decay]", "lacks unit")),
        (RAIL.replace("value = 0.2\n", ""), ("[friction_decay]", "lacks value")),
        (RAIL.replace("[slip_reduction]\nvalue = 0.1", "[slip_reduction]\nvalue = nan"), ("finite",)),
        (RAIL.replace("value = 0.1", "value = inf"), ("[slip_reduction]", "finite")),
        (RAIL.replace("value = 0.1", "value = 1" + 400 * "0"), ("[slip_reduction]", "finite")),
        (RAIL.replace("value = 0.1", "value = true"), ("[slip_reduction]", "must be a number")),
        (RAIL.replace("value = 0.1", 'value = "0.1"'), ("[slip_reduction]", "without quotes")),
        (RAIL.replace("value = 0.1", "value = [0.1]"), ("[slip_reduction]", "must be a number")),
        (RAIL.replace("value = 0.1", "value = 1.4"), ("[slip_reduction]", "in (0, 1]")),
        (RAIL.replace("value = 0.2", "value = -0.2"), ("[friction_decay]", "at least 0")),
        (RAIL.replace("value = 5", "value = 9"), ("[mu0]", "outside its bounds [3, 8] %")),
        (RAIL.replace("[3, 8]", "[8, 3]"), ("[mu0]", "lower one above")),
        (RAIL.replace("[3, 8]", "[3]"), ("[mu0]", "[lower, upper]")),
        (RAIL.replace("[3, 8]", "8"), ("[mu0]", "list of two numbers")),
        (RAIL.replace("[3, 8]", "[3, nan]"), ("bounds of [mu0]", "finite")),
        (RAIL.replace("[3, 8]", '[3, 8]\nstatus = "guessed"'), ("guessed", "assumed")),
        (RAIL.replace("[3, 8]", "[3, 8]\nsource = 7"), ("source = 7", "in quotes")),
        (RAIL.replace('"Leaves"', "7"), ("title = 7", "in quotes")),
        (RAIL.replace('title = "Leaves"', "slip_limit = 3"), ("unknown key slip_limit",)),
        (RAIL.replace('"Leaves"', '"Leaves'), ("not valid TOML", "line 2")),
        (RAIL.replace("[slip_reduction]", "[mu0]"), ("not valid TOML", "line ")),
        (RAIL.replace("value = 0.4", "value = 0,4"), ("not valid TOML", 'write "0.4" with a point')),
        (RAIL.replace("value = 0.4", "value = [0,4"), ("not valid TOML", "correct that place")),
        (RAIL[: RAIL.index("[slip_reduction]")], ("lacks [slip_reduction]", "add it", "base")),
        ("mu0 = 0.3\n", ("lacks [friction_ratio]", "add them", "polach-wet")),
        ('base = "polach-wett"\n', ('base = "polach-wett"', 'did you mean "polach-wet"', "table10-dry")),
        ("base = 3\n", ("base = 3", "available: eurosprinter127")),
        ('base = ["polach-wet"]\n', ("base = ['polach-wet']", "available: eurosprinter127")),
        ("", ("lacks [mu0]", "base")),
    ],
)
def test_wrong_rail_file(write, text, fragments):
    path = write(text)
    with pytest.raises(UserError) as caught:
        loading.load_rail(path)
    message = str(caught.value)
    assert str(path) in message
    assert "\n" not in message
    assert message.endswith(".")
    for fragment in fragments:
        assert fragment in message


@pytest.mark.parametrize(
    ("text", "fragments"),
    [
        (
            "[brake.max_torqe]\nvalue = 1\n",
            ("unknown key brake.max_torqe", 'did you mean "brake.max_torque"'),
        ),
        ("[brakes.max_torque]\nvalue = 1\n", ("unknown key brakes", 'did you mean "brake"')),
        ("brake = 3\n", ("brake", "must be a table", "[brake.max_torque]")),
        ('[brake.max_torque]\nvalue = 60\nunit = "kN"\n', ("unit of force, not of torque", "kN m")),
        ('[mass]\nvalue = 0\nunit = "t"\n', ("[mass]", "above 0")),
        (MASS, ("mass = 80000 kg", "76841 kg", "change the three together")),
        ('[wheelsets]\nvalue = 6\nunit = "-"\n', ("body_mass + 3 bogie_mass", "change the three together")),
        ('[wheelsets]\nvalue = 2\nunit = "-"\n', ("make one bogie", "axles_per_bogie = 1")),
        ('[wheelsets]\nvalue = 4.5\nunit = "-"\n', ("wheelsets = 4.5", "whole number")),
        ('[wheelsets]\nvalue = 33\nunit = "-"\n', ("[wheelsets]", "[1, 32]")),
        (
            '[axles_per_bogie]\nvalue = 3\nunit = "-"\n',
            ("wheelsets = 4", "multiple of axles_per_bogie = 3"),
        ),
        (
            '[bodies]\nvalue = 2\nunit = "-"\n',
            ("bodies = 2", "on 3 bogies", "make 2"),
        ),
        ('[wheelbase]\nvalue = 12\nunit = "m"\n', ("wheelbase = 12 m", "below bogie_spacing")),
        (
            '[brake.axle_shares]\nvalue = [1, 0, 1]\nunit = "-"\n',
            ("brake.axle_shares has 3 numbers", "4 wheelsets"),
        ),
        (
            '[brake.axle_shares]\nvalue = [0, 0, 0, 0]\nunit = "-"\n',
            ("leaves no axle with a brake",),
        ),
        (
            '[brake.axle_shares]\nvalue = [1, 1, -1, 1]\nunit = "-"\n',
            ("brake.axle_shares", "at least 0"),
        ),
        ('[wheel_radius]\nvalue = 550\nunit = "m"\n', ("550 m", "0.1 to 1.5 m", "did you mean 550 mm?")),
        ('[mass]\nvalue = 76.8\nunit = "kg"\n', ("76.8 kg", "did you mean 76.8 t?")),
        ('[wheel_radius]\nvalue = 40\nunit = "m"\n', ("40 m", "0.1 to 1.5 m", "correct it")),
        (
            '[wheel_radius]\nvalue = 0.55\nbounds = [0.5, 550]\nunit = "m"\n',
            ("bounds of [wheel_radius]", "did you mean 550 mm?"),
        ),
    ],
)
def test_wrong_vehicle_file(write, text, fragments):
    with pytest.raises(UserError) as caught:
        loading.load_vehicle(write('base = "er24pc"\n' + text, "loco.toml"))
    for fragment in ("loco", *fragments):
        assert fragment in str(caught.value)


@pytest.mark.parametrize(
    ("load", "name", "fragments"),
    [
        (
            loading.load_vehicle,
            "er24cp",
            ('unknown vehicle "er24cp"', 'mean "er24pc"', "er24pc-service", ".toml"),
        ),
        (loading.load_vehicle, "ER24PC", ('did you mean "er24pc"',)),
        (loading.load_rail, "polach-damp", ("unknown rail", "available: eurosprinter127", "low-adhesion")),
        (loading.load_rail, "", ('unknown rail ""',)),
        (loading.load_rail, "../vehicles/er24pc", ("unknown rail",)),
        (loading.load_rail, "missing.toml", ("missing.toml does not exist",)),
        (loading.load_track_spectrum, "erri", ('did you mean "erri-b176"',)),
        (loading.load_trenitalia, "textbok", ('unknown preset "textbok"', "calibrated, textbook")),
    ],
)
def test_unknown_names(load, name, fragments):
    with pytest.raises(UserError) as caught:
        load(name)
    for fragment in fragments:
        assert fragment in str(caught.value)


def test_controllers_have_no_files_of_one_s_own(write):
    path = write("", "trenitalia.toml")
    with pytest.raises(UserError, match="unknown controller"):
        loading.load_entries("controller", path)


def test_a_byte_order_mark_is_no_fault(tmp_path):
    path = tmp_path / "wet.toml"
    path.write_bytes(b'\xef\xbb\xbfbase = "polach-wet"\n')
    assert loading.load_rail(path).mu0 == loading.load_rail("polach-wet").mu0


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("value = 1" + "0" * 5000 + '\nunit = "s/m"\n', "thousands of digits"),
        ("value = " + "[" * 20_000 + "\n", "nested too deeply"),
        ('value = 5e-324\nunit = "s/m"\n', "too small to compute with"),
    ],
)
def test_hostile_numbers(write, text, word):
    path = write('base = "polach-wet"\n[friction_decay]\n' + text)
    with pytest.raises(UserError, match=word) as caught:
        loading.load_rail(path)
    assert str(path) in str(caught.value)
    assert len(str(caught.value)) < 300


def test_shipped_numbers_keep_away_from_the_ends_of_what_is_plausible():
    """Otherwise a range would say more about our files than about railways."""
    for kind in ("vehicle", "rail"):
        for name in loading.available(kind):
            parameters = loading.load_entries(kind, name)
            for key, entry in parameters.entries.items():
                ends = schema_of(kind, name)[key].plausible
                if ends is not None and ends[1] > 1.0:
                    assert 2.0 * ends[0] <= entry.value <= 0.5 * ends[1], (name, key)


def test_unreadable_files(tmp_path):
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    with pytest.raises(UserError, match="cannot be read"):
        loading.load_rail(folder)
    binary = tmp_path / "binary.toml"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(UserError, match="UTF-8"):
        loading.load_rail(binary)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read every file")
def test_file_without_permission(write):
    path = write(RAIL)
    path.chmod(0)
    with pytest.raises(UserError, match=r"cannot be read \(Permission denied\)"):
        loading.load_rail(path)


def test_a_multibody_file_stands_beside_its_vehicle_file(tmp_path):
    own = tmp_path / "own.toml"
    for named, loaded in (("bodies.toml", str(tmp_path / "bodies.toml")), ("er24pc-82", "er24pc-82")):
        own.write_text(f'base = "er24pc"\nmultibody = "{named}"\n')
        assert loading.load_vehicle(own).multibody == loaded
    own.write_text('base = "er24pc"\n')
    assert loading.load_vehicle(own).multibody == "er24pc-82"


def test_what_a_caller_does_to_shipped_entries_reaches_no_other():
    loading.load_entries("rail", "polach-wet").entries.clear()
    assert "mu0" in loading.load_entries("rail", "polach-wet").entries
