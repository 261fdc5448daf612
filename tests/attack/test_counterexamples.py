"""The audit's counterexamples keep their values in equations that share nothing with the package."""

from dataclasses import asdict, replace

import numpy as np
import pytest

from tests.attack import linear, motion
from tests.attack.case import read_data
from tests.attack.counterexamples import (
    ADAPTIVE,
    CALM_SPEED,
    DEPARTURES,
    EQUILIBRIA,
    FALLS,
    FAST_VENT,
    FAST_VENT_SPEED,
    GAIN_BY_LOAD,
    GAIN_BY_RAIL,
    LEAVES,
    LOAD_SHARES,
    OTHER_WET,
    PEAK_SUMS,
    RAIL_AND_RADIUS,
    REPELLED,
    REPULSION,
    SLIP_ONLY,
    SMC,
    SWINGING,
    SWINGING_SPEEDS,
    UNSTABLE_CORNER,
    UNSTABLE_RADIUS,
    braking_always,
    coach,
    peak_rise,
    slip_only_loop,
    smc,
    torque_feedback,
)
from tests.attack.laws import layer, sliding_torque, surface, surface_rate
from tests.attack.plant import deceleration, holding_torque, load_shares, slip_pole, slip_rate
from tests.attack.search import Attack, assail
from tests.attack.statements import needed_gain

ETA = 0.204  # m/s2, of the audited design
BOX = ("mass", "wheelset_inertia", "mu0")


@pytest.mark.parametrize("loop", SLIP_ONLY, ids=lambda each: f"{each.kind} at {each.speed:g}")
def test_laws_on_the_slip_alone_are_stable_on_the_dry_rail(loop):
    plant = read_data("er24pc", "polach-dry").plant
    matrix, memory = slip_only_loop(loop.kind, plant, loop.speed)
    assert np.sort_complex(np.linalg.eigvals(matrix)) == pytest.approx(
        np.sort_complex(np.array(loop.poles)), abs=2e-3
    )
    pole = slip_pole(plant, 0.14, loop.speed)
    assert pole > 1.0 / plant.fill_time  # what the theorem asks for
    assert np.trace(matrix) == pytest.approx(pole - 1.0 / plant.fill_time + memory)


@pytest.mark.parametrize("point", EQUILIBRIA, ids=lambda each: f"{each.slip}")
def test_equilibria_off_the_nominal_parameters(point):
    case = torque_feedback(point.rail)
    plant = case.data.plant.with_numbers(asdict(point))
    slip, _ = linear.equilibrium(case, plant, np.array([point.speed]), sampled=False)
    assert slip == pytest.approx(point.slip, abs=6e-5)


def test_an_evil_subclass_has_the_numbers_of_its_law_and_brakes_fully(make_controller):
    law = make_controller("smc")
    evil = braking_always(law)
    assert isinstance(evil, type(law))
    assert type(evil) is not type(law)
    assert evil.gains == law.gains
    _, command = evil.step(evil.start(None), None)
    assert (command.fill, command.vent) == (1.0, 0.0)


def required(case, names, **ranges):
    """Least W0 that outweighs the model error over a box, found from below."""
    free = {"slip": case.slips, "speed": case.speeds} | {name: case.data.bounds[name] for name in names}

    def margin(x):
        plant = case.data.plant.with_numbers(x)
        return -needed_gain(case, plant, x["slip"], x["speed"], ETA)

    attack = Attack(check="reaching", statement="W0", box=free | ranges, margin=margin)
    return -assail(attack, evaluations=30_000, seed=1).margin


def test_another_rail_of_the_same_name_needs_more_gain():
    low, high = OTHER_WET["mu0_bounds"]
    assert required(smc(), ("mass", "wheelset_inertia"), mu0=(low, high)) == pytest.approx(15.2, abs=0.06)


def test_load_shares_of_the_four_axles():
    data = read_data("er24pc", "polach-wet")
    assert load_shares(data.plant, data.body, 0.27) == pytest.approx(LOAD_SHARES, abs=6e-4)


@pytest.mark.parametrize(("share", "rate"), REPULSION.items())
def test_the_surface_repels_a_loaded_axle(share, rate):
    """The train decelerates as with equal loads."""
    case = smc()
    slip, speed = REPELLED["slip"], REPELLED["speed"]
    equal = case.data.plant.with_numbers(REPELLED)
    plant = equal.with_numbers({"load_share": share, "train_deceleration": deceleration(equal, slip, speed)})
    error, c = case.slip - slip, surface_rate(case)
    torque = sliding_torque(case, slip, speed, (2.0 * layer(case) - error) / c)
    moved = speed * (-slip_rate(plant, slip, speed, torque) + c * error)
    assert moved == pytest.approx(rate, abs=6e-3)


@pytest.mark.parametrize(("ranges", "gain"), GAIN_BY_LOAD.items())
def test_gain_that_unequal_loads_need(ranges, gain):
    share, deceleration = ranges
    found = required(smc(), BOX, load_share=share, train_deceleration=deceleration)
    assert found == pytest.approx(gain, abs=0.01)


