"""A small dossier made by hand, with invented numbers: no simulation and no check runs."""

import math
from dataclasses import replace

import numpy as np

from wspd_design.analysis.brake_sheet import brake_sheet
from wspd_design.analysis.linearization import Linearization
from wspd_design.certificates.records import Certificate, Hypothesis, Point, Range, Role, Series, Status
from wspd_design.controllers.family import FAMILIES
from wspd_design.controllers.protocol import Measurement
from wspd_design.design.records import Design, Gain, Specification
from wspd_design.design.requirements import DrawnSets, Limit, Requirements, judged_by
from wspd_design.design.stop_requirements import MODEL, StopRequirements
from wspd_design.parameters.loading import load_entries, load_rail, load_vehicle
from wspd_design.simulation.comparison import Trial
from wspd_design.simulation.draws import Choice, Draw
from wspd_design.simulation.metrics import Metrics
from wspd_design.simulation.records import Fault, Scenario
from wspd_design.simulation.runs import Ending, Run, Sample, Totals
from wspd_design.simulation.self_check import StepCheck
from wspd_design.studies.dossier import Dossier, PhasePlane
from wspd_design.studies.faults import FaultedStop, Robustness
from wspd_design.studies.judgment import judged_drawn, judged_stop
from wspd_design.studies.ladder import Ladder
from wspd_design.studies.loop_growth import Growth
from wspd_design.studies.provenance import InputFile, Provenance
from wspd_design.studies.reported_law import ReportedLaw
from wspd_design.studies.rung import Rung, axle_figures
from wspd_design.studies.uncertainty import Effect, Spread, Uncertainty, Variant, WorstSet

LYAPUNOV = ("lyapunov_one", "two")  # checks whose curve is a Lyapunov function
INITIAL_SPEED = 120.0 / 3.6
SAMPLE_PROVENANCE = Provenance(
    command="wspd report design.toml --vehicle er24pc --rail polach-wet --seed 7",
    seed=7,
    inputs=(InputFile(name="design.toml", text="[gains]\n", meaning="the design"),),
    searches_cut=("two",),
    program_version="0.1.0",
    package_sha256="fedcba9876543210" * 4,
    package_tree="0123456789" * 4,
    changed=False,
    compiler="cc 1.2.3",
    platform="Linux x86_64",
    versions=(("Python", "3.11.7"), ("numpy", "2.4.6")),
)


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
        seed=0,
        wheel_radius=0.55,
        ending=ending,
        time=time,
        speed=speed,
        distance=np.cumsum(speed) * 0.025,
        wheel_speed=wheel_speed,
        slip=slip,
        torque=30e3 + 1e4 * np.cos(3.0 * time[:, np.newaxis] + np.arange(4)),
        wheel_load=94e3 + 1e4 * np.array([1.5, 0.5, -0.5, -1.5]) * np.ones((401, 1)),
        cylinder_pressure=np.full((401, 4), 3e5),
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
        build_up=1.2,
        build_up_distance=38.5,
        lag=1.259,
        plateau=3.8135,
        slip_mean=0.1412,
        slip_max=0.2399,
        slip_rms=0.0707,
        slip_reached=2.1,
        held_slip_rms=0.0612,
        slip_overshoot=0.0999,
        slip_undershoot=0.1001,
        perfect_slip_rms=0.0012,
        lock_time=0.975,
        judged_lock=0.5,
        slip_band=math.nan,
        speed_error=math.nan,
        distance_error=math.nan,
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
    return Trial(run=run, metrics=replace(figures, **changes), check=check, slip_reference=0.14)


def estimating(plain: Trial) -> Trial:
    """Return the trial of a law of the vehicle: 5 % too fast, slip references that rise, axle 2 released twice."""
    names = (
        "train_speed",
        *(f"slip_reference_{k}" for k in range(1, 5)),
        *(f"released_{k}" for k in range(1, 5)),
    )

    def told(sample: Sample) -> Sample:
        speed = 1.05 * INITIAL_SPEED * (1.0 - sample.time / 10.0)
        held = (0.1 + 0.01 * sample.time,) * 4
        look = (0.0, float(2.0 <= sample.time < 2.5 or 5.0 <= sample.time < 5.5), 0.0, 0.0)
        return sample._replace(state=(speed, *held, *look))

    samples = tuple(map(told, plain.run.samples))
    run = replace(plain.run, memory=names, axle_samples=(samples,) * 4)
    figures = replace(plain.metrics, slip_band=0.091, speed_error=0.05, distance_error=0.65)
    return replace(plain, run=run, metrics=figures)


