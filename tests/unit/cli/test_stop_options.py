"""From the options of a stop to its scenario."""

from dataclasses import asdict

import pytest

from wspd_design.cli.disturbances import StopOptions
from wspd_design.cli.stop_options import scenario
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.description import disturbances_of, rails_of
from wspd_design.simulation.records import Fault, Patch, Scenario, Sensing

WET, DRY = load_rail("polach-wet"), load_rail("polach-dry")


def made(**words):
    vehicle = load_vehicle("er24pc")
    return scenario(WET, StopOptions(**words), initial_speed=120.0 / 3.6, seed=3, vehicle=vehicle)


def test_a_comma_may_belong_to_the_name_of_a_rail_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wet,old.toml").write_text('base = "polach-wet"\n')
    rails = made(axle_rails="wet,old.toml, polach-dry,wet,old.toml,polach-wet").axle_rails
    assert [rail.name for rail in rails] == ["wet,old", "polach-dry", "wet,old", "polach-wet"]
    with pytest.raises(UserError, match='unknown rail "wet"'):
        made(axle_rails="polach-dry,wet,new.toml")


@pytest.mark.parametrize(
    ("text", "metres"), [("0.05 km polach-dry", 50.0), ("50 m polach-dry", 50.0), ("5000 mm polach-dry", 5.0)]
)
def test_start_of_a_patch(text, metres):
    assert made(patch=[text]).patches == (Patch(start=metres, rail=DRY),)


def test_nothing_written_disturbs_nothing():
    assert made() == Scenario(rail=WET, initial_speed=120.0 / 3.6, seed=3)
    assert disturbances_of(made()) == ""
    assert rails_of(made()) == "polach-wet"


@pytest.mark.parametrize(
    ("text", "grade"),
    [
        ("5 permille", 0.005),
        ("-5 per mille", -0.005),
        ("5permil", 0.005),
        ("12.5 ‰", 0.0125),
        ("0.5 %", 0.005),
        ("1 in 200", 0.005),
        ("-1:200", -0.005),
        ("\u22125 permille", -0.005),
        ("-0.5 %", -0.005),
        ("0.005", 0.005),
        ("0,5 %", 0.005),
    ],
)
def test_grade(text, grade):
    assert made(grade=text).grade == pytest.approx(grade, rel=1e-15)


@pytest.mark.parametrize("text", ["5 promille", "permille", "", "5 m", "nan", "uphill", "1 2 %"])
def test_what_is_no_grade(text):
    with pytest.raises(UserError, match="5 permille"):
        made(grade=text)


@pytest.mark.parametrize("text", ["50 m polach-dry", "50m polach-dry", " 5e4 mm  polach-dry "])
def test_patch(text):
    assert made(patch=[text]).patches == (Patch(start=50.0, rail=DRY),)


def test_patch_on_an_own_rail_in_a_folder_with_a_blank(tmp_path):
    folder = tmp_path / "my rails"
    folder.mkdir()
    (folder / "icy.toml").write_text('base = "polach-wet"\n')
    (patch,) = made(patch=[f"50 m {folder / 'icy.toml'}"]).patches
    assert (patch.start, patch.rail.name) == (50.0, "icy")


@pytest.mark.parametrize(
    "text", ["", "50 m", "polach-dry", "50 polach-dry", "m polach-dry", "50 m/s polach-dry"]
)
def test_what_is_no_patch(text):
    with pytest.raises(UserError, match="50 m"):
        made(patch=[text])


def test_axle_rails_are_front_first():
    rails = made(axle_rails="polach-wet, polach-dry ,low-adhesion,polach-dry").axle_rails
    assert [rail.name for rail in rails] == ["polach-wet", "polach-dry", "low-adhesion", "polach-dry"]