@pytest.mark.parametrize("start", DEPARTURES, ids=lambda each: f"{each.start_kmh:g} km/h")
def test_starts_from_which_the_layer_is_not_reached_in_time(start):
    case = smc()
    plant = case.data.plant.with_numbers(asdict(start))
    path = motion.layer_run(
        case,
        plant,
        np.array([start.slip]),
        np.array([start.start_kmh / 3.6]),
        np.array([start.integral]),
        time=1.0,
        step=2e-3,
    )
    for _, slip, speed, integral in path:
        if speed * 3.6 <= start.end_kmh or abs(surface(case, slip, integral)) <= layer(case):
            break
    assert speed * 3.6 == pytest.approx(start.end_kmh, abs=0.02)
    assert slip == pytest.approx(start.end_slip, abs=2e-3)
    assert surface(case, slip, integral) == pytest.approx(start.end_surface, abs=2e-3)


def test_gain_that_the_bounds_of_the_rail_file_need():
    found = required(smc(), (*BOX, *RAIL_AND_RADIUS))
    assert found >= GAIN_BY_RAIL - 0.01 > SMC["switching_gain"]


@pytest.mark.parametrize(("rail", "radius"), UNSTABLE_RADIUS.items())
def test_torque_feedback_is_unstable_at_a_corner_of_the_bounds(rail, radius):
    """At the reference, where the law knows the holding torque: mass, inertia and friction are searched."""
    case = torque_feedback(rail)

    def margin(x):
        plant = case.data.plant.with_numbers({**x, **UNSTABLE_CORNER})
        share = np.clip(holding_torque(plant, case.slip, x["speed"]) / plant.max_torque, 1e-3, 1.0 - 1e-3)
        duty = linear.duty_of(plant, share, case.sample_time)
        matrix = linear.sampled_map(case, plant, case.slip, x["speed"], duty)
        return 1.0 - linear.spectral_radius(matrix)

    free = {"speed": case.speeds} | {name: case.data.bounds[name] for name in BOX}
    found = assail(Attack(check="-", statement="-", box=free, margin=margin), evaluations=4000)
    assert found.broken
    assert 1.0 - found.margin >= radius - 0.01


@pytest.mark.parametrize(("vent_time", "eigenvalue"), FAST_VENT.items())
def test_eigenvalue_with_fast_venting(vent_time, eigenvalue):
    case, speed = coach(vent_time), np.array([FAST_VENT_SPEED])
    slip, duty = linear.equilibrium(case, case.data.plant, speed)
    frozen = slip_pole(case.data.plant, slip, speed)
    matrix = linear.sampled_map(case, case.data.plant, slip, speed, duty, q=frozen)[..., 0]
    assert np.linalg.eigvals(matrix).min() == pytest.approx(eigenvalue, abs=1.5e-3)


def test_the_duty_swings_for_ever_with_fast_venting():
    case = torque_feedback()
    plant = case.data.plant.with_numbers(SWINGING)
    speed = np.array([*SWINGING_SPEEDS, CALM_SPEED])
    state = motion.wheels(case.slip, speed, holding_torque(plant, case.slip, speed))
    motion.sampled_run(case, plant, state, 500)
    torques = []
    for _ in range(20):
        motion.sampled_run(case, plant, state, 1)
        torques.append(state.torque / plant.max_torque)
    swing = np.ptp(np.array(torques), axis=0)
    assert np.all(swing[:-1] > 5e-3)
    assert swing[-1] < 1e-4


@pytest.mark.parametrize("point", PEAK_SUMS, ids=lambda each: f"{each.rise:.1%}")
def test_unequal_loads_raise_the_sum_of_the_peaks(point):
    plant = read_data("er24pc", "polach-dry").plant.with_numbers(asdict(point))
    assert peak_rise(plant, point.speed, point.transfer) >= point.rise
    shipped = read_data("er24pc", "polach-dry").plant
    assert peak_rise(shipped, point.speed, point.transfer) < 0.0


@pytest.mark.parametrize("run", [LEAVES, FALLS], ids=["out", "down"])
def test_runs_of_the_adaptive_law_leave_the_slips_of_its_theorem(run, adaptive_case):
    case = replace(adaptive_case, gains={**adaptive_case.gains, **ADAPTIVE})
    plant = case.data.plant.with_numbers(run)
    done = motion.adaptive_run(
        replace(case, slips=(-0.1, 0.9)),  # so that it goes on where it leaves the slips
        plant,
        np.array([run["start"]]),
        np.array([case.speeds[1]]),
        least_speed=1.0,
        constant=25e3,
        bound=20e3,
        step=2e-3,
    )
    if "highest" in run:
        assert done.highest[0] > case.slips[1]
        assert done.highest[0] <= run["highest"] + 2e-3
    else:
        assert done.lowest[0] <= run["lowest"] < case.slips[0]