WANTED = StopRequirements(
    name="sample",
    not_refuted=("lyapunov_one",),
    limits=(
        Limit(criterion="slip_rms", value=0.1, source="a wish"),
        Limit(criterion="longest_lock", value=0.6, source="contract 12", verified=True),
    ),
)
SOUND = tuple(certificate(name, Status.PROVED) for name in MODEL)


def judged(dossier: Dossier, wanted: StopRequirements = WANTED, growth: Growth | None = None) -> Dossier:
    """Judge a dossier whose records were changed again."""
    found = {each.name: each for each in dossier.certificates}
    made = judged_stop(wanted, dossier.trials[0], found, growth=growth, full_adhesion=175.0)
    return replace(dossier, judgment=made, growth=growth)


def drawn(dossier: Dossier, **reached: float) -> Dossier:
    """Judge a dossier by two limits on drawn stops, with checks that find equations and simulation sound."""
    limits = (Limit(criterion="efficiency_mean", value=0.975), Limit(criterion="longest_lock", value=0.1))
    numbers = {"efficiency_mean": 0.9812, "longest_lock": 0.04, "valve_switches": 12.3} | reached
    wanted = Requirements(
        rails=("polach-wet", "polach-dry"),
        within_bounds=("rail",),
        held_out=DrawnSets(sets=200, seed=77),
        limits=limits,
        stop=(("stop.initial_speed", INITIAL_SPEED),),
        draws=(Draw(name="stop.sensing.dead_time", distribution=Choice(values=(0.0, 0.02))),),
    )
    sound = replace(dossier, certificates=(*dossier.certificates, *SOUND))
    found = {each.name: each for each in sound.certificates}
    return replace(sound, judgment=judged_drawn(wanted, judged_by(limits, numbers), sound.trials[0], found))


def faults(**changes) -> Robustness:
    """Return what became of four faults: all hold but for the valve that fills, where the rail forces a lock."""

    def stop(kind: str, distance: float, *locks: float) -> FaultedStop:
        return FaultedStop(
            fault=Fault(axle=2, kind=kind, since=3.0), stopped=True, distance=distance, locks=locks
        )

    plain = Robustness(
        plain=300.0,
        faults=(
            stop("sensor-lost", 306.0, 0.0, 0.1, 0.0, 0.0),
            stop("valve-holds", 309.0, 0.0, 0.4, 0.0, 0.0),
            stop("valve-vents", 345.0, 0.0, 0.0, 0.0, 0.0),
            stop("valve-fills", 300.9, 0.0, 9.0, 0.0, 0.02),
        ),
        patches=FaultedStop(fault=None, stopped=True, distance=512.0, locks=(0.0, 0.2, 0.0, 0.0)),
        full_torque=60e3,
        most_adhesion=(24e3, 31e3),
    )
    return replace(plain, **changes)


def sample_ladder() -> Ladder:
    """Return a ladder of two models, of which the smaller one has other loads."""
    made = trial("mine")
    axles = axle_figures(made.run, wheelsets=4, wheel_radius=0.55, build_up=1.2)
    alike = tuple(replace(axle, braking_load=axle.static_load) for axle in axles)
    top = Rung(
        title="planar",
        plant="planar",
        run=made.run,
        metrics=made.metrics,
        axles=axles,
        step_change=2e-9,
        spread=0.0,
    )
    loaded = tuple(replace(axle, static_load=94e3) for axle in axles)
    return Ladder(
        vehicle="er24pc",
        controller="mine",
        rail="polach-wet",
        initial_speed=INITIAL_SPEED,
        rungs=(replace(top, title="quarter", plant="quarter", axles=alike), replace(top, axles=loaded)),
        remark="Inferred: 3 of the 4 numbers of a model.",
    )


