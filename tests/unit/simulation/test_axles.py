"""Stops of vehicles with other numbers of axles and states than the paper's, compiled and without a compiler."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.model.slip import slip_dynamics
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_rail
from wspd_design.plants.planar import Planar
from wspd_design.plants.quarter import Quarter
from wspd_design.simulation.ideal import ideal_stop
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.metrics import energy_residual, metrics, momentum_residual
from wspd_design.simulation.records import LoadIrregularity, Patch, Scenario, Sensing
from wspd_design.simulation.stop import simulate

WET = load_rail("polach-wet")


def with_axles(vehicle, axles):
    """As many wheelsets with the same load, resistance and brake each."""
    share = axles / vehicle.wheelsets
    return replace(
        vehicle,
        wheelsets=axles,
        mass=share * vehicle.mass,
        body_mass=share * vehicle.mass - axles // 2 * vehicle.bogie_mass,
        resistance_constant=share * vehicle.resistance_constant,
        resistance_linear=share * vehicle.resistance_linear,
        resistance_quadratic=share * vehicle.resistance_quadratic,
    )


@pytest.fixture(scope="module")
def scenario():
    return Scenario(rail=WET, initial_speed=15.0)


@pytest.mark.parametrize("name", ["trenitalia", "afsmc"])
@pytest.mark.parametrize("axles", [2, 6])
def test_the_stop_of_equal_wheelsets_does_not_know_their_number(
    er24pc, make_controller, scenario, axles, name
):
    law = make_controller(name, "polach-wet")
    four = simulate(er24pc, law, scenario, plant="quarter")
    other = simulate(with_axles(er24pc, axles), law, scenario, plant="quarter")
    assert other.totals.distance == pytest.approx(four.totals.distance, rel=1e-10)
    assert other.totals.torque == pytest.approx(four.totals.torque * axles / 4, rel=1e-9)
    assert len(other.final_wheel_speeds) == axles
    np.testing.assert_allclose(other.wheel_load[-1], four.wheel_load[-1], rtol=1e-12)


def test_the_mass_of_a_wheelset_counts(er24pc, make_controller):
    # The counterpart: the same train with half as many brakes is another stop, where the brake is what limits it.
    law, scenario = make_controller("none"), Scenario(rail=load_rail("polach-dry"), initial_speed=15.0)
    weak = replace(er24pc, brake=replace(er24pc.brake, max_torque=10e3))
    two, four = (simulate(replace(weak, wheelsets=n), law, scenario, plant="quarter") for n in (2, 4))
    assert two.totals.distance > 1.5 * four.totals.distance


@pytest.mark.parametrize(("plant", "axles"), [("quarter", 2), ("quarter", 6), ("planar", 6)])
def test_momentum_and_energy_are_conserved(er24pc, make_controller, scenario, plant, axles):
    vehicle, law = with_axles(er24pc, axles), make_controller("trenitalia")
    run = simulate(vehicle, law, scenario, plant=plant)
    assert abs(momentum_residual(run, vehicle)) < 1e-6
    assert abs(energy_residual(run, vehicle)) < 1e-5
    assert metrics(run, vehicle, scenario, slip_reference=0.14).efficiency < 1.0
    assert run.wheel_speed.shape[1] == len(run.axle_samples) == (1 if plant == "quarter" else axles)


def test_six_axles_without_heights_are_equal(er24pc, make_controller, scenario):
    six, law = with_axles(er24pc, 6), make_controller("trenitalia")
    flat = replace(six, body_height=0.0, bogie_height=0.0, traction_rod_height=0.0)
    one, other = simulate(flat, law, scenario), simulate(six, law, scenario, plant="quarter")
    assert one.totals.distance == pytest.approx(other.totals.distance, rel=1e-12)
    assert simulate(six, law, scenario).totals.distance != pytest.approx(other.totals.distance, rel=1e-6)


def test_braking_loads_the_front_bogie_most(er24pc, make_controller, scenario):
    run = simulate(with_axles(er24pc, 6), make_controller("trenitalia"), scenario)
    while_braking = run.wheel_load[len(run.time) // 2].reshape(3, 2)
    assert (np.diff(while_braking, axis=1) < 0.0).all()  # within each bogie
    assert (np.diff(while_braking.mean(axis=1)) < 0.0).all()  # over the bogies


FEATURES = {
    "plain": {},
    "rails of single axles": {"axle_rails": (WET, load_rail("polach-dry"))},
    "patches and noise": {
        "patches": (Patch(start=10.0, rail=load_rail("polach-dry")),),
        "sensing": Sensing(speed_noise=0.02),
    },
    "loads": {
        "load_irregularity": LoadIrregularity(spacing=2.0, factors=((1.0, 1.1, 0.9), (1.0, 0.9, 1.05)))
    },
}


def both(plant, law, scenario):
    """The same stop compiled and in the virtual machine."""
    given = replace(loop_input([(plant, scenario)], law), trace_rows=20_000)
    rows = sample_rows(law)
    compiled = load_closed_loop(plant, law).run(given, sample_rows=rows)
    return compiled, run_virtual(plant, law, given, sample_rows=rows, disturbed=False)


def assert_same(virtual, compiled):
    assert (virtual.steps, virtual.trace.shape) == (compiled.steps, compiled.trace.shape)
    for totals in ("stop_totals", "lane_totals"):
        for name, values in getattr(compiled, totals).items():
            scale = 1.0 if name == "end_speed" else np.abs(values).max()
            np.testing.assert_allclose(
                getattr(virtual, totals)[name], values, rtol=0, atol=1e-7 * scale, err_msg=name
            )
    np.testing.assert_allclose(virtual.wheel_speeds, compiled.wheel_speeds, atol=1e-7)


@pytest.mark.parametrize("feature", FEATURES)
@pytest.mark.parametrize(("kind", "axles"), [(Quarter, 2), (Planar, 6)])
def test_without_a_compiler_the_numbers_are_the_same(er24pc, make_controller, kind, axles, feature):
    changes = dict(FEATURES[feature])
    if kind is Quarter and feature in ("rails of single axles", "loads"):
        kind, axles = Planar, 4
    if "axle_rails" in changes:
        changes["axle_rails"] *= axles // 2
    if "load_irregularity" in changes:
        table = changes["load_irregularity"]
        changes["load_irregularity"] = replace(table, factors=table.factors * (axles // 2))
    scenario = Scenario(rail=WET, initial_speed=6.0, **changes)
    compiled, virtual = both(kind(with_axles(er24pc, axles)), make_controller("trenitalia"), scenario)
    assert_same(virtual, compiled)


@pytest.mark.parametrize(("plant", "axles"), [("quarter", 2), ("planar", 6)])
def test_ideal_stops_of_other_vehicles(er24pc, scenario, plant, axles):
    ideal = ideal_stop(with_axles(er24pc, axles), scenario, plant=plant).distance
    four = ideal_stop(er24pc, scenario, plant="quarter").distance
    assert ideal == pytest.approx(four, rel=1e-9 if plant == "quarter" else 0.02)


@pytest.mark.parametrize("axles", [2, 6])
def test_rails_for_another_number_of_axles_are_refused(er24pc, make_controller, axles):
    law = make_controller("none")
    for changes, what in (
        ({"axle_rails": (WET,) * axles}, f"axle rails: the stop names {axles} rails; name 4, .*er24pc"),
        (
            {"load_irregularity": LoadIrregularity(spacing=1.0, factors=((1.0, 1.0),) * axles)},
            f"load irregularity: the stop names {axles} tables; name 4",
        ),
    ):
        with pytest.raises(UserError, match=what):
            simulate(er24pc, law, Scenario(rail=WET, initial_speed=5.0, **changes))


@pytest.mark.parametrize("axles", [1, 2, 6])
def test_slip_dynamics_do_not_know_the_number_of_equal_wheelsets(er24pc, axles):
    mine, theirs = (slip_dynamics(v, WET, 0.1, 20.0) for v in (er24pc, with_axles(er24pc, axles)))
    np.testing.assert_allclose(theirs, mine, rtol=1e-13)


@dataclass(frozen=True, slots=True)
class Warming(Quarter):
    """A plant with a second state of every wheelset, its clock, by which the damping of the wheels decays."""

    @property
    def axle_states(self):
        return 2

    def wheel_damping(self, time):  # noqa: ARG002
        return Quarter(self.vehicle).wheel_damping(0.0)

    def axle_motion(self, rail, *, states, condition, **given):
        from wspd_design.model.number import exp

        wheel, clock = states
        damping = condition.damping * exp(-self.vehicle.wheel_damping_decay * clock)
        motion = Quarter(self.vehicle).axle_motion(
            rail, states=(wheel,), condition=condition._replace(damping=damping), **given
        )
        return motion._replace(rates=(*motion.rates, 1.0 + 0.0 * wheel))


@pytest.mark.parametrize("axles", [2, 4])
def test_a_plant_with_two_states_per_axle(er24pc, axles):
    # Much damping, so that its decay counts; Quarter takes it at the middle of every step.
    vehicle = replace(with_axles(er24pc, axles), wheel_damping=100.0, wheel_damping_decay=0.5)
    law, scenario = (
        Unprotected(name="none", sample_time=0.1),
        Scenario(rail=load_rail("polach-dry"), initial_speed=8.0),
    )
    compiled, virtual = both(Warming(vehicle), law, scenario)
    assert_same(virtual, compiled)
    usual, _ = both(Quarter(vehicle), law, scenario)
    steady, _ = both(Quarter(replace(vehicle, wheel_damping_decay=0.0)), law, scenario)
    distance, known, other = (float(x.stop_totals["distance"][0]) for x in (compiled, usual, steady))
    assert distance == pytest.approx(known, rel=1e-7)
    assert distance != pytest.approx(other, rel=1e-4)
