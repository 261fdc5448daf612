"""Many stops: the same numbers as single stops, repeatable, the same bits with any division, interruptible."""

import itertools
import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields, replace

import numpy as np
import pytest

from wspd_design.codegen import closed_loop
from wspd_design.controllers.protocol import Command
from wspd_design.model.number import where
from wspd_design.parameters.errors import UserError
from wspd_design.parameters.loading import load_entries, load_rail
from wspd_design.plants.names import plant_of
from wspd_design.simulation import campaign_rows, draws, loop_input
from wspd_design.simulation.campaign import CHUNK, chunks, shard, simulate_many
from wspd_design.simulation.draws import Choice, Draw, Uniform, within_bounds
from wspd_design.simulation.metrics import metrics
from wspd_design.simulation.records import Patch, Scenario, Sensing
from wspd_design.simulation.stop import simulate, simulate_on

RAIL = "table10-wet"
STEP = 6e-3  # s, a step between two points of the traces


@pytest.fixture(scope="module")
def scenario():
    return Scenario(rail=load_rail(RAIL), initial_speed=30.0 / 3.6, seed=5)


@pytest.fixture(scope="module")
def bounds():
    return within_bounds(load_entries("vehicle", "er24pc"), load_entries("rail", RAIL))


def drawn_case(er24pc, scenario, bounds, run):
    """Vehicle and stop of one row, from the records alone."""
    plant, stop = campaign_rows.Deck(campaign_rows.plant_of("planar", er24pc), scenario, bounds).cases(
        run, 1
    )[0]
    return plant.vehicle, stop


def plan_of(er24pc, law, scenario):
    return campaign_rows.make_plan(er24pc, law, scenario, plant="planar", draws=(), check_every=0)


def test_nominal_runs_are_the_single_stop(er24pc, make_controller, scenario):
    controller = make_controller("trenitalia", RAIL)
    many = simulate_many(er24pc, controller, scenario, count=18)
    single = simulate(er24pc, controller, scenario)
    assert many.complete
    assert many.table["stopped"].all()
    np.testing.assert_allclose(many.table["distance_m"], single.totals.distance, rtol=1e-9)
    np.testing.assert_allclose(many.table["torque_integral_Nms"], single.totals.torque, rtol=1e-9)


@pytest.mark.parametrize(
    ("name", "plant"), [("afsmc", "planar"), ("trenitalia", "planar"), ("none", "quarter")]
)
def test_figures_are_those_of_single_stops(er24pc, make_controller, scenario, bounds, name, plant):
    """A row against the metrics of the same stop alone, which count from its samples, traces and ideal stop."""
    law = make_controller(name, RAIL)
    many = simulate_many(er24pc, law, scenario, count=20, draws=bounds, plant=plant)
    for run in (0, 7, 19):
        row = many.table[run]
        vehicle, stop = drawn_case(er24pc, scenario, bounds, run)
        single = simulate(vehicle, law, stop, plant=plant)
        figures = metrics(single, vehicle, stop, slip_reference=0.14)
        for column, value in (
            ("distance_m", figures.distance),
            ("stopping_time_s", figures.stopping_time),
            ("torque_integral_Nms", figures.torque_integral),
            ("efficiency", figures.efficiency),
            ("slip_mean", figures.slip_mean),
            ("slip_max", figures.slip_max),
            ("vented_air", figures.vented_air),
        ):
            assert row[column] == pytest.approx(value, rel=1e-5, abs=1e-6), column
        assert row["lock_time_s"] == pytest.approx(figures.lock_time, abs=STEP)
        # The reference of the law is .14; one without a reference has no slip about it.
        expected = figures.slip_rms if name == "afsmc" else math.nan
        assert row["slip_rms"] == pytest.approx(expected, rel=1e-5, nan_ok=True)
        switches = [_switches(samples) for samples in single.axle_samples]
        assert row["valve_switches_per_s"] * row["stopping_time_s"] == pytest.approx(
            np.mean(switches), rel=1e-9
        )
        assert f"sliding_work_J_{len(switches)}" in row.dtype.names
        work = sum(row[f"sliding_work_J_{axle + 1}"] for axle in range(len(switches)))
        assert work * 4 / len(switches) == pytest.approx(single.totals.sliding_work, rel=1e-5)