def uncertainty(**changes) -> Uncertainty:
    """Return an uncertainty of four sets; the distance of the last has no end."""

    def spread(name: str, nominal: float, *values: float, worst: int) -> Spread:
        ordered = sorted(values)
        return Spread(
            name=name,
            nominal=nominal,
            low=ordered[0],
            high=ordered[-1],
            p05=ordered[0],
            p95=ordered[2],
            worst=WorstSet(
                number=worst,
                value=values[worst],
                parameters=(("vehicle.mass", 80e3), ("rail.mu0", 0.25)),
                command=f"wspd simulate mine.toml --only-run {worst}",
            ),
            values=values,
        )

    plain = (("distance", 187.65), ("efficiency", 0.93), ("slip_rms", 0.0707), ("longest_lock", 0.0))
    found = Uncertainty(
        sets=4,
        seed=7,
        drawn=("vehicle.mass", "rail.mu0"),
        held=("vehicle.wheel_radius",),
        unstopped=1,
        checked=1,
        step_change=2e-4,
        numerical=0.4,
        numbers=((70e3, 0.3), (76e3, 0.28), (75e3, 0.26), (80e3, 0.25)),
        spreads=(
            spread("distance", 187.65, 181.2, 176.4, 240.9, math.inf, worst=3),
            spread("efficiency", 0.93, 0.95, 0.912, 0.881, 0.0, worst=3),
            spread("slip_rms", 0.0707, 0.06, 0.08, 0.1041, 0.09, worst=2),
            spread("longest_lock", 0.0, 0.0, 0.0, 0.0, 0.0, worst=0),
        ),
        effects=(
            Effect(
                name="vehicle.mass",
                low=61473.0,
                high=92209.0,
                at_low=(("distance", 185.0), ("efficiency", 0.92)),
                at_high=(("distance", 190.5), ("efficiency", 0.94)),
            ),
            Effect(
                name="rail.mu0",
                low=0.24,
                high=0.36,
                at_low=(("distance", 230.0), ("efficiency", 0.9), ("slip_rms", 0.09)),
                at_high=(("distance", 170.0), ("efficiency", 0.94), ("slip_rms", 0.06)),
            ),
        ),
        variants=(
            Variant(
                subject="rail", words="low-adhesion", outcome=(("distance", math.inf), ("efficiency", 0.0))
            ),
            Variant(subject="sensors", words="torque error -10 %", outcome=plain),
            Variant(subject="sensors", words="accelerometer bias 0.05 m/s2", outcome=(("distance", 201.4),)),
        ),
    )
    return replace(found, **changes)


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
            trial("trenitalia", rail, distance=201.75, build_up_distance=62.0),
            trial("none", rail),
        )
    names = ("lyapunov_one", "two", "three", "four", "five", "six", "seven", "eight", "nine")
    checks = tuple(certificate(name, status) for name, status in zip(names, statuses, strict=False))
    return Dossier(
        law=ReportedLaw(
            name="mine",
            title="adaptive fuzzy sliding mode",
            origin="eqs. (29) to (42)",
            own=False,
            called="design.toml",
            equations=FAMILIES["afsmc"].equations,
            acts_on="one wheelset",
            fingerprint="123abc" * 10 + "1234",
            reads=("train speed", "wheel speed"),
        ),
        specification=Specification(),
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
        other_parameters=(load_entries("constants", "constants"), load_entries("controller", "trenitalia")),
        compared_designs=(),
        brake=brake_sheet(load_vehicle("er24pc")),
        adhesion_use="The brake asks for much.",
        idle=False,
        linearizations=tuple(
            linearization(float(v), 2.0 - 8.0 / v) for v in np.geomspace(1.0, INITIAL_SPEED, 12)
        ),
        certificates=checks,
        trials=trials,
        phase_plane=PhasePlane(
            integral=(0.0, 0.014, 0.02), error=(0.14, 0.06, -0.05), surface_rate=0.38, layer=0.025
        ),
        growth=None,
        judgment=judged_stop(
            WANTED, trials[0], {each.name: each for each in checks}, growth=None, full_adhesion=175.0
        ),
        next_step=None,
        robustness=None,
        uncertainty=None,
        ladder=None,
        scenario=Scenario(rail=load_rail(rail), initial_speed=INITIAL_SPEED, seed=7),
        previous=None,
        provenance=SAMPLE_PROVENANCE,
    )
