"""A small dossier made by hand, with invented numbers: no simulation and no check runs."""

import math
from dataclasses import replace

import numpy as np

from wspd_design.analysis.brake_sheet import brake_sheet
from wspd_design.analysis.linearization import Linearization
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Range, Role, Series, Status
from wspd_design.controllers.protocol import Measurement
from wspd_design.design.records import Design, Gain, Specification
from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.records import Ending, Run, Sample, Scenario, Totals
from wspd_design.simulation.self_check import StepCheck
from wspd_design.studies.dossier import Dossier, PhasePlane, Provenance

LYAPUNOV = ("lyapunov_one", "two")  # checks whose curve is a Lyapunov function
INITIAL_SPEED = 120.0 / 3.6


def certificate(name: str, status: Status, **changes) -> Certificate:
    plain = Certificate(
        name=name,
        title=f"Check {name}",
        claim=f"the claim of {name}",
        status=status,
        explanation=f"the explanation of {name}",
        margin=Range(low=None, high=-1.25, unit="1/s"),
        worst_point=(Point(name="speed", value=63.5, unit="km/h"),),
        hypotheses=(Hypothesis(text=f"the hypothesis of {name}", status=Status.EVIDENCE),),
        assumptions=("T = u",),
        method="sampling",
        remark="81 speeds were tried",
        reference="eq. (19)",
        model_hash="0123456789abcdef" * 4,
        seconds=0.123,
        series=(
            Series(
                name="V",
                x_label="time [s]",
                y_label="V [-]",
                x=(0.0, 1.0),
                y=(2.0, 1.0),
                role=Role.LYAPUNOV if name in LYAPUNOV else Role.CURVE,
            ),
            Series(name="slip", x_label="time [s]", y_label="slip [-]", x=(0.0, 1.0), y=(0.0, 0.14)),
        ),
    )
    return replace(plain, **changes)


def trial(
    controller: str,
    rail: str = "polach-wet",
    *,
    ending: Ending = Ending.STOPPED,
    spread: float = 0.0,
    **changes,
) -> Trial:
    time = np.linspace(0.0, 10.0, 401)
    speed = INITIAL_SPEED * (1.0 - time / 10.0)
    slip = 0.14 + 0.1 * np.sin(3.0 * time[:, np.newaxis] - 0.3 * np.arange(4))
    wheel_speed = speed[:, np.newaxis] * (1.0 - slip) / 0.55
    wheel_speed[200:240, 1] = 0.0
    totals = dict.fromkeys(Totals.__dataclass_fields__, 1.0)
    samples = tuple(
        Sample(time=0.1 * k, fill=k % 2, vent=1 - k % 2, state=(0.0,), seen=Measurement(20.0, 30.0, 3e4))
        for k in range(100)
    )
    run = Run(
        controller=controller,
        vehicle="er24pc",
        rail=rail,
        plant="planar",
        sample_time=0.1,
        dead_time=0.0,
        shortest_pulse=0.0,
        initial_speed=INITIAL_SPEED,
        ending=ending,
        time=time,
        speed=speed,
        distance=np.cumsum(speed) * 0.025,
        wheel_speed=wheel_speed,
        slip=slip,
        torque=30e3 + 1e4 * np.cos(3.0 * time[:, np.newaxis] + np.arange(4)),
        wheel_load=94e3 + 1e4 * np.array([1.5, 0.5, -0.5, -1.5]) * np.ones((401, 1)),
        axle_samples=(samples,) * 4,
        totals=Totals(**totals),
        final_wheel_speeds=(0.0,) * 4,
        slip_max=0.24,
        engine="by hand",
    )
    figures = Metrics(
        distance=187.65,
        stopping_time=10.0,
        torque_integral=1.5678e6,
        lag=1.259,
        plateau=3.8135,
        slip_mean=0.1412,
        slip_max=0.2399,
        slip_rms=0.0707,
        lock_time=0.975,
        saturated_share=1.0,
        valve_switches=99,
        vented_air=3.21,
        air_used=np.nan,
        lowest_reservoir=np.nan,
        watchdog_fills=None,
        adhesion_utilization=0.81,
        ideal_stop=174.25,
        ideal_ending=Ending.STOPPED,
        efficiency=0.9286,
        released_below=math.nan,
        momentum_residual=1.2e-9,
        energy_residual=-3.4e-8,
    )
    check = StepCheck(distance=2e-9, slip=3e-7, refinement=1, sensitive=spread > 0.0, spread=spread)
    return Trial(run=run, metrics=replace(figures, **changes), check=check)


def linearization(speed: float, pole: float) -> Linearization:
    return Linearization(
        vehicle="er24pc",
        rail="polach-wet",
        slip=0.14,
        speed=speed,
        equilibrium_torque=25e3,
        equilibrium_duty=0.42,
        slip_pole=pole,
        gain=2e-5,
        time_constant=0.6,
        state_matrix=np.array([[pole, 2e-5], [0.0, -1.0 / 0.6]]),
        input_matrix=np.array([[0.0], [1e5]]),
    )


def sample_dossier(
    statuses: tuple[Status, ...] = tuple(Status),
    *,
    rail: str = "polach-wet",
    trials: tuple[Trial, ...] | None = None,
) -> Dossier:
    """Return a dossier with one check of each given status."""
    if trials is None:
        trials = (
            trial("mine", rail),
            trial("trenitalia", rail, distance=201.75, lag=2.0),
            trial("none", rail),
        )
    names = ("lyapunov_one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
    return Dossier(
        design=Design(
            name="mine",
            law="afsmc",
            vehicle="er24pc",
            vehicle_hash="abc",
            rail_hash="def",
            rail=rail,
            specification=Specification(),
            gains=(
                Gain(name="integral_gain", value=0.3846, unit="1/s", why="because of the valve"),
                Gain(name="centres", value=(-0.14, 0.0, 0.14), unit="-", why="evenly"),
                Gain(name="dead_zone", value=True, unit="-", why="the repaired V needs it"),
            ),
        ),
        vehicle=load_entries("vehicle", "er24pc"),
        rail=load_entries("rail", rail),
        own_files=(),
        other_parameters=(load_entries("constants", "constants"), load_entries("controller", "trenitalia")),
        compared_designs=(),
        brake=brake_sheet(load_vehicle("er24pc")),
        adhesion_use="The brake asks for much.",
        linearizations=tuple(
            linearization(float(v), 2.0 - 8.0 / v) for v in np.geomspace(1.0, INITIAL_SPEED, 12)
        ),
        certificates=tuple(certificate(name, status) for name, status in zip(names, statuses, strict=False)),
        trials=trials,
        lag_distances=tuple(INITIAL_SPEED * each.metrics.lag for each in trials),
        phase_plane=PhasePlane(
            integral=(0.0, 0.014, 0.02), error=(0.14, 0.06, -0.05), surface_rate=0.38, layer=0.025
        ),
        scenario=Scenario(rail=load_rail(rail), initial_speed=INITIAL_SPEED, seed=7),
        provenance=Provenance(
            command="wspd report mine.toml",
            versions=(("Python", "3.11.7"), ("wspd-design", "0.1.0")),
            seed=7,
            input_hash="fedcba9876543210" * 4,
        ),
    )