def _switches(samples):
    """Changes of the valve state, counted from the commands."""
    states = [
        state
        for sample in samples
        for state, share in enumerate((sample.fill, sample.vent, 1.0 - sample.fill - sample.vent))
        if share > 1e-9
    ]
    return sum(a != b for a, b in itertools.pairwise(states))


@dataclass(frozen=True, kw_only=True)
class LockingTwice:
    """Fill, vent from 4 s on, and fill again from 7 s on; a user's own controller."""

    name: str = "locking twice"
    sample_time: float = 0.1

    def start(self, measurement):  # noqa: ARG002
        return (1e-9,)

    def step(self, state, measurement):  # noqa: ARG002
        (time,) = state
        vent = where(time > 4.0, where(time < 7.0, 1.0, 0.0), 0.0)
        return (time + self.sample_time,), Command(fill=1.0 - vent, vent=vent)


FAST = Scenario(rail=load_rail("polach-wet"), initial_speed=120.0 / 3.6)


@pytest.mark.parametrize("name", ["locking twice", "trenitalia"])
def test_locks_are_those_of_the_traces(er24pc, make_controller, name):
    """Longest and total time at rest above 10 km/h of each axle, from the traces of the same stop."""
    law = LockingTwice() if name == "locking twice" else make_controller(name, "polach-wet")
    row = campaign_rows.compute_rows(plan_of(er24pc, law, FAST), 0, 1)[0]
    run = simulate(er24pc, law, FAST)
    fast = run.speed > loop_input.JUDGING_SPEED
    locks = 0
    for axle in range(4):
        at_rest = (run.wheel_speed[:, axle] == 0.0) & fast
        edges = np.flatnonzero(np.diff(np.concatenate([[0], at_rest, [0]]).astype(int)))
        lengths = [run.time[end - 1] - run.time[start] for start, end in edges.reshape(-1, 2)]
        locks += len(lengths)
        margin = 2.0 * STEP * max(len(lengths), 1)
        assert row[f"longest_lock_s_{axle + 1}"] == pytest.approx(max(lengths, default=0.0), abs=margin)
        assert row[f"total_lock_s_{axle + 1}"] == pytest.approx(sum(lengths), abs=margin)
    assert (locks >= 8) is (name == "locking twice")  # two on each axle


def test_a_lock_that_is_not_ended_is_seen(er24pc, monkeypatch):
    """The planted fault: the length goes on over the next lock."""
    source = closed_loop.closed_loop_source

    def faulty(*arguments, **options):
        text = source(*arguments, **options)
        right = "locked != 0.0 ? loop->lock_length[l] + judged : 0.0"
        assert right in text
        return text.replace(right, "loop->lock_length[l] + judged")

    monkeypatch.setattr(closed_loop, "closed_loop_source", faulty)
    law = LockingTwice(sample_time=0.1 + 1e-7)  # so that the loop is made anew
    row = campaign_rows.compute_rows(plan_of(er24pc, law, FAST), 0, 1)[0]
    assert row["longest_lock_s_1"] == row["total_lock_s_1"]  # the test above sees two locks


SPREADS = {
    "speed_noise": Choice(values=(0.0, 0.05)),
    "pulses_per_turn": Choice(values=(80.0, 100.0)),
    "period_timing": Choice(values=(0.0, 1.0)),
    "reference_error": Uniform(low=-0.02, high=0.02),
    "reference_drift": Uniform(low=-0.05, high=0.05),
    "reference_noise": Choice(values=(0.0, 0.05)),
    "torque_error": Uniform(low=-0.2, high=0.2),
    "dead_time": Uniform(low=0.0, high=0.25),
    "shortest_pulse": Choice(values=(0.0, 0.02)),
}
OF_VEHICLE = {
    "accelerometer_bias",
    "accelerometer_noise",
    "radius_errors",
}  # test_vehicle_law_engines.py has these


