"""Designs of laws of a vehicle: reference and sensors in their files, rules on every vehicle, and what is refused."""

from dataclasses import replace

import pytest

from tests.unit.controllers.vehicle_cases import LAWS
from wspd_design.controllers.observers.fastest import FastestAxle
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.protection import Protection
from wspd_design.controllers.protocol import acts_on_vehicle
from wspd_design.controllers.references import ConstantSlip, FallingSlip, SlipTable
from wspd_design.design.file import design_text, read_design, write_design
from wspd_design.design.records import Specification
from wspd_design.design.selection import design_controller
from wspd_design.design.tracking_gains import CURVE_SHARE, vented_rate
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.files import available
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.peak import peak_adhesion

REFERENCES = {None: FallingSlip, "constant": ConstantSlip, "falling": FallingSlip, "peak": SlipTable}


def designed(vehicle, law="observer-smc", rail="polach-wet", **specification):
    return design_controller(vehicle, load_rail(rail), Specification(**specification), law=law)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("reference", [*REFERENCES, "seeking"])
@pytest.mark.parametrize("sensors", [Sensors(), Sensors(speed="wheels", accelerometer=True, pressures=False)])
def test_reference_and_sensors_come_back_from_the_file(er24pc, tmp_path, law, reference, sensors):
    made = designed(er24pc, law, reference=reference, sensors=sensors, sample_time=0.02)
    write_design(made, tmp_path / "my.toml")
    assert read_design(tmp_path / "my.toml") == made
    built = made.build(er24pc, load_rail("polach-wet"))
    assert isinstance(built, Protection)
    assert type(built.reference) is REFERENCES.get(reference, FallingSlip)
    assert (built.seeking is not None) == (reference == "seeking")
    assert built.pressure_sensors == sensors.pressures


def test_files_say_nothing_about_what_is_usual(er24pc):
    for law in ("smc", "observer-smc"):
        text = design_text(designed(er24pc, law))
        assert "reference =" not in text
        assert "sensors" not in text


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('speed = "wheels"', 'speed = "radar"', 'sensors: speed = "radar" must be one of "told"'),
        ('speed = "wheels"', "speed = 3", "specification.sensors.speed = 3 in .* must be text"),
        ("grade = false", 'grade = "no"', "specification.sensors.grade = no in .* must be true or false"),
        ("grade = false", "slope = false", "unknown key specification.sensors.slope"),
        ('reference = "peak"', 'reference = "best"', 'reference = "best" must be one of "constant"'),
        ('reference = "peak"', "reference = 3", "specification.reference in .* must be text"),
    ],
)
def test_bad_words_are_refused_in_one_sentence(er24pc, tmp_path, old, new, words):
    made = designed(er24pc, reference="peak", sensors=Sensors(speed="wheels"))
    path = tmp_path / "my.toml"
    text = design_text(made)
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(UserError, match=words) as refused:
        read_design(path)
    assert "\n" not in str(refused.value)


def test_a_law_of_one_wheelset_holds_a_constant_slip(er24pc):
    made = designed(er24pc, "smc", reference="falling")
    with pytest.raises(UserError, match='reference = "falling" goes with a law of a vehicle'):
        made.build(er24pc, load_rail("polach-wet"))
    assert not acts_on_vehicle(
        designed(er24pc, "smc", reference="constant").build(er24pc, load_rail("polach-wet"))
    )


def test_sensors_put_a_law_of_one_wheelset_into_a_protection(er24pc):
    made = designed(er24pc, "torque-feedback", sensors=Sensors(speed="fastest-axle"))
    law = made.build(er24pc, load_rail("polach-wet"))
    assert isinstance(law, Protection)
    assert isinstance(law.source, FastestAxle)
    told = replace(made, specification=replace(made.specification, sensors=Sensors()))
    assert law.core.law == told.build(er24pc, load_rail("polach-wet"))


def test_the_table_of_the_peak_is_that_of_the_rail(er24pc):
    rail = load_rail("polach-dry")
    law = designed(er24pc, rail="polach-dry", reference="peak").build(er24pc, rail)
    import numpy as np

    speeds = np.array([2.0, 7.0, 20.0, 33.0])
    slips, _ = peak_adhesion(er24pc, rail, speeds)
    assert [law.reference.at(v, 1.0).slip for v in speeds] == pytest.approx(list(slips), rel=0.03)


@pytest.mark.parametrize("name", available("vehicle"))
@pytest.mark.parametrize("law", LAWS)
def test_rules_give_gains_with_reasons_on_every_vehicle(name, law):
    vehicle = load_vehicle(name)
    for period in (0.02, 0.1):
        made = designed(vehicle, law, reference="seeking", sample_time=period)
        assert all(gain.why for gain in made.gains)
        built = made.build(vehicle, load_rail("polach-wet"))
        assert built.torque_shares == vehicle.brake_shares


def test_a_slower_sample_and_valve_make_a_slower_approach(er24pc):
    def rate(vehicle, period):
        return designed(vehicle, sample_time=period).gain("approach_rate")

    slow = replace(er24pc, brake=replace(er24pc.brake, vent_time=1.2))
    assert rate(er24pc, 0.02) > rate(er24pc, 0.1)
    assert rate(er24pc, 0.02) > rate(slow, 0.02)


@pytest.mark.parametrize(
    ("rail", "changes", "share"),
    [
        ("polach-wet", {"reference": "constant"}, CURVE_SHARE),
        ("polach-wet", {"reference": "constant", "slip": 0.1}, 1.0),  # the peak is at .055
        ("polach-wet", {"reference": "constant", "speeds": (10.0 / 3.6, 40.0 / 3.6)}, 1.0),  # and there at .1
        ("table10-wet", {"reference": "constant"}, 1.0),  # which has no peak
        ("eurosprinter127", {}, 1.0),  # beside the peak
        ("eurosprinter127", {"reference": "peak"}, 1.0),
        ("eurosprinter127", {"reference": "seeking"}, 1.0),
    ],
)
def test_only_a_constant_reference_far_beyond_the_peak_leaves_a_part_of_the_vented_rate(
    er24pc, rail, changes, share
):
    vented = vented_rate(er24pc, load_rail(rail), Specification(**changes)).rate
    made = designed(er24pc, rail=rail, **changes)
    assert made.gain("torque_slew") == share * vented
    why = next(gain.why for gain in made.gains if gain.name == "torque_slew")
    assert why.startswith("0.25 T/tau, " if share == CURVE_SHARE else "T/tau, ")
    wide = designed(er24pc, "super-twisting", rail=rail, **changes)
    whole = vented / er24pc.wheelset_inertia / wide.gain("approach_rate") ** 2 * er24pc.wheel_radius
    assert wide.gain("layer") == pytest.approx(whole, rel=1e-12)  # a layer takes all of it
