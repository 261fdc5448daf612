"""The protection of a vehicle: its state, its observers, and commands that others than the law decide."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from tests.unit.controllers.vehicle_cases import LAWS, protection, seen
from wspd_design.codegen.laws import law_kernels
from wspd_design.codegen.sampled import flat
from wspd_design.controllers.baselines.unprotected import Unprotected
from wspd_design.controllers.observers.protocol import SpeedEstimate
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.controllers.observers.told import ToldSpeed
from wspd_design.controllers.protected import protected
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_vehicle


@dataclass(frozen=True, slots=True, kw_only=True)
class Asking(ToldSpeed):
    """A source that wants one wheelset released and another one held."""

    released: int
    held: int

    def step(self, state, seen, friction_torques, slip_references):
        state, told = ToldSpeed.step(self, state, seen, friction_torques, slip_references)
        axles = range(self.wheelsets)
        return state, SpeedEstimate(
            told.speed,
            told.acceleration,
            tuple(float(axle == self.released) for axle in axles),
            tuple(float(axle == self.held) for axle in axles),
        )


def braking(vehicle, slips=(0.036,) * 4, speed=20.0, share=0.4, **changes):
    return seen(vehicle, speed, slips, (share * vehicle.brake.max_pressure,) * 4, **changes)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("reference", ["constant", "falling", "peak", "seeking"])
@pytest.mark.parametrize("name", ["er24pc", "co-co", "two-axle-wagon", "metro"])
def test_the_memory_names_every_element(law, reference, name):
    vehicle = load_vehicle(name)
    made = protection(vehicle, law, reference=reference)
    axles = vehicle.wheelsets
    now = (
        braking(vehicle, (0.03,) * axles)
        if axles == 4
        else seen(vehicle, 20.0, (0.03,) * axles, (1e5,) * axles)
    )
    state = made.start(now)
    following, commands = made.step(state, now)
    assert len(state) == len(following) == len(made.memory) == len(set(made.memory))
    assert len(commands) == axles == made.wheelsets
    first = made.memory.index("slip_reference_1")
    assert made.memory[first : first + axles] == tuple(f"slip_reference_{n}" for n in range(1, axles + 1))
    assert all(np.isfinite(following))
    for command in commands:
        assert command.fill >= 0.0
        assert command.vent >= 0.0
        assert command.fill + command.vent <= 1.0


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("sensors", [Sensors(), Sensors(pressures=False), Sensors(speed="fastest-axle")])
def test_what_is_traced_is_what_runs(er24pc, law, sensors):
    made = protection(er24pc, law, reference="seeking", sensors=sensors)
    kernels = law_kernels(made)
    assert kernels.gains, "its numbers are inputs"
    random = np.random.default_rng(1)
    state = made.start(braking(er24pc))
    for _ in range(50):
        now = braking(er24pc, tuple(random.uniform(0.0, 0.1, 4)), speed=random.uniform(0.5, 33.0))
        following, commands = made.step(state, now)
        expected = [*following, *(each.fill for each in commands), *(each.vent for each in commands)]
        traced = np.array(kernels.step(state, flat(now), kernels.gains)).ravel()
        assert traced == pytest.approx(list(map(float, expected)), rel=1e-9, abs=1e-9)
        state = following


def test_the_source_releases_and_holds(er24pc):
    made = protection(er24pc)
    source = Asking(sample_time=0.02, wheel_radius=er24pc.wheel_radius, wheelsets=4, released=2, held=1)
    made = replace(made, source=source)
    now = braking(er24pc, (0.3,) * 4)
    state, commands = made.step(made.start(now), now)
    assert commands[2] == (0.0, 1.0)
    assert commands[1] == (0.0, 0.0)
    assert commands[0].vent > 0.0
    released = [dict(zip(made.memory, state, strict=True))[f"released_{n}"] for n in (1, 2, 3, 4)]
    assert released == [0.0, 0.0, 1.0, 0.0]


def test_a_lost_sensor_is_known_and_its_wheelset_brakes_less_than_the_others(er24pc):
    made = protection(er24pc)
    healthy = (1.0, 0.0, 1.0, 1.0)
    pressures = [0.4 * er24pc.brake.max_pressure] * 4
    now = seen(er24pc, 20.0, (0.036,) * 4, pressures, healthy=healthy)
    now = now._replace(wheel_speeds=(now.wheel_speeds[0], 0.0, *now.wheel_speeds[2:]))
    _, commands = made.step(made.start(now), now)
    assert commands[1].vent > 0.0  # down to .85 of the others, though its wheel reads a lock
    pressures[1] = 0.85 * pressures[0]
    now = now._replace(pressures=tuple(pressures))
    assert made.step(made.start(now), now)[1][1] == (0.0, 0.0)
    blind = now._replace(healthy=(0.0,) * 4)
    assert all(command.fill > 0.0 for command in made.step(made.start(blind), blind)[1])


def test_at_low_speed_the_valves_hold_and_a_wheel_that_slides_far_is_let_go(er24pc):
    made = protection(er24pc)
    for speed, slips, expected in (
        (1.0, (0.0, 0.3, 0.6, 1.0), [(0, 0), (0, 0), (0, 1), (0, 1)]),
        (3.0, (0.0,) * 4, None),
    ):
        now = braking(er24pc, slips, speed=speed)
        before = now if expected is None else braking(er24pc, slips, speed=speed + 0.3)
        _, commands = made.step(made.start(before), now)
        if expected is None:
            assert all(command.fill > 0.0 for command in commands)
        else:
            assert [(command.fill, command.vent) for command in commands] == expected


def test_a_slow_train_that_is_not_braked_is_braked_again(er24pc):
    made = protection(er24pc)
    now = braking(er24pc, (0.0,) * 4, speed=1.0, share=0.0)  # empty cylinders: a grade would keep it running
    _, commands = made.step(made.start(now), now)
    assert all(command.fill > 0.0 for command in commands)


@pytest.mark.parametrize("pressures", [True, False])
def test_the_friction_torque_is_observed(er24pc, pressures):
    """Wheels that slow down evenly under a constant torque: tau = T + J w'."""
    made = protection(er24pc, sensors=Sensors(pressures=pressures))
    torque, rate, speed = 2e4, -3.0, 25.0
    now = seen(er24pc, speed, (0.0,) * 4, (torque / er24pc.brake.max_torque * er24pc.brake.max_pressure,) * 4)
    state = made.start(now)
    for k in range(1, 60):
        wheels = tuple(speed / er24pc.wheel_radius + rate * 0.02 * k for _ in range(4))
        named = dict(zip(made.memory, state, strict=True))
        held = [named[f"mean_torque_{n}"] for n in (1, 2, 3, 4)]  # as if the valves made what the model says
        state, _ = made.step(state, now._replace(wheel_speeds=wheels))
        expected = [mean + er24pc.wheelset_inertia * rate for mean in held]
    named = dict(zip(made.memory, state, strict=True))
    observed = [named[f"friction_torque_{n}"] for n in (1, 2, 3, 4)]
    assert observed == pytest.approx([max(0.0, each) for each in expected], rel=0.15)


def test_a_controller_of_one_wheelset_runs_unchanged(er24pc, make_controller):
    law = make_controller("knorr-bremse", sample_time=0.02)
    made = protected(law, er24pc, Sensors())
    now, later = braking(er24pc, (0.0,) * 4), braking(er24pc, (0.2, 0.02, 0.3, 0.0), speed=19.9)
    _, commands = made.step(made.start(now), later)
    for axle, command in enumerate(commands):
        _, alone = law.step(law.start(now.of(axle)), later.of(axle))
        assert (command.fill, command.vent) == pytest.approx((alone.fill, alone.vent), abs=1e-12)
    idle = protected(Unprotected(name="none", sample_time=0.1), er24pc, Sensors())
    assert len(idle.memory) == len(idle.start(now))


def test_a_search_needs_two_wheelsets_with_a_brake():
    wagon = load_vehicle("two-axle-wagon")
    lame = replace(wagon, brake=replace(wagon.brake, axle_shares=(1.0, 0.0)))
    with pytest.raises(UserError, match="has not two with a brake"):
        protection(lame, reference="seeking")
    assert protection(lame, reference="falling").wheelsets == 2