def test_sensing():
    stop = made(
        speed_noise="0.18 km/h",
        pulses=80,
        period_timing=True,
        reference_error="-2 %",
        reference_drift="-0.05 m/s2",
        reference_noise="0.36 km/h",
        torque_error="15 %",
        accelerometer_bias="-0.05 m/s2",
        accelerometer_noise="0.1 m/s2",
        radius_errors="0.5 %,-0.5 %, 0 %,0.001",
        dead_time="40 ms",
        shortest_pulse="10 ms",
    )
    right = Sensing(
        speed_noise=0.05,
        pulses_per_turn=80,
        period_timing=True,
        reference_error=-0.02,
        reference_drift=-0.05,
        reference_noise=0.1,
        torque_error=0.15,
        accelerometer_bias=-0.05,
        accelerometer_noise=0.1,
        radius_errors=(0.005, -0.005, 0.0, 0.001),
        dead_time=0.04,
        shortest_pulse=0.01,
    )
    found, wanted = asdict(stop.sensing), asdict(right)
    assert found.pop("radius_errors") == pytest.approx(wanted.pop("radius_errors"), rel=1e-15)
    assert found == pytest.approx(wanted, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "fault", "words"),
    [
        (
            "axle 2: valve-holds from 3 s",
            Fault(axle=2, kind="valve-holds", since=3.0),
            "valve of axle 2 stuck holding from 3 s on",
        ),
        (" Axle 1 :sensor-lost ", Fault(axle=1, kind="sensor-lost"), "speed sensor of axle 1 lost"),
        (
            "axle 4: valve-fills from 250 ms",
            Fault(axle=4, kind="valve-fills", since=0.25),
            "valve of axle 4 stuck filling from 0.25 s on",
        ),
        ("axle 3: VALVE-VENTS", Fault(axle=3, kind="valve-vents"), "valve of axle 3 stuck venting"),
    ],
)
def test_fault(text, fault, words):
    stop = made(fault=[text])
    assert stop.faults == (fault,)
    assert disturbances_of(stop) == words


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "must be an axle and what fails"),
        ("axle 2", "must be an axle and what fails"),
        ("axle two: valve-holds", "must be an axle and what fails"),
        ("axle 2: valve-hold", 'did you mean "valve-holds"'),
        ("axle 2: flat", "it may be sensor-lost, valve-holds, valve-vents, valve-fills"),
        ("axle 5: valve-holds", "from 1 to 4"),
        ("axle 0: valve-holds", "from 1 to 4"),
        ("axle 1: valve-holds from 3", "start of the fault"),
        ("axle 1: valve-holds from -3 s", "must not be negative"),
    ],
)
def test_what_is_no_fault(text, said):
    with pytest.raises(UserError, match=said):
        made(fault=[text])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1 %", "give 4 between commas"),
        ("1 %,1 %,1 %,2", "between -100 % and 100 %"),
        ("1 %,,0,0", "radius error"),
    ],
)
def test_what_are_no_radius_errors(text, said):
    with pytest.raises(UserError, match=said):
        made(radius_errors=text)


def test_all_is_said_to_the_reader():
    stop = made(
        axle_rails="polach-wet,polach-wet,polach-dry,polach-dry",
        patch=["50 m low-adhesion"],
        grade="-5 permille",
        pad_vibration=True,
        speed_noise="0.05 m/s",
        pulses=80,
        reference_error="2 %",
        reference_drift="-0.05 m/s2",
        reference_noise="0.1 m/s",
        torque_error="-10 %",
        accelerometer_bias="0.05 m/s2",
        accelerometer_noise="0.1 m/s2",
        radius_errors="0.5 %,0 %,0 %,-0.5 %",
        dead_time="40 ms",
        shortest_pulse="10 ms",
        fault=["axle 1: sensor-lost", "axle 2: valve-vents from 2 s"],
    )
    assert rails_of(stop) == "polach-wet/polach-wet/polach-dry/polach-dry, low-adhesion from 50 m"
    assert disturbances_of(stop) == (
        "grade -5 permille, pad vibration, speed noise 0.05 m/s rms, 80 pulses per turn, counted, "
        "reference error 2 %, reference drift -0.05 m/s2, reference noise 0.1 m/s rms, torque error -10 %, "
        "accelerometer bias 0.05 m/s2, accelerometer noise 0.1 m/s2 rms, wheel radii wrong by 0.5, 0, 0, -0.5 %, "
        "dead time 40 ms, shortest pulse 10 ms, speed sensor of axle 1 lost, valve of axle 2 stuck venting from 2 s on"
    )
    assert "100 pulses per turn, timed" in disturbances_of(made(pulses=100, period_timing=True))


def test_load_spread():
    loads = made(load_spread="4 %").load_irregularity
    assert len(loads.factors) == 4
    assert loads.spread == pytest.approx(0.04, rel=0.1)
    assert loads == made(load_spread="4 %").load_irregularity
    assert "wheel loads that vary by 4 % rms" in disturbances_of(made(load_spread="4 %"))


def test_irregularities():
    assert made().irregularities == "none"
    assert made(irregularities="High ").irregularities == "high"
    assert "track irregularities of ERRI B 176, low level" in disturbances_of(made(irregularities="low"))
    with pytest.raises(UserError, match=r'"hihg" names no level.*may be none, low, high'):
        made(irregularities="hihg")
