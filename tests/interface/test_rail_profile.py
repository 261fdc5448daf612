"""A rail that changes along the track: stops know it, everything else says in one sentence that it does not."""

import pytest

from wspd_design.parameters import loading
from wspd_design.parameters.errors import UserError

STOP = ("--vehicle", "er24pc-service", "--speed", "50 km/h", "--plant", "quarter")
PROFILE = """title = "Leaves"
[profile]
starts = ["0 m", "20 m", "0.04 km"]
rails = ["polach-wet", "leaf.toml", "polach-wet"]
"""
IN_METRES = PROFILE.replace('"0.04 km"', '"40 m"')


@pytest.fixture
def track(tmp_path):
    (tmp_path / "leaf.toml").write_text('base = "very-low"\nmu0 = 0.022\n')
    (tmp_path / "track.toml").write_text(IN_METRES)
    return tmp_path


@pytest.mark.usefixtures("track")
def test_a_profile_is_what_patches_say(wspd):
    one = wspd("simulate", "none", *STOP, "--rail", "track.toml", "--json")
    patches = ("--patch", "20 m leaf.toml", "--patch", "40 m polach-wet")
    other = wspd("simulate", "none", *STOP, "--rail", "polach-wet", *patches, "--json")
    assert one.code == other.code == 0
    assert one.out == other.out
    assert "leaf" in one.out


def test_the_shipped_profile_in_a_comparison_and_a_campaign(wspd, tmp_path):
    shown = wspd("compare", "none", "trenitalia", *STOP, "--rail", "patchy")
    assert shown.code == 0
    assert "on 12 stretches of polach-wet, low-adhesion and very-low," in " ".join(shown.out.split())
    (tmp_path / "campaign.toml").write_text(
        'controllers = ["none"]\nrails = ["patchy", "polach-wet"]\nvehicle = "er24pc-service"\n'
        'plant = "quarter"\nspeed = "30 km/h"\nstops = 2\ncheck_every = 0\n'
    )
    assert wspd("campaign", "campaign.toml", "-o", "rows.csv").code == 0
    rows = (tmp_path / "rows.csv").read_text()
    assert "12 stretches of polach-wet, low-adhesion and very-low" in rows
    assert ",polach-wet," in rows


@pytest.mark.parametrize("command", ["design", "verify", "linearize"])
def test_what_speaks_about_one_adhesion_refuses_a_profile(wspd, command):
    outcome = wspd(command, "--rail", "patchy")
    assert outcome.code == 2
    assert "one adhesion is asked for here; take one of polach-wet, low-adhesion, very-low." in outcome.err


@pytest.mark.parametrize(
    ("text", "fragments"),
    [
        (PROFILE, ("several units, m, km",)),
        (IN_METRES.replace('"20 m"', '"50 m"'), ("0 m, 50 m, 40 m", "rise from 0 m")),
        (IN_METRES.replace('"0 m"', '"1 m"'), ("rise from 0 m",)),
        (IN_METRES.replace('"20 m", ', ""), ("must be 3 places",)),
        (IN_METRES.replace("starts", "start"), ('did you mean "profile.starts"',)),
        (IN_METRES.replace('"leaf.toml"', "3"), ("must consist of words",)),
        (IN_METRES.replace("leaf.toml", "missing.toml"), ("missing.toml", "check the path")),
        (IN_METRES.replace("leaf.toml", "track.toml"), ("changes along the track itself",)),
        (IN_METRES.replace("leaf.toml", "patchy"), ("patchy, which changes along the track itself",)),
        ("mu0 = 0.3\n" + IN_METRES, ("mu0", "stands beside a profile", "leave it out")),
        ('profile.rails = ["polach-wet"]\n', ("profile.starts = nothing",)),
    ],
)
def test_wrong_profiles(track, text, fragments):
    (track / "track.toml").write_text(text)
    with pytest.raises(UserError) as caught:
        loading.load_rail_profile(track / "track.toml")
    for fragment in fragments:
        assert fragment in str(caught.value)


def test_a_rail_without_profile_is_one_from_the_start_on():
    profile = loading.load_rail_profile("very-low")
    assert (profile.starts, profile.rails) == ((0.0,), ("very-low",))


@pytest.mark.parametrize("option", [("--patch", "5 m polach-dry"), ("--axle-rails", "polach-wet")])
def test_a_profile_takes_no_other_change_of_rail(wspd, option):
    outcome = wspd("simulate", "none", "--rail", "patchy", *option)
    assert outcome.code == 2
    assert f"leave {option[0]} out" in outcome.err


def test_rails_of_a_campaign_that_are_told_alike_are_refused(wspd, track):
    (track / "leaf-2").mkdir()
    (track / "leaf-2" / "leaf.toml").write_text('base = "very-low"\nmu0 = 0.03\n')
    (track / "campaign.toml").write_text(
        'controllers = ["none"]\nrails = ["leaf.toml", "leaf-2/leaf.toml"]\nstops = 2\ncheck_every = 0\n'
    )
    outcome = wspd("campaign", "campaign.toml", "-o", "rows.csv")
    assert outcome.code == 2
    assert "told alike" in outcome.err
    assert not (track / "rows.csv").exists()
