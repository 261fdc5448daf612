"""Controllers by name and by design file, and designs that do not fit."""

from dataclasses import replace

import pytest

from wspd_design.controllers.family import FAMILIES, designed
from wspd_design.controllers.protocol import acts_on_vehicle
from wspd_design.controllers.sliding_mode import SlidingMode
from wspd_design.design.catalog import controller
from wspd_design.design.file import write_design
from wspd_design.design.records import Specification, vehicle_hash
from wspd_design.design.selection import design_controller, named_design
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.simulation.metrics import energy_residual, momentum_residual
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.runs import Ending
from wspd_design.simulation.stop import simulate

pytestmark = pytest.mark.usefixtures("remembered")

DESIGNED = tuple(family.name for family in designed() if family.name != "afsmc")
"""Laws whose gains the rules choose."""


def held_slip(law):
    """Slip of the constant reference of a law."""
    return law.reference.slip if acts_on_vehicle(law) else law.gains.slip_reference


@pytest.mark.parametrize("name", [name for name in FAMILIES if name not in DESIGNED])
@pytest.mark.parametrize("period", [0.1, 0.02])
def test_names(er24pc, make_controller, name, period):
    made = controller(name, er24pc, load_rail("polach-wet"), Specification(sample_time=period))
    assert made == make_controller(name, sample_time=period)
    assert (made.name, made.sample_time) == (name, period)


@pytest.mark.parametrize("name", DESIGNED)
def test_names_of_designed_laws(er24pc, name):
    rail, specification = load_rail("polach-wet"), Specification(sample_time=0.02)
    made = controller(name, er24pc, rail, specification)
    assert (made.name, made.sample_time) == (name, 0.02)
    law = design_controller(er24pc, rail, specification, law=name).build(er24pc, rail)
    assert replace(law, name=name) == made


@pytest.mark.parametrize("rail", ["table10-dry", "table10-wet", "polach-dry", "polach-wet"])
def test_smc_stops_the_train_and_keeps_the_balances(er24pc, rail):
    track = load_rail(rail)
    made = controller("smc", er24pc, track, Specification())
    assert isinstance(made, SlidingMode)
    assert made.name == "smc"
    run = simulate(er24pc, made, Scenario(rail=track, initial_speed=120.0 / 3.6), plant="quarter")
    assert run.ending is Ending.STOPPED
    assert abs(momentum_residual(run, er24pc)) < 1e-6
    assert abs(energy_residual(run, er24pc)) < 1e-5


def test_slip_reference_of_the_specification_reaches_the_law(er24pc):
    rail = load_rail("polach-dry")
    for name in ("afsmc", *DESIGNED):
        made = controller(name, er24pc, rail, Specification(slip=0.08, reference="constant"))
        assert held_slip(made) == 0.08


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("trenitali", 'did you mean "trenitalia"'),
        ("knorr", "available: afsmc, smc"),
        ("", "unknown controller"),
        ("xyz.toml", "does not exist"),
    ],
)
def test_unknown_names(er24pc, name, words):
    with pytest.raises(UserError, match=words):
        controller(name, er24pc, load_rail("polach-dry"), Specification())


@pytest.mark.parametrize("law", ["afsmc", *DESIGNED])
def test_a_design_file_stands_for_its_own_controller(er24pc, tmp_path, law):
    # The file brings its rail and specification; those of the call do not matter.
    rail = load_rail("polach-wet")
    specification = Specification(slip=0.1, sample_time=0.05, reference="constant")
    made = design_controller(er24pc, rail, specification, law=law)
    path = tmp_path / "my.toml"
    write_design(made, path)
    from_file = controller(str(path), er24pc, load_rail("table10-dry"), Specification())
    assert from_file == made.build(er24pc, rail)
    assert (from_file.sample_time, held_slip(from_file)) == (0.05, 0.1)


def test_a_design_for_another_vehicle_is_refused(er24pc, tmp_path):
    path = tmp_path / "my.toml"
    write_design(design_controller(er24pc, load_rail("polach-wet"), Specification(), law="smc"), path)
    service = load_vehicle("er24pc-service")
    with pytest.raises(
        UserError, match="was made for vehicle er24pc, not for er24pc-service; use --vehicle er24pc"
    ):
        controller(str(path), service, load_rail("polach-wet"), Specification())


@pytest.mark.parametrize(
    "change",
    [
        lambda v: replace(v, mass=v.mass + 1.0),
        lambda v: replace(v, brake=replace(v.brake, vent_time=0.61)),
        lambda v: replace(v, bounds=v.bounds | {"mass": (6e4, 9e4)}),
    ],
)
def test_a_design_for_older_numbers_of_the_vehicle_is_refused(er24pc, tmp_path, change):
    path = tmp_path / "my.toml"
    write_design(design_controller(er24pc, load_rail("polach-wet"), Specification(), law="smc"), path)
    changed = change(er24pc)
    assert vehicle_hash(changed) != vehicle_hash(er24pc)
    with pytest.raises(UserError, match="numbers of vehicle er24pc have changed"):
        controller(str(path), changed, load_rail("polach-wet"), Specification())


def test_a_design_on_another_rail_is_refused(er24pc):
    made = design_controller(er24pc, load_rail("polach-wet"), Specification(), law="smc")
    with pytest.raises(UserError, match="made on rail polach-wet, not on polach-dry"):
        made.build(er24pc, load_rail("polach-dry"))


def test_vehicle_hash_is_the_same_in_every_process(er24pc):
    import subprocess
    import sys

    code = (
        "from wspd_design.design.records import vehicle_hash\n"
        "from wspd_design.parameters.loading import load_vehicle\n"
        "print(vehicle_hash(load_vehicle('er24pc')))"
    )
    other = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert other.stdout.strip() == vehicle_hash(er24pc)


def test_named_designs_carry_the_name_of_the_controller(er24pc):
    rail = load_rail("polach-dry")
    for name in ("afsmc", *DESIGNED):
        assert named_design(name, er24pc, rail, Specification()).name == name
