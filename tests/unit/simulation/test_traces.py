"""Traces of a stop: times, commands, pressures, what the law sees and remembers, and files that keep them."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest

import wspd_design as wd
from wspd_design.controllers.observers.sensors import Sensors
from wspd_design.parameters.records import DynamicBrake, Pads
from wspd_design.simulation.law_memory import speed_estimate

EVERY = 0.01


@pytest.fixture(scope="module")
def run(er24pc):
    law = wd.controller("smc", er24pc, wd.load_rail("polach-wet"), wd.Specification(sample_time=0.1))
    return wd.simulate(er24pc, law, wd.Scenario.stop(from_kmh=60, rail=wd.load_rail("polach-wet"), seed=7))


@pytest.fixture(scope="module")
def traces(run):
    return run.resampled(every=EVERY)


def test_the_grid_is_uniform_and_ends_with_the_stop(run, traces):
    assert np.diff(traces["time_s"]) == pytest.approx(EVERY, rel=1e-9)
    assert traces["time_s"][0] == 0.0
    assert 0.0 <= run.time[-1] - traces["time_s"][-1] < EVERY


def test_a_multiple_of_the_interval_is_not_lost(run):
    """A stop of exactly so many intervals has its last row, whatever the last bit of the quotient says."""
    end = float(run.time[-1])
    assert len(run.resampled(every=end / 7.0).table) == 8


def test_what_moves_is_interpolated_between_its_records(run, traces):
    place = np.searchsorted(run.time, 5.0)
    row = round(5.0 / EVERY)
    low, high = sorted(run.slip[place - 1 : place + 1, 2])
    assert low <= traces["slip_3"][row] <= high
    assert traces["speed_m_s"][row] == pytest.approx(run.speed[place], rel=1e-4)


def test_commands_are_held_from_sample_to_sample(run, traces):
    samples = run.axle_samples[1]
    for sample in samples[:-1]:
        row = round(sample.time / EVERY)
        held = slice(row, row + round(run.sample_time / EVERY))
        assert set(traces["fill_2"][held]) == {sample.fill}
        assert set(traces["vent_2"][held]) == {sample.vent}
        assert set(traces["law_integral_of_the_slip_error_2"][held]) == {sample.state[0]}


@pytest.mark.parametrize(("vibration", "pads", "dynamic"), [(False, False, False), (True, True, True)])
def test_the_pressure_is_that_behind_the_torque_that_the_law_is_told(er24pc, vibration, pads, dynamic):
    """The program tells its law the torque of the pressures; the traces find the pressure from what brakes give."""
    table = Pads(
        speeds=(5.0, 15.0, 40.0),
        speed_factors=(1.1, 1.0, 0.8),
        temperatures=(0.0, 300.0),
        temperature_factors=(1.0, 0.7),
        heat_capacity=3e5,
        cooling=50.0,
    )
    motor = DynamicBrake(torque=10e3, power=4e5, build_up_time=0.5, fade_speed=8.0, cut_out_speed=3.0)
    vehicle = replace(er24pc, pads=table if pads else None, dynamic=motor if dynamic else None)
    rail = wd.load_rail("polach-wet")
    law = wd.controller("trenitalia", vehicle, rail, wd.Specification())
    stop = replace(wd.Scenario.stop(from_kmh=60, rail=rail), pad_vibration=vibration)
    run = wd.simulate(vehicle, law, stop)
    compared = 0
    for axle, samples in enumerate(run.axle_samples):
        for sample in samples[1:]:
            place = int(np.argmin(abs(run.time - sample.time)))
            if abs(run.time[place] - sample.time) < 1e-9:
                told = sample.seen.torque / er24pc.brake.max_torque
                motors = 0.0 if run.dynamic_torque is None else run.dynamic_torque[place, axle]
                found = run.cylinder_pressure[place, axle] / er24pc.brake.max_pressure
                assert found == pytest.approx(told - motors / er24pc.brake.max_torque, abs=1e-9)
                compared += 1
    assert compared > 200


def test_a_wheelset_without_a_brake_has_no_pressure_and_no_commands(er24pc):
    brake = replace(er24pc.brake, axle_shares=(1.0, 0.0, 1.0, 1.0))
    vehicle, rail = replace(er24pc, brake=brake), wd.load_rail("polach-wet")
    law = wd.controller("none", vehicle, rail, wd.Specification())
    run = wd.simulate(vehicle, law, wd.Scenario.stop(from_kmh=30, rail=rail))
    assert not run.cylinder_pressure[:, 1].any()
    assert run.cylinder_pressure[-1, 0] > 1e5
    traces = run.traces()
    assert "fill_1" in traces.units
    assert not {"fill_2", "pressure_Pa_2", "told_torque_Nm_2"} & set(traces.units)
    assert "told_speed_m_s" in traces.units


def test_what_a_law_of_a_vehicle_estimates_is_a_column(er24pc):
    rail = wd.load_rail("polach-wet")
    specification = wd.Specification(sample_time=0.02, sensors=Sensors(speed="wheels"))
    law = wd.controller("observer-smc", er24pc, rail, specification)
    run = wd.simulate(er24pc, law, wd.Scenario.stop(from_kmh=60, rail=rail))
    traces, estimate = run.traces(), speed_estimate(run)
    assert traces.units["law_train_speed_m_s"] == "m/s"
    assert "law_slip_reference_1" in traces.units
    at = np.searchsorted(run.time, estimate.time[5] + 1e-6)
    assert traces["law_train_speed_m_s"][at] == estimate.speed[5]
    assert not [name for name in traces.units if name.startswith("law_train_speed_m_s_")]


def test_all_recorded_rows_are_there_without_an_interval(run):
    traces = run.traces()
    assert traces["time_s"] is not run.time
    assert traces["time_s"].tolist() == run.time.tolist()
    assert traces["torque_Nm_4"].tolist() == run.torque[:, 3].tolist()


@pytest.mark.parametrize(
    ("every", "sentence"),
    [
        (0.0, "must be finite and above 0"),
        (-0.01, "must be finite and above 0"),
        (float("nan"), "must be finite and above 0"),
        (float("inf"), "must be finite and above 0"),
        (1e-9, r"makes .* rows of a stop of .* s; choose a longer one"),
    ],
)
def test_an_interval_that_is_none_is_refused(run, every, sentence):
    with pytest.raises(wd.UserError, match=sentence):
        run.resampled(every=every)


def test_a_column_that_is_not_there_names_those_that_are(traces):
    with pytest.raises(KeyError, match="there are time_s, speed_m_s"):
        traces["speed"]


def test_frame_and_dataset_have_the_same_numbers_with_units(traces):
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    frame, dataset = traces.to_pandas(), traces.to_xarray()
    assert frame.index.name == "time_s"
    assert frame["slip_2"].tolist() == traces["slip_2"].tolist()
    assert frame.attrs["units"]["pressure_Pa_1"] == "Pa"
    assert dataset["slip"].sel(wheelset=2).values.tolist() == traces["slip_2"].tolist()
    assert dataset["pressure_Pa"].attrs["units"] == "Pa"
    assert dataset["speed_m_s"].dims == ("time",)
    assert dataset.attrs["seed"] == "7"
    assert dataset.attrs["version"] == wd.__version__


def test_csv_has_units_in_its_names_and_all_digits(traces, tmp_path):
    traces.write(tmp_path / "a.csv")
    with (tmp_path / "a.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert list(rows[0]) == list(traces.units)
    assert [float(row["slip_4"]) for row in rows] == traces["slip_4"].tolist()


def test_parquet_says_what_it_is_about(traces, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    traces.write(tmp_path / "a.parquet")
    table = parquet.read_table(tmp_path / "a.parquet")
    assert table["torque_Nm_1"].to_pylist() == traces["torque_Nm_1"].tolist()
    about = {key.decode(): value.decode() for key, value in table.schema.metadata.items()}
    assert about["wspd.version"] == wd.__version__
    assert (about["wspd.seed"], about["wspd.controller"], about["wspd.vehicle"]) == ("7", "smc", "er24pc")
    assert json.loads(about["wspd.units"])["speed_m_s"] == "m/s"


def test_matlab_reads_columns_units_and_what_it_is_about(traces, tmp_path):
    from scipy.io import loadmat

    traces.write(tmp_path / "a.mat")
    found = loadmat(tmp_path / "a.mat", squeeze_me=True, simplify_cells=True)
    assert found["slip_1"].tolist() == traces["slip_1"].tolist()
    assert found["units"]["wheel_load_N_1"] == "N"
    assert found["units"]["slip_1"] == "-"
    assert (found["about"]["seed"], found["about"]["version"]) == ("7", wd.__version__)


@pytest.mark.parametrize("ending", ["csv", "parquet", "mat"])
def test_the_same_traces_give_the_same_bytes(traces, tmp_path, ending):
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    for name in "ab":
        traces.write(tmp_path / f"{name}.{ending}")
    first, second = ((tmp_path / f"{name}.{ending}").read_bytes() for name in "ab")
    assert first == second


@pytest.mark.parametrize(
    ("name", "sentence"),
    [("a.xlsx", r"must end in .csv, .parquet or .mat"), ("none/a.csv", "folder .* does not exist")],
)
def test_a_file_that_cannot_be_is_refused(traces, tmp_path, name, sentence):
    with pytest.raises(wd.UserError, match=sentence):
        traces.write(tmp_path / name)
    assert list(tmp_path.iterdir()) == []
