"""Wheels that adhere and have settled take exponential steps: fewer of them, for the same stop."""

from dataclasses import replace

import pytest

from wspd_design.codegen import closed_loop
from wspd_design.codegen.closed_loop import load_closed_loop
from wspd_design.codegen.memory import Memory
from wspd_design.codegen.virtual_machine import run_virtual
from wspd_design.parameters.loading import load_rail, load_vehicle
from wspd_design.plants.planar import Planar
from wspd_design.simulation.loop_input import loop_input, sample_rows
from wspd_design.simulation.records import Scenario

SERVICE = load_vehicle("er24pc-service")  # its brake asks for less than dry rail gives
DRY = Scenario(rail=load_rail("polach-dry"), initial_speed=100.0 / 3.6)


def ended(make_controller, *, refinement=1, scenario=DRY):
    """Steps of a stop whose wheels never slide, its distance and the integral of the slip of its first axle."""
    plant, law = Planar(SERVICE), make_controller("none")
    output = load_closed_loop(plant, law).run(loop_input([(plant, scenario)], law, refinement=refinement))
    return output.steps, (float(output.stop_totals["distance"][0]), float(output.lane_totals["slip"][0]))


def agrees(found, true):
    return found[0] == pytest.approx(true[0], rel=5e-8) and found[1] == pytest.approx(true[1], rel=5e-5)


@pytest.fixture
def with_fault(monkeypatch):
    """Compile the loop with another text in place of one of its own."""

    def planted(text, other):
        true = closed_loop.closed_loop_source

        def faulty(*arguments, **options):
            source = true(*arguments, **options)
            assert source.count(text) == 1
            return source.replace(text, other)

        monkeypatch.setattr(closed_loop, "closed_loop_source", faulty)
        monkeypatch.setattr(closed_loop, "_plants", Memory(4))

    return planted


def test_fewer_steps_for_the_same_stop(make_controller, with_fault):
    steps, found = ended(make_controller)
    with_fault("settling[l] = stop[l] * calm * rate;", "settling[l] = 0.0;")  # classical steps alone
    classical, _ = ended(make_controller)
    _, true = ended(make_controller, refinement=8)
    assert 3 * steps < classical
    assert agrees(found, true)


@pytest.mark.parametrize(
    ("text", "other"),
    [
        ("to->speed[s] += impulse / whole;", ""),  # the impulse of the stages alone
        (
            "double one = (whole - 1.0) / z, two = (one - 1.0) / z,",
            "double one = (whole - 1.0) / z, two = 0.5,",
        ),
        ("more[l] = wheels->rate[l] != 0.0 ? 2.0 * part", "more[l] = wheels->rate[l] != 0.0 ? 2.0001 * part"),
    ],
)
def test_a_wrong_formula_is_seen(make_controller, with_fault, text, other):
    _, true = ended(make_controller, refinement=4)
    with_fault(text, other)
    _, found = ended(make_controller)
    assert not agrees(found, true)


def test_the_same_without_a_compiler(make_controller):
    plant, law = Planar(SERVICE), make_controller("none")
    for rail in ("polach-dry", "low-adhesion"):
        given = loop_input([(plant, replace(DRY, rail=load_rail(rail), initial_speed=15.0))], law)
        compiled = load_closed_loop(plant, law).run(given)
        virtual = run_virtual(plant, law, given, sample_rows=sample_rows(law), disturbed=False)
        assert abs(virtual.steps - compiled.steps) <= 2
        for name in ("distance", "time", "resistance_work"):
            expected = compiled.stop_totals[name][0]
            assert virtual.stop_totals[name][0] == pytest.approx(expected, rel=1e-9), name