def test_every_disturbance_differs_from_stop_to_stop(er24pc, make_controller, scenario):
    """Rows in which all disturbances are drawn are those stops alone."""
    assert set(SPREADS) | OF_VEHICLE == {field.name for field in fields(Sensing)}
    law = make_controller("torque-feedback", RAIL)
    drawn = (
        *(Draw(name=f"stop.sensing.{name}", distribution=spread) for name, spread in SPREADS.items()),
        Draw(name="stop.grade", distribution=Uniform(low=-0.01, high=0.01)),
        Draw(name="stop.pad_vibration", distribution=Choice(values=(0.0, 1.0))),
        Draw(name="stop.initial_speed", distribution=Uniform(low=5.0, high=8.0)),
    )
    table = simulate_many(er24pc, law, scenario, count=16, draws=drawn).table
    for row in table:
        casts = {float | None: float}  # a time of the valves, or that of the vehicle
        kinds = {field.name: casts.get(field.type, field.type) for field in fields(Sensing)}
        stop = replace(
            scenario,
            seed=int(row["seed"]),
            grade=float(row["stop.grade"]),
            initial_speed=float(row["stop.initial_speed"]),
            pad_vibration=bool(row["stop.pad_vibration"]),
            sensing=Sensing(**{name: kinds[name](row[f"stop.sensing.{name}"]) for name in SPREADS}),
        )
        assert simulate(er24pc, law, stop).totals.distance == pytest.approx(row["distance_m"], rel=1e-9)
    assert len(set(table["distance_m"])) == len(table)


@pytest.fixture(scope="module")
def noisy(scenario):
    return replace(scenario, initial_speed=15.0 / 3.6, sensing=Sensing(speed_noise=0.1))


@pytest.fixture(scope="module")
def reference(er24pc, make_controller, noisy, bounds):
    """Rows 0 to 159 by one thread."""
    with ThreadPoolExecutor(1) as one:
        return simulate_many(
            er24pc, make_controller("trenitalia", RAIL), noisy, count=160, draws=bounds, executor=one
        ).table


@pytest.mark.parametrize(("first", "count"), [(0, 160), (0, 1), (3, 5), (100, 60), (127, 2), (159, 1)])
def test_a_row_depends_on_its_number_alone(er24pc, make_controller, noisy, bounds, reference, first, count):
    law = make_controller("trenitalia", RAIL)
    with ThreadPoolExecutor(8) as eight:
        part = simulate_many(er24pc, law, noisy, first=first, count=count, draws=bounds, executor=eight).table
    assert part.tobytes() == reference[first : first + count].tobytes()


def test_a_row_that_depends_on_its_chunk_is_seen(
    er24pc, make_controller, noisy, bounds, reference, monkeypatch
):
    """The planted fault: a generator that begins anew with each chunk."""
    law, true = make_controller("trenitalia", RAIL), draws._shares
    monkeypatch.setattr(draws, "_shares", lambda seed, name, _first, count: true(seed, name, 0, count))
    part = simulate_many(er24pc, law, noisy, first=100, count=5, draws=bounds).table
    assert part["run"].tolist() == reference["run"][100:105].tolist()
    assert part["distance_m"].tolist() != reference["distance_m"][100:105].tolist()


def test_another_seed_is_another_campaign(er24pc, make_controller, noisy, bounds, reference):
    law = make_controller("trenitalia", RAIL)
    other = simulate_many(er24pc, law, replace(noisy, seed=6), count=20, draws=bounds).table
    assert not np.isin(other["distance_m"], reference["distance_m"]).any()
    assert len(set(reference["distance_m"])) == len(reference)


