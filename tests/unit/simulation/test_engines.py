"""The same stop on every engine: compiled, without a compiler, and with a controller that stays in Python."""

import warnings
from dataclasses import dataclass, replace

import numpy as np
import pytest

from wspd_design.codegen import closed_loop, law_library
from wspd_design.codegen.compiler import NoCompilerError
from wspd_design.parameters.loading import load_rail
from wspd_design.simulation.records import Scenario
from wspd_design.simulation.stop import simulate


@dataclass(frozen=True)
class Untraceable:
    """A controller that decides with Python's own words, so that it cannot be traced."""

    law: object

    @property
    def name(self):
        return f"untraceable {self.law.name}"

    @property
    def sample_time(self):
        return self.law.sample_time

    def start(self, measurement):
        return self.law.start(measurement)

    def step(self, state, measurement):
        if measurement.speed < 0.0:
            raise AssertionError("the train does not run backwards")
        return self.law.step(state, measurement)


def assert_same(one, other):
    assert one.totals.distance == pytest.approx(other.totals.distance, rel=1e-9)
    assert one.totals.torque == pytest.approx(other.totals.torque, rel=1e-9)
    assert one.slip_max == pytest.approx(other.slip_max, rel=1e-6)
    assert len(one.samples) == len(other.samples)
    np.testing.assert_allclose(one.slip[-1], other.slip[-1], atol=1e-6)


@pytest.mark.parametrize(
    ("missing", "engine"),
    [
        (closed_loop, "CasADi virtual machine"),
        (law_library, "compiled plant, law in CasADi's virtual machine"),
    ],
    ids=["plant", "law"],
)
@pytest.mark.parametrize("name", ["trenitalia", "none"])
def test_without_a_compiler_the_numbers_are_the_same(
    monkeypatch, er24pc, make_controller, name, missing, engine
):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=5.0)
    compiled = simulate(er24pc, make_controller(name), scenario, plant="quarter")

    def no_compiler(_source):
        raise NoCompilerError("no C compiler")

    monkeypatch.setattr(missing, "load_library", no_compiler)
    with warnings.catch_warnings(record=True):
        warnings.simplefilter("always")
        virtual = simulate(replace(er24pc, name="virtual"), make_controller(name), scenario, plant="quarter")
    assert (compiled.engine, virtual.engine) == ("compiled", engine)
    assert_same(virtual, compiled)
    assert 0.0 <= virtual.slip_max <= 1.0


def test_a_controller_that_cannot_be_traced_runs_in_python_and_says_so(er24pc, make_controller):
    scenario = Scenario(rail=load_rail("polach-wet"), initial_speed=5.0)
    law = make_controller("trenitalia")
    compiled = simulate(er24pc, law, scenario, plant="quarter")
    with pytest.warns(
        UserWarning, match="untraceable trenitalia.* cannot be traced by CasADi and runs in Python"
    ):
        in_python = simulate(er24pc, Untraceable(law), scenario, plant="quarter")
    assert in_python.engine == "compiled plant, controller in Python"
    assert_same(in_python, compiled)
