"""Evidence and a reproduction made by hand, with invented numbers: nothing is simulated."""

import math
from dataclasses import replace

import numpy as np

from tests.unit.reporting.sample_dossier import INITIAL_SPEED, SAMPLE_PROVENANCE, trial
from wspd_design.design.records import Specification
from wspd_design.parameters.loading import load_track_spectrum, load_vehicle
from wspd_design.plants.multibody.loading import load_multibody
from wspd_design.studies.paper.conclusions import conclusions
from wspd_design.studies.paper.disturbances import CHANNELS, Disturbance, TrackChannel
from wspd_design.studies.paper.evidence import (
    CONTROLLERS,
    RAILS,
    UNPROTECTED,
    Ablation,
    Evidence,
    StopFigures,
    Yardstick,
)
from wspd_design.studies.paper.locomotive import OnLocomotive
from wspd_design.studies.paper.published import load_table10
from wspd_design.studies.paper.reproduction import FrictionCurve, Reproduction
from wspd_design.studies.paper.section7 import Section7
from wspd_design.studies.paper.slip_history import SlipHistory
from wspd_design.studies.paper.table10 import Table10Row
from wspd_design.studies.tornado import Effects, Swing, Tornado

HISTORY = SlipHistory(
    early_rms=0.1,
    late_rms=0.02,
    late_ripple=0.01,
    standstill_rms=0.1,
    front_mean=0.13,
    rear_mean=0.15,
    torque_frequency=1.0,
)


def figures(controller: str, rail: str, *, spread: float = 0.0, history=None, **metrics) -> StopFigures:
    made = trial(controller, rail, spread=spread, **metrics)
    return StopFigures(
        controller=controller,
        rail=rail,
        metrics=made.metrics,
        check=made.check,
        history=replace(HISTORY, **(history or {})),
    )


def sample_evidence(**changes) -> Evidence:
    """Return evidence in which every conclusion of the paper holds."""
    stops = []
    for rail in RAILS:
        wet = rail.endswith("wet")
        for place, name in enumerate(("afsmc", "trenitalia", "knorr-bremse", "mitsubishi", UNPROTECTED)):
            frequency = {"trenitalia": 0.3, "mitsubishi": 1.5}.get(name, 0.8)
            stops.append(
                figures(
                    name,
                    rail,
                    distance=200.0 + 10.0 * place,
                    lag=1.2,
                    efficiency=0.98 - 0.05 * place,
                    ideal_stop=180.0,
                    slip_max=0.6 if wet else 0.25,
                    saturated_share=0.1,
                    vented_air=3.2,
                    history={
                        "standstill_rms": 0.1 + 0.1 * place,
                        "torque_frequency": frequency * (1.3 if wet else 1.0),
                    },
                )
            )
    published = load_table10()
    # A table whose gaps are differences of deceleration, not of build-up.
    slower = {"afsmc": 0.0, "trenitalia": 0.2, "mitsubishi": 0.4, "knorr-bremse": 0.6}
    published = replace(
        published,
        stops=tuple(
            replace(
                each,
                stopping_time_s=10.0 + slower[each.controller],
                distance_m=(11.2 + slower[each.controller]) / 2.0 * INITIAL_SPEED,
            )
            for each in published.stops
        ),
    )
    evidence = Evidence(
        initial_speed=INITIAL_SPEED,
        slip_reference=0.14,
        slip_tolerance=0.05,
        published=published,
        stops=tuple(stops),
        ablations=tuple(
            Ablation(
                rail=rail,
                printed=200.0,
                as_share=201.0,
                unadapted=230.0,
                relay=240.0,
                unadapted_printed=260.0,
                largest_weight=1.5,
                bound_growth=2.0,
                ripple=0.02,
                ideal_ripple=0.01,
            )
            for rail in RAILS
        ),
        yardsticks=tuple(
            Yardstick(rail=rail, ideal_stop=150.0, ideal_time=9.0, ideal_at_once=120.0, constant_slip=160.0)
            for rail in RAILS
        ),
        ideal_fill_time=0.01,
        ideal_sample_time=1e-3,
        fill_time=0.6,
        mean_loads=(220e3, 200e3, 180e3, 160e3),
    )
    return replace(evidence, **changes)


def on_locomotive(small: Section7) -> OnLocomotive:
    """Return stops on the multibody model, of which those on irregular track shift no weight."""
    level = replace(small.evidence, mean_loads=(188.2e3, 188.1e3, 188e3, 188e3))
    nominal = Effects(distance=200.0, transfer=0.1, relief=-0.1, slip=0.14)
    return OnLocomotive(
        model=load_multibody("er24pc-82"),
        smooth=small,
        irregular=replace(small, evidence=level, conclusions=conclusions(level)),
        seed=1,
        tornado=Tornado(
            plant="locomotive",
            controller="afsmc",
            rail="table10-wet",
            initial_speed=INITIAL_SPEED,
            nominal=nominal,
            swings=(
                Swing(
                    name="traction_rod.height",
                    low=0.0,
                    high=1.1,
                    at_low=replace(nominal, transfer=0.05),
                    at_high=replace(nominal, distance=201.0, transfer=0.16),
                ),
                Swing(
                    name="conicity",
                    low=0.025,
                    high=0.4,
                    at_low=nominal,
                    at_high=replace(nominal, slip=0.15, distance=math.inf),
                ),
            ),
            stops=5,
        ),
    )


def sample_reproduction(evidence: Evidence | None = None) -> Reproduction:
    evidence = evidence or sample_evidence()
    trials = {(name, rail): trial(name, rail) for rail in RAILS for name in (*CONTROLLERS, UNPROTECTED)}
    slip = np.linspace(0.0, 1.0, 21)
    wavenumber = np.linspace(0.3, 2.0, 20)
    distance = np.arange(0.0, 30.0, 0.5)
    small = Section7(
        plant="planar",
        vehicle=load_vehicle("er24pc"),
        specification=Specification(),
        trials=trials,
        table10=tuple(
            Table10Row(
                published=each,
                metrics=trials[each.controller, each.rail].metrics,
                spread=0.0,
                momentum=1.57e6,
            )
            for each in load_table10().stops
        ),
        evidence=evidence,
        conclusions=conclusions(evidence),
    )
    return Reproduction(
        small=small,
        locomotive=on_locomotive(small),
        friction=tuple(
            FrictionCurve(rail=rail, speed=speed, slip=slip, force=3e4 * np.tanh(10.0 * slip))
            for rail in RAILS
            for speed in (30.0, 5.0)
        ),
        spectra=load_track_spectrum("erri-b176"),
        track=tuple(
            TrackChannel(
                channel=channel,
                kind=CHANNELS[channel],
                sigma=1.6e-3,
                found_sigma=1.5e-3,
                ratio=1.01,
                wavenumber=wavenumber,
                density=1e-6 / wavenumber,
                found=1.1e-6 / wavenumber,
                distance=distance,
                profile=1e-3 * np.sin(distance),
            )
            for channel in CHANNELS
        ),
        disturbances=tuple(
            Disturbance(controller=name, rail=rail, spread=0.0, by_pads=1e-4, by_track=-0.62)
            for name in CONTROLLERS
            for rail in RAILS
        ),
        ideal_changes=(0.01, -0.02, 0.03, 0.0),
        provenance=replace(SAMPLE_PROVENANCE, command="wspd reproduce -o reports/paper", seed=1, inputs=()),
    )