def test_stated_rows_are_checked_with_half_the_steps(er24pc, make_controller, scenario, bounds, monkeypatch):
    law = make_controller("trenitalia", RAIL)
    many = simulate_many(er24pc, law, scenario, first=5, count=12, draws=bounds, check_every=7)
    checked = ~np.isnan(many.table["step_distance_change"])
    assert many.table["run"][checked].tolist() == [7, 14]
    assert (many.table["step_distance_change"][checked] < 1e-6).all()
    assert (many.table["step_slip_change"][checked] < 1e-4).all()

    def coarse_input(cases, controller):  # the planted fault
        given = loop_input.loop_input(cases, controller)
        given.settings.longest_step, given.settings.creep_rate = 0.1, 0.1 * given.settings.creep_rate
        return given

    monkeypatch.setattr(campaign_rows, "loop_input", coarse_input)
    coarse = simulate_many(er24pc, law, scenario, first=7, count=1, draws=bounds, check_every=7)
    assert coarse.table["step_distance_change"][0] > 1e-6
    none = simulate_many(er24pc, law, scenario, count=2, check_every=0)
    assert np.isnan(none.table["step_distance_change"]).all()


def test_a_change_of_rail_has_no_efficiency(er24pc, make_controller, scenario):
    patched = replace(scenario, patches=(Patch(start=5.0, rail=load_rail("polach-dry")),))
    table = simulate_many(er24pc, make_controller("none", RAIL), patched, count=2).table
    assert np.isnan(table["efficiency"]).all()
    assert table["stopped"].all()


@pytest.mark.parametrize(("first", "count"), [(0, 1), (0, 1000), (5, 100), (CHUNK, CHUNK), (CHUNK - 1, 2)])
def test_chunks_cover_all_runs_once(first, count):
    pieces = chunks(first, count)
    assert [run for start, length in pieces for run in range(start, start + length)] == list(
        range(first, first + count)
    )
    assert all(start % CHUNK == 0 for start, _ in pieces[1:])


@pytest.mark.parametrize(("count", "of"), [(1000, 3), (1000, 8), (CHUNK, 1), (10 * CHUNK + 1, 4)])
def test_parts_cover_all_chunks_once(count, of):
    parts = [shard(count, number, of) for number in range(1, of + 1)]
    assert [piece for part in parts for piece in chunks(*part) if part[1]] == chunks(0, count)


def test_an_interrupt_keeps_what_is_done(er24pc, make_controller, scenario):
    def interrupt(finished):
        if finished:
            raise KeyboardInterrupt

    many = simulate_many(er24pc, make_controller("none", RAIL), scenario, count=500, progress=interrupt)
    assert not many.complete
    assert CHUNK - 1 <= len(many.table) < 500
    assert (many.table["distance_m"] > 0.0).all()


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"count": 0}, "count = 0 must be at least 1"),
        ({"count": 1, "first": -1}, "first = -1 must not be negative"),
        ({"count": 1, "check_every": -1}, "check_every = -1 must be 1 or more"),
        (
            {
                "count": 1,
                "draws": [Draw(name="stop.sensing.reference_error", distribution=Uniform(low=0.0, high=0.1))]
                * 2,
            },
            "drawn twice",
        ),
    ],
)
def test_what_is_no_campaign_is_refused(er24pc, make_controller, scenario, options, sentence):
    with pytest.raises(UserError, match=sentence):
        simulate_many(er24pc, make_controller("none", RAIL), scenario, **options)


@pytest.mark.parametrize("mass", [61473.0, 92209.0])
def test_the_body_takes_up_what_a_drawn_mass_adds(er24pc, make_controller, scenario, mass):
    """The parts weigh what the whole does; the load transfer, and with it the distance, is that of the heavy body."""
    draw = Draw(name="vehicle.mass", distribution=Choice(values=(mass,)))
    changed, _ = drawn_case(er24pc, scenario, (draw,), 0)
    assert changed.mass == mass
    assert changed.bogie_mass == er24pc.bogie_mass
    assert changed.body_mass + 2.0 * changed.bogie_mass == pytest.approx(mass)
    light = replace(changed, body_mass=er24pc.body_mass)
    controller = make_controller("trenitalia", RAIL)
    plants = (
        plant_of("planar", each) for each in (changed, light)
    )  # simulate refuses masses that contradict
    heavy, kept = (simulate_on(plant, controller, scenario).totals.distance for plant in plants)
    assert heavy != pytest.approx(kept, rel=1e-6)
